#include "scene/scene_desc.h"
#include "scene/small_scene.h"

#include <functional>
#include <limits>

#include <gtest/gtest.h>

namespace etendue {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

TEST(Validate, AcceptsAGoodScene) {
    const ProblemList problems = validate(small_scene());
    EXPECT_EQ(problems.error_count(), 0u) << (problems.all().empty() ? "" : problems.all()[0].str());
}

TEST(Validate, AcceptsAnEmptyScene) {
    EXPECT_FALSE(validate(SceneDesc{}).has_errors());
}

struct Defect {
    const char* name;
    const char* expected;  ///< part of the message
    std::function<void(SceneDesc&)> make;
};

class ValidateDefect : public testing::TestWithParam<Defect> {};

TEST_P(ValidateDefect, IsReportedOnce) {
    SceneDesc scene = small_scene();
    GetParam().make(scene);
    const ProblemList problems = validate(scene);
    ASSERT_EQ(problems.error_count(), 1u) << problems.all().size();
    EXPECT_NE(problems.all()[0].message.find(GetParam().expected), std::string::npos) << problems.all()[0].message;
}

PrimitiveDesc& primitive(SceneDesc& s) {
    return s.meshes[0].primitives[0];
}

/// A profile that is good, for the scene's spot light.
IesProfileDesc& add_profile(SceneDesc& s) {
    s.lights[0].profile.index = 0;
    return s.ies_profiles.emplace_back(IesProfileDesc{"lamp", {0, 1}, {0, 1, 2 * kPi}, {1, 2, 3, 4, 5, 6}, {}});
}

TEST(Validate, AcceptsTheMostAnisotropicMedium) {
    SceneDesc scene = small_scene();
    scene.materials[0].volume.scatter_anisotropy = -kMostAnisotropic;
    EXPECT_FALSE(validate(scene).has_errors());
}

TEST(Validate, AcceptsLightsWithAProfile) {
    SceneDesc scene = small_scene();
    add_profile(scene);
    EXPECT_FALSE(validate(scene).has_errors());
}

const Defect kDefects[] = {
    {"OriginNan", "origin is not finite", [](SceneDesc& s) { s.origin.y = static_cast<double>(kNan); }},
    {"NodeMissing", "node 3 does not exist", [](SceneDesc& s) { s.instances[0].node = 3; }},
    {"NodeBeforeItsParent", "node 0 stands before its parent",
     [](SceneDesc& s) {
         s.nodes = {{"a", 1, 0}, {"b", NodeDesc::kNone, 1}};
     }},
    {"ProfileMissing", "IES profile 3 does not exist", [](SceneDesc& s) { s.lights[0].profile.index = 3; }},
    {"ProfileOfTheSun", "directional light has no position",
     [](SceneDesc& s) {
         add_profile(s);
         s.lights[0].type = LightType::Directional;
     }},
    {"ProfileShort", "5 values for 2 x 3", [](SceneDesc& s) { add_profile(s).candela.pop_back(); }},
    {"ProfileNegative", "negative or not finite", [](SceneDesc& s) { add_profile(s).candela[4] = -1; }},
    {"ProfileNan", "negative or not finite", [](SceneDesc& s) { add_profile(s).candela[4] = kNan; }},
    {"ProfileOpen", "do not ascend", [](SceneDesc& s) { add_profile(s).horizontal[2] = 6; }},
    {"ProfileRepeated", "do not ascend", [](SceneDesc& s) { add_profile(s).horizontal[1] = 0; }},
    {"ProfileBeyondTheZenith", "do not ascend", [](SceneDesc& s) { add_profile(s).vertical[1] = 3.2f; }},
    {"ProfileAngleNan", "do not ascend", [](SceneDesc& s) { add_profile(s).vertical[0] = kNan; }},
    {"CubeWithoutFaces", "image -1 does not exist",
     [](SceneDesc& s) {
         s.environment.cube.emplace();
         for (std::size_t face = 1; face < 6; ++face) s.environment.cube->faces[face].index = 0;
     }},
    {"ImageWithoutSource", "either a file or bytes", [](SceneDesc& s) { s.images[0].path.clear(); }},
    {"ImageWithTwoSources", "either a file or bytes", [](SceneDesc& s) { s.images[0].encoded.resize(4); }},
    {"ImageWithoutSize", "0 x 2", [](SceneDesc& s) { s.images[0].width = 0; }},
    {"TextureWithoutImage", "image -1 does not exist", [](SceneDesc& s) { s.textures[0].image = {}; }},
    {"TextureBeyondImages", "image 1 does not exist", [](SceneDesc& s) { s.textures[0].image.index = 1; }},
    {"MaterialBeyondTextures", "texture of base colour, 7",
     [](SceneDesc& s) { s.materials[0].base_color_texture.texture.index = 7; }},
    {"TexcoordTwo", "only 0 and 1", [](SceneDesc& s) { s.materials[0].base_color_texture.texcoord = 2; }},
    {"TextureTransformNan", "not finite",
     [](SceneDesc& s) { s.materials[0].base_color_texture.transform.scale.y = kNan; }},
    {"BaseColorAboveOne", "base colour is 2", [](SceneDesc& s) { s.materials[0].base_color.g = 2; }},
    {"BaseColorNan", "base colour", [](SceneDesc& s) { s.materials[0].base_color.b = kNan; }},
    {"NegativeRoughness", "roughness", [](SceneDesc& s) { s.materials[0].roughness = -0.1f; }},
    {"InfiniteStrength", "emissive strength", [](SceneDesc& s) { s.materials[0].emissive_strength = kInf; }},
    {"IorBelowOne", "ior", [](SceneDesc& s) { s.materials[0].ior = 0.5f; }},
    {"AnisotropyOne", "scatter anisotropy is 1, but must be in [-0.999, 0.999]",
     [](SceneDesc& s) { s.materials[0].volume.scatter_anisotropy = 1.0f; }},
    {"UnknownMetal", "unknown metal 'Xx'",
     [](SceneDesc& s) {
         s.materials[0].override_model = ConductorDesc{"Xx", 0.0f};
     }},
    {"DielectricIorBelowOne", "[1, 3]",
     [](SceneDesc& s) {
         s.materials[0].override_model = DielectricDesc{0.9f, 0.0f};
     }},
    {"AlbedoAboveOne", "albedo", [](SceneDesc& s) { s.materials[0].override_model = DiffuseDesc{Rgb(1.5f)}; }},
    {"PositionInfinite", "positions 1", [](SceneDesc& s) { primitive(s).positions[1].x = kInf; }},
    {"NormalsMissing", "2 normals for 3", [](SceneDesc& s) { primitive(s).normals.pop_back(); }},
    {"NormalNotUnit", "normals 2",
     [](SceneDesc& s) {
         primitive(s).normals[2] = {0, 0, 2};
     }},
    {"TangentSign", "tangents 0", [](SceneDesc& s) { primitive(s).tangents[0].w = 0; }},
    {"UvCount", "2 texture coordinates 0", [](SceneDesc& s) { primitive(s).uv0.pop_back(); }},
    {"UvNan", "texture coordinates 1 0", [](SceneDesc& s) { primitive(s).uv1[0].y = kNan; }},
    {"ColorNegative", "vertex colours 1", [](SceneDesc& s) { primitive(s).colors[1].w = -1; }},
    {"IndexOutOfRange", "(0, 3, 2)", [](SceneDesc& s) { primitive(s).triangles[0][1] = 3; }},
    {"NoTriangles", "without triangles", [](SceneDesc& s) { primitive(s).triangles.clear(); }},
    {"NoMaterial", "material -1", [](SceneDesc& s) { primitive(s).material = {}; }},
    {"InstanceOfNothing", "mesh 3", [](SceneDesc& s) { s.instances[0].mesh.index = 3; }},
    {"InstanceSingular", "singular", [](SceneDesc& s) { s.instances[0].to_world[2][2] = 0; }},
    {"InstanceNan", "singular", [](SceneDesc& s) { s.instances[0].to_world[3][0] = kNan; }},
    {"YfovPi", "yfov", [](SceneDesc& s) { s.cameras[0].yfov = kPi; }},
    {"YmagZero", "ymag",
     [](SceneDesc& s) {
         s.cameras[0].type = CameraType::Orthographic;
         s.cameras[0].ymag = 0;
     }},
    {"FocusZero", "focus distance", [](SceneDesc& s) { s.cameras[0].focus_distance = 0; }},
    {"LightNegative", "light intensity", [](SceneDesc& s) { s.lights[0].intensity = -1; }},
    {"SpotConesSwapped", "cone", [](SceneDesc& s) { s.lights[0].inner_cone_angle = 1; }},
    {"EnvironmentScale", "environment scale", [](SceneDesc& s) { s.environment.scale = kNan; }},
    {"EnvironmentInfinite", "colour times its scale is infinite",
     [](SceneDesc& s) {
         s.environment.color = Rgb(3e38f);
         s.environment.scale = 3e38f;
     }},
    {"UnknownCamera", "did you mean 'main'", [](SceneDesc& s) { s.settings.camera = "mian"; }},
    {"SppZero", "spp", [](SceneDesc& s) { s.settings.spp = 0; }},
    {"WidthHuge", "size is [65537", [](SceneDesc& s) { s.settings.film.width = 65537; }},
    {"CropOutside", "crop",
     [](SceneDesc& s) {
         s.settings.film.crop = {{0, 0, 2100, 10}};
     }},
    {"CropEmpty", "crop",
     [](SceneDesc& s) {
         s.settings.film.crop = {{10, 0, 10, 10}};
     }},
    {"MeshFar", "the mesh reaches 2e+15 m", [](SceneDesc& s) { s.instances[0].to_world[3][1] = -2e15f; }},
    {"VertexFar", "the mesh reaches", [](SceneDesc& s) { primitive(s).positions[2].z = 1e38f; }},
    {"VertexMovesFar", "the mesh reaches",
     [](SceneDesc& s) {
         primitive(s).motion.resize(2, {primitive(s).positions, primitive(s).normals});
         primitive(s).motion[1].positions[0].x = 1e17f;
     }},
    {"MeshMovesFar", "the mesh reaches",
     [](SceneDesc& s) {
         s.instances[0].motion.resize(2);
         s.instances[0].motion[1][3][2] = 1e20f;
     }},
    {"MeshTiny", "shrinks the mesh so much",
     [](SceneDesc& s) {
         s.instances[0].to_world[0][0] = 1e-9f;
         s.lights[0].to_world[3][0] = 1e12f;
     }},
    {"CameraFar", "the camera's view reaches", [](SceneDesc& s) { s.cameras[0].to_world[3][2] = 2e18f; }},
    {"OrthographicHuge", "the camera's view reaches",
     [](SceneDesc& s) {
         s.cameras[0].type = CameraType::Orthographic;
         s.cameras[0].ymag = 1e30f;
     }},
    {"FocusFar", "the camera's focus reaches",
     [](SceneDesc& s) {
         s.cameras[0].lens_radius = 0.01f;
         s.cameras[0].focus_distance = 1e30f;
     }},
    {"FovZero", "fov is 0",
     [](SceneDesc& s) {
         s.cameras[0].type = CameraType::Fisheye;
         s.cameras[0].fov = 0.0f;
     }},
    {"PanoramaShifted", "has no shift",
     [](SceneDesc& s) {
         s.cameras[0].type = CameraType::Equirectangular;
         s.cameras[0].shift.x = 0.1f;
     }},
    {"OverscanFraction", "a whole number of pixels", [](SceneDesc& s) { s.settings.film.overscan = 2.5f; }},
    {"OverscanLarge", "more than the image", [](SceneDesc& s) { s.settings.film.overscan = 60000.0f; }},
    {"ShiftFar", "shift is 101", [](SceneDesc& s) { s.cameras[0].shift.y = 101.0f; }},
    {"ClipEmpty", "the clipping is from 2 to 2",
     [](SceneDesc& s) {
         s.cameras[0].clip = {2.0f, 2.0f};
     }},
    {"ClipFar", "the camera's clipping reaches", [](SceneDesc& s) { s.cameras[0].clip.start = 1e30f; }},
    {"TwoBlades", "blades is 2", [](SceneDesc& s) { s.cameras[0].aperture.blades = 2; }},
    {"NoAperture", "aperture ratio", [](SceneDesc& s) { s.cameras[0].aperture.ratio = 0.0f; }},
    {"PixelAspectZero", "pixel_aspect", [](SceneDesc& s) { s.settings.film.pixel_aspect = 0.0f; }},
    {"LightFar", "the light reaches", [](SceneDesc& s) { s.lights[0].to_world[3][0] = 1e19f; }},
    {"LightSamplesMany", "light_samples", [](SceneDesc& s) { s.settings.integrator.light_samples = 65; }},
    {"DepthsSwapped", "min_depth", [](SceneDesc& s) { s.settings.integrator.lengths.min_depth = 99; }},
    {"StrategyHitsTheLens", "strategy 3,0",
     [](SceneDesc& s) {
         s.settings.integrator.strategy = {{3, 0}};
     }},
    {"StrategyWithoutEdges", "strategy 0,1",
     [](SceneDesc& s) {
         s.settings.integrator.strategy = {{0, 1}};
     }},
    {"UnweightedSum", "without weights", [](SceneDesc& s) { s.settings.integrator.weighted = false; }},
};

INSTANTIATE_TEST_SUITE_P(All, ValidateDefect, testing::ValuesIn(kDefects),
                         [](const auto& param_info) { return std::string(param_info.param.name); });

TEST(Validate, ReportsEveryProblem) {
    SceneDesc scene = small_scene();
    for (const Defect& defect : kDefects) {
        if (std::string(defect.name).find("Ior") != std::string::npos) defect.make(scene);
        if (std::string(defect.name).find("Spp") != std::string::npos) defect.make(scene);
        if (std::string(defect.name).find("Yfov") != std::string::npos) defect.make(scene);
    }
    EXPECT_EQ(validate(scene).error_count(), 4u);
}

}  // namespace
}  // namespace etendue
