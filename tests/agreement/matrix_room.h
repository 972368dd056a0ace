// Rooms of the matrix, built from their traits.
#pragma once

#include "agreement/room_traits.h"
#include "integrator/agreement_cases.h"

#include <filesystem>

namespace etendue::test {

/// Files of images that rooms share, in a directory of their own that lives as long as this.
class RoomImages {
  public:
    RoomImages();
    ~RoomImages();
    RoomImages(const RoomImages&) = delete;
    RoomImages& operator=(const RoomImages&) = delete;

    [[nodiscard]] std::filesystem::path normals() const { return directory_ / "normals.png"; }
    [[nodiscard]] std::filesystem::path emission() const { return directory_ / "emission.png"; }
    [[nodiscard]] std::filesystem::path environment() const { return directory_ / "environment.exr"; }

    static constexpr int kTextureSize = 16;  ///< pixels, of both sides

  private:
    std::filesystem::path directory_;
};

/// `images` must outlive the case.
[[nodiscard]] AgreementCase make_case(const RoomTraits& room, const RoomImages& images);

}  // namespace etendue::test
