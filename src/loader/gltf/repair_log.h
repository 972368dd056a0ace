// Counts what was repaired in a file, so that a million bad vertices make one warning, not a million.
#pragma once

#include "core/error.h"

#include <array>
#include <cstddef>

namespace etendue {

enum class Repair {
    NotTriangles,         ///< primitives of points and lines
    NoPositions,          ///< primitives without a POSITION attribute
    LeftoverIndices,      ///< primitives whose number of indices is not one of whole triangles
    DegenerateTriangles,  ///< triangles
    EmptyPrimitives,      ///< primitives without any triangle that can be seen
    BadNormals,           ///< normals
    BadTangents,          ///< primitives
    BadTexcoords,         ///< texture coordinates
    BadColors,            ///< vertex colours
    MissingTexcoords,     ///< primitives
    EmptyArrays,          ///< arrays of the document
    Undeclared,           ///< objects of extensions
    RequiredNotUsed,      ///< extensions
    MatrixWithParts,      ///< nodes
    RotationNotUnit,      ///< nodes
    WeightsOfNothing,     ///< meshes and nodes
    NoPositionBounds,     ///< primitives
    ClipPlanes,           ///< cameras
    Unaligned,            ///< accessors
    NoMimeType,           ///< images
    RepeatedTargets,      ///< channels of animations
    RepeatedJoints,       ///< joints of skins
    TargetCounts,         ///< primitives, meshes and nodes
    BadPositions,         ///< triangles
    WholeColors,          ///< primitives
    StrideOfZero,         ///< buffer views
    OddStride,            ///< buffer views
    NoCones,              ///< spots
    BadWeights,           ///< weights of joints
    Count
};

class RepairLog {
  public:
    /// `count` more were repaired at `where`.
    void add(Repair repair, std::size_t count, const SourceLocation& where);
    /// Returns whether something of this kind was repaired: the places of others do not matter.
    [[nodiscard]] bool has(Repair repair) const { return entries_[static_cast<std::size_t>(repair)].count > 0; }

    /// One warning for each kind of repair, at the place of the first.
    void report(ProblemList& problems) const;

  private:
    struct Entry {
        std::size_t count = 0;
        SourceLocation first;
    };
    std::array<Entry, static_cast<std::size_t>(Repair::Count)> entries_;
};

}  // namespace etendue
