#include "integrator/agreement_cases.h"

#include "integrator/agreement_room.h"
#include "world/test_scene.h"

#include <stdexcept>
#include <utility>

namespace etendue::test {

namespace {

std::function<void(SceneDesc&)> under_lamp(const MaterialDesc& material) {
    return [=](SceneDesc& scene) {
        add_ball(scene, material);
        add_lamp(scene);
    };
}

std::function<void(SceneDesc&)> under(const LightDesc& desc, const MaterialDesc& material = gltf_plastic()) {
    return [=](SceneDesc& scene) {
        add_ball(scene, material);
        scene.lights.push_back(desc);
    };
}

/// A room under a lamp that shines into a cone.
void under_panel(SceneDesc& scene) {
    add_ball(scene, gltf_plastic());
    MaterialDesc lamp = emissive(Rgb(12.0f));
    lamp.beam = {.kind = BeamDesc::Kind::Panel, .spread = 1.2f};
    add_object(scene, quad({0.1f, 1.3f, -2.8f}, {0.3f, 0, 0}, {0, 0, 0.3f}), add_material(scene, lamp));
}

/// A room with a lamp and a card in view, neither of which the camera sees.
void under_hidden_lamp(SceneDesc& scene) {
    add_ball(scene, gltf_plastic());
    MaterialDesc lamp = emissive(Rgb(4.0f));
    lamp.double_sided = true;
    lamp.visible_to_camera = false;
    add_object(scene, quad({0.45f, 0.2f, -2.2f}, {0.25f, 0, 0.1f}, {0, 0.25f, 0.05f}), add_material(scene, lamp));
    MaterialDesc card = gltf_plastic();
    card.visible_to_camera = false;
    add_object(scene, quad({0.1f, -0.3f, -2.3f}, {0.3f, 0, 0.1f}, {0, 0.1f, -0.2f}), add_material(scene, card));
}

/// A room under a lamp that turns while it passes, and a spot that flies the other way.
void under_moving_lamps(SceneDesc& scene) {
    add_ball(scene, gltf_plastic());
    MaterialDesc lamp = emissive(Rgb(12.0f));
    lamp.beam = {.kind = BeamDesc::Kind::Panel, .spread = 2.0f};
    add_object(scene, quad({0, 0, 0}, {0.25f, 0, 0}, {0, 0, 0.25f}), add_material(scene, lamp));
    LightDesc spot;
    spot.type = LightType::Spot;
    spot.intensity = 1.5f;
    spot.inner_cone_angle = 0.3f;
    spot.outer_cone_angle = 0.7f;
    constexpr int kSteps = 33;
    for (int i = 0; i < kSteps; ++i) {
        const float t = static_cast<float>(i) / (kSteps - 1);
        Mat4f leaning;
        leaning.setEulerAngles(Vec3f(0.0f, 0.0f, 1.2f * t - 0.6f));
        scene.instances.back().motion.push_back(leaning * translation({1.0f * t - 0.5f, 1.2f, -2.8f}));
        Mat4f aimed;
        aimed.setEulerAngles(Vec3f(0.4f - 0.8f * t, 0.3f, 0.0f));
        spot.motion.push_back(aimed * translation({0.5f - 1.0f * t, 0.2f, -1.2f}));
    }
    scene.instances.back().to_world = scene.instances.back().motion[kSteps / 2];
    spot.to_world = spot.motion[kSteps / 2];
    scene.lights.push_back(spot);
}

/// A room with exact shapes of all kinds, three of which are lamps, one of them within reach of the wall.
void under_shapes(SceneDesc& scene) {
    const auto ball = add_material(scene, gltf_plastic());
    add_object(scene, exact(ShapeKind::Sphere, Vec3f(0.4f)), ball, translation({0.2f, -0.25f, -3.0f}));
    add_object(scene, exact(ShapeKind::Cylinder, {0.15f, 0.3f, 0.15f}), add_material(scene, glass(0.6f)),
               translation({-0.7f, -0.3f, -3.1f}));
    MaterialDesc both_sides = emissive(Rgb(4.0f));
    both_sides.double_sided = true;
    Mat4f leaning;
    leaning.setEulerAngles(Vec3f(0.9f, 0.3f, 0.0f));
    add_object(scene, exact(ShapeKind::Sphere, Vec3f(0.2f)), add_material(scene, emissive(Rgb(8.0f))),
               translation({0.7f, 0.5f, -4.15f}));
    add_object(scene, exact(ShapeKind::Disk, Vec3f(0.25f)), add_material(scene, both_sides),
               leaning * translation({-0.5f, 0.7f, -3.0f}));
    add_object(scene, exact(ShapeKind::Cylinder, {0.05f, 0.3f, 0.05f}), add_material(scene, emissive(Rgb(12.0f))),
               leaning * translation({0.1f, 0.9f, -2.8f}));
}

/// Surfaces whose backs are culled in a room, facing both ways, two of them in one place.
void add_culled(SceneDesc& scene) {
    scene.settings.cull_backfaces = true;
    MaterialDesc leaf = gltf_plastic();
    leaf.diffuse_transmission.factor = 0.6f;
    MaterialDesc sheet = gltf_plastic();
    sheet.transmission = 0.8f;
    sheet.roughness = 0.6f;
    MaterialDesc veil = diffuse({0.3f, 0.6f, 0.3f});
    veil.alpha_mode = AlphaMode::Blend;
    veil.base_alpha = 0.5f;
    const auto wall = add_material(scene, diffuse({0.7f, 0.7f, 0.3f}));
    const auto other = add_material(scene, gltf_plastic());
    add_object(scene, quad({0.4f, 0.5f, -2.9f}, {0.5f, 0, 0}, {0, 0, -0.4f}), wall);
    add_object(scene, quad({-0.1f, -0.2f, -1.9f}, {0, 0.5f, 0}, {0.5f, 0, 0}), other);
    add_object(scene, quad({0.6f, 0.1f, -2.4f}, {0.25f, 0, 0.1f}, {0, 0.3f, 0}), add_material(scene, leaf));
    add_object(scene, quad({-0.6f, -0.1f, -2.7f}, {0, 0.3f, 0}, {0.25f, 0, 0.1f}), add_material(scene, sheet));
    add_object(scene, quad({0.1f, 0.3f, -2.5f}, {0, 0.2f, 0}, {0.2f, 0, 0}), add_material(scene, veil));
    add_object(scene, quad({0.9f, -0.2f, -3.3f}, {0, 0.4f, 0}, {0, 0, 0.4f}), wall);
    add_object(scene, quad({0.9f, -0.2f, -3.3f}, {0, 0, 0.4f}, {0, 0.4f, 0}), other);
}

std::vector<AgreementCase> all_cases() {
    MaterialDesc wax;
    wax.override_model = SubsurfaceDesc{.albedo = {0.8f, 0.6f, 0.4f}, .radius = Rgb(0.03f)};  // dense
    MaterialDesc coated = gltf_plastic();
    coated.clearcoat.factor = 1.0f;
    coated.clearcoat.roughness = 0.3f;
    coated.sheen.color = Rgb(0.4f);
    coated.sheen.roughness = 0.5f;
    MaterialDesc sheet = gltf_plastic();
    sheet.transmission = 0.8f;
    sheet.roughness = 0.6f;
    MaterialDesc leaf = gltf_plastic();
    leaf.diffuse_transmission.factor = 0.6f;
    MaterialDesc veil = diffuse({0.3f, 0.6f, 0.3f});
    veil.alpha_mode = AlphaMode::Blend;
    veil.base_alpha = 0.5f;
    std::vector<AgreementCase> cases{
        {"LampDiffuse", under_lamp(diffuse(Rgb(0.7f)))},
        {"LampPlastic", under_lamp(gltf_plastic())},
        {"LampConductor", under_lamp(conductor(0.6f))},
        {"LampRoughGlass", under_lamp(glass(0.6f))},
        {"LampAmber", under_lamp(glass(0.6f, 0.0f, {0.9f, 0.5f, 0.1f}))},
        {"LampPrism", under_lamp(glass(0.6f, 4.0f))},
        {"LampLayers", under_lamp(coated)},
        {"LampWax", under_lamp(wax), {.max_depth = 4}},
        {"PointPlastic", under(point_light())},
        {"SpotConductor", under(spot_light(), conductor(0.6f))},
        {"SunRoughGlass", under(sun_light(), glass(0.6f))},
        {"WideSunPlastic",
         [](SceneDesc& scene) {
             add_ball(scene, gltf_plastic());
             scene.lights.push_back(sun_light());
             scene.lights.back().angle = 0.3f;
         },
         {.max_depth = 4},
         {0, 0, kAgreementWidth, kAgreementHeight},
         16,
         {"path", "light", "bdpt", "vcm"}},
        {"Panel", under_panel, {.max_depth = 6}, {0, 0, kAgreementWidth, kAgreementHeight}, 16},
        {"HiddenLamp",
         under_hidden_lamp,
         {.max_depth = 6},
         {0, 0, kAgreementWidth, kAgreementHeight},
         16,
         {"path", "light", "bdpt", "vcm"}},
    };
    cases.push_back(
        {"TwoSidedLamp", [](SceneDesc& scene) {
             add_ball(scene, gltf_plastic());
             add_lamp(scene, true);
             add_object(scene, quad({0, 1.7f, -3}, {1, 0, 0}, {0, 0, 1}), add_material(scene, diffuse(Rgb(0.8f))));
         }});
    cases.push_back({"Environment", [](SceneDesc& scene) {
                         add_ball(scene, gltf_plastic());
                         add_environment(scene);
                     }});
    cases.push_back(
        {"SheetAndLeaf", [=](SceneDesc& scene) {
             add_object(scene, quad({0.3f, 0, -2.6f}, {0.5f, 0, 0.2f}, {0, 0.5f, 0}), add_material(scene, sheet));
             add_object(scene, quad({-0.6f, 0, -2.9f}, {0.4f, 0, 0}, {0, 0.4f, 0.2f}), add_material(scene, leaf));
             scene.lights.push_back(point_light());
         }});
    cases.push_back(
        {"VeilMirroredThinLens", [=](SceneDesc& scene) {
             add_object(scene, quad({0.2f, 0.1f, -2.0f}, {0.4f, 0, 0}, {0, 0.4f, 0}), add_material(scene, veil));
             PrimitiveDesc ball = sphere(Vec3f(0.0f), 0.4f, 12);
             ball.material = add_material(scene, gltf_plastic());
             const auto shared = add_mesh(scene, {ball});
             place(scene, shared, scaling({-1.2f, 0.7f, 1.0f}) * translation({0.3f, -0.3f, -3}));
             place(scene, shared, scaling(Vec3f(0.4f)) * translation({-0.6f, -0.5f, -2.8f}));
             add_lamp(scene);
             scene.cameras[0].lens_radius = 0.08f;
             scene.cameras[0].focus_distance = 3.0f;
         }});
    // One refraction on the way: its squared index is in radiance and not in importance.
    cases.push_back(
        {"LampInRoughGlass", [](SceneDesc& scene) {
             add_ball(scene, glass(0.6f));
             MaterialDesc lamp = emissive(Rgb(20.0f));
             lamp.double_sided = true;
             add_object(scene, quad({0.2f, -0.25f, -3.0f}, {0.12f, 0, 0}, {0, 0.1f, 0.05f}), add_material(scene, lamp));
         }});
    // Normals that are far from those of the triangles: the adjoint's factor is large.
    cases.push_back(
        {"CoarseSmoothNormals", [](SceneDesc& scene) {
             add_object(scene, sphere({0.1f, -0.2f, -2.8f}, 0.5f, 4), add_material(scene, diffuse(Rgb(0.8f))));
             add_lamp(scene);
         }});
    cases.push_back({"CoarseSmoothPlastic", [](SceneDesc& scene) {
                         add_object(scene, sphere({0.1f, -0.2f, -2.8f}, 0.5f, 4), add_material(scene, gltf_plastic()));
                         add_lamp(scene);
                     }});
    cases.push_back({"Orthographic", [](SceneDesc& scene) {
                         add_ball(scene, gltf_plastic());
                         add_lamp(scene);
                         scene.cameras[0].type = CameraType::Orthographic;
                         scene.cameras[0].ymag = 1.2f;
                     }});
    // Something before the lens whose blur light paths must find in the crop, as eye paths do.
    cases.push_back({"OutOfFocusBeforeLensCrop",
                     [](SceneDesc& scene) {
                         add_ball(scene, gltf_plastic());
                         add_lamp(scene);
                         add_object(scene, quad({0.05f, -0.08f, -0.8f}, {0.1f, 0.02f, 0}, {0, 0.05f, 0.02f}),
                                    add_material(scene, diffuse({0.8f, 0.7f, 0.2f})));
                         scene.cameras[0].lens_radius = 0.1f;
                         scene.cameras[0].focus_distance = 3.0f;
                     },
                     {.max_depth = 6},
                     {11, 13, 57, 45},
                     128});
    // The occluder before the near plane, most of the wall and of the floor beyond the far one.
    const auto clipped = [](SceneDesc& scene) {
        scene.settings.film.pixel_aspect = 1.3f;
        CameraDesc& camera = scene.cameras[0];
        camera.shift = {0.1f, -0.05f};
        camera.clip = {2.3f, 3.4f};
        camera.lens_radius = 0.08f;
        camera.focus_distance = 2.6f;
        camera.aperture = {.blades = 5, .rotation = 0.4f, .ratio = 1.5f};
    };
    const PixelRect all{0, 0, kAgreementWidth, kAgreementHeight};
    cases.push_back({"ShiftedClippedBlades",
                     [=](SceneDesc& scene) {
                         add_ball(scene, gltf_plastic());
                         add_lamp(scene);
                         clipped(scene);
                     },
                     {.max_depth = 3},
                     all,
                     24});
    cases.push_back({"Equirectangular",
                     [](SceneDesc& scene) {
                         add_ball(scene, gltf_plastic());
                         add_lamp(scene);
                         scene.cameras[0].type = CameraType::Equirectangular;
                     },
                     {.max_depth = 3},
                     all,
                     24});
    cases.push_back({"FisheyeBeyondItsCircle",
                     [](SceneDesc& scene) {
                         add_ball(scene, gltf_plastic());
                         add_lamp(scene);
                         scene.cameras[0].type = CameraType::Fisheye;
                         scene.cameras[0].fov = 1.5f;
                         scene.cameras[0].shift = {0.1f, 0.05f};
                     },
                     {.max_depth = 3},
                     all,
                     24,
                     {"path", "light"}});
    // The caustic on the floor and the shadow around it; the glass itself, which light paths cannot show, is outside.
    cases.push_back({"CausticCrop", under_lamp(glass(0.0f)), {.max_depth = 6}, {28, 38, 60, 48}, 512});
    // What the eye sees in mirrors and through smooth glass, which light tracing cannot.
    const std::vector<std::string> bdpt{"path", "bdpt"};
    cases.push_back({"Mirror", under_lamp(conductor(0.0f)), {.max_depth = 6}, all, 64, bdpt});
    cases.push_back({"SmoothGlass", under_lamp(glass(0.0f)), {.max_depth = 6}, all, 128, bdpt});
    cases.push_back({"NearlySmoothGlass", under_lamp(glass(0.2f)), {.max_depth = 6}, all, 128, bdpt});
    MaterialDesc varnished = gltf_plastic();
    varnished.clearcoat.factor = 1.0f;
    cases.push_back({"SmoothCoat", under_lamp(varnished), {.max_depth = 6}, all, 64, bdpt});
    MaterialDesc pane = gltf_plastic();
    pane.transmission = 0.8f;
    pane.roughness = 0.0f;
    cases.push_back({"SmoothPane", under_lamp(pane), {.max_depth = 6}, all, 128, bdpt});
    // Light passes panes on the way to what is sampled, to what is met, and between subpaths.
    const auto behind_panes = [=](SceneDesc& scene) {
        MaterialDesc tinted = pane;
        tinted.base_color = {0.9f, 0.6f, 0.4f};
        tinted.alpha_mode = AlphaMode::Blend;
        tinted.base_alpha = 0.7f;
        add_ball(scene, gltf_plastic());
        add_lamp(scene);
        add_object(scene, quad({0.2f, 0.5f, -2.9f}, {0.6f, 0.1f, 0}, {0.1f, 0, 0.6f}), add_material(scene, tinted));
        add_object(scene, quad({-0.2f, -0.1f, -2.2f}, {0.3f, 0, 0.1f}, {0, 0.5f, 0}), add_material(scene, pane));
    };
    cases.push_back({"BehindPanes", behind_panes, {.max_depth = 6}, all, 128, bdpt});
    cases.push_back(
        {"HiddenLampBehindPane",
         [=](SceneDesc& scene) {
             under_hidden_lamp(scene);
             add_object(scene, quad({0.33f, 0.15f, -1.6f}, {0.3f, 0, 0.1f}, {0, 0.3f, 0}), add_material(scene, pane));
         },
         {.max_depth = 6},
         all,
         16,
         bdpt});
    cases.push_back({"ClippedBehindPanes",
                     [=](SceneDesc& scene) {
                         behind_panes(scene);
                         clipped(scene);
                         scene.cameras[0].clip.start = 1.0f;
                     },
                     {.max_depth = 3},
                     all,
                     24,
                     bdpt});
    // Of a point, path finds no light that panes reflect.
    cases.push_back({"BehindPanesOneBounce",
                     [=](SceneDesc& scene) {
                         behind_panes(scene);
                         scene.lights.push_back(point_light());
                     },
                     {.max_depth = 2},
                     all,
                     64,
                     bdpt});
    cases.push_back({"LongPathsAndRoulette", under_lamp(glass(0.4f)), {.max_depth = 24, .roulette_depth = 2}, all, 64});
    cases.push_back({"SecondBounceOnly", under_lamp(gltf_plastic()), {.max_depth = 3, .min_depth = 3}, all, 64});
    cases.push_back({"VisibleEnvironment",
                     [](SceneDesc& scene) {
                         add_ball(scene, conductor(0.0f));
                         add_environment(scene);
                         scene.environment.visible_to_camera = true;
                     },
                     {.max_depth = 6},
                     all,
                     64,
                     bdpt});
    const auto mist = [](float ior, float distance, const Rgb& multiscatter_color, float g) {
        DielectricDesc desc{.ior = ior, .roughness = 0.0f};
        desc.volume.attenuation_distance = distance;
        desc.volume.attenuation_color = {0.3f, 0.4f, 0.5f};
        desc.volume.multiscatter_color = multiscatter_color;
        desc.volume.scatter_anisotropy = g;
        MaterialDesc material;
        material.override_model = desc;
        return material;
    };
    const auto in_fog = [=](SceneDesc& scene) {
        add_ball(scene, gltf_plastic());
        add_lamp(scene);
        add_object(scene, sphere({0, 0, -2}, 6, 16),
                   add_material(scene, mist(1.00001f, 2.0f, {0.5f, 0.6f, 0.4f}, 0.3f)));
    };
    // Not by light tracing: what scatters right before a pinhole has infinite variance there. Of so many light paths
    // the nearest vertex is some 5 cm away, and what lies nearer, 2% of the light, is nearly always missing.
    cases.push_back({"LampInFog", in_fog, {.max_depth = 4}, all, 32, bdpt});
    // Scattering in media adds no edges: with the fewest of them there is still light from all over the fog.
    cases.push_back({"LampInFogWithoutSurfaces", in_fog, {.max_depth = 1}, all, 16, bdpt});
    cases.push_back({"LampInFogOneSurface", in_fog, {.max_depth = 2}, all, 32, bdpt});
    // Neither light nor camera is in the cloud, whose boundary light samples and connections pass.
    const auto behind_cloud = [=](SceneDesc& scene) {
        add_ball(scene, gltf_plastic());
        add_occluder(scene);
        add_object(scene, sphere({0.1f, 0.1f, -2.6f}, 0.5f, 12),
                   add_material(scene, mist(1.0f, 0.4f, {0.8f, 0.7f, 0.6f}, 0.4f)));
    };
    cases.push_back({"CloudUnderLamp",
                     [=](SceneDesc& scene) {
                         behind_cloud(scene);
                         add_lamp(scene);
                     },
                     {.max_depth = 4},
                     all,
                     32,
                     {"path", "light", "bdpt"}});
    cases.push_back({"CloudUnderSun",
                     [=](SceneDesc& scene) {
                         behind_cloud(scene);
                         scene.lights.push_back(sun_light());
                     },
                     {.max_depth = 4},
                     all,
                     32,
                     {"path", "light", "bdpt"}});
    // Light leaves one lamp within a body and in the open. Light tracing does not see what lies behind the body.
    cases.push_back({"LampAcrossBody",
                     [](SceneDesc& scene) {
                         add_ball(scene, gltf_plastic());
                         add_lamp(scene);
                         MaterialDesc water;
                         DielectricDesc desc{.ior = 1.00001f, .roughness = 0.0f};
                         desc.volume.attenuation_distance = 0.2f;
                         desc.volume.attenuation_color = {0.3f, 0.5f, 0.8f};
                         water.override_model = desc;
                         add_object(scene, sphere({0.5f, 1.2f, -3.0f}, 0.45f, 12), add_material(scene, water));
                     },
                     {.max_depth = 3},
                     {16, 26, 60, 48},
                     64,
                     {"path", "light", "bdpt"}});
    // A light path takes one of the surfaces that its ray lights; in fog some of them lie behind where it is scattered.
    cases.push_back({"CulledBacks",
                     [](SceneDesc& scene) {
                         add_ball(scene, gltf_plastic());
                         add_lamp(scene);
                         add_culled(scene);
                     },
                     {.max_depth = 4},
                     all,
                     12,
                     {"path", "light", "bdpt"}});
    cases.push_back({"CulledPane",
                     [=](SceneDesc& scene) {
                         behind_panes(scene);
                         scene.settings.cull_backfaces = true;
                     },
                     {.max_depth = 4},
                     all,
                     12,
                     bdpt});
    cases.push_back({"CulledBacksInFog",
                     [=](SceneDesc& scene) {
                         in_fog(scene);
                         add_culled(scene);
                     },
                     {.max_depth = 2},
                     all,
                     8,
                     bdpt});
    // Cones of directions from points, areas for light paths; lamps, bodies and receivers that are exact.
    cases.push_back({"ShapeLamps", under_shapes, {.max_depth = 4}, all, 16, {"path", "light", "bdpt", "vcm"}});
    cases.push_back({"MovingLamps", under_moving_lamps, {.max_depth = 4}, all, 16, {"path", "light", "bdpt"}});
    return cases;
}

}  // namespace

const std::vector<AgreementCase>& agreement_cases() {
    static const std::vector<AgreementCase> cases = all_cases();
    return cases;
}

const AgreementCase& agreement_case(std::string_view name) {
    for (const AgreementCase& agreement : agreement_cases())
        if (agreement.name == name) return agreement;
    throw std::invalid_argument("no room is named " + std::string(name));
}

void PrintTo(const RoomRun& run, std::ostream* out) {
    *out << run.integrator << " " << run.name;
}

SceneDesc agreement_scene(const AgreementCase& agreement) {
    SceneDesc scene = empty_scene();
    scene.settings.film.width = kAgreementWidth;
    scene.settings.film.height = kAgreementHeight;
    add_room(scene);
    add_occluder(scene);
    agreement.make(scene);
    return scene;
}

World agreement_world(const AgreementCase& agreement) {
    return compile(agreement_scene(agreement));
}

}  // namespace etendue::test
