#include "output/software_name.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

namespace etendue {

namespace {

constexpr std::size_t kBuildBytes = 8;

/// The build ID among the notes of a segment, each of which has its name and its content at multiples of `alignment`;
/// empty if none is.
std::string build_id_in(std::span<const std::byte> notes, std::size_t alignment) {
    const auto aligned = [alignment](std::size_t offset) { return (offset + alignment - 1) / alignment * alignment; };
    constexpr std::size_t kNameSize = sizeof ELF_NOTE_GNU;
    while (notes.size() >= sizeof(ElfW(Nhdr))) {
        ElfW(Nhdr) header;
        std::memcpy(&header, notes.data(), sizeof header);
        const std::size_t begin = aligned(sizeof header + header.n_namesz);
        const std::size_t end = begin + header.n_descsz;
        if (end > notes.size()) break;
        if (header.n_type == NT_GNU_BUILD_ID && header.n_namesz == kNameSize &&
            std::memcmp(notes.data() + sizeof header, ELF_NOTE_GNU, kNameSize) == 0) {
            std::string digits;
            for (const std::byte byte : notes.subspan(begin, std::min<std::size_t>(header.n_descsz, kBuildBytes)))
                digits += fmt::format("{:02x}", std::to_integer<unsigned>(byte));
            return digits;
        }
        notes = notes.subspan(std::min(aligned(end), notes.size()));
    }
    return {};
}

/// For dl_iterate_phdr, which begins with the program itself: there is no need for another one.
int find_build_id(dl_phdr_info* program, std::size_t /*size*/, void* result) {
    constexpr std::size_t kLeastAlignment = 4;
    auto& build = *static_cast<std::string*>(result);
    for (const ElfW(Phdr) & segment : std::span(program->dlpi_phdr, program->dlpi_phnum)) {
        if (segment.p_type != PT_NOTE || !build.empty()) continue;
        const auto* const begin = reinterpret_cast<const std::byte*>(program->dlpi_addr + segment.p_vaddr);
        build = build_id_in({begin, segment.p_memsz}, std::max<std::size_t>(segment.p_align, kLeastAlignment));
    }
    return 1;
}

}  // namespace

std::string_view software_name() {
    return "Etendue " ETENDUE_VERSION;
}

std::string software_build() {
    std::string build;
    ::dl_iterate_phdr(find_build_id, &build);
    return build.empty() ? "unknown" : build;
}

}  // namespace etendue
