#include "agreement/agreement_report.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace etendue::test {

namespace {

/// All rooms that a line of a table is about.
using Row = std::vector<const RoomComparison*>;

/// Rows by their titles, in the order in which they appear.
struct Table {
    std::string title;
    std::string what;  ///< heads the column of titles
    std::vector<std::pair<std::string, Row>> rows;

    Row& row(const std::string& name) {
        for (auto& [title_of_row, row] : rows)
            if (title_of_row == name) return row;
        return rows.emplace_back(name, Row()).second;
    }
};

std::vector<Table> tables(std::span<const RoomComparison> rooms) {
    std::vector<Table> result;
    const auto table = [&](std::string_view title, const char* what) -> Table& {
        for (Table& there : result)
            if (there.title == title) return there;
        return result.emplace_back(Table{std::string(title), what, {}});
    };
    for (const RoomComparison& comparison : rooms) {
        const RoomTraits& room = comparison.room;
        if (room.medium != RoomMedium::None)
            table("Media", "light, medium")
                .row(fmt::format("{}, {}", name_of(room.light), name_of(room.medium)))
                .push_back(&comparison);
        else
            table("Lights", "light").row(std::string(name_of(room.light))).push_back(&comparison);
    }
    return result;
}

std::vector<std::pair<std::string, std::string>> integrator_pairs() {
    std::vector<std::pair<std::string, std::string>> pairs;
    const auto integrators = matrix_integrators();
    for (std::size_t a = 0; a < integrators.size(); ++a)
        for (std::size_t b = a + 1; b < integrators.size(); ++b) pairs.emplace_back(integrators[a], integrators[b]);
    return pairs;
}

char letter_of(Exclusion exclusion) {
    return static_cast<char>('a' + static_cast<int>(exclusion) - 1);
}

/// The worst of a row's comparisons of two integrators, and letters for why some rooms have none.
std::string cell(const Row& row, const std::pair<std::string, std::string>& names) {
    double z = 0.0;
    double mean = 0.0;
    std::size_t compared = 0;
    bool failed = false;
    std::string letters;
    for (const RoomComparison* comparison : row) {
        for (const PairComparison& pair : comparison->pairs) {
            if (pair.a != names.first || pair.b != names.second) continue;
            ++compared;
            z = std::max(z, std::abs(pair.agreement.worst.z));
            mean = std::max(mean, pair.agreement.mean_difference);
            failed = failed || !pair.agreement.agree();
        }
        for (const std::string& name : {names.first, names.second}) {
            const Exclusion exclusion = exclusion_of(comparison->room, name);
            if (exclusion == Exclusion::None) continue;
            if (letters.find(letter_of(exclusion)) == std::string::npos) letters += letter_of(exclusion);
        }
    }
    std::sort(letters.begin(), letters.end());
    if (compared == 0) return letters;
    std::string text = fmt::format("{:.1f}, {:.2f}%", z, 100.0 * mean);
    if (failed) text = fmt::format("**{}**", text);
    return letters.empty() ? text : fmt::format("{} ({})", text, letters);
}

/// True if a room of the table has a comparison of the two.
bool is_compared(const Table& table, const std::pair<std::string, std::string>& names) {
    return std::ranges::any_of(table.rows, [&](const auto& row) {
        return std::ranges::any_of(row.second, [&](const RoomComparison* room) {
            return std::ranges::any_of(room->pairs, [&](const PairComparison& pair) {
                return pair.a == names.first && pair.b == names.second;
            });
        });
    });
}

std::string markdown(const Table& table) {
    auto pairs = integrator_pairs();
    std::erase_if(pairs, [&](const auto& pair) { return !is_compared(table, pair); });
    std::string text = fmt::format("\n### {}\n\n| {} |", table.title, table.what);
    std::string rule = "|---|";
    for (const auto& [a, b] : pairs) {
        text += fmt::format(" {}, {} |", a, b);
        rule += "---|";
    }
    text += fmt::format("\n{}\n", rule);
    for (const auto& [title, row] : table.rows) {
        text += fmt::format("| {} |", title);
        for (const auto& pair : pairs) text += fmt::format(" {} |", cell(row, pair));
        text += "\n";
    }
    return text;
}

/// Percent: what half of `values`, what 95 of 100 and what all of them stay below.
std::string quantiles(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const auto at = [&](double share) {
        return 100.0 * values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
    };
    return fmt::format("{:.2f}% | {:.2f}% | {:.2f}%", at(0.5), at(0.95), at(1.0));
}

std::string summary(std::span<const RoomComparison> rooms, double significance) {
    std::size_t pairs = 0;
    std::size_t failed = 0;
    std::size_t tests = 0;
    std::size_t compared_rooms = 0;
    std::vector<double> mean_errors;
    std::vector<double> block_errors;
    std::vector<double> differences;
    for (const RoomComparison& room : rooms) {
        compared_rooms += room.pairs.empty() ? 0 : 1;
        for (const auto& [a, b, agreement] : room.pairs) {
            ++pairs;
            failed += agreement.agree() ? 0 : 1;
            tests += agreement.tests;
            mean_errors.push_back(agreement.mean_error);
            block_errors.push_back(agreement.block_error);
            differences.push_back(agreement.mean_difference);
        }
    }
    if (pairs == 0) return "No room has two integrators to compare.\n";
    const double threshold = critical_z(significance, tests);
    std::string text = fmt::format(
        "{} rooms, {} of them with a pair of integrators; {} pairs, {} z-tests; {} pairs disagree. A block fails "
        "beyond "
        "|z| = {:.2f}.\n\n| | half of the pairs | 95 of 100 | all |\n|---|---|---|---|\n",
        rooms.size(), compared_rooms, pairs, tests, failed, threshold);
    text += "| image means differ by less than | " + quantiles(differences) + " |\n";
    const auto seen = [&](std::vector<double> errors) {
        for (double& error : errors) error *= threshold;
        return quantiles(std::move(errors));
    };
    text += "| an error of all of an image that is seen every other time | " + seen(mean_errors) + " |\n";
    text += "| an error of one block that is seen every other time | " + seen(block_errors) + " |\n";
    return text;
}

}  // namespace

std::string markdown_report(std::span<const RoomComparison> rooms, double significance) {
    std::string text = summary(rooms, significance);
    text += "\nWho is left out, by the letters of the tables:\n\n";
    for (int i = 1; i <= static_cast<int>(Exclusion::NothingMerges); ++i) {
        const auto exclusion = static_cast<Exclusion>(i);
        std::string who;
        for (const std::string_view integrator : matrix_integrators()) {
            const auto count = std::count_if(rooms.begin(), rooms.end(), [&](const RoomComparison& comparison) {
                return exclusion_of(comparison.room, integrator) == exclusion;
            });
            if (count > 0) who += fmt::format("{}`{}` in {} rooms", who.empty() ? "" : ", ", integrator, count);
        }
        if (!who.empty()) text += fmt::format("- {}: {}. {}.\n", letter_of(exclusion), who, reason_of(exclusion));
    }
    for (const Table& table : tables(rooms)) text += markdown(table);
    return text;
}

std::string with_report(const std::string& document, const std::string& report) {
    constexpr std::string_view kBegin = "<!-- results -->\n";
    constexpr std::string_view kEnd = "<!-- end of results -->";
    const std::size_t begin = document.find(kBegin);
    const std::size_t end = document.find(kEnd);
    if (begin == std::string::npos || end == std::string::npos || end < begin)
        throw std::invalid_argument("the document has no lines '<!-- results -->' and '<!-- end of results -->'");
    return document.substr(0, begin + kBegin.size()) + "\n" + report + "\n" + document.substr(end);
}

}  // namespace etendue::test
