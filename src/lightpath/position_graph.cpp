#include "lightpath/position_graph.h"

#include <algorithm>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Holds the positions at which paths through a part of an expression can begin and end.
struct Ends {
    bool is_nullable = false;  ///< the part may be empty
    std::vector<std::size_t> first;
    std::vector<std::size_t> last;
};

void append(std::vector<std::size_t>& to, const std::vector<std::size_t>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

EventKinds possible_kinds(const EventSet& event) {
    EventKinds kinds = 0;
    for (const EventPattern& pattern : event.patterns)
        if (!event.is_negated || pattern.label.empty()) kinds |= pattern.kinds;
    return event.is_negated ? kAllKinds & ~kinds : kinds;
}

/// Adds one expression to a graph.
class Builder {
  public:
    Builder(const PathExpression& expression, bool is_from_light, std::size_t index, PositionGraph& graph)
        : expression_(expression), is_from_light_(is_from_light), index_(index), graph_(graph) {}

    void build() {
        const std::size_t beginning = add(nullptr);
        graph_.beginnings.push_back(beginning);
        const Ends whole = build(expression_.nodes.size() - 1);
        connect({beginning}, whole.first);
        for (const std::size_t p : whole.last) graph_.positions[p].may_end = true;
        for (std::size_t p = beginning; p < graph_.positions.size(); ++p) make_unique(graph_.positions[p].following);
    }

  private:
    std::size_t add(const EventSet* event) {
        if (graph_.positions.size() == kMostPositions)
            throw ExpressionError(fmt::format("all expressions together have more than {} events", kMostPositions), 0);
        graph_.positions.push_back({.event = event, .expression = index_, .following = {}, .may_end = false});
        return graph_.positions.size() - 1;
    }

    static void make_unique(std::vector<std::size_t>& positions) {
        std::ranges::sort(positions);
        positions.erase(std::unique(positions.begin(), positions.end()), positions.end());
    }

    void connect(const std::vector<std::size_t>& from, const std::vector<std::size_t>& to) {
        for (const std::size_t p : from) {
            std::vector<std::size_t>& following = graph_.positions[p].following;
            append(following, to);
            // Nested repetitions add the same positions many times.
            if (following.size() > 2 * kMostPositions) make_unique(following);
        }
    }

    Ends build(std::size_t index) {
        const ExpressionNode& node = expression_.nodes[index];
        switch (node.kind) {
            case ExpressionNode::Kind::Event: {
                const std::size_t position = add(&node.event);
                return {false, {position}, {position}};
            }
            case ExpressionNode::Kind::Choice: {
                Ends choice;
                for (const std::size_t child : node.children) {
                    const Ends ends = build(child);
                    choice.is_nullable = choice.is_nullable || ends.is_nullable;
                    append(choice.first, ends.first);
                    append(choice.last, ends.last);
                }
                return choice;
            }
            case ExpressionNode::Kind::Sequence: {
                Ends sequence{.is_nullable = true, .first = {}, .last = {}};
                for (std::size_t i = 0; i < node.children.size(); ++i)
                    sequence =
                        follow(sequence, build(node.children[is_from_light_ ? node.children.size() - 1 - i : i]));
                return sequence;
            }
            case ExpressionNode::Kind::Repeat:
                return repeat(node);
        }
        return {};
    }

    /// Connects one part to the one that follows it.
    Ends follow(const Ends& before, const Ends& after) {
        connect(before.last, after.first);
        Ends both{before.is_nullable && after.is_nullable, before.first, after.last};
        if (before.is_nullable) append(both.first, after.first);
        if (after.is_nullable) append(both.last, before.last);
        return both;
    }

    /// The part as often as must be, then as often as may be.
    Ends repeat(const ExpressionNode& node) {
        Ends all{.is_nullable = true, .first = {}, .last = {}};
        for (int i = 1; i < node.least; ++i) all = follow(all, build(node.children[0]));
        if (node.most == ExpressionNode::kEndless) {
            Ends loop = build(node.children[0]);
            connect(loop.last, loop.first);
            loop.is_nullable = loop.is_nullable || node.least == 0;
            return follow(all, loop);
        }
        if (node.least > 0) all = follow(all, build(node.children[0]));
        for (int i = node.least; i < node.most; ++i) {
            Ends optional = build(node.children[0]);
            optional.is_nullable = true;
            all = follow(all, optional);
        }
        return all;
    }

    const PathExpression& expression_;
    bool is_from_light_;
    std::size_t index_;
    PositionGraph& graph_;
};

EventKinds first_kinds(const PositionGraph& graph, std::size_t beginning) {
    EventKinds kinds = 0;
    for (const std::size_t p : graph.positions[beginning].following) kinds |= possible_kinds(*graph.positions[p].event);
    return kinds;
}

EventKinds last_kinds(const PositionGraph& graph, std::size_t beginning) {
    EventKinds kinds = 0;
    for (std::size_t p = beginning; p < graph.positions.size(); ++p)
        if (graph.positions[p].may_end && graph.positions[p].event != nullptr)
            kinds |= possible_kinds(*graph.positions[p].event);
    return kinds;
}

}  // namespace

PositionGraph make_position_graph(std::span<const PathExpression> expressions) {
    PositionGraph graph;
    for (std::size_t e = 0; e < expressions.size(); ++e) {
        const std::size_t beginning = graph.positions.size();
        bool is_found = false;
        for (const bool is_from_light : {false, true}) {
            graph.positions.resize(beginning);
            graph.beginnings.resize(e);
            Builder(expressions[e], is_from_light, e, graph).build();
            is_found =
                first_kinds(graph, beginning) == kCameraKind && (last_kinds(graph, beginning) & kAllSourceKinds) != 0;
            if (is_found) break;
        }
        if (!is_found)
            throw ExpressionError(
                "an expression begins with the camera (C or E) and ends at a light (L, O or B), or the other way round",
                0);
    }
    return graph;
}

}  // namespace etendue
