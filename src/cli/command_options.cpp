#include "cli/command_options.h"

#include "cli/settings_options.h"
#include "core/log.h"

#include <charconv>
#include <set>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace etendue {

namespace {

constexpr const char* kFreePort = "free";

}  // namespace

std::vector<GivenOption> given_options(std::span<const CLI::Option* const> options) {
    std::vector<GivenOption> given;
    for (const CLI::Option* option : options) {
        if (option->count() == 0 || option->get_group().empty()) continue;
        const std::string name = option->get_positional() ? "" : option->get_name();
        const bool is_flag = option->get_items_expected_max() == 0;
        if (is_flag)
            given.push_back({name, std::nullopt});
        else
            for (const std::string& value : option->results()) given.push_back({name, value});
    }
    return given;
}

void add_live_option(CLI::App& command, std::string& live, const std::string& help) {
    const CLI::Validator is_port(
        [](const std::string& text) {
            return live_port(text) ? std::string() : fmt::format("'{}' is no port from 1 to 65535", text);
        },
        "", "port");
    command
        .add_flag(
            fmt::format("--live{{{}}}", kFreePort), live,
            help +
                "; a line on stderr has the page's address, of this machine only, and --live=PORT chooses its port "
                "(docs/live.md)")
        ->check(is_port);
}

std::optional<int> live_port(const std::string& live) {
    if (live == kFreePort) return 0;
    int port = 0;
    const auto [end, error] = std::from_chars(live.data(), live.data() + live.size(), port);
    const bool is_port = error == std::errc{} && end == live.data() + live.size() && port > 0 && port < (1 << 16);
    return is_port ? std::optional(port) : std::nullopt;
}

void add_tev_option(CLI::App& command, std::optional<TevAddress>& address, const std::string& help) {
    command
        .add_option_function<std::string>(
            "--tev",
            [&address](const std::string& text) {
                address = TevAddress::parse(text);
                if (!address) throw CLI::ValidationError("--tev", fmt::format("'{}' is no HOST:PORT", text));
            },
            help + " to the viewer tev that listens there (docs/live.md)")
        ->type_name("HOST:PORT");
}

void add_threads_option(CLI::App& command, int& threads) {
    command.add_option("--threads", threads, "Threads to use (default: one per processor)")->check(CLI::Range(1, 4096));
}

void add_directory_option(CLI::App& command, std::string& directory, const std::string& help) {
    command.add_option("-o,--output", directory, help)
        ->required()
        ->check(CLI::Validator([](const std::string& text) { return std::string(text.empty() ? "it is empty" : ""); },
                               "DIR"));
}

void require_different(const std::string& option, const std::vector<std::string>& names) {
    std::set<std::string> known;
    for (const std::string& name : names)
        if (!known.insert(name).second) throw CLI::ValidationError(option, "'" + name + "' is named twice");
}

void set_group(CLI::App& command, const std::string& group, std::initializer_list<const char*> options) {
    for (const char* option : options) command.get_option(option)->group(group);
}

void add_old_name(CLI::App& command, const std::string& old_name, const std::string& name) {
    CLI::Option* const option = command.get_option(name);
    command
        .add_option_function<std::string>(old_name,
                                          [&command, option, old_name, name](const std::string& text) {
                                              if (command.count("--quiet") == 0)
                                                  log_info("note: {} is {} now", old_name, name);
                                              // Whether this comes before or after the option's own callback, it then
                                              // has what was given.
                                              option->add_result(text);
                                              option->run_callback();
                                          })
        ->group("");
}

void replace_time_option(CLI::App& command, std::optional<double>& seconds, const std::string& help) {
    command.remove_option(command.get_option("--time"));
    command.add_option("--time", seconds, help)->check(real_range(1e-3, 1e9));
    add_old_name(command, "--seconds", "--time");
}

void hide_options(CLI::App& command, std::span<const OptionOfRender> options) {
    for (const OptionOfRender& option : options) command.get_option(option.name)->group("");
}

void refuse_options(const CLI::App& command, std::span<const OptionOfRender> options) {
    for (const OptionOfRender& option : options)
        if (command.count(option.name) > 0)
            throw CLI::ValidationError(option.name, fmt::format("is for 'render'; {}", option.instead));
}

}  // namespace etendue
