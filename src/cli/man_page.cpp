#include "cli/man_page.h"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Returns what troff prints as the character `c` itself, so that the character can be copied into a shell.
std::string escaped(char c) {
    switch (c) {
        case '\\':
            return "\\e";
        case '-':
            return "\\-";
        case '\'':
            return "\\(aq";
        case '`':
            return "\\(ga";
        case '^':
            return "\\(ha";
        case '~':
            return "\\(ti";
        default:
            return {c};
    }
}

/// `text` as troff prints it letter by letter, without requests.
std::string escaped(std::string_view text) {
    std::string result;
    bool starts_line = true;
    for (const char c : text) {
        if (starts_line && c == '.') result += "\\&";
        result += escaped(c);
        starts_line = c == '\n';
    }
    return result;
}

std::string upper(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return text;
}

/// Words within a heading that are options keep their case.
std::string heading(const std::string& text) {
    std::istringstream words(text);
    std::string result;
    for (std::string word; words >> word;)
        result += (result.empty() ? "" : " ") + (word.starts_with('-') ? word : upper(word));
    return escaped(result);
}

std::string title(const std::string& page, const std::string& software) {
    // Ragged right: lists of words without spaces cannot be adjusted.
    return fmt::format(".TH {} 1 \"\" \"{}\" \"Etendue\"\n.ad l\n", escaped(upper(page)), escaped(software));
}

std::string named(const std::string& page, const std::string& summary) {
    return fmt::format(".SH NAME\n{} \\- {}\n", escaped(page), escaped(summary));
}

std::string option_item(const OptionHelp& option) {
    std::string names;
    for (const std::string& name : option.names)
        names += fmt::format("{}\\fB{}\\fR", names.empty() ? "" : ", ", escaped(name));
    const std::string terms = option.terms.empty() ? "" : fmt::format(" \\fI{}\\fR", escaped(option.terms));
    return fmt::format(".TP\n{}{}\n{}\n", names, terms, escaped(option.description));
}

std::string option_items(const char* section, const std::vector<OptionHelp>& options) {
    if (options.empty()) return "";
    std::string text = fmt::format(".SH {}\n", section);
    std::vector<std::string> groups;
    for (const OptionHelp& option : options)
        if (std::ranges::find(groups, option.group) == groups.end()) groups.push_back(option.group);
    for (const std::string& group : groups) {
        if (groups.size() > 1) text += fmt::format(".SS {}\n", escaped(group));
        for (const OptionHelp& option : options)
            if (option.group == group) text += option_item(option);
    }
    return text;
}

bool is_indented(const std::string& line) {
    return line.starts_with("  ");
}

/// Paragraphs are filled; indented lines stand as they are, under the heading before them.
std::string footer_sections(const std::string& footer) {
    std::vector<std::string> lines;
    std::istringstream stream(footer);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    std::string text;
    bool is_open = false;  // a paragraph
    bool has_notes = false;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const bool is_heading = lines[i].ends_with(':') && i + 1 < lines.size() && is_indented(lines[i + 1]);
        if (is_heading) {
            text += fmt::format(".SH {}\n", heading(lines[i].substr(0, lines[i].size() - 1)));
            is_open = false;
        } else if (is_indented(lines[i])) {
            text += ".nf\n";
            for (; i < lines.size() && is_indented(lines[i]); ++i) text += escaped(lines[i].substr(2)) + "\n";
            text += ".fi\n";
            is_open = false;
            --i;
        } else if (lines[i].empty()) {
            is_open = false;
        } else {
            if (!is_open) text += has_notes ? ".PP\n" : ".SH NOTES\n";
            has_notes = is_open = true;
            text += escaped(lines[i]) + "\n";
        }
    }
    return text;
}

std::string page_name(const CommandHelp& program, const CommandHelp& command) {
    return program.name + "-" + command.name;
}

}  // namespace

std::string program_page(const CommandHelp& program, const std::string& software) {
    std::string page = title(program.name, software) + named(program.name, "an offline renderer for glTF 2.0 scenes") +
                       fmt::format(".SH SYNOPSIS\n\\fB{}\\fR \\fICOMMAND\\fR [\\fIOPTION\\fR...]\n", program.name) +
                       fmt::format(".SH DESCRIPTION\n{}\n", escaped(program.summary)) +
                       option_items("OPTIONS", program.options) + ".SH COMMANDS\n";
    std::string others;
    for (const CommandHelp& command : program.commands) {
        page += fmt::format(".TP\n\\fB{}\\fR\n{}\n", escaped(command.name), escaped(command.summary));
        others += fmt::format("{}\\fB{}\\fR(1)", others.empty() ? "" : ",\n", escaped(page_name(program, command)));
    }
    return page + footer_sections(program.footer) + ".SH SEE ALSO\n" + others + "\n";
}

std::string command_page(const CommandHelp& program, const CommandHelp& command, const std::string& software) {
    const std::string name = page_name(program, command);
    std::string synopsis = fmt::format("\\fB{} {}\\fR [\\fIOPTION\\fR...]", program.name, command.name);
    for (const OptionHelp& argument : command.arguments)
        synopsis += fmt::format(" \\fI{}\\fR", escaped(argument.names.front()));
    return title(name, software) + named(name, command.summary) + ".SH SYNOPSIS\n" + synopsis + "\n" +
           option_items("ARGUMENTS", command.arguments) + option_items("OPTIONS", command.options) +
           footer_sections(command.footer) + fmt::format(".SH SEE ALSO\n\\fB{}\\fR(1)\n", program.name);
}

}  // namespace etendue
