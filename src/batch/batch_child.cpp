#include "batch/batch_child.h"

#include "core/error.h"
#include "session/interrupt.h"

#include <chrono>
#include <csignal>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

constexpr std::chrono::milliseconds kBetweenLooksAtChild(100);

/// A path that no command line takes for an option.
std::string as_argument(const std::filesystem::path& path) {
    return path.string().starts_with('-') ? "./" + path.string() : path.string();
}

/// Runs `arguments` to their end and returns the JSON object that stdout holds; it is no object if anything failed, or
/// if the user has no patience.
nlohmann::json ask(std::vector<std::string> arguments, const BatchOptions& options) try {
    // A scene may have very many meshes and materials, whose names `inspect` lists.
    constexpr std::size_t kMostOutput = std::size_t{1} << 28;
    ChildProcess child(
        {.arguments = std::move(arguments), .memory_limit = options.max_memory, .most_output = kMostOutput});
    const auto ignore = [](const std::string&) {};
    while (child.wait(kBetweenLooksAtChild, ignore, ignore))
        if (interrupt_requested()) child.send(SIGKILL);
    if (child.end().signal != 0 || child.end().exit_code != 0 || child.output_was_cut()) return {};
    return nlohmann::json::parse(child.output(), nullptr, false);
} catch (const IoError&) {
    return {};  // no process could be started: those that render will fail, too, and say why
}

}  // namespace

std::optional<ChildProgress> parse_progress(const std::string& line) {
    const nlohmann::json json = nlohmann::json::parse(line, nullptr, false);
    if (!json.is_object()) return std::nullopt;
    const auto phase = json.find("phase");
    const auto fraction = json.find("fraction");
    const auto seconds = json.find("seconds");
    if (phase == json.end() || !phase->is_string() || fraction == json.end() || !fraction->is_number() ||
        seconds == json.end() || !seconds->is_number())
        return std::nullopt;
    return ChildProgress{phase->get<std::string>(), fraction->get<double>(), seconds->get<double>()};
}

std::vector<std::string> render_arguments(const BatchTask& task, const BatchOptions& options) {
    std::vector<std::string> arguments{"render", as_argument(task.job.scene), "-o", as_argument(task.render_output)};
    std::vector<GivenOption> given = options.given;
    if (task.job.frame) given = without(std::move(given), "--frames");
    for (const GivenOption& option : given) {
        arguments.push_back(option.name);
        if (option.value) arguments.push_back(*option.value);
    }
    if (task.job.frame) arguments.insert(arguments.end(), {"--frames", fmt::format("{0}:{0}", *task.job.frame)});
    if (task.job.variant) arguments.insert(arguments.end(), {"--variant", *task.job.variant});
    if (options.threads > 0) arguments.insert(arguments.end(), {"--threads", fmt::format("{}", options.threads)});
    if (options.quiet) arguments.emplace_back("--quiet");
    return arguments;
}

std::vector<std::string> find_variants(const std::filesystem::path& scene, const BatchOptions& options) {
    if (interrupt_requested()) return {};
    const nlohmann::json json = ask({"inspect", as_argument(scene), "--json"}, options);
    const auto variants = json.is_object() ? json.value("variants", nlohmann::json()) : nlohmann::json();
    std::vector<std::string> names;
    if (!variants.is_array()) return names;
    for (const nlohmann::json& name : variants)
        if (name.is_string()) names.push_back(name.get<std::string>());
    return names;
}

std::optional<double> probe_in_child(const BatchTask& task, const BatchOptions& options) {
    std::vector<std::string> arguments = render_arguments(task, options);
    arguments.emplace_back("--probe");
    const nlohmann::json json = ask(std::move(arguments), options);
    const auto seconds = json.is_object() ? json.value("estimated_seconds", nlohmann::json()) : nlohmann::json();
    if (!seconds.is_number()) return std::nullopt;
    return seconds.get<double>();
}

std::string error_of(const std::deque<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) {
        if (text.empty() && !line.starts_with("error")) continue;
        if (!text.empty()) text += '\n';
        text += line;
    }
    return text;
}

}  // namespace etendue
