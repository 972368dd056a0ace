// An image on disk: EXR, PNG and statistics.
#pragma once

#include "color/color_config.h"
#include "image/write.h"
#include "picture/image_description.h"
#include "picture/integrator_choice.h"
#include "picture/output_paths.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// Where SIGUSR1 has the image of that moment written.
[[nodiscard]] std::filesystem::path preview_path(const std::filesystem::path& output);

/// Removes what SIGUSR1 had written of the image before it was finished, unless the file is another image's.
void remove_preview(const std::filesystem::path& output);

/// Every file that a render of the image or part `output` may write; `layers` are the names of those that have files of
/// their own.
[[nodiscard]] std::vector<std::filesystem::path> files_of_image(const std::filesystem::path& output,
                                                                std::span<const std::string> layers = {});

/// Returns the integrator that `auto` chose for the first of the frames before this one that lie beside `file`, the
/// statistics that this one will have, and were made of the files and with the settings of `statistics`.
[[nodiscard]] std::optional<IntegratorChoice> choice_of_sequence(const std::filesystem::path& file,
                                                                 const RenderStatistics& statistics);

/// Writes the files of `image`, whose state has been described; fills in how long that took. `beside` is called for
/// what else belongs to the image. Layers stand where `image` says. Statistics are removed first and written last, so
/// that where they stand, the other files are of the same render, wherever it was killed. Returns the names of files
/// that belonged to the image which has been replaced, as its statistics said, and are still there: of layers and
/// depths that this one does not have. Throws IoError.
std::vector<std::string> write_image_files(const OutputPaths& paths, ImageDescription& image, const ColorConfig& colors,
                                           PixelDepth depth, const std::function<void()>& beside = {});

/// Says which exposure was chosen for the PNG, and how much of it is clipped if that is over 5% of its pixels.
void note_exposure(const OutputPaths& paths, const RenderStatistics& statistics);

/// Says how many pixels are too bright for the EXR of a `depth` of 16 bits, which then holds the largest value it can.
void note_brightest(const OutputPaths& paths, const OutputFrame& frame, const ColorConfig& colors, PixelDepth depth);

/// A note for each of these names.
void note_earlier_files(const std::vector<std::string>& names);

}  // namespace etendue
