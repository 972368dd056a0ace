#include "core/error.h"

#include "core/shown_text.h"

#include <algorithm>
#include <numeric>

namespace etendue {

namespace {

const char* severity_name(Severity severity) {
    switch (severity) {
        case Severity::Note:
            return "note";
        case Severity::Warning:
            return "warning";
        case Severity::Error:
            return "error";
    }
    return "error";
}

std::string join_errors(const ProblemList& problems) {
    std::string text;
    for (const Problem& problem : problems.all()) {
        if (problem.severity != Severity::Error) continue;
        if (!text.empty()) text += '\n';
        text += problem.str();
    }
    if (problems.dropped() > 0) text += "\n(and " + std::to_string(problems.dropped()) + " more problems)";
    return text;
}

ProblemList single_error(SourceLocation where, std::string message) {
    ProblemList problems;
    problems.error(std::move(where), std::move(message));
    return problems;
}

/// Returns the beginning and the end of a `text` that is longer than `most` bytes, else all of it.
std::string shortened(std::string text, std::size_t most) {
    constexpr std::string_view kGap = " ... ";
    if (text.size() <= most) return text;
    const std::size_t half = (most - kGap.size()) / 2;
    return std::string(first_characters(text, half)).append(kGap).append(last_characters(text, half));
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({row[j] + 1, diagonal + 1, substituted});
        }
    }
    return row.back();
}

}  // namespace

std::string Problem::str() const {
    const std::string place = where.str();
    return std::string(severity_name(severity)) + ": " + (place.empty() ? "" : place + ": ") + message;
}

void ProblemList::add(Problem problem) {
    if (problem.severity == Severity::Error) ++error_count_;
    if (is_full()) {
        ++dropped_;
        return;
    }
    problem.where.pointer = shortened(std::move(problem.where.pointer), kMaxPointer);
    problem.message = shortened(std::move(problem.message), kMaxMessage);
    problems_.push_back(std::move(problem));
}

SceneError::SceneError(ProblemList problems)
    : std::runtime_error(join_errors(problems)), problems_(std::move(problems)) {}

SceneError::SceneError(SourceLocation where, std::string message)
    : SceneError(single_error(std::move(where), std::move(message))) {}

std::string name_hint(std::string_view name, std::span<const std::string_view> known) {
    constexpr std::size_t kMostListed = 20;
    constexpr std::size_t kLongestListed = 64;
    if (known.empty()) return "there is no other either";
    const std::string nearest = nearest_name(name, known);
    if (!nearest.empty()) return "did you mean '" + nearest + "'?";
    std::string list = "there are ";
    for (std::size_t i = 0; i < std::min(known.size(), kMostListed); ++i) {
        if (i > 0) list += ", ";
        const std::string_view part = first_characters(known[i], kLongestListed);
        list.append("'").append(part).append(part.size() < known[i].size() ? "...'" : "'");
    }
    if (known.size() > kMostListed) list += " and " + std::to_string(known.size() - kMostListed) + " more";
    return list;
}

std::string nearest_name(std::string_view name, std::span<const std::string_view> known) {
    constexpr std::size_t kLongestName = 64;  // the distance is quadratic in the length; longer names get no suggestion
    constexpr std::size_t kMostWork = std::size_t{1} << 21;  // pairs of characters: thousands of names as people write
    if (name.size() > kLongestName) return {};
    std::string_view best;
    std::size_t best_distance = std::max<std::size_t>(2, name.size() / 3) + 1;
    std::size_t work = 0;
    for (const std::string_view candidate : known) {
        if (std::max(name.size(), candidate.size()) - std::min(name.size(), candidate.size()) >= best_distance)
            continue;
        if (work > kMostWork) break;
        work += (name.size() + 1) * (candidate.size() + 1);
        const std::size_t distance = edit_distance(name, candidate);
        if (distance < best_distance) {
            best = candidate;
            best_distance = distance;
        }
    }
    return std::string(best);
}

}  // namespace etendue
