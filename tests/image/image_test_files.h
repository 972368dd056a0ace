// Sample images for the tests of reading and writing images.
#pragma once

#include "support/temporary_folder.h"

#include <filesystem>
#include <vector>

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

namespace etendue {

/// Writes `pixels` with OpenImageIO itself, in any format it knows, so that reading is tested against files that our
/// own writer did not make. Returns the path.
template <typename T>
std::filesystem::path write_reference(const std::filesystem::path& path, OIIO::ImageSpec spec,
                                      const std::vector<T>& pixels) {
    spec.attribute("oiio:UnassociatedAlpha", 1);
    const auto output = OIIO::ImageOutput::create(path.string());
    EXPECT_TRUE(output && output->open(path.string(), spec) &&
                output->write_image(OIIO::BaseTypeFromC<T>::value, pixels.data()) && output->close())
        << OIIO::geterror();
    return path;
}

}  // namespace etendue
