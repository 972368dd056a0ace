#include "lightpath/automaton.h"

#include "lightpath/position_graph.h"

#include <algorithm>
#include <bit>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Positions as bits.
using PositionSet = std::vector<std::uint64_t>;

void insert(PositionSet& set, std::size_t position) {
    set[position / 64] |= std::uint64_t{1} << (position % 64);
}
void add(PositionSet& set, const PositionSet& other) {
    for (std::size_t i = 0; i < set.size(); ++i) set[i] |= other[i];
}
PositionSet common(PositionSet a, const PositionSet& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] &= b[i];
    return a;
}
/// Calls `visit` with each position that is in both.
template <typename Visit>
void for_each_common(const PositionSet& a, const PositionSet& b, const Visit& visit) {
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::uint64_t left = a[i] & b[i]; left != 0; left &= left - 1)
            visit(64 * i + static_cast<std::size_t>(std::countr_zero(left)));
}

/// Holds the positions that one step in the graph leads to, for every position and every symbol.
struct Steps {
    std::vector<PositionSet> following;  ///< by position
    std::vector<PositionSet> preceding;  ///< by position
    std::vector<PositionSet> at_symbol;  ///< by symbol: positions that it can stand at
    PositionSet none;
    PositionSet end;  ///< where paths may end

    [[nodiscard]] PositionSet forwards(const PositionSet& from) const { return all_of(from, following); }
    [[nodiscard]] PositionSet backwards(const PositionSet& from) const { return all_of(from, preceding); }

  private:
    [[nodiscard]] PositionSet all_of(const PositionSet& from, const std::vector<PositionSet>& sets) const {
        PositionSet all = none;
        for_each_common(from, from, [&](std::size_t p) { add(all, sets[p]); });
        return all;
    }
};

/// Labels that patterns for any of `kinds` name, each once.
std::vector<std::string> labels_of(std::span<const PathExpression> expressions, EventKinds kinds) {
    std::vector<std::string> labels;
    for (const PathExpression& expression : expressions)
        for (const ExpressionNode& node : expression.nodes)
            for (const EventPattern& pattern : node.event.patterns)
                if (!pattern.label.empty() && (pattern.kinds & kinds) != 0) labels.push_back(pattern.label);
    std::ranges::sort(labels);
    labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
    return labels;
}

/// Sets of positions that are reached from each other by reading symbols, numbered. Paths have one end at the camera
/// and the other at a light, and nothing of either between: what else expressions allow leads to no state of its own.
class SubsetStates {
  public:
    /// The first symbol of a path is one of [first_begin, first_end), later ones are not; whoever reads one of
    /// [last_begin, last_end) has come to the end. `step` makes the sets that each symbol leads to from a set.
    struct Alphabet {
        std::size_t symbols;
        std::size_t first_begin;
        std::size_t first_end;
        std::size_t last_begin;
        std::size_t last_end;
    };
    template <typename Step>
    std::vector<PathAutomaton::State> explore(PositionSet start, const PositionSet& none, const Alphabet& alphabet,
                                              const Step& step) {
        std::vector<PathAutomaton::State> targets;
        (void)number({std::move(start), Progress::None});
        for (std::size_t state = 0; state < sets_.size(); ++state) {
            const Progress progress = progress_[state];
            const auto advance = step(PositionSet(sets_[state]));
            for (std::size_t symbol = 0; symbol < alphabet.symbols; ++symbol) {
                const bool is_first = symbol >= alphabet.first_begin && symbol < alphabet.first_end;
                const bool is_last = symbol >= alphabet.last_begin && symbol < alphabet.last_end;
                const bool is_path = progress == Progress::None ? is_first : progress == Progress::Begun && !is_first;
                targets.push_back(is_path ? number({advance(symbol), is_last ? Progress::Ended : Progress::Begun})
                                          : number({none, Progress::Ended}));
            }
        }
        return targets;
    }
    [[nodiscard]] const std::vector<PositionSet>& sets() const { return sets_; }

  private:
    enum class Progress : std::uint8_t { None, Begun, Ended };
    using Place = std::pair<PositionSet, Progress>;

    PathAutomaton::State number(Place place) {
        const auto [found, is_new] = numbers_.try_emplace(place, static_cast<PathAutomaton::State>(sets_.size()));
        if (is_new) {
            if (sets_.size() == kMostStates)
                throw ExpressionError(
                    fmt::format("all expressions together have more than {} states: ask for fewer in one render",
                                kMostStates),
                    0);
            sets_.push_back(std::move(place.first));
            progress_.push_back(place.second);
        }
        return found->second;
    }

    std::map<Place, PathAutomaton::State> numbers_;
    std::vector<PositionSet> sets_;
    std::vector<Progress> progress_;
};

}  // namespace

std::vector<bool> PathAutomaton::symbols_of(const EventSet& set) const {
    std::vector<bool> symbols(symbol_count_, set.is_negated);
    const auto put = [&](std::size_t symbol) { symbols[symbol] = !set.is_negated; };
    for (const EventPattern& pattern : set.patterns) {
        if ((pattern.kinds & kCameraKind) != 0) put(0);
        const auto materials = static_cast<std::uint16_t>(materials_.count());
        const auto lights = static_cast<std::uint16_t>(lights_.count());
        for (std::size_t kind = 0; kind < kScatterEvents; ++kind)
            for (std::uint16_t label = 0; label < materials; ++label)
                if ((pattern.kinds >> kind & 1) != 0 && materials_.matches(label, pattern.label))
                    put(scatter_symbol(static_cast<ScatterEvent>(kind), label));
        for (std::size_t kind = 0; kind < kSourceEvents; ++kind)
            for (std::uint16_t label = 0; label < lights; ++label)
                if ((pattern.kinds >> (kScatterEvents + kind) & 1) != 0 && lights_.matches(label, pattern.label))
                    put(source_symbol(static_cast<SourceEvent>(kind), label));
    }
    return symbols;
}

PathAutomaton::PathAutomaton(std::span<const PathExpression> expressions, const PathNames& names)
    : expression_count_(expressions.size()),
      materials_(labels_of(expressions, kAllScatterKinds), names.materials),
      lights_(labels_of(expressions, kAllSourceKinds), names.lights, names.light_aliases),
      first_source_(1 + kScatterEvents * materials_.count()),
      symbol_count_(first_source_ + kSourceEvents * lights_.count()) {
    if (expressions.size() > kMostExpressions)
        throw ExpressionError(fmt::format("more than {} expressions in one render", kMostExpressions), 0);
    const PositionGraph graph = make_position_graph(expressions);
    const std::vector<PositionGraph::Position>& positions = graph.positions;
    Steps steps;
    steps.none.assign((positions.size() + 63) / 64, 0);
    steps.end = steps.none;
    steps.following.assign(positions.size(), steps.none);
    steps.preceding.assign(positions.size(), steps.none);
    steps.at_symbol.assign(symbol_count_, steps.none);
    for (std::size_t p = 0; p < positions.size(); ++p) {
        if (positions[p].may_end) insert(steps.end, p);
        for (const std::size_t q : positions[p].following) {
            insert(steps.following[p], q);
            insert(steps.preceding[q], p);
        }
        if (positions[p].event == nullptr) continue;
        const std::vector<bool> symbols = symbols_of(*positions[p].event);
        for (std::size_t symbol = 0; symbol < symbol_count_; ++symbol)
            if (symbols[symbol]) insert(steps.at_symbol[symbol], p);
    }

    PositionSet beginning = steps.none;
    for (const std::size_t p : graph.beginnings) insert(beginning, p);
    SubsetStates eye;
    eye_ = {symbol_count_, eye.explore(beginning, steps.none, {symbol_count_, 0, 1, first_source_, symbol_count_},
                                       [&](const PositionSet& from) {
                                           return [&, to = steps.forwards(from)](std::size_t symbol) {
                                               return common(to, steps.at_symbol[symbol]);
                                           };
                                       })};
    eye_start_ = eye_.next(0, 0);
    SubsetStates light;
    light_ = {symbol_count_, light.explore(steps.end, steps.none, {symbol_count_, first_source_, symbol_count_, 0, 1},
                                           [&](PositionSet from) {
                                               return [&, from = std::move(from)](std::size_t symbol) {
                                                   return steps.backwards(common(from, steps.at_symbol[symbol]));
                                               };
                                           })};

    ExpressionMask negated = 0;
    for (std::size_t e = 0; e < expressions.size(); ++e)
        if (expressions[e].is_negated) negated |= ExpressionMask{1} << e;
    const auto expressions_in_both = [&](const PositionSet& a, const PositionSet& b) {
        ExpressionMask mask = 0;
        for_each_common(a, b, [&](std::size_t p) { mask |= ExpressionMask{1} << positions[p].expression; });
        return mask ^ negated;
    };
    for (const PositionSet& set : eye.sets()) whole_.push_back(expressions_in_both(set, steps.end));
    join_.reserve(eye.sets().size() * light.sets().size());
    for (const PositionSet& from_eye : eye.sets())
        for (const PositionSet& from_light : light.sets()) join_.push_back(expressions_in_both(from_eye, from_light));
}

std::vector<std::string> PathAutomaton::unmatched_names() const {
    std::vector<std::string> names = materials_.unmatched();
    for (std::string& name : lights_.unmatched()) names.push_back(std::move(name));
    return names;
}

}  // namespace etendue
