// The parts of `validate`, one per kind of description.
#pragma once

#include "scene/scene_desc.h"

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace etendue {

/// Errors unless `motion` is empty or has from 2 to kMaxMotionSteps transforms that can be inverted.
void check_motion(const TransformMotion& motion, const SourceLocation& where, ProblemList& problems);

void validate_images_and_textures(const SceneDesc& scene, ProblemList& problems);
void validate_materials(const SceneDesc& scene, ProblemList& problems);
void validate_meshes(const SceneDesc& scene, ProblemList& problems);
void validate_instances(const SceneDesc& scene, ProblemList& problems);
void validate_cameras(const SceneDesc& scene, ProblemList& problems);
void validate_lights(const SceneDesc& scene, ProblemList& problems);
void validate_settings(const SceneDesc& scene, ProblemList& problems);

/// Errors where something reaches so far that rays to it are beyond single precision. Everything must be finite, and
/// all that refers to something must refer to what exists.
void validate_extent(const SceneDesc& scene, ProblemList& problems);

/// Adds an error unless `handle` refers to an element of `elements`.
template <typename T>
void check_handle(Handle<T> handle, const std::vector<T>& elements, std::string_view what, const SourceLocation& where,
                  ProblemList& problems) {
    if (handle.index >= 0 && static_cast<std::size_t>(handle.index) < elements.size()) return;
    problems.error(where, fmt::format("{} {} does not exist; there are {}", what, handle.index, elements.size()));
}

/// Adds an error unless `value` is finite and in [low, high].
inline void check_range(double value, double low, double high, std::string_view what, const SourceLocation& where,
                        ProblemList& problems) {
    if (std::isfinite(value) && value >= low && value <= high) return;
    if (std::isfinite(high)) {
        problems.error(where, fmt::format("{} is {}, but must be in [{:g}, {:g}]", what, value, low, high));
    } else {
        problems.error(where, fmt::format("{} is {}, but must be finite and at least {:g}", what, value, low));
    }
}

/// Adds an error for the first channel of the colour `value` that is not finite or not in [low, high].
inline void check_range(const Rgb& value, double low, double high, std::string_view what, const SourceLocation& where,
                        ProblemList& problems) {
    for (const float channel : {value.r, value.g, value.b}) {
        const std::size_t errors = problems.error_count();
        check_range(static_cast<double>(channel), low, high, what, where, problems);
        if (problems.error_count() > errors) return;
    }
}

/// Adds an error unless these are the cone angles of a spot, radians from its axis.
inline void check_cones(float inner, float outer, const SourceLocation& where, ProblemList& problems) {
    if (inner >= 0.0f && inner <= outer && outer > 0.0f && outer <= 0.5f * kPi + 1e-6f) return;
    problems.error(where, fmt::format("the spot's cone angles are {} and {}, but must satisfy 0 <= inner <= outer <= "
                                      "pi/2, and outer > 0",
                                      inner, outer));
}

}  // namespace etendue
