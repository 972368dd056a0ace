// What a render keeps besides the image, as integrators see it.
#pragma once

#include "film/bucket_layers.h"
#include "film/layers.h"
#include "lightpath/automaton.h"
#include "scene/aov_desc.h"
#include "wave/aov/first_hit_value.h"
#include "wave/aov/path_speller.h"
#include "world/world.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace etendue {

/// The ids of what the first surfaces belong to: those of a Cryptomatte.
struct MatteIds {
    bool by_material = false;          ///< else by instance
    std::vector<std::uint32_t> ids{};  ///< id of each material or instance of the scene
};

struct AovSet {
    LayerLayout layout{};
    /// Reads the paths of the light layers, of which the first are those of its expressions. Null if there are none.
    std::shared_ptr<const PathAutomaton> automaton{};
    /// Numbers the light layer of what TileJob::clamp_indirect took away, which comes after those of expressions; none
    /// if nobody asks.
    std::optional<std::size_t> removed_light{};
    /// Describes the layers of buckets, which come after all other light layers; their values are behind those of first
    /// hits.
    BucketLayers buckets{};
    /// Has paths spelled out, in place of being read by the automaton, and all contributions recorded, if it is not
    /// null. There are no layers then, and one thread. Must outlive the render.
    PathSpeller* speller = nullptr;
    /// Counts the lamps: the automaton's names for lights are those of the lamps, of the instances and of the
    /// environment, in this order.
    std::size_t lamp_count = 0;
    std::size_t instance_count = 0;
    /// Lists the values of the first surface that the eye meets which are averaged, in the order of their channels.
    std::vector<FirstHitValue> values{};
    /// Lists the values of the first surface of a pixel's nearest sample, in the order of their channels.
    std::vector<FirstHitValue> nearest{};
    MistSettings mist{};
    float frames_of_shutter = 0.0f;  ///< how many frames the shutter is open for; 0 if it is not
    std::vector<MatteIds> mattes{};  ///< one for each matte of the layout

    /// Puts buckets behind all layers that there are.
    void add_buckets(std::size_t count) {
        buckets = {count, layout.light, layout.values};
        layout.light += count;
        layout.values += buckets.value_count();
    }

    [[nodiscard]] bool needs_first_hits() const {
        return !values.empty() || !nearest.empty() || !mattes.empty() || layout.is_deep;
    }

    /// How the automaton reads a light.
    struct Source {
        SourceEvent event = SourceEvent::Surface;
        std::uint16_t label = 0;
    };
    [[nodiscard]] Source source_of_instance(std::uint32_t instance) const {
        return {SourceEvent::Surface, light_label(lamp_count + instance)};
    }
    [[nodiscard]] Source environment_source() const {
        return {SourceEvent::Environment, light_label(lamp_count + instance_count)};
    }
    /// Returns how the automaton reads the light of this index in `world`.
    [[nodiscard]] Source source_of_light(const World& world, std::uint32_t light) const {
        const Emitter& emitter = world.lights().emitter(light);
        if (emitter.instance != kNone) return source_of_instance(emitter.instance);
        if (emitter.lamp != kNone) return {SourceEvent::Lamp, light_label(emitter.lamp)};
        return environment_source();
    }

  private:
    [[nodiscard]] std::uint16_t light_label(std::size_t index) const {
        return automaton ? automaton->light_label(index) : std::uint16_t{0};
    }
};

}  // namespace etendue
