#include "cli/help_text.h"

#include "core/shown_text.h"

#include <algorithm>
#include <functional>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace etendue {

namespace {

/// Characters of UTF-8: its bytes but for those that go on with one.
std::size_t characters(const std::string& text) {
    return static_cast<std::size_t>(std::ranges::count_if(text, std::not_fn(continues_character)));
}

/// Puts the words of `text` into lines of at most `width` characters; a word that is longer has a line of its own.
std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
    std::vector<std::string> lines;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        if (!lines.empty() && characters(lines.back()) + 1 + characters(word) <= width)
            lines.back() += " " + word;
        else
            lines.push_back(word);
    }
    return lines;
}

/// Returns `name` broken into lines of at most `width` characters, after commas and spaces.
std::string broken_name(const std::string& name, std::size_t width) {
    constexpr std::size_t kIndent = 10;
    std::string result;
    std::size_t used = 0;  // characters of the last line
    for (std::size_t begin = 0, end = 0; begin < name.size(); begin = end) {
        end = std::min(name.find_first_of(", ", begin), name.size() - 1) + 1;
        const std::string piece = name.substr(begin, end - begin);
        const std::size_t length = characters(piece);
        if (used > kIndent && used + length - (piece.ends_with(' ') ? 1 : 0) > width) {
            if (result.ends_with(' ')) result.pop_back();
            result += "\n" + std::string(kIndent, ' ');
            used = kIndent;
        }
        result += piece;
        used += length;
    }
    return result;
}

/// Returns `name` and, beside or below it, the lines of `text`, from the column `indent` on.
std::string entry(const std::string& name, const std::string& text, std::size_t indent, std::size_t width) {
    constexpr std::size_t kLeastText = 24;
    const std::vector<std::string> lines = wrapped(text, std::max(kLeastText, width - std::min(width, indent)));
    std::string result = broken_name("  " + name, width);
    const bool is_beside = characters(result) + 2 <= indent;
    if (!is_beside || lines.empty()) result += "\n";
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::size_t used = i == 0 && is_beside ? characters(result) : 0;
        result += std::string(indent - used, ' ') + lines[i] + "\n";
    }
    return result;
}

std::string names_in_help(const OptionHelp& option) {
    std::string names;
    // Those without a short name stand below the long names of others.
    if (option.names.front().starts_with("--")) names = "    ";
    for (const std::string& name : option.names) names += (name == option.names.front() ? "" : ", ") + name;
    return option.terms.empty() ? names : names + " " + option.terms;
}

/// Wraps paragraphs; indented lines stand as they are.
std::string wrapped_footer(const std::string& footer, std::size_t width) {
    std::string result;
    std::string paragraph;
    const auto end_paragraph = [&] {
        for (const std::string& line : wrapped(paragraph, width)) result += line + "\n";
        paragraph.clear();
    };
    std::istringstream lines(footer);
    for (std::string line; std::getline(lines, line);) {
        if (!line.empty() && line.front() != ' ') {
            paragraph += line + " ";
            continue;
        }
        end_paragraph();
        result += line + "\n";
    }
    end_paragraph();
    return result;
}

}  // namespace

std::string help_text(const CommandHelp& help, const std::string& usage, std::size_t width) {
    constexpr std::size_t kWideColumn = 30;
    constexpr std::size_t kNarrowColumn = 8;
    constexpr std::size_t kWide = 72;
    const std::size_t indent = width >= kWide ? kWideColumn : kNarrowColumn;
    std::string text;
    for (const std::string& line : wrapped(help.summary, width)) text += line + "\n";
    text += "\nUsage: " + usage + "\n";
    if (!help.arguments.empty()) text += "\nArguments:\n";
    for (const OptionHelp& argument : help.arguments)
        text += entry(argument.names.front(), argument.description, indent, width);
    std::vector<std::string> groups;
    for (const OptionHelp& option : help.options)
        if (std::ranges::find(groups, option.group) == groups.end()) groups.push_back(option.group);
    for (const std::string& group : groups) {
        text += fmt::format("\n{}:\n", group);
        for (const OptionHelp& option : help.options)
            if (option.group == group) text += entry(names_in_help(option), option.description, indent, width);
    }
    if (!help.commands.empty()) text += "\nSubcommands:\n";
    for (const CommandHelp& command : help.commands) text += entry(command.name, command.summary, 14, width);
    if (!help.footer.empty()) text += "\n" + wrapped_footer(help.footer, width);
    return text;
}

std::size_t help_width() {
    constexpr std::size_t kOfFiles = 100;
    constexpr std::size_t kLeast = 40;
    constexpr std::size_t kMost = 120;
    winsize size{};
    if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return kOfFiles;
    return std::clamp<std::size_t>(size.ws_col, kLeast, kMost);
}

}  // namespace etendue
