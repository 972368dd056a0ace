// One room of the matrix: rendered by all who find its light, and every two of the images compared.
#pragma once

#include "agreement/matrix_room.h"
#include "agreement/room_traits.h"
#include "metrics/block_agreement.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace etendue::test {

struct PairComparison {
    std::string a;
    std::string b;
    BlockAgreement agreement;
};

struct RoomComparison {
    RoomTraits room;
    std::vector<PairComparison> pairs;
    double seconds = 0.0;  ///< of one thread

    [[nodiscard]] bool agrees() const;
};

struct ComparisonOptions {
    double significance = 0.01;  ///< of one pair
    std::uint32_t samples = 1;   ///< multiplies those of every image
    std::string failures;        ///< directory for images that disagree; empty for none
};

/// `index` is the room's in the whole matrix: no two images of it have a seed in common, and a part of the matrix is
/// rendered as in the whole. Uses the calling thread alone. Images that disagree are written to a directory with the
/// room's name; throws IoError if that fails.
[[nodiscard]] RoomComparison compare_in_room(const RoomTraits& room, std::size_t index, const RoomImages& images,
                                             const ComparisonOptions& options);

}  // namespace etendue::test
