// SceneDesc as text: one line per thing, in the order of the struct, bulk arrays as counts.

#include "core/shown_text.h"
#include "scene/canonical_settings.h"
#include "scene/scene_desc.h"

#include <cmath>
#include <iterator>
#include <type_traits>

#include <fmt/format.h>

namespace etendue {

namespace {

using Out = std::back_insert_iterator<std::string>;

std::string text(const Rgb& c) {
    return fmt::format("({:g} {:g} {:g})", c.r, c.g, c.b);
}

std::string text(const Vec3f& v) {
    return fmt::format("({:g} {:g} {:g})", v.x, v.y, v.z);
}

std::string text(const Mat4f& m) {
    return fmt::format("x {} y {} z {} origin {}", text(Vec3f(m[0][0], m[0][1], m[0][2])),
                       text(Vec3f(m[1][0], m[1][1], m[1][2])), text(Vec3f(m[2][0], m[2][1], m[2][2])),
                       text(Vec3f(m[3][0], m[3][1], m[3][2])));
}

/// In the world.
std::string text(const Mat4f& m, const Vec3d& origin) {
    if (origin == Vec3d(0.0)) return text(m);
    const auto part = [&](int axis) { return static_cast<double>(m[3][axis]) + origin[axis]; };
    return fmt::format("x {} y {} z {} origin ({:.12g} {:.12g} {:.12g})", text(Vec3f(m[0][0], m[0][1], m[0][2])),
                       text(Vec3f(m[1][0], m[1][1], m[1][2])), text(Vec3f(m[2][0], m[2][1], m[2][2])), part(0), part(1),
                       part(2));
}

std::string text(const TextureRef& ref) {
    if (!ref.valid()) return "none";
    std::string result = fmt::format("texture {} uv{}", ref.texture.index, ref.texcoord);
    const TextureTransform& t = ref.transform;
    if (t != TextureTransform{}) {
        result += fmt::format(" offset ({:g} {:g}) rotation {:g} scale ({:g} {:g})", t.offset.x, t.offset.y, t.rotation,
                              t.scale.x, t.scale.y);
    }
    return result;
}

const char* text(AlphaMode mode) {
    switch (mode) {
        case AlphaMode::Opaque:
            return "opaque";
        case AlphaMode::Mask:
            return "mask";
        case AlphaMode::Blend:
            return "blend";
    }
    return "?";
}

const char* text(TextureWrap wrap) {
    switch (wrap) {
        case TextureWrap::Repeat:
            return "repeat";
        case TextureWrap::MirroredRepeat:
            return "mirrored-repeat";
        case TextureWrap::ClampToEdge:
            return "clamp-to-edge";
    }
    return "?";
}

const char* text(TextureFilter filter) {
    return filter == TextureFilter::Nearest ? "nearest" : "linear";
}

const char* text(TextureMipFilter filter) {
    switch (filter) {
        case TextureMipFilter::None:
            return "none";
        case TextureMipFilter::Nearest:
            return "nearest";
        case TextureMipFilter::Linear:
            return "linear";
    }
    return "?";
}

/// Quotes a name as terminals may show it; different names stay different.
std::string quoted(const std::string& name) {
    return '"' + shown_text(name) + '"';
}

void dump_textures(const SceneDesc& scene, Out out) {
    for (std::size_t i = 0; i < scene.images.size(); ++i) {
        const ImageDesc& image = scene.images[i];
        if (image.unreadable) {
            fmt::format_to(out, "image {} {}: unreadable\n", i, quoted(image.name));
            continue;
        }
        fmt::format_to(out, "image {} {}: {} x {}, {}\n", i, quoted(image.name), image.width, image.height,
                       image.path.empty() ? fmt::format("{} bytes embedded", image.encoded.size())
                                          : shown_text(image.path.filename().string()));
    }
    for (std::size_t i = 0; i < scene.textures.size(); ++i) {
        const TextureDesc& t = scene.textures[i];
        fmt::format_to(out, "texture {} {}: image {}, wrap {} {}, {}, minified {} mip {}\n", i, quoted(t.name),
                       t.image.index, text(t.wrap_u), text(t.wrap_v), text(t.filter), text(t.min_filter),
                       text(t.mip_filter));
    }
}

std::string text(const VolumeDesc& v) {
    return fmt::format("attenuation {} at {:g} m, dispersion {:g}, multiscatter {} anisotropy {:g}, priority {}",
                       text(v.attenuation_color), v.attenuation_distance, v.dispersion, text(v.multiscatter_color),
                       v.scatter_anisotropy, v.priority);
}

/// The layers that extensions add, those that are there.
void dump_layers(const MaterialDesc& m, Out out) {
    if (m.diffuse_roughness.factor > 0.0f)
        fmt::format_to(out, "  diffuse roughness {:g}, {}\n", m.diffuse_roughness.factor,
                       text(m.diffuse_roughness.texture));
    if (m.diffuse_transmission.factor > 0.0f)
        fmt::format_to(out, "  diffuse transmission {:g}, {} colour {}, {}\n", m.diffuse_transmission.factor,
                       text(m.diffuse_transmission.texture), text(m.diffuse_transmission.color),
                       text(m.diffuse_transmission.color_texture));
    if (m.volume.closed) fmt::format_to(out, "  volume {}\n", text(m.volume));
    if (m.anisotropy.strength > 0.0f)
        fmt::format_to(out, "  anisotropy {:g} rotation {:g}, {}\n", m.anisotropy.strength, m.anisotropy.rotation,
                       text(m.anisotropy.texture));
    if (m.iridescence.factor > 0.0f)
        fmt::format_to(out, "  iridescence {:g}, {} ior {:g} thickness {:g} to {:g} nm, {}\n", m.iridescence.factor,
                       text(m.iridescence.texture), m.iridescence.ior, m.iridescence.thickness_minimum_nm,
                       m.iridescence.thickness_maximum_nm, text(m.iridescence.thickness_texture));
    if (!is_black(m.sheen.color))
        fmt::format_to(out, "  sheen {}, {} roughness {:g}, {}\n", text(m.sheen.color), text(m.sheen.color_texture),
                       m.sheen.roughness, text(m.sheen.roughness_texture));
    if (m.clearcoat.factor > 0.0f)
        fmt::format_to(out, "  clearcoat {:g}, {} roughness {:g}, {} normal scale {:g}, {}\n", m.clearcoat.factor,
                       text(m.clearcoat.texture), m.clearcoat.roughness, text(m.clearcoat.roughness_texture),
                       m.clearcoat.normal_scale, text(m.clearcoat.normal_texture));
}

std::string text_of_motion(std::size_t steps) {
    return steps == 0 ? std::string() : fmt::format(", {} steps of motion", steps);
}

std::string text_of_override(const MaterialDesc& material) {
    const auto describe = [](const auto& model) -> std::string {
        using Model = std::decay_t<decltype(model)>;
        if constexpr (std::is_same_v<Model, ConductorDesc>) {
            return fmt::format("conductor {} roughness {:g}", model.metal.empty() ? "lossless" : model.metal,
                               model.roughness);
        } else if constexpr (std::is_same_v<Model, DielectricDesc>) {
            return fmt::format("dielectric ior {:g} roughness {:g}, {}", model.ior, model.roughness,
                               text(model.volume));
        } else if constexpr (std::is_same_v<Model, DiffuseDesc>) {
            return fmt::format("diffuse {} roughness {:g}", text(model.albedo), model.roughness);
        } else if constexpr (std::is_same_v<Model, SubsurfaceDesc>) {
            return fmt::format("subsurface {} radius {} anisotropy {:g} ior {:g} roughness {:g} priority {}",
                               text(model.albedo), text(model.radius), model.anisotropy, model.ior, model.roughness,
                               model.priority);
        } else {
            return {};
        }
    };
    return std::visit(describe, material.override_model);
}

void dump_material(std::size_t index, const MaterialDesc& m, Out out) {
    fmt::format_to(out, "material {} {}: alpha {}{}{}\n", index, quoted(m.name), text(m.alpha_mode),
                   m.double_sided ? ", double-sided" : "", m.unlit ? ", unlit" : "");
    if (m.alpha_mode == AlphaMode::Mask) fmt::format_to(out, "  alpha cutoff {:g}\n", m.alpha_cutoff);
    if (const std::string model = text_of_override(m); !model.empty()) fmt::format_to(out, "  override {}\n", model);
    fmt::format_to(out, "  base colour {} alpha {:g}, {}\n", text(m.base_color), m.base_alpha,
                   text(m.base_color_texture));
    fmt::format_to(out, "  metallic {:g} roughness {:g}, {}\n", m.metallic, m.roughness,
                   text(m.metallic_roughness_texture));
    fmt::format_to(out, "  normal scale {:g}, {}\n", m.normal_scale, text(m.normal_texture));
    fmt::format_to(out, "  emissive {} strength {:g}, {}\n", text(m.emissive), m.emissive_strength,
                   text(m.emissive_texture));
    if (m.beam.kind == BeamDesc::Kind::Panel) fmt::format_to(out, "  beam of spread {:g}\n", m.beam.spread);
    if (m.beam.kind == BeamDesc::Kind::Spot)
        fmt::format_to(out, "  beam of cone {:g} to {:g}\n", m.beam.inner_cone_angle, m.beam.outer_cone_angle);
    if (m.seen_as == SeenAs::Shadow) fmt::format_to(out, "  catches shadows\n");
    if (m.seen_as == SeenAs::Hole) fmt::format_to(out, "  cuts a hole\n");
    if (!m.visible_to_camera) fmt::format_to(out, "  hidden from the camera\n");
    fmt::format_to(out, "  specular {:g}, {} color {:g} {:g} {:g}, {}\n", m.specular, text(m.specular_texture),
                   m.specular_color.r, m.specular_color.g, m.specular_color.b, text(m.specular_color_texture));
    if (m.glossiness) fmt::format_to(out, "  glossiness {:g}\n", *m.glossiness);
    fmt::format_to(out, "  ior {:g} transmission {:g}, {}\n", m.ior, m.transmission, text(m.transmission_texture));
    dump_layers(m, out);
}

void dump_geometry(const SceneDesc& scene, Out out) {
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        fmt::format_to(out, "mesh {} {}\n", i, quoted(scene.meshes[i].name));
        for (const PrimitiveDesc& p : scene.meshes[i].primitives) {
            if (p.shape) {
                fmt::format_to(out, "  {} with half its size {}, material {}\n", shape_name(p.shape->kind),
                               text(p.shape->half_size), p.material.index);
                continue;
            }
            fmt::format_to(out, "  {} triangles, {} vertices, material {}{}{}{}{}{}\n", p.triangles.size(),
                           p.positions.size(), p.material.index, p.tangents.empty() ? "" : ", tangents",
                           p.uv0.empty() ? "" : ", uv0", p.uv1.empty() ? "" : ", uv1",
                           p.colors.empty() ? "" : ", colours", text_of_motion(p.motion.size()));
        }
    }
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const NodeDesc& node = scene.nodes[i];
        if (node.parent != NodeDesc::kNone)
            fmt::format_to(out, "node {} {} below node {} {}\n", i, quoted(node.name), node.parent,
                           quoted(scene.nodes[node.parent].name));
    }
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const InstanceDesc& instance = scene.instances[i];
        fmt::format_to(out, "instance {} {}: mesh {}, {}{}\n", i, quoted(instance.name), instance.mesh.index,
                       text(instance.to_world, scene.origin), text_of_motion(instance.motion.size()));
    }
}

/// Quotes the name of a camera or lamp, and that of its node if it is another.
std::string quoted(const std::string& name, const std::string& node) {
    return node.empty() || node == name ? quoted(name) : fmt::format("{} of node {}", quoted(name), quoted(node));
}

std::string text_of_projection(const CameraDesc& c) {
    switch (c.type) {
        case CameraType::Perspective:
            return fmt::format("perspective yfov {:g}", c.yfov);
        case CameraType::Orthographic:
            return fmt::format("orthographic ymag {:g}", c.ymag);
        case CameraType::Equirectangular:
            return "equirectangular";
        case CameraType::Fisheye:
            return fmt::format("fisheye fov {:g} {} circle {:g}", c.fov,
                               c.fisheye == FisheyeType::Equisolid ? "equisolid" : "equidistant", c.circle);
    }
    return "?";
}

/// Says of a camera what few have.
void dump_view(const CameraDesc& c, Out out) {
    if (c.shift != Vec2f(0.0f, 0.0f)) fmt::format_to(out, "  shift ({:g} {:g})\n", c.shift.x, c.shift.y);
    if (c.clip.start > 0.0f || std::isfinite(c.clip.end))
        fmt::format_to(out, "  clipped from {:g} to {:g}\n", c.clip.start, c.clip.end);
    if (c.aperture.blades > 0 || c.aperture.ratio != 1.0f)
        fmt::format_to(out, "  aperture of {} blades turned by {:g}, ratio {:g}\n", c.aperture.blades,
                       c.aperture.rotation, c.aperture.ratio);
}

void dump_cameras_and_lights(const SceneDesc& scene, Out out) {
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        const CameraDesc& c = scene.cameras[i];
        fmt::format_to(out, "camera {} {}: {}, aspect {:g}, lens radius {:g}, focus {:g}, {}{}\n", i,
                       quoted(c.name, c.node), text_of_projection(c), c.aspect_ratio, c.lens_radius, c.focus_distance,
                       text(c.to_world, scene.origin), text_of_motion(c.motion.size()));
        dump_view(c, out);
    }
    for (std::size_t i = 0; i < scene.ies_profiles.size(); ++i) {
        const IesProfileDesc& p = scene.ies_profiles[i];
        fmt::format_to(out, "IES profile {} {}: {} x {} directions, peak {:g} cd\n", i, quoted(p.name),
                       p.vertical.size(), p.horizontal.size(), peak_candela(p));
    }
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const LightDesc& light = scene.lights[i];
        fmt::format_to(out, "light {} {}: {} colour {} intensity {:g}", i, quoted(light.name, light.node),
                       kLightTypeNames[static_cast<std::size_t>(light.type)], text(light.color), light.intensity);
        if (light.type == LightType::Spot) {
            fmt::format_to(out, " cone {:g} to {:g}", light.inner_cone_angle, light.outer_cone_angle);
        }
        if (light.angle > 0.0f) fmt::format_to(out, " angle {:g}", light.angle);
        if (light.profile) fmt::format_to(out, " times IES profile {}", light.profile.index);
        fmt::format_to(out, ", {}{}\n", text(light.to_world, scene.origin), text_of_motion(light.motion.size()));
    }
    const EnvironmentDesc& e = scene.environment;
    if (!e.enabled) return;
    if (e.cube)
        fmt::format_to(out, "environment cube map: images {} {} {} {} {} {}, intensity {:g}, {}\n",
                       e.cube->faces[0].index, e.cube->faces[1].index, e.cube->faces[2].index, e.cube->faces[3].index,
                       e.cube->faces[4].index, e.cube->faces[5].index, e.cube->intensity, text(e.cube->to_world));
    fmt::format_to(out, "environment: {}image {}, colour {} scale {:g} rotation {:g}{}\n",
                   e.is_studio ? "studio, " : "", quoted(e.image.filename().string()), text(e.color), e.scale,
                   e.rotation, e.visible_to_camera ? "" : ", hidden from the camera");
}

}  // namespace

std::string dump_without_settings(const SceneDesc& scene) {
    std::string result;
    const Out out = std::back_inserter(result);
    fmt::format_to(out, "scene {}\n", quoted(scene.name));
    fmt::format_to(out, "extensions used: {}\nextensions ignored: {}\n",
                   shown_text(fmt::format("{}", fmt::join(scene.extensions_used, " "))),
                   shown_text(fmt::format("{}", fmt::join(scene.extensions_ignored, " "))));
    for (std::size_t i = 0; i < scene.scenes.size() && scene.scenes.size() > 1; ++i)
        fmt::format_to(out, "scene of the file {}{}\n", quoted(scene.scenes[i]),
                       i == scene.shown_scene ? ", shown" : "");
    dump_textures(scene, out);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) dump_material(i, scene.materials[i], out);
    dump_geometry(scene, out);
    for (const std::string& animation : scene.animations) fmt::format_to(out, "animation {}\n", quoted(animation));
    for (const std::string& variant : scene.variants) fmt::format_to(out, "variant {}\n", quoted(variant));
    dump_cameras_and_lights(scene, out);
    return result;
}

std::string dump(const SceneDesc& scene) {
    std::string result = dump_without_settings(scene);
    const Out out = std::back_inserter(result);
    for (const auto& [pointer, text] : setting_texts(scene.settings))
        if (text != "null") fmt::format_to(out, "{}: {}\n", setting_name(*find_setting(pointer)), shown_text(text));
    return result;
}

}  // namespace etendue
