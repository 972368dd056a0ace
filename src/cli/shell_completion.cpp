#include "cli/shell_completion.h"

#include "process/shell_word.h"

#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace etendue {

namespace {

using Value = OptionHelp::Value;

constexpr const char* kHead = "# Completion of etendue. Made from its --help while building.\n";

std::vector<std::string> names_of(const std::vector<OptionHelp>& options) {
    std::vector<std::string> names;
    for (const OptionHelp& option : options) names.insert(names.end(), option.names.begin(), option.names.end());
    return names;
}

std::vector<std::string> names_of(const std::vector<CommandHelp>& commands) {
    std::vector<std::string> names;
    names.reserve(commands.size());
    for (const CommandHelp& command : commands) names.push_back(command.name);
    return names;
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
    return text;
}

std::string joined(const std::vector<std::string>& words) {
    return fmt::format("{}", fmt::join(words, " "));
}

/// A branch of `case` in bash for the values of one option of `command`; none for a flag.
std::string bash_value_branch(const std::string& command, const OptionHelp& option) {
    if (option.value == Value::None) return "";
    std::string patterns;
    for (const std::string& name : option.names)
        patterns += fmt::format("{}'{} {}'", patterns.empty() ? "" : " | ", command, name);
    switch (option.value) {
        case Value::Choice:
            return fmt::format("        {}) _etendue_words '{}' ;;\n", patterns, joined(option.choices));
        case Value::Text:
            return fmt::format("        {}) _etendue_files ;;\n", patterns);
        case Value::Number:
        case Value::None:
            break;
    }
    return fmt::format("        {}) COMPREPLY=() ;;\n", patterns);
}

std::string bash_option_branch(const std::string& command, const std::vector<OptionHelp>& options) {
    return fmt::format("        '{} -'*) _etendue_words '{}' ;;\n", command, joined(names_of(options)));
}

/// Returns the text that stands between the brackets of an option in zsh, from the option's `description`.
std::string zsh_text(const std::string& description) {
    std::string text = first_clause(description);
    for (const char* mark : {"\\", "[", "]", ":"}) text = replaced(text, mark, std::string("\\") + mark);
    return text;
}

std::string zsh_value(const OptionHelp& option) {
    switch (option.value) {
        case Value::Choice:
            return fmt::format(":value:({})", joined(option.choices));
        case Value::Text:
            return ":value:_files";
        case Value::Number:
            return ":number: ";
        case Value::None:
            break;
    }
    return "";
}

/// One for each name: an option can be given by any of them, and more than once.
std::string zsh_options(const std::vector<OptionHelp>& options, std::string_view indent) {
    std::string text;
    for (const OptionHelp& option : options)
        for (const std::string& name : option.names)
            text +=
                fmt::format("{}{} \\\n", indent,
                            quoted(fmt::format("*{}[{}]{}", name, zsh_text(option.description), zsh_value(option))));
    return text;
}

std::string fish_option(const std::string& condition, const OptionHelp& option) {
    std::string line = fmt::format("complete -c etendue -n {}", quoted(condition));
    for (const std::string& name : option.names)
        line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (option.value == Value::Choice) line += fmt::format(" -x -a {}", quoted(joined(option.choices)));
    if (option.value == Value::Number) line += " -x";
    if (option.value == Value::Text) line += " -r -F";
    return line + fmt::format(" -d {}\n", quoted(first_clause(option.description)));
}

}  // namespace

std::string bash_completion(const CommandHelp& program) {
    const std::string commands = joined(names_of(program.commands));
    std::string branches;
    for (const CommandHelp& command : program.commands) {
        for (const OptionHelp& option : command.options) branches += bash_value_branch(command.name, option);
    }
    std::string words = bash_option_branch("", program.options);
    for (const CommandHelp& command : program.commands) words += bash_option_branch(command.name, command.options);
    return std::string(kHead) +
           "# shellcheck shell=bash\n"
           "_etendue_words() { mapfile -t COMPREPLY < <(compgen -W \"$1\" -- \"$current\"); }\n"
           "_etendue_files() {\n"
           "    mapfile -t COMPREPLY < <(compgen -f -- \"$current\")\n"
           "    compopt -o filenames 2>/dev/null\n"
           "}\n"
           "_etendue() {\n"
           "    local command='' current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}\n"
           "    # --option=value is three words.\n"
           "    if [[ $current == = ]]; then\n"
           "        current=''\n"
           "    elif [[ $previous == = ]]; then\n"
           "        previous=${COMP_WORDS[COMP_CWORD - 2]}\n"
           "    fi\n"
           "    ((COMP_CWORD == 1)) || command=${COMP_WORDS[1]}\n"
           "    case \"$command $previous\" in\n" +
           branches + fmt::format("        'help help') _etendue_words '{}' ;;\n", commands) +
           "        *) _etendue_word ;;\n"
           "    esac\n"
           "}\n"
           "# The word is not the value of an option.\n"
           "_etendue_word() {\n"
           "    case \"$command $current\" in\n" +
           words + fmt::format("        ' '*) _etendue_words '{}' ;;\n", commands) +
           "        *) _etendue_files ;;\n"
           "    esac\n"
           "}\n"
           "complete -F _etendue etendue\n";
}

std::string zsh_completion(const CommandHelp& program) {
    std::string list;
    std::string branches;
    for (const CommandHelp& command : program.commands) {
        list += fmt::format("        {}\n", quoted(command.name + ":" + first_clause(command.summary)));
        const char* const rest = command.name == "help" ? "\"1:command:($names)\"" : "'*:file:_files'";
        branches += fmt::format("        {})\n            _arguments \\\n{}                {}\n            ;;\n",
                                command.name, zsh_options(command.options, "                "), rest);
    }
    return "#compdef etendue\n" + std::string(kHead) +
           "_etendue() {\n"
           "    local curcontext=$curcontext state line\n"
           "    local -a commands names\n"
           "    commands=(\n" +
           list +
           "    )\n"
           "    names=(${commands%%:*})\n"
           "    _arguments -C \\\n" +
           zsh_options(program.options, "        ") +
           "        '1: :->command' \\\n"
           "        '*:: :->rest'\n"
           "    case $state in\n"
           "    command) _describe command commands ;;\n"
           "    rest)\n"
           "        case $line[1] in\n" +
           branches +
           "        esac\n"
           "        ;;\n"
           "    esac\n"
           "}\n"
           "_etendue \"$@\"\n";
}

std::string fish_completion(const CommandHelp& program) {
    const std::string commands = joined(names_of(program.commands));
    const std::string before = "not __fish_seen_subcommand_from " + commands;
    std::string text = std::string(kHead) + fmt::format("complete -c etendue -n {} -f\n", quoted(before));
    for (const OptionHelp& option : program.options) text += fish_option(before, option);
    for (const CommandHelp& command : program.commands) {
        text += fmt::format("complete -c etendue -n {} -a {} -d {}\n", quoted(before), command.name,
                            quoted(first_clause(command.summary)));
        const std::string after = "__fish_seen_subcommand_from " + command.name;
        for (const OptionHelp& option : command.options) text += fish_option(after, option);
        if (command.name == "help")
            text += fmt::format("complete -c etendue -n {} -f -a {}\n", quoted(after), quoted(commands));
    }
    return text;
}

}  // namespace etendue
