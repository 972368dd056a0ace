#include "cli/command_mistakes.h"

#include "cli/command_help.h"
#include "core/error.h"
#include "core/shown_text.h"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace etendue {

namespace {

/// Returns the command that was given, or the program.
const CLI::App& given_command(const CLI::App& app) {
    const std::vector<CLI::App*> commands = app.get_subcommands();
    return commands.empty() ? app : *commands.front();
}

/// Returns the option of the command that `name` names; null if there is none.
const OptionHelp* find_option(const CommandHelp& command, std::string_view name) {
    for (const auto* options : {&command.options, &command.arguments})
        for (const OptionHelp& option : *options)
            if (std::ranges::find(option.names, name) != option.names.end()) return &option;
    return nullptr;
}

std::string where_to_look(const CommandHelp& command) {
    return command.commands.empty() ? fmt::format("'etendue help {}' lists all", command.name)
                                    : std::string("'etendue help' lists all");
}

/// Returns the option that begins with `name`, the shortest if there are several, or else the nearest; empty if none is
/// near.
std::string likely_option(const std::string& name, const std::vector<std::string_view>& known) {
    constexpr std::size_t kTelling = 5;  // "--out"
    std::string_view begun;
    for (const std::string_view option : known)
        if (option.starts_with(name) && (begun.empty() || option.size() < begun.size())) begun = option;
    return name.size() >= kTelling && !begun.empty() ? std::string(begun) : nearest_name(name, known);
}

/// Says that the command knows no option of that name, with the most likely of those that it knows.
std::string unknown_option(const CommandHelp& command, const std::string& word) {
    const std::string name = word.substr(0, word.find('='));
    std::vector<std::string_view> known;
    for (const OptionHelp& option : command.options)
        known.insert(known.end(), option.names.begin(), option.names.end());
    const std::string nearest = likely_option(name, known);
    const std::string hint = nearest.empty() ? where_to_look(command) : fmt::format("did you mean '{}'?", nearest);
    const std::string of = command.commands.empty() ? fmt::format(" of '{}'", command.name) : "";
    return fmt::format("there is no option '{}'{}; {}", shown(name), of, hint);
}

/// Returns the list with commas that was given and could hold `word` as well; empty if there is none.
std::string list_for(const CLI::App& app, const CommandHelp& command, const std::string& word) {
    for (const CLI::Option* const given : app.get_options()) {
        const OptionHelp* const option = find_option(command, given->get_name());
        if (option == nullptr || given->count() == 0 || given->get_delimiter() == '\0') continue;
        const bool is_number =
            option->value == OptionHelp::Value::Number && word.find_first_not_of("0123456789") == std::string::npos;
        if (is_number || std::ranges::find(option->choices, word) != option->choices.end()) return given->get_name();
    }
    return "";
}

std::string unexpected(const CLI::App& app, const CommandHelp& command, const std::vector<std::string>& words) {
    const auto option = std::ranges::find_if(words, [](const std::string& word) { return word.starts_with('-'); });
    if (option != words.end()) return unknown_option(command, *option);
    const std::string list = list_for(app, command, words.front());
    return fmt::format(
        "'{}' is one word too many for '{}', which takes {}; {}", shown(words.front()), command.name,
        command.arguments.empty() ? std::string("none") : "'" + command.arguments.front().names.front() + "'",
        list.empty() ? where_to_look(command) : fmt::format("values of {}: separate them by commas", list));
}

/// Says which option or argument is missing, and what it is for.
std::string missing(const CommandHelp& command, const std::string& message) {
    const std::string name = message.substr(0, message.find(' '));
    const OptionHelp* const option = find_option(command, name);
    if (option == nullptr) return message + "; " + where_to_look(command);
    return fmt::format("{} is missing: {}; 'etendue help {}' tells more", name, first_clause(option->description),
                       command.name);
}

/// Returns what follows `before` in `message`; empty if that is not in it.
std::string after(const std::string& message, std::string_view before) {
    const std::size_t at = message.find(before);
    return at == std::string::npos ? "" : message.substr(at + before.size());
}

std::string no_such_thing(std::string_view option, const char* what, const std::string& path) {
    const bool is_glob = path.find_first_of("*?[") != std::string::npos;
    return fmt::format("{}: there is no {} '{}'{}", option, what, shown(path),
                       is_glob ? ": the shell found nothing that the pattern matches" : "");
}

/// Returns "; did you mean 'bdpt'?" for "--integrator: bdtp not in {bdpt,path}"; empty if none of the words is near.
std::string meant_word(const std::string& message) {
    const std::size_t set = message.rfind(" not in {");
    const std::size_t name = message.find(": ");
    if (set == std::string::npos || name >= set) return "";
    const std::string word = message.substr(name + 2, set - name - 2);
    if (word.find_first_not_of("0123456789.-+") == std::string::npos) return "";  // another number is no misspelling
    std::vector<std::string> choices;
    std::istringstream list(message.substr(message.find('{', set) + 1));
    for (std::string choice; std::getline(list, choice, ',');) choices.push_back(choice);
    if (!choices.empty() && choices.back().ends_with('}')) choices.back().pop_back();
    const std::string nearest = nearest_name(word, std::vector<std::string_view>(choices.begin(), choices.end()));
    return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
}

/// Says in words of its own that a file is not there, and which word may have been meant.
std::string invalid(const std::string& message) {
    for (const char* before : {"File does not exist: ", "Directory does not exist: ", "Path does not exist: "}) {
        const std::string path = after(message, before);
        if (path.empty()) continue;
        const std::string name = message.substr(0, message.find(':'));
        if (*before == 'P') return missing_in_words(name, path);
        return no_such_thing(name, *before == 'F' ? "file" : "directory", path);
    }
    return message + meant_word(message);
}

}  // namespace

std::string missing_in_words(std::string_view option, const std::string& path) {
    return no_such_thing(option, std::filesystem::path(path).has_extension() ? "file" : "directory", path);
}

std::string mistake_in_words(const CLI::App& app, const CLI::ParseError& error) {
    const CLI::App& given = given_command(app);
    const CommandHelp command = describe_command(given);
    const std::string message = error.what();
    const std::vector<std::string> words = app.remaining(true);
    // What was misspelt is not missing.
    const auto misspelt = std::ranges::find_if(words, [](const std::string& word) { return word.starts_with("--"); });
    if (misspelt != words.end()) return unknown_option(command, *misspelt);
    if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr && !words.empty())
        return unexpected(given, command, words);
    if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
        if (command.commands.empty()) return missing(command, message);
        return "a command is missing; " + where_to_look(command);
    }
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
        const std::string name = message.substr(0, message.find(':'));
        const OptionHelp* const option = find_option(command, name);
        if (option != nullptr && message.find(" missing") != std::string::npos)
            return fmt::format("{} needs a value behind it, {}: {}", name, option->terms,
                               first_clause(option->description));
        const std::string times = after(message, "At Most 1 required but received ");
        if (option != nullptr && !times.empty()) return fmt::format("{} is given {} times; give it once", name, times);
    }
    return invalid(message);
}

}  // namespace etendue
