// Which light path expressions the light of a path belongs to.
//
// A vertex whose material has several lobes may be taken for several events. Its light is not given to one of them at
// random but shared among them by what each lobe scatters, and a path carries the states of all its words with the
// share of its light that each has: layers that take each path once add up to the image, but for rounding. States that
// have become the same are one, so that there are few.
#pragma once

#include "core/rgb.h"
#include "wave/aov/aov_set.h"
#include "world/scattering.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Says what a vertex may be taken for: one event, or two with the shares of its light that are theirs.
struct VertexEvent {
    ScatterEvent event = ScatterEvent::Volume;
    ScatterEvent other = ScatterEvent::Volume;
    Rgb share{1.0f};          ///< share of `event`; what is left is of `other`
    std::uint16_t label = 0;  ///< label of the material
};

/// Returns what scattering towards `wi` at a surface whose material has `label` may be taken for.
[[nodiscard]] VertexEvent surface_event(const Scattering& scattering, const Vec3f& wi, bool is_delta,
                                        TransportMode mode, std::uint16_t label);

/// Returns the event of scattering at a diffuse surface whose material has `label`: diffuse reflection.
[[nodiscard]] inline VertexEvent diffuse_event(std::uint16_t label) {
    return {.event = ScatterEvent::ReflectDiffuse, .other = ScatterEvent::ReflectGlossy, .label = label};
}

/// A word that a path may be, by the automaton's state after it.
struct WordShare {
    PathAutomaton::State state = 0;
    Rgb share{1.0f};  ///< share of the path's throughput
};

/// The words of a path or subpath, in `PathWords`.
struct WordRange {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

/// Expressions that have a share of some light.
struct ExpressionShare {
    ExpressionMask expressions = 0;
    Rgb share{1.0f};
};

/// The words of the paths of a wave. Does nothing, and costs nothing, without an automaton.
class PathWords {
  public:
    /// Forgets all words. `aovs` may be null.
    void reset(const AovSet* aovs) {
        aovs_ = aovs;
        automaton_ = aovs != nullptr ? aovs->automaton.get() : nullptr;
        speller_ = aovs != nullptr ? aovs->speller : nullptr;
        are_followed_ = automaton_ != nullptr || speller_ != nullptr;
        words_.clear();
    }
    [[nodiscard]] bool are_followed() const { return are_followed_; }

    /// Returns how the automaton reads the material at `point`; without meaning if words are not followed.
    [[nodiscard]] std::uint16_t label(const World& world, const SurfacePoint& point) const {
        return automaton_ != nullptr ? automaton_->material_label(world.materials().index(point)) : std::uint16_t{0};
    }
    [[nodiscard]] AovSet::Source surface_source(const SurfacePoint& point) const {
        return are_followed() ? aovs_->source_of_instance(point.instance) : AovSet::Source{};
    }
    [[nodiscard]] AovSet::Source light_source(const World& world, std::uint32_t light) const {
        return are_followed() ? aovs_->source_of_light(world, light) : AovSet::Source{};
    }

    [[nodiscard]] WordRange begin_at_eye() {
        return speller_ != nullptr ? WordRange{PathSpeller::kEye} : begin(automaton_->eye_start());
    }
    [[nodiscard]] WordRange begin_at_light(const AovSet::Source& source) {
        return speller_ != nullptr ? WordRange{speller_->begin_at_light(source.event)}
                                   : begin(automaton_->light_start(source.event, source.label));
    }
    /// Returns the words of a path with the words `before` after a vertex that scatters as `event`.
    [[nodiscard]] WordRange scatter_from_eye(WordRange before, const VertexEvent& event);
    [[nodiscard]] WordRange scatter_from_light(WordRange before, const VertexEvent& event);

    /// Appends to `shares` the expressions of a path from the eye with the words in `range` that meets a light.
    void end_at_light(WordRange range, const AovSet::Source& source, std::vector<ExpressionShare>& shares) const;
    /// Appends to `shares` the expressions of a path from the eye whose last vertex, after the words `before`, scatters
    /// as `event` and samples a light.
    void end_at_light(WordRange before, const VertexEvent& event, const AovSet::Source& source,
                      std::vector<ExpressionShare>& shares);
    /// Appends to `shares` the expressions of a path from a light, with the words in `range`, that meets the camera.
    void end_at_camera(WordRange range, std::vector<ExpressionShare>& shares) const;
    /// Appends to `shares` the expressions of a light that the camera sees.
    void end_at_camera(const AovSet::Source& source, std::vector<ExpressionShare>& shares) const;
    /// Appends to `shares` the expressions of a connection between a vertex with the words `eye` and one with the words
    /// `light`, which are among `light_words`.
    void join(WordRange eye, const PathWords& light_words, WordRange light, std::vector<ExpressionShare>& shares) const;

    /// Appends the words in `range` of `from`, and returns where they are.
    WordRange copy(const PathWords& from, WordRange range) {
        const WordRange copied{static_cast<std::uint32_t>(words_.size()), range.count};
        const std::span<const WordShare> words = from[range];
        words_.insert(words_.end(), words.begin(), words.end());
        return copied;
    }

    /// Forgets all words but the first `size`: the others were needed for one connection only.
    void shrink_to(std::size_t size) { words_.resize(size); }
    [[nodiscard]] std::size_t size() const { return words_.size(); }
    [[nodiscard]] std::size_t bytes() const { return words_.capacity() * sizeof(WordShare); }

  private:
    [[nodiscard]] std::span<const WordShare> operator[](WordRange range) const {
        return std::span(words_).subspan(range.first, range.count);
    }
    [[nodiscard]] WordRange begin(PathAutomaton::State state);
    template <typename Next>
    WordRange scatter(WordRange before, const VertexEvent& event, const Next& next);
    void add_word(std::size_t first, PathAutomaton::State state, const Rgb& share);

    const AovSet* aovs_ = nullptr;
    const PathAutomaton* automaton_ = nullptr;
    PathSpeller* speller_ = nullptr;  ///< in place of the automaton: a range is a node of its then
    bool are_followed_ = false;
    std::vector<WordShare> words_;
};

}  // namespace etendue
