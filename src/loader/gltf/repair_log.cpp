#include "loader/gltf/repair_log.h"

#include <string_view>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr std::array<std::string_view, static_cast<std::size_t>(Repair::Count)> kMessages{
    "primitives of points or lines are skipped, only triangles are rendered",
    "primitives without positions are skipped",
    "indices left over after a primitive's last triangle are ignored",
    "degenerate triangles are removed",
    "primitives without any triangle are skipped",
    "normals that are zero or not finite are computed from the triangles instead",
    "tangents are ignored for primitives where some are zero or not finite",
    "texture coordinates that are not finite are set to 0",
    "vertex colours that are negative or not finite are set to 0 or 1",
    "texture coordinates that a material needs are missing from its primitive; (0, 0) is used",
    "empty arrays, which glTF does not allow, are taken for absent ones",
    "extensions that extensionsUsed does not declare; those that are supported are read all the same",
    "required extensions are missing from extensionsUsed",
    "nodes have a matrix and a translation, rotation or scale as well; the matrix counts",
    "rotations that are not of unit length are normalised",
    "weights of meshes without morph targets are ignored",
    "positions have no min and max, which glTF asks for; they are not needed here",
    "cameras have a far plane that is not beyond the near one; nothing is clipped here",
    "accessors do not lie at multiples of their components' size, or of 4 for vertices; they are read all the same",
    "images in buffers have no mimeType; their bytes say what they are",
    "channels of one animation have the same target; the last of them counts",
    "joints are listed more than once in a skin; each of them moves its vertices",
    "morph targets of a mesh, or weights of them, differ in number; those without a counterpart are ignored",
    "triangles with a vertex whose position is not finite are removed",
    "vertex colours are integers that are not marked as normalised; they are read as if they were",
    "buffer views have a stride of 0; their elements are taken to lie side by side",
    "buffer views have a stride that is no multiple of 4 up to 252; they are read all the same",
    "spots do not describe their cones; the angles 0 and pi/4 are taken",
    "weights of joints that are negative or not finite are set to 0",
};

}  // namespace

void RepairLog::add(Repair repair, std::size_t count, const SourceLocation& where) {
    if (count == 0) return;
    Entry& entry = entries_[static_cast<std::size_t>(repair)];
    if (entry.count == 0) entry.first = where;
    entry.count += count;
}

void RepairLog::report(ProblemList& problems) const {
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        if (entries_[i].count == 0) continue;
        const std::string count = entries_[i].count == 1 ? "once" : fmt::format("{} times", entries_[i].count);
        problems.warning(entries_[i].first, fmt::format("{} ({} in this file, first here)", kMessages[i], count));
    }
}

}  // namespace etendue
