#include "color/built_in_config.h"

#include <fstream>
#include <sstream>
#include <string>

#include <OpenColorIO/OpenColorIO.h>
#include <gtest/gtest.h>

namespace etendue {

namespace {

TEST(BuiltInConfig, IsTheFileInTheTree) {
    std::ifstream file(ETENDUE_SOURCE_DIR "/third_party_config/ocio/config.ocio");
    std::stringstream text;
    text << file.rdbuf();
    EXPECT_EQ(built_in_config_text(), text.str());
}

TEST(BuiltInConfig, Validates) {
    std::istringstream stream{std::string(built_in_config_text())};
    const auto config = OCIO_NAMESPACE::Config::CreateFromStream(stream);
    EXPECT_NO_THROW(config->validate());
    // Every space and every view compiles, which validate() does not try.
    for (int i = 0; i < config->getNumColorSpaces(); ++i) {
        EXPECT_NO_THROW(
            (void)config->getProcessor(config->getColorSpaceNameByIndex(i), "scene_linear")->getDefaultCPUProcessor())
            << config->getColorSpaceNameByIndex(i);
    }
}

}  // namespace

}  // namespace etendue
