#include "scene/material_textures.h"
#include "scene/validate_parts.h"

#include <algorithm>
#include <limits>

namespace etendue {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void check_anisotropy(float value, std::string_view what, const SourceLocation& where, ProblemList& problems) {
    constexpr auto kMost = static_cast<double>(kMostAnisotropic);
    check_range(static_cast<double>(value), -kMost, kMost, what, where, problems);
}

void validate_texture_ref(const TextureRef& ref, std::string_view slot, const SceneDesc& scene,
                          const SourceLocation& where, ProblemList& problems) {
    if (!ref.valid()) return;
    check_handle(ref.texture, scene.textures, fmt::format("the texture of {},", slot), where, problems);
    if (ref.texcoord != 0 && ref.texcoord != 1) {
        problems.error(where,
                       fmt::format("{} uses texture coordinates {}, but only 0 and 1 exist", slot, ref.texcoord));
    }
    const TextureTransform& t = ref.transform;
    for (const float v : {t.offset.x, t.offset.y, t.rotation, t.scale.x, t.scale.y}) {
        if (std::isfinite(v)) continue;
        problems.error(where, fmt::format("the texture transform of {} is not finite", slot));
        return;
    }
}

void validate_override(const ConductorDesc& model, const SourceLocation& where, ProblemList& problems) {
    check_range(static_cast<double>(model.roughness), 0.0, 1.0, "roughness", where, problems);
    if (model.metal.empty() || std::ranges::find(kMetalNames, model.metal) != kMetalNames.end()) return;
    problems.error(where, fmt::format("unknown metal '{}'; known are {}", model.metal, fmt::join(kMetalNames, ", ")));
}

void validate_volume(const VolumeDesc& volume, const SourceLocation& where, ProblemList& problems) {
    check_range(volume.attenuation_color, 0.0, 1.0, "attenuation colour", where, problems);
    // Infinity is what means that nothing is absorbed.
    if (!(volume.attenuation_distance > 0.0f))
        problems.error(where,
                       fmt::format("attenuation distance is {}, but must be above 0", volume.attenuation_distance));
    check_range(static_cast<double>(volume.dispersion), 0.0, kInfinity, "dispersion", where, problems);
    check_range(volume.multiscatter_color, 0.0, 1.0, "multiscatter colour", where, problems);
    check_anisotropy(volume.scatter_anisotropy, "scatter anisotropy", where, problems);
}

void validate_override(const DielectricDesc& model, const SourceLocation& where, ProblemList& problems) {
    check_range(static_cast<double>(model.roughness), 0.0, 1.0, "roughness", where, problems);
    if (!(model.ior >= 1.0f && model.ior <= 3.0f)) {
        problems.error(where, fmt::format("ior is {}, but must be in [1, 3]", model.ior));
    }
    validate_volume(model.volume, where, problems);
}

void validate_override(const DiffuseDesc& model, const SourceLocation& where, ProblemList& problems) {
    check_range(model.albedo, 0.0, 1.0, "albedo", where, problems);
    check_range(static_cast<double>(model.roughness), 0.0, 1.0, "roughness", where, problems);
}

void validate_override(const SubsurfaceDesc& model, const SourceLocation& where, ProblemList& problems) {
    check_range(model.albedo, 0.0, 1.0, "albedo", where, problems);
    check_range(model.radius, 0.0, kInfinity, "radius", where, problems);
    if (!(min_component(model.radius) > 0.0f)) problems.error(where, "radius must be above 0 in every channel");
    check_anisotropy(model.anisotropy, "anisotropy", where, problems);
    check_range(static_cast<double>(model.ior), 1.0, 3.0, "ior", where, problems);
    check_range(static_cast<double>(model.roughness), 0.0, 1.0, "roughness", where, problems);
}

void validate_override(std::monostate, const SourceLocation&, ProblemList&) {}

/// The layers that extensions add.
void validate_layers(const MaterialDesc& m, ProblemList& problems) {
    const auto in_unit = [&](float value, std::string_view what) {
        check_range(static_cast<double>(value), 0.0, 1.0, what, m.location, problems);
    };
    const auto finite = [&](float value, double least, std::string_view what) {
        check_range(static_cast<double>(value), least, std::numeric_limits<float>::max(), what, m.location, problems);
    };
    in_unit(m.clearcoat.factor, "clearcoat");
    in_unit(m.clearcoat.roughness, "clearcoat roughness");
    finite(m.clearcoat.normal_scale, -std::numeric_limits<float>::max(), "clearcoat normal scale");
    check_range(m.sheen.color, 0.0, 1.0, "sheen colour", m.location, problems);
    in_unit(m.sheen.roughness, "sheen roughness");
    in_unit(m.iridescence.factor, "iridescence");
    finite(m.iridescence.ior, 1.0, "iridescence ior");
    finite(m.iridescence.thickness_minimum_nm, 0.0, "iridescence thickness minimum");
    finite(m.iridescence.thickness_maximum_nm, 0.0, "iridescence thickness maximum");
    in_unit(m.anisotropy.strength, "anisotropy");
    finite(m.anisotropy.rotation, -std::numeric_limits<float>::max(), "anisotropy rotation");
    in_unit(m.diffuse_roughness.factor, "diffuse roughness");
    in_unit(m.diffuse_transmission.factor, "diffuse transmission");
    check_range(m.diffuse_transmission.color, 0.0, 1.0, "diffuse transmission colour", m.location, problems);
}

void validate_material(const MaterialDesc& m, const SceneDesc& scene, ProblemList& problems) {
    const auto in_range = [&](float value, double low, double high, std::string_view what) {
        check_range(static_cast<double>(value), low, high, what, m.location, problems);
    };
    check_range(m.base_color, 0.0, 1.0, "base colour", m.location, problems);
    in_range(m.base_alpha, 0.0, 1.0, "base alpha");
    in_range(m.metallic, 0.0, 1.0, "metallic");
    in_range(m.roughness, 0.0, 1.0, "roughness");
    in_range(m.normal_scale, -std::numeric_limits<float>::max(), kInfinity, "normal scale");
    check_range(m.emissive, 0.0, 1.0, "emissive", m.location, problems);
    in_range(m.emissive_strength, 0.0, kInfinity, "emissive strength");
    if (m.beam.kind == BeamDesc::Kind::Panel && !(m.beam.spread > 0.0f && m.beam.spread <= kPi + 1e-6f))
        problems.error(m.location, fmt::format("the beam's spread is {}, but must be in (0, pi]", m.beam.spread));
    if (m.beam.kind == BeamDesc::Kind::Spot)
        check_cones(m.beam.inner_cone_angle, m.beam.outer_cone_angle, m.location, problems);
    in_range(m.alpha_cutoff, 0.0, kInfinity, "alpha cutoff");
    in_range(m.transmission, 0.0, 1.0, "transmission");
    in_range(m.specular, 0.0, 1.0, "specular");
    check_range(m.specular_color, 0.0, std::numeric_limits<double>::infinity(), "specular colour", m.location,
                problems);
    in_range(m.glossiness.value_or(0.0f), 0.0, 1.0, "glossiness");
    if (m.ior != 0.0f) in_range(m.ior, 1.0, kInfinity, "ior (other than 0)");

    validate_layers(m, problems);
    validate_volume(m.volume, m.location, problems);
    for_each_texture(m, [&](const TextureRef& ref, std::string_view slot) {
        validate_texture_ref(ref, slot, scene, m.location, problems);
    });
    std::visit([&](const auto& model) { validate_override(model, m.location, problems); }, m.override_model);
}

}  // namespace

void validate_images_and_textures(const SceneDesc& scene, ProblemList& problems) {
    for (const ImageDesc& image : scene.images) {
        if (image.unreadable) continue;
        if (image.path.empty() == image.encoded.empty()) {
            problems.error(image.location, "an image must be either a file or bytes in memory");
        }
        if (image.width < 1 || image.height < 1) {
            problems.error(image.location, fmt::format("an image of {} x {} pixels", image.width, image.height));
        }
    }
    for (const TextureDesc& texture : scene.textures) {
        check_handle(texture.image, scene.images, "image", texture.location, problems);
    }
}

void validate_materials(const SceneDesc& scene, ProblemList& problems) {
    for (const MaterialDesc& material : scene.materials) validate_material(material, scene, problems);
}

}  // namespace etendue
