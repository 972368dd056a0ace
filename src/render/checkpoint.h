// A render kept in a file, for another process or machine to go on with it.
//
// The file, little endian: the eight characters of kMagic, of which the last is the format; the names and values of the
// identity; the description; counts, the brightest contributions and times; the tiles of the pass under way; of an
// adaptive render the samples of each pixel and which pixels the pass under way is for; the sums of the film and, if
// there are any, of the splats, as they lie in memory; the same of every other pass if it is kept; and at the end an
// XXH3 hash, 16 bytes, of all that stands before. 48 bytes a pixel, 72 with splats, and what layers take; twice that
// with every other pass, 5 more if it is adaptive.
#pragma once

#include "core/error.h"
#include "render/progressive_render.h"

#include <filesystem>
#include <map>
#include <string>

namespace etendue {

/// All that the sums of a render depend on, by name: those of two renders can be told apart, and the difference named.
using RenderIdentity = std::map<std::string, std::string>;

/// Lists the differences between `kept` and `wanted`, a line for each name with the value that either has and where;
/// empty if there are none.
[[nodiscard]] std::string difference(const RenderIdentity& kept, const RenderIdentity& wanted,
                                     const std::string& kept_place = "there", const std::string& wanted_place = "here");

struct Checkpoint {
    RenderIdentity identity;
    std::string description;  ///< any text about the image that is no part of its identity
    RenderState state;
};

/// Writes the file whole or not at all. Throws IoError.
void write_checkpoint(const std::filesystem::path& path, const RenderIdentity& identity, const std::string& description,
                      const RenderState& state);

/// Says that a file holds no checkpoint, or not a whole one: reading the file again is of no use.
class DamagedCheckpoint : public IoError {
  public:
    using IoError::IoError;
};

/// A checkpoint or part that is nothing to go on with, and what to do about it: others of the scene's images may be
/// rendered all the same.
class RefusedCheckpoint : public SceneError {
  public:
    using SceneError::SceneError;
};

/// Throws IoError if the file cannot be read, RefusedCheckpoint if it is whole but of another format, DamagedCheckpoint
/// if it is damaged: it is never believed in part. Sizes
/// that its bytes claim are checked before memory is taken for them, and that windows, counts and tiles belong
/// together.
[[nodiscard]] Checkpoint read_checkpoint(const std::filesystem::path& path);

}  // namespace etendue
