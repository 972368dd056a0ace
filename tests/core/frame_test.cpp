#include "core/frame.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {

namespace {

void expect_right_handed(const Frame& f) {
    EXPECT_NEAR(length(f.tangent), 1.0f, 1e-5f);
    EXPECT_NEAR(length(f.bitangent), 1.0f, 1e-5f);
    EXPECT_NEAR(dot(f.tangent, f.bitangent), 0.0f, 1e-5f);
    EXPECT_NEAR(dot(f.tangent, f.normal), 0.0f, 1e-5f);
    EXPECT_NEAR(dot(f.bitangent, f.normal), 0.0f, 1e-5f);
    EXPECT_NEAR(length(cross(f.tangent, f.bitangent) - f.normal), 0.0f, 1e-5f);
}

std::vector<Vec3f> normals() {
    std::vector<Vec3f> list{{0.0f, 0.0f, 1.0f},  {0.0f, 0.0f, -1.0f}, {1.0f, 0.0f, 0.0f},
                            {0.0f, -1.0f, 0.0f}, {0.0f, 0.0f, -0.0f}, {1e-4f, 1e-4f, -1.0f}};
    list[4] = normalize({1.0f, 1.0f, -0.0f});
    for (int i = 0; i < 200; ++i) {
        const float z = std::cos(0.1f * static_cast<float>(i));
        const float phi = 2.4f * static_cast<float>(i);
        const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
        list.push_back({r * std::cos(phi), r * std::sin(phi), z});
    }
    for (Vec3f& n : list) n = normalize(n);
    return list;
}

TEST(Frame, FromNormalIsOrthonormalAndRightHanded) {
    for (const Vec3f& n : normals()) {
        SCOPED_TRACE(testing::Message() << n.x << " " << n.y << " " << n.z);
        const Frame f = Frame::from_normal(n);
        EXPECT_EQ(f.normal, n);
        expect_right_handed(f);
    }
}

TEST(Frame, LocalAndWorldAreInverse) {
    const Vec3f v{0.3f, -0.7f, 2.0f};
    for (const Vec3f& n : normals()) {
        const Frame f = Frame::from_normal(n);
        EXPECT_NEAR(length(f.to_world(f.to_local(v)) - v), 0.0f, 1e-5f);
        EXPECT_NEAR(f.to_local(n).z, 1.0f, 1e-5f);
    }
}

TEST(Frame, KeepsTheTangentsDirection) {
    const Vec3f n = normalize({0.1f, 0.2f, 1.0f});
    const Vec3f t{2.0f, 0.5f, 0.3f};
    const Frame f = Frame::from_normal_and_tangent(n, t);
    expect_right_handed(f);
    EXPECT_GT(dot(f.tangent, t), 0.0f);
    EXPECT_NEAR(dot(f.bitangent, t), 0.0f, 1e-6f) << "the given tangent lies in the plane of tangent and normal";
}

TEST(Frame, AUselessTangentStillGivesAFrame) {
    const Vec3f n = normalize({0.1f, 0.2f, 1.0f});
    expect_right_handed(Frame::from_normal_and_tangent(n, n * 3.0f));
    expect_right_handed(Frame::from_normal_and_tangent(n, Vec3f(0.0f)));
    expect_right_handed(Frame::from_normal_and_tangent(n, Vec3f(std::nanf(""), 0.0f, 0.0f)));
}

}  // namespace

}  // namespace etendue
