#include "report/text_table.h"

#include "core/shown_text.h"

#include <algorithm>
#include <string_view>

namespace etendue {

namespace {

constexpr std::size_t kGap = 2;  // spaces between columns

/// Characters of UTF-8, each taken to be one column wide.
std::size_t width_of(std::string_view text) {
    return text.size() - static_cast<std::size_t>(std::count_if(text.begin(), text.end(), continues_character));
}

/// The bytes of the first `width` characters of `text`.
std::size_t bytes_of(std::string_view text, std::size_t width) {
    std::size_t bytes = 0;
    while (bytes < text.size() && (continues_character(text[bytes]) || width-- > 0)) ++bytes;
    return bytes;
}

std::vector<std::size_t> column_widths(const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::size_t> widths;
    for (const std::vector<std::string>& row : rows) {
        if (row.size() == 1) continue;
        widths.resize(std::max(widths.size(), row.size()));
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i]));
    }
    return widths;
}

}  // namespace

std::string aligned(const std::vector<std::vector<std::string>>& rows, std::size_t indent) {
    const std::vector<std::size_t> widths = column_widths(rows);
    std::string text;
    for (const std::vector<std::string>& row : rows) {
        std::string line(indent, ' ');
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::size_t width = i < widths.size() ? widths[i] : 0;
            const std::string space(width - std::min(width, width_of(row[i])), ' ');
            if (i > 0) line += std::string(kGap, ' ');
            line += i == 0 ? row[i] + space : space + row[i];
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line.substr(0, bytes_of(line, kMostColumns)) + '\n';
    }
    return text;
}

std::string wrapped(const std::string& text, std::size_t indent) {
    const std::string shown = shown_text(text);
    std::string lines;
    std::string_view rest = shown;
    std::size_t room = kMostColumns;
    while (width_of(rest) > room) {
        const std::size_t most = bytes_of(rest, room);
        const std::size_t space = rest.substr(0, most + 1).find_last_of(' ');
        const bool breaks = space != std::string_view::npos && space > 0;
        const std::size_t end = breaks ? space : most;
        lines += std::string(rest.substr(0, end)) + '\n' + std::string(indent, ' ');
        rest.remove_prefix(breaks ? end + 1 : end);
        room = kMostColumns - indent;
    }
    return lines + std::string(rest) + '\n';
}

}  // namespace etendue
