// All light path expressions of a render as one automaton that reads paths from both ends.
//
// Eye subpaths are read forwards: their state is the set of positions (position_graph.h) that the events so far may
// have led to. Light subpaths are read backwards: their state is the set of positions after which the events so far may
// complete a path. A connection joins the two: the path has the expressions whose position is in both sets.
#pragma once

#include "lightpath/expression.h"
#include "lightpath/label_classes.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// Expressions as bits, by their index.
using ExpressionMask = std::uint64_t;
inline constexpr std::size_t kMostExpressions = 64;

/// Most states of either direction.
inline constexpr std::size_t kMostStates = 1024;

/// Names in the scene that expressions may ask for.
struct PathNames {
    std::vector<std::string> materials;
    std::vector<std::string> lights;
    std::vector<std::string> light_aliases{};  ///< second names by the same index, some empty; fewer where none follow
};

class PathAutomaton {
  public:
    using State = std::uint16_t;

    /// Throws ExpressionError (with offset 0) for more than kMostExpressions expressions or kMostStates states, and as
    /// make_position_graph does.
    PathAutomaton(std::span<const PathExpression> expressions, const PathNames& names);

    /// Returns the label of the material with this index among the names: what the functions below call `label`.
    [[nodiscard]] std::uint16_t material_label(std::size_t index) const { return materials_.of(index); }
    /// Returns the label of the light with this index among the names.
    [[nodiscard]] std::uint16_t light_label(std::size_t index) const { return lights_.of(index); }
    /// Names that expressions ask for and nothing in the scene has.
    [[nodiscard]] std::vector<std::string> unmatched_names() const;

    /// Returns the state of a path from the eye that has left the camera.
    [[nodiscard]] State eye_start() const { return eye_start_; }
    [[nodiscard]] State eye_scatter(State state, ScatterEvent event, std::uint16_t label) const {
        return eye_.next(state, scatter_symbol(event, label));
    }
    /// The expressions of a path from the eye that ends at a light.
    [[nodiscard]] ExpressionMask eye_ends(State state, SourceEvent event, std::uint16_t label) const {
        return whole_[eye_.next(state, source_symbol(event, label))];
    }

    /// Returns the state of a path from a light that has begun with this event at a light of this label.
    [[nodiscard]] State light_start(SourceEvent event, std::uint16_t label) const {
        return light_.next(light_end_, source_symbol(event, label));
    }
    [[nodiscard]] State light_scatter(State state, ScatterEvent event, std::uint16_t label) const {
        return light_.next(state, scatter_symbol(event, label));
    }
    /// The expressions of the path that a connection makes, whose vertices' events both states have seen.
    [[nodiscard]] ExpressionMask join(State eye, State light) const { return join_[eye * light_.size() + light]; }

    [[nodiscard]] std::size_t eye_states() const { return eye_.size(); }
    [[nodiscard]] std::size_t light_states() const { return light_.size(); }

  private:
    /// Transitions by state and symbol.
    struct Table {
        std::size_t symbols = 0;
        std::vector<State> targets;

        [[nodiscard]] State next(State state, std::size_t symbol) const { return targets[state * symbols + symbol]; }
        [[nodiscard]] std::size_t size() const { return targets.size() / symbols; }
    };

    [[nodiscard]] std::size_t scatter_symbol(ScatterEvent event, std::uint16_t label) const {
        return 1 + static_cast<std::size_t>(event) * materials_.count() + label;
    }
    [[nodiscard]] std::size_t source_symbol(SourceEvent event, std::uint16_t label) const {
        return first_source_ + static_cast<std::size_t>(event) * lights_.count() + label;
    }
    /// Returns for each symbol whether it is in `set`.
    [[nodiscard]] std::vector<bool> symbols_of(const EventSet& set) const;

    std::size_t expression_count_;
    LabelClasses materials_;
    LabelClasses lights_;
    std::size_t first_source_;
    std::size_t symbol_count_;
    Table eye_;
    Table light_;
    State eye_start_ = 0;
    State light_end_ = 0;                ///< state of a path from a light before its first event
    std::vector<ExpressionMask> whole_;  ///< by state of the eye: of paths that are complete
    std::vector<ExpressionMask> join_;   ///< by state of the eye, by state of the light
};

}  // namespace etendue
