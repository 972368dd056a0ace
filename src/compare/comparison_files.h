// What a comparison leaves beside its report: data, tables, plots and images.
#pragma once

#include "color/color_config.h"
#include "compare/comparison_reference.h"
#include "report/comparison_report.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// Names, in the directory of a comparison, of the files that are written of every one, images aside.
[[nodiscard]] std::vector<std::string> names_of_data_files();

/// Name of the file that a reference is written to.
inline constexpr const char* kReferenceFile = "reference.exr";
/// Name of the directory of the images that are kept.
inline constexpr const char* kImagesDirectory = "images";

/// Writes data.csv, tables.tex and plots to `directory`; removes plots of an earlier comparison that are not made
/// again.
void write_data_files(const std::filesystem::path& directory, const ComparisonReport& report);

/// Returns a note on the names that plots in PDF cannot show; else empty.
[[nodiscard]] std::string lost_in_pdf(const ComparisonReport& report);

/// Removes the reference at `path` if a comparison has made it; returns whether it did.
bool remove_own_reference(const std::filesystem::path& path);

/// Writes the reference as an EXR of 32-bit floats in the working space. A pooled one is the mean of all renders, has
/// the standard error of each value as its layer "noise", and says which seeds it was made of.
void write_reference(const std::filesystem::path& path, const Reference& reference, const ComparisonReport& report,
                     const ColorConfig& colors);

/// Holds what a file that Etendue has rendered says of its image.
struct ReferenceOrigin {
    SeedRange seeds{};                 ///< seeds of the renders that it was made of
    bool has_other_renders = false;    ///< another comparison has made it of several renders
    std::optional<ImageF> variance{};  ///< variance of each value, R, G and B in the file's colour space, if known
};

/// Reads where the image of `path` comes from, and its variance in `window`, of the full image. Returns nothing of
/// files that do not say a seed, such as those whose channels cannot all be read as floats.
[[nodiscard]] std::optional<ReferenceOrigin> read_reference_origin(const std::filesystem::path& path,
                                                                   const PixelRect& window);

/// Returns the file's name of the render of a variant with `seed`, unlike that of any other of `report`.
[[nodiscard]] std::string render_file_name(const ComparisonReport& report, std::size_t variant, std::uint32_t seed);

/// Writes the last image of every render to `directory`, which is made, in place of those that an earlier comparison
/// has written there.
void write_renders(const std::filesystem::path& directory, const ComparisonReport& report,
                   std::span<const FinishedImages> images, const ColorConfig& colors);

}  // namespace etendue
