// Draco's decoder, held to a bound on its memory.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include <draco/mesh/mesh.h>

namespace etendue {

/// Says whether a decoder may take so many bytes of memory, all in all. It is asked before they are taken.
using MayTake = std::function<bool(std::uint64_t bytes)>;

/// Decodes the mesh that `bytes` hold. Draco believes the counts in a header, and a few bytes may stand for millions of
/// faces. Returns null if `may_take` denies what the mesh needs. Throws IoError if the bytes hold no mesh.
[[nodiscard]] std::unique_ptr<draco::Mesh> decode_draco_mesh(std::span<const unsigned char> bytes,
                                                             const MayTake& may_take);

}  // namespace etendue
