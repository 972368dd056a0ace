#include "cli/command_help.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <sstream>
#include <string_view>
#include <tuple>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace etendue {

namespace {

/// The words of "TEXT:{draft,final,preview}"; none if the type has no such list.
std::vector<std::string> choices_of(const std::string& type) {
    const std::size_t begin = type.find('{');
    const std::size_t end = type.find('}', begin == std::string::npos ? 0 : begin);
    std::vector<std::string> choices;
    if (begin == std::string::npos || end == std::string::npos) return choices;
    std::istringstream words(type.substr(begin + 1, end - begin - 1));
    for (std::string word; std::getline(words, word, ',');) choices.push_back(word);
    return choices;
}

OptionHelp::Value value_of(const CLI::Option& option, const std::vector<std::string>& choices) {
    // CLI11 gives flags a type, too: only the number of values tells them from options.
    if (option.get_items_expected_max() == 0) return OptionHelp::Value::None;
    if (!choices.empty()) return OptionHelp::Value::Choice;
    const std::string type = option.get_type_name();
    const bool is_number = std::ranges::any_of(std::vector<std::string_view>{"INT", "UINT", "FLOAT"},
                                               [&](std::string_view name) { return type.starts_with(name); });
    return is_number ? OptionHelp::Value::Number : OptionHelp::Value::Text;
}

/// Returns the names of the options: "--denoise, --jobs".
std::string listed_names(const std::set<CLI::Option*>& options) {
    std::set<std::string> names;
    for (const CLI::Option* option : options) names.insert(option->get_name());
    return fmt::format("{}", fmt::join(names, ", "));
}

OptionHelp describe_option(const CLI::Option& option) {
    OptionHelp help;
    if (option.get_positional()) help.names.push_back(option.get_name(true));
    for (const std::string& name : option.get_snames()) help.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) help.names.push_back("--" + name);
    const CLI::Formatter formatter;
    help.group = option.get_group();
    help.terms = CLI::detail::trim_copy(formatter.make_option_opts(&option));
    help.description = option.get_description();
    // CLI11 names a type before its range or its words, and the default behind them.
    for (const auto& [from, to] :
         {std::pair("INT:INT in", "INT in"), std::pair("UINT:INT in", "INT in"), std::pair("UINT:UINT in", "INT in"),
          std::pair("FLOAT:FLOAT in", "FLOAT in"), std::pair("FLOAT:POSITIVE", "FLOAT > 0"), std::pair("TEXT:{", "{"),
          std::pair("TEXT:FILE", "FILE"), std::pair("TEXT:DIR", "DIR")})
        if (help.terms.starts_with(from)) help.terms.replace(0, std::string_view(from).size(), to);
    if (const std::string value = option.get_default_str(); !value.empty()) {
        // As CLI11 2.3 shows it, and 2.4.
        for (const std::string& shown : {"=" + value, " [" + value + "]"})
            if (const std::size_t at = help.terms.rfind(shown); at != std::string::npos)
                help.terms.erase(at, shown.size());
        help.description += fmt::format(" (default: {})", value);
    }
    // CLI11 names other options behind the type, where nobody looks for a sentence.
    for (const auto& [heading, options, words] : {std::tuple("Needs:", option.get_needs(), "needs"),
                                                  std::tuple("Excludes:", option.get_excludes(), "not with")})
        if (!options.empty()) {
            help.terms = CLI::detail::trim_copy(help.terms.substr(0, help.terms.find(heading)));
            help.description += fmt::format(" ({} {})", words, listed_names(options));
        }
    help.choices = choices_of(option.get_type_name());
    help.value = value_of(option, help.choices);
    return help;
}

}  // namespace

CommandHelp describe_command(const CLI::App& app) {
    CommandHelp help{.name = app.get_name(),
                     .summary = app.get_description(),
                     .footer = app.get_footer(),
                     .arguments = {},
                     .options = {},
                     .commands = {}};
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_group().empty()) continue;  // hidden
        (option->get_positional() ? help.arguments : help.options).push_back(describe_option(*option));
    }
    for (const CLI::App* command : app.get_subcommands({}))
        if (!command->get_group().empty()) help.commands.push_back(describe_command(*command));
    return help;
}

std::string first_clause(const std::string& text) {
    std::size_t end = text.size();
    for (const char* mark : {". ", "; ", ": ", " (", ", ", "\n"}) end = std::min(end, text.find(mark));
    return text.substr(0, end);
}

}  // namespace etendue
