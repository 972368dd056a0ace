// The bytes of a file that OpenImageIO is shown. For this room only.
#pragma once

#include "image/shown_pieces.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <OpenImageIO/filesystem.h>

namespace etendue::oiio {

/// Shows pieces of a file as if there were nothing else in it.
class ShownBytes final : public OIIO::Filesystem::IOProxy {
  public:
    ShownBytes(std::unique_ptr<OIIO::Filesystem::IOProxy> whole, std::vector<FilePiece> pieces);

    [[nodiscard]] const char* proxytype() const override { return "etendue"; }
    [[nodiscard]] std::size_t size() const override;
    std::size_t read(void* bytes, std::size_t count) override;
    std::size_t pread(void* bytes, std::size_t count, std::int64_t offset) override;

  private:
    std::unique_ptr<OIIO::Filesystem::IOProxy> whole_;
    std::vector<FilePiece> pieces_;
    std::vector<std::uint64_t> ends_;  ///< of each piece, in what is shown
};

}  // namespace etendue::oiio
