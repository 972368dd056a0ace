#include "core/memory_nodes.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include <sched.h>

namespace etendue {

namespace {

namespace fs = std::filesystem;

using KernelSet = std::array<cpu_set_t, ProcessorSet::kMostProcessors / CPU_SETSIZE>;

/// The number that `text` begins with, which is taken off it; nothing where it begins with none.
std::optional<int> take_number(std::string_view& text) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || number < 0) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return number;
}

/// "0-3,8" as the kernel writes it; what is no range ends the list.
ProcessorSet listed_processors(std::string_view text) {
    ProcessorSet processors;
    while (const std::optional<int> first = take_number(text)) {
        std::optional<int> last = first;
        if (text.starts_with('-')) {
            text.remove_prefix(1);
            last = take_number(text);
            if (!last) break;
        }
        for (int processor = *first; processor <= std::min(*last, ProcessorSet::kMostProcessors - 1); ++processor)
            processors.add(processor);
        if (!text.starts_with(',')) break;
        text.remove_prefix(1);
    }
    return processors;
}

}  // namespace

ProcessorSet ProcessorSet::of_this_thread() {
    KernelSet set{};
    ProcessorSet processors;
    if (sched_getaffinity(0, sizeof(set), set.data()) == 0)
        processors.words_ = std::bit_cast<decltype(processors.words_)>(set);
    return processors;
}

void ProcessorSet::add(int processor) {
    if (processor < 0 || processor >= kMostProcessors) return;
    words_[static_cast<std::size_t>(processor) / 64] |= std::uint64_t{1} << processor % 64;
}

bool ProcessorSet::contains(int processor) const {
    if (processor < 0 || processor >= kMostProcessors) return false;
    return (words_[static_cast<std::size_t>(processor) / 64] >> processor % 64 & 1) != 0;
}

int ProcessorSet::size() const {
    int size = 0;
    for (const std::uint64_t word : words_) size += std::popcount(word);
    return size;
}

ProcessorSet ProcessorSet::common_with(const ProcessorSet& other) const {
    ProcessorSet common;
    for (std::size_t word = 0; word < words_.size(); ++word) common.words_[word] = words_[word] & other.words_[word];
    return common;
}

bool ProcessorSet::bind_this_thread() const {
    const auto set = std::bit_cast<KernelSet>(words_);
    return sched_setaffinity(0, sizeof(set), set.data()) == 0;
}

int size_of_all(std::span<const ProcessorSet> sets) {
    int size = 0;
    for (const ProcessorSet& set : sets) size += set.size();
    return size;
}

std::vector<ProcessorSet> memory_nodes(const std::filesystem::path& directory) {
    constexpr std::string_view kPrefix = "node";
    const ProcessorSet allowed = ProcessorSet::of_this_thread();
    std::map<int, ProcessorSet> by_number;
    std::error_code error;
    for (fs::directory_iterator entry(directory, error); entry != fs::directory_iterator(); entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (!name.starts_with(kPrefix)) continue;
        std::string_view rest = std::string_view(name).substr(kPrefix.size());
        const std::optional<int> number = take_number(rest);
        if (!number || !rest.empty()) continue;
        std::string list;
        std::getline(std::ifstream(entry->path() / "cpulist"), list);
        const ProcessorSet processors = listed_processors(list).common_with(allowed);
        if (processors.size() > 0) by_number.emplace(*number, processors);
    }
    std::vector<ProcessorSet> nodes;
    nodes.reserve(by_number.size());
    for (const auto& [number, processors] : by_number) nodes.push_back(processors);
    return nodes;
}

}  // namespace etendue
