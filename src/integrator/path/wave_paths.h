// The paths of a wave, from bounce to bounce.
#pragma once

#include "integrator/path/path_columns.h"
#include "scene/integrator_settings.h"
#include "transport/dimensions.h"
#include "wave/aov/path_words.h"
#include "wave/camera_wave.h"
#include "wave/tile_job.h"
#include "world/world.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Says for what, and how, the paths of a wave are traced, and how far they are.
struct PathContext {
    const World& world;
    const TileJob& job;
    const IntegratorSettings& settings;
    int rays;  ///< rays that each path has traced; its edges, if the World has no bodies
    RenderCounters& counters;

    /// Returns true if paths sample lights, and do not find them by chance only.
    [[nodiscard]] bool samples_lights() const { return settings.light_samples > 0; }
};

/// Adds to the columns of all paths what only some scenes and renders ask for, and the camera samples they belong to.
struct WavePaths : PathColumns {
    std::vector<Hit> hits{kCapacity};
    std::vector<Interior> interiors;       ///< only if the World has bodies
    std::vector<LightReceiver> receivers;  ///< where rays start; only if the World chooses lights by that
    std::vector<float> passed;             ///< see `metres_passed`; only if the World has clear surfaces
    std::vector<WordRange> ranges;         ///< words of the paths so far; only if words are followed
    PathWords words;
    std::vector<CameraSample> samples{kCapacity};  ///< by slot

    /// Begins the paths of the first `rays.size()` of `samples`.
    void begin(const World& world, const TileJob& job, std::span<const Ray> rays);

    /// Returns where the ray of path `i` starts, as far as the choice of a light depends on that.
    [[nodiscard]] LightReceiver receiver(std::size_t i) const {
        return receivers.empty() ? LightReceiver{} : receivers[i];
    }
    /// Returns the metres from the vertex that path `i` comes from to where its ray starts, behind clear surfaces.
    [[nodiscard]] float metres_passed(std::size_t i) const { return passed.empty() ? 0.0f : passed[i]; }
    /// Returns the cone of path `i` where its ray ends.
    [[nodiscard]] RayCone arriving_cone(std::size_t i) const { return cone(i).at(hits[i].t); }
    /// Takes the words of path `i` past a vertex that scatters as `event`.
    void follow(std::size_t i, const VertexEvent& event) { ranges[i] = words.scatter_from_eye(ranges[i], event); }

    /// Returns the number of light samples at one vertex of path `i`: at the one that it has reached if `first_vertex`
    /// is kOnlyDeltas, at the one before if it is kIsDirect.
    [[nodiscard]] std::uint32_t light_samples(const PathContext& context, std::size_t i,
                                              std::uint32_t first_vertex) const {
        return is(first_vertex, i) ? context.settings.light_samples : 1u;
    }
    /// Returns how many light samples at the last vertex of path `i` could have found the light that it meets.
    [[nodiscard]] std::uint32_t samples_of_met_light(const PathContext& context, std::size_t i) const {
        if (!context.samples_lights() || is(path_history::kUnsampled, i)) return 0;
        return light_samples(context, i, path_history::kIsDirect);
    }
    /// Returns the key from which the numbers of the `round`-th light sample of path `i` come.
    [[nodiscard]] SampleKey light_sample_key(const PathContext& context, std::size_t i, std::uint32_t round) const {
        return etendue::light_sample_key(key(i), light_samples(context, i, path_history::kOnlyDeltas), round);
    }
    /// Returns the alpha key of the ray that path `i` goes on along.
    [[nodiscard]] std::uint32_t next_alpha_key(const PathContext& context, std::size_t i) const {
        if (!context.world.traits().has_transparency) return 0;
        return sample_bits(key(i), bounce_dimension(context.rays, kAlpha));
    }
    /// Returns the alpha key of the shadow ray of the `round`-th light sample of path `i`, unlike those of other rounds
    /// and of the ray that goes on.
    [[nodiscard]] std::uint32_t shadow_alpha_key(const PathContext& context, std::size_t i, std::uint32_t round) const {
        return etendue::shadow_alpha_key(next_alpha_key(context, i), round);
    }

    /// Tells the profile, if there is one, of the end of path `i`.
    void end_path(const PathContext& context, std::size_t i, PathEnding ending) const {
        count_eye_path_end(context.job, samples[slot[i]], ending, context.rays);
    }
    /// Moves all that `survivors` keep to where they go on.
    void move(BlockSurvivors survivors, const SceneTraits& traits);

    [[nodiscard]] std::size_t bytes() const;
};

}  // namespace etendue
