#include "lightpath/automaton.h"

#include "lightpath/position_graph.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Positions as bits.
using PositionSet = std::vector<std::uint64_t>;

bool contains(const PositionSet& set, std::size_t position) {
    return ((set[position / 64] >> (position % 64)) & 1) != 0;
}
void insert(PositionSet& set, std::size_t position) {
    set[position / 64] |= std::uint64_t{1} << (position % 64);
}

/// Labels that patterns for any of `kinds` name, each once.
std::vector<std::string> labels_of(std::span<const PathExpression> expressions, EventKinds kinds) {
    std::vector<std::string> labels;
    for (const PathExpression& expression : expressions)
        for (const ExpressionNode& node : expression.nodes)
            for (const EventPattern& pattern : node.event.patterns)
                if (!pattern.label.empty() && (pattern.kinds & kinds) != 0) labels.push_back(pattern.label);
    std::ranges::sort(labels);
    labels.erase(std::ranges::unique(labels).begin(), labels.end());
    return labels;
}

/// Sets of positions that are reached from each other by reading symbols, numbered.
class SubsetStates {
  public:
    /// `step` makes the set that `symbol` leads to from `set`.
    template <typename Step>
    std::vector<PathAutomaton::State> explore(PositionSet start, std::size_t symbols, const Step& step) {
        std::vector<PathAutomaton::State> targets;
        (void)number(std::move(start));
        for (std::size_t state = 0; state < sets_.size(); ++state)
            for (std::size_t symbol = 0; symbol < symbols; ++symbol) {
                const PositionSet from = sets_[state];
                targets.push_back(number(step(from, symbol)));
            }
        return targets;
    }
    [[nodiscard]] const std::vector<PositionSet>& sets() const { return sets_; }

  private:
    PathAutomaton::State number(PositionSet set) {
        const auto [found, is_new] = numbers_.try_emplace(set, static_cast<PathAutomaton::State>(sets_.size()));
        if (is_new) {
            if (sets_.size() == kMostStates)
                throw ExpressionError(
                    fmt::format("all expressions together have more than {} states: ask for fewer in one render",
                                kMostStates),
                    0);
            sets_.push_back(std::move(set));
        }
        return found->second;
    }

    std::map<PositionSet, PathAutomaton::State> numbers_;
    std::vector<PositionSet> sets_;
};

}  // namespace

std::vector<bool> PathAutomaton::symbols_of(const EventSet& set) const {
    std::vector<bool> symbols(symbol_count_, set.is_negated);
    const auto put = [&](std::size_t symbol) { symbols[symbol] = !set.is_negated; };
    for (const EventPattern& pattern : set.patterns) {
        if ((pattern.kinds & kCameraKind) != 0) put(0);
        for (std::size_t kind = 0; kind < kScatterEvents; ++kind)
            for (std::uint16_t label = 0; label < materials_.count(); ++label)
                if ((pattern.kinds >> kind & 1) != 0 && materials_.matches(label, pattern.label))
                    put(scatter_symbol(static_cast<ScatterEvent>(kind), label));
        for (std::size_t kind = 0; kind < kSourceEvents; ++kind)
            for (std::uint16_t label = 0; label < lights_.count(); ++label)
                if ((pattern.kinds >> (kScatterEvents + kind) & 1) != 0 && lights_.matches(label, pattern.label))
                    put(source_symbol(static_cast<SourceEvent>(kind), label));
    }
    return symbols;
}

PathAutomaton::PathAutomaton(std::span<const PathExpression> expressions, const PathNames& names)
    : expression_count_(expressions.size()),
      materials_(labels_of(expressions, kAllScatterKinds), names.materials),
      lights_(labels_of(expressions, kAllSourceKinds), names.lights),
      first_source_(1 + kScatterEvents * materials_.count()),
      symbol_count_(first_source_ + kSourceEvents * lights_.count()) {
    if (expressions.size() > kMostExpressions)
        throw ExpressionError(fmt::format("more than {} expressions in one render", kMostExpressions), 0);
    const PositionGraph graph = make_position_graph(expressions);
    const std::vector<PositionGraph::Position>& positions = graph.positions;
    std::vector<std::vector<bool>> stands_at;  // by position, by symbol
    for (const auto& position : positions)
        stands_at.push_back(position.event != nullptr ? symbols_of(*position.event)
                                                      : std::vector<bool>(symbol_count_, false));
    const PositionSet none((positions.size() + 63) / 64, 0);

    PositionSet beginning = none;
    for (const std::size_t p : graph.beginnings) insert(beginning, p);
    SubsetStates eye;
    eye_ = {symbol_count_, eye.explore(beginning, symbol_count_, [&](const PositionSet& from, std::size_t symbol) {
                PositionSet to = none;
                for (std::size_t p = 0; p < positions.size(); ++p)
                    if (contains(from, p))
                        for (const std::size_t q : positions[p].following)
                            if (stands_at[q][symbol]) insert(to, q);
                return to;
            })};
    eye_start_ = eye_.next(0, 0);

    PositionSet end = none;
    for (std::size_t p = 0; p < positions.size(); ++p)
        if (positions[p].may_end) insert(end, p);
    SubsetStates light;
    light_ = {symbol_count_, light.explore(end, symbol_count_, [&](const PositionSet& from, std::size_t symbol) {
                  PositionSet to = none;
                  for (std::size_t p = 0; p < positions.size(); ++p)
                      if (std::ranges::any_of(positions[p].following,
                                              [&](std::size_t q) { return contains(from, q) && stands_at[q][symbol]; }))
                          insert(to, p);
                  return to;
              })};

    ExpressionMask negated = 0;
    for (std::size_t e = 0; e < expressions.size(); ++e)
        if (expressions[e].is_negated) negated |= ExpressionMask{1} << e;
    const auto expressions_in_both = [&](const PositionSet& a, const PositionSet& b) {
        ExpressionMask mask = 0;
        for (std::size_t p = 0; p < positions.size(); ++p)
            if (contains(a, p) && contains(b, p)) mask |= ExpressionMask{1} << positions[p].expression;
        return mask ^ negated;
    };
    for (const PositionSet& set : eye.sets()) whole_.push_back(expressions_in_both(set, end));
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
