#include "batch/batch_child.h"

#include "batch/json_lookup.h"
#include "core/content_hash.h"
#include "core/error.h"
#include "session/exit_code.h"
#include "session/interrupt.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

constexpr std::chrono::milliseconds kBetweenLooksAtChild(100);

/// Holds what a process that was asked has said.
struct Answer {
    nlohmann::json json{};     ///< no object if there was no whole one
    std::string error{};       ///< why there is none that counts
    bool has_refused = false;  ///< its process has said so and ended by itself
};

/// Returns what stands at `key` of `json`; null if that is no object, or has none.
nlohmann::json value_of(const nlohmann::json& json, const char* key) {
    return json.is_object() ? json.value(key, nlohmann::json()) : nlohmann::json();
}

/// Runs `arguments` to their end, or until the user has no patience.
Answer ask(std::vector<std::string> arguments, const BatchOptions& options) try {
    // A scene may have very many meshes and materials, whose names `inspect` lists.
    constexpr std::size_t kMostOutput = std::size_t{1} << 28;
    ChildProcess child(
        {.arguments = std::move(arguments), .memory_limit = options.max_memory, .most_output = kMostOutput});
    const auto ignore = [](const std::string&) {};
    // Libraries that are denied memory may wait for ever.
    const auto limit = std::chrono::duration<double, std::ratio<60>>(options.stall_minutes);
    const auto start = std::chrono::steady_clock::now();
    bool is_stalled = false;
    while (child.wait(kBetweenLooksAtChild, ignore, ignore)) {
        is_stalled = is_stalled || (options.stall_minutes > 0.0 && std::chrono::steady_clock::now() - start > limit);
        if (interrupt_requested() || is_stalled) child.send(SIGKILL);
    }
    Answer answer;
    if (is_stalled) {
        answer.error = fmt::format("error: nothing was known of it after --stall-minutes {:g}", options.stall_minutes);
        return answer;
    }
    if (!child.output_was_cut()) answer.json = nlohmann::json::parse(child.output(), nullptr, false);
    if (interrupt_requested() || (child.end().signal == 0 && child.end().exit_code == 0)) return answer;
    answer.error = error_of(child.last_messages());
    answer.has_refused =
        child.end().signal == 0 && (child.end().exit_code == static_cast<int>(ExitCode::InvalidScene) ||
                                    child.end().exit_code == static_cast<int>(ExitCode::UsageError));
    if (answer.error.empty()) answer.error = "error: " + end_in_words(child.end());
    return answer;
} catch (const IoError&) {
    return {};  // no process could be started: those that render will fail, too, and say why
}

SceneLook look_of(const Answer& answer, const nlohmann::json& outline) {
    SceneLook look{.error = answer.error};
    look.outline = {.width = number_at<int>(outline, "/width").value_or(0),
                    .height = number_at<int>(outline, "/height").value_or(0),
                    .spp = number_at<int>(outline, "/spp").value_or(0),
                    .integrator = text_at(outline, "/integrator"),
                    .camera = text_at(outline, "/camera")};
    return look;
}

/// Returns the options as words of a command line.
std::vector<std::string> words_of(const std::vector<GivenOption>& options) {
    std::vector<std::string> words;
    for (const GivenOption& option : options) {
        words.push_back(option.name);
        if (option.value) words.push_back(*option.value);
    }
    return words;
}

/// Returns the options that make the image of `task` of its scene, as the batch was given them.
std::vector<std::string> options_of(const BatchTask& task, const BatchOptions& options) {
    std::vector<std::string> arguments = words_of(task.job.frame ? without(options.given, "--frames") : options.given);
    if (task.job.frame) arguments.insert(arguments.end(), {"--frames", fmt::format("{0}:{0}", *task.job.frame)});
    if (task.job.variant) arguments.insert(arguments.end(), {"--variant", *task.job.variant});
    if (task.job.camera) arguments.insert(arguments.end(), {"--camera", *task.job.camera});
    return arguments;
}

/// Returns the options with those of renders that `inspect` takes, too: it writes no files.
BatchOptions for_inspect(BatchOptions options) {
    options.given = without(std::move(options.given), "--no-png");
    return options;
}

}  // namespace

std::string as_argument(const std::filesystem::path& path) {
    return path.string().starts_with('-') ? "./" + path.string() : path.string();
}

std::optional<ChildProgress> parse_progress(const std::string& line) {
    const nlohmann::json json = nlohmann::json::parse(line, nullptr, false);
    std::string phase = text_at(json, "/phase");
    const auto fraction = number_at<double>(json, "/fraction");
    const auto seconds = number_at<double>(json, "/seconds");
    if (phase.empty() || !fraction || !seconds) return std::nullopt;
    return ChildProgress{std::move(phase), *fraction, *seconds, number_at<std::uint64_t>(json, "/samples").value_or(0)};
}

std::vector<std::string> render_arguments(const BatchTask& task, const BatchOptions& options, int threads) {
    std::vector<std::string> arguments{"render", as_argument(task.job.scene), "-o", as_argument(task.render_output)};
    for (std::string& option : options_of(task, options)) arguments.push_back(std::move(option));
    if (task.job.first_frame && task.job.first_frame != task.job.frame)
        arguments.insert(arguments.end(), {"--first-frame", fmt::format("{}", *task.job.first_frame)});
    if (threads > 0) arguments.insert(arguments.end(), {"--threads", fmt::format("{}", threads)});
    if (options.quiet) arguments.emplace_back("--quiet");
    return arguments;
}

SceneNames find_names(const std::filesystem::path& scene, const BatchOptions& options) {
    SceneNames names;
    if (interrupt_requested()) return names;
    std::vector<std::string> arguments{"inspect", as_argument(scene), "--json"};
    for (std::string& option : words_of(without(for_inspect(options).given, "--frames")))
        arguments.push_back(std::move(option));
    const nlohmann::json json = ask(std::move(arguments), options).json;
    const auto list = [&](const char* key) {
        std::vector<std::string> found;
        const nlohmann::json all = value_of(json, key);
        if (all.is_array())
            for (const nlohmann::json& name : all)
                if (name.is_string()) found.push_back(name.get<std::string>());
        return found;
    };
    names.shown_camera = text_at(json, "/image/camera");
    names.variants = list("variants");
    names.cameras = list("cameras");
    // Cameras whose names say nothing are found by their nodes.
    const std::vector<std::string> nodes = list("camera_nodes");
    for (std::size_t i = 0; i < std::min(names.cameras.size(), nodes.size()); ++i)
        if (names.cameras[i].empty() || std::ranges::count(names.cameras, names.cameras[i]) > 1)
            names.cameras[i] = nodes[i];
    std::erase(names.cameras, "");
    return names;
}

std::vector<std::string> display_arguments(const std::filesystem::path& statistics) {
    std::ifstream in = open_regular_file(statistics);
    const nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
    std::vector<std::string> arguments;
    for (const std::string name : {"display", "view", "look"})
        if (const std::string value = text_at(json, "/settings/~1color~1" + name); !value.empty())
            arguments.insert(arguments.end(), {"--" + name, value});
    if (const auto stops = number_at<float>(json, "/exposure/stops"))
        arguments.insert(arguments.end(), {"--exposure", fmt::format("{}", *stops)});
    return arguments;
}

SceneLook probe_in_child(const BatchTask& task, const BatchOptions& options) {
    std::vector<std::string> arguments = render_arguments(task, options, options.threads);
    arguments.emplace_back("--probe");
    const Answer answer = ask(std::move(arguments), options);
    SceneLook look = look_of(answer, answer.json);
    look.seconds = number_at<double>(answer.json, "/estimated_seconds");
    look.start_seconds = number_at<double>(answer.json, "/start_seconds").value_or(0.0);
    look.memory_bytes = number_at<std::uint64_t>(answer.json, "/estimated_memory_bytes");
    // What is refused is refused before anything large is made.
    if (answer.has_refused) look.memory_bytes = 0;
    return look;
}

SceneLook inspect_in_child(const BatchTask& task, const BatchOptions& options) {
    std::vector<std::string> arguments{"inspect", as_argument(task.job.scene), "--json"};
    for (std::string& option : options_of(task, for_inspect(options))) arguments.push_back(std::move(option));
    Answer answer = ask(std::move(arguments), options);
    std::string errors;
    std::vector<std::string> warnings;
    for (const nlohmann::json& problem : value_of(answer.json, "problems")) {
        if (!problem.is_object()) continue;
        const std::string severity = text_at(problem, "/severity");
        if (severity == "warning") warnings.push_back(text_at(problem, "/text"));
        if (severity != "error") continue;
        if (!errors.empty()) errors += '\n';
        errors += text_at(problem, "/text");
    }
    if (!errors.empty()) answer.error = errors;
    SceneLook look = look_of(answer, value_of(answer.json, "image"));
    look.warnings = std::move(warnings);
    return look;
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

std::string end_in_words(const ChildEnd& end) {
    if (end.signal == 0) return fmt::format("its process ended with exit code {}", end.exit_code);
    const char* const description = ::sigdescr_np(end.signal);
    std::string text = fmt::format("its process was ended by {}", signal_name(end.signal));
    if (description != nullptr) text += fmt::format(" ({})", description);
    if (end.signal == SIGKILL) text += ": by somebody, or by the system for want of memory";
    return text;
}

}  // namespace etendue
