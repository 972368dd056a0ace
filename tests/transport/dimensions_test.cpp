#include "transport/dimensions.h"

#include <cstdint>
#include <set>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// Deeper than nearly all paths.
constexpr int kDepths = 200;

/// Those of the camera, which every path takes. The alpha key has the number of the time, but takes bits.
std::set<std::uint32_t> camera_dimensions() {
    return {kFilmDimension, kLensDimension, kTimeDimension};
}

// Two purposes that shared numbers would be correlated, which no mean of a scene need show.
TEST(PathDimensions, AreEachForOnePurpose) {
    std::set<std::uint32_t> seen = camera_dimensions();
    EXPECT_EQ(seen.size(), 3u);
    for (int depth = 1; depth <= kDepths; ++depth) {
        for (std::uint32_t which = 0; which < kBounceDimensions; ++which)
            EXPECT_TRUE(seen.insert(bounce_dimension(depth, static_cast<BounceDimension>(which))).second)
                << which << " at depth " << depth;
        for (std::uint32_t which = 0; which < kBodyDimensions; ++which)
            EXPECT_TRUE(seen.insert(body_dimension(depth, static_cast<BodyDimension>(which))).second)
                << which << " in bodies at depth " << depth;
    }
}

TEST(SubpathDimensions, AreEachForOnePurpose) {
    std::set<std::uint32_t> seen = camera_dimensions();
    for (const SubpathEnd end : {SubpathEnd::AtEye, SubpathEnd::AtLight})
        for (int bounce = 0; bounce <= kDepths; ++bounce)
            for (std::uint32_t which = 0; which < static_cast<std::uint32_t>(SubpathDimension::Count); ++which)
                EXPECT_TRUE(seen.insert(subpath_dimension(end, bounce, static_cast<SubpathDimension>(which))).second)
                    << which << " at bounce " << bounce;
}

}  // namespace

}  // namespace etendue::test
