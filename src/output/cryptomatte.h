// What Cryptomatte files say of names: ids, manifests and metadata (J. Friedman, A. C. Jones, "Cryptomatte
// Specification", Psyop, github.com/Psyop/Cryptomatte).
#pragma once

#include "image/write.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// The bits of the float that stands for `name` in pixels: its MurmurHash3, whose exponent is brought into [1, 254], so
/// that it is neither zero or denormal nor infinite or NaN.
[[nodiscard]] std::uint32_t matte_id(std::string_view name);

/// Returns the key under which a file has the metadata of the matte `layer`: seven hexadecimal digits.
[[nodiscard]] std::string matte_key(std::string_view layer);

/// JSON: the ids of names, eight hexadecimal digits each, every name once and in the order of the alphabet.
[[nodiscard]] std::string matte_manifest(std::span<const std::string> names);

/// Returns names as a JSON list, the first of which is that of the id 1 where ids are numbers.
[[nodiscard]] std::string id_names(std::span<const std::string> names);

/// Names of a list that have the same id.
struct MatteCollision {
    std::string first;
    std::string second;
};
[[nodiscard]] std::vector<MatteCollision> matte_collisions(std::span<const std::string> names);

/// The metadata of a file or part that has the channels of this matte; `manifest` may be empty.
[[nodiscard]] std::vector<ImageAttribute> matte_attributes(const std::string& layer, const std::string& manifest);

/// Names the channel `index` of the matte `layer`, with two ranks in each of its layers: "NAME00.R" is the id of the
/// first rank, G the first's coverage, B and A those of the second rank, and "NAME01" has the third and fourth.
[[nodiscard]] std::string matte_channel(std::string_view layer, std::size_t index);

}  // namespace etendue
