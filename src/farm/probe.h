// What an image would take, from the beginning of it.
#pragma once

#include "core/parallel.h"
#include "session/image_job.h"

#include <string>

namespace etendue {

/// Loads and compiles the scene of `job` and renders for about a second. Writes no file. Returns a JSON object,
/// indented and ended by a newline: scene, width and height of what is rendered, spp, integrator, camera, threads,
/// load_seconds, build_seconds, start_seconds (from the start of this process until it rendered), seconds_per_spp,
/// estimated_seconds (the start and all of the image, or the limit of time that is set), peak_memory_bytes,
/// estimated_memory_bytes (of all of the render, with kMemorySafety), and deep_bytes, the part of the peak that depths
/// have taken and that grows with the samples. Memory for splats and textures grows a little after the first second.
/// Throws what `prepare_scene` throws. If it is interrupted, what it returns says nothing.
[[nodiscard]] std::string probe(const ImageJob& job, const SettingsOverrides& overrides, const ThreadPool& threads);

}  // namespace etendue
