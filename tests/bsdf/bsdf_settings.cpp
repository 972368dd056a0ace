#include "bsdf_settings.h"

#include <cmath>

#include <fmt/format.h>

namespace etendue::test {

namespace {

FresnelMetal gold() {
    return FresnelMetal::from_f0_f82({1.0f, 0.78f, 0.34f}, {0.96f, 0.92f, 0.7f});
}

constexpr XyzToWorking kXyzToWorkingSpace{{{3.2404542f, -1.5371385f, -0.4985314f},
                                           {-0.9692660f, 1.8760108f, 0.0415560f},
                                           {0.0556434f, -0.2040259f, 1.0572252f}}};

ThinFilm film(float thickness_nm) {
    return {.strength = 0.8f, .ior = 1.4f, .thickness_nm = thickness_nm, .xyz_to_working = &kXyzToWorkingSpace};
}

void add_metallic_roughness(std::vector<BsdfSetting>& settings) {
    for (const float metallic : {0.0f, 0.5f, 1.0f})
        for (const float alpha : {0.0f, 0.01f, 0.16f, 1.0f})
            for (const float f0 : {0.04f, 0.3f})
                for (const float transmission : {0.0f, 0.5f, 1.0f}) {
                    // A metal has neither f0 of its own nor transmission.
                    if (metallic == 1.0f && (f0 != 0.04f || transmission != 0.0f)) continue;
                    settings.push_back(
                        {fmt::format("metallic {} alpha {} f0 {} transmission {}", metallic, alpha, f0, transmission),
                         MetallicRoughness{.base = {0.9f, 0.5f, 0.1f},
                                           .metallic = metallic,
                                           .alpha_x = alpha,
                                           .alpha_y = alpha,
                                           .f0 = Rgb(f0),
                                           .transmission = transmission}});
                }
    settings.push_back({"all white, f0 1", MetallicRoughness{.base = Rgb(1.0f), .metallic = 0.0f, .f0 = Rgb(1.0f)}});
    for (const float alpha : {0.0f, 0.04f, 0.5f})
        settings.push_back(
            {fmt::format("coloured specular, alpha {}", alpha), MetallicRoughness{.base = {0.8f, 0.5f, 0.2f},
                                                                                  .metallic = 0.1f,
                                                                                  .alpha_x = alpha,
                                                                                  .alpha_y = alpha,
                                                                                  .f0 = {0.02f, 0.1f, 0.3f},
                                                                                  .f90 = 0.6f,
                                                                                  .transmission = 0.3f}});
    settings.push_back({"all black", MetallicRoughness{.base = Rgb(0.0f), .metallic = 0.0f, .f0 = Rgb(0.0f)}});
}

void add_gltf_extensions(std::vector<BsdfSetting>& settings) {
    for (const float alpha_x : {0.04f, 0.5f, 1.0f})
        for (const float alpha_y : {0.01f, 0.3f})
            settings.push_back(
                {fmt::format("anisotropic {} {}", alpha_x, alpha_y), MetallicRoughness{.base = {0.9f, 0.6f, 0.3f},
                                                                                       .metallic = 0.7f,
                                                                                       .alpha_x = alpha_x,
                                                                                       .alpha_y = alpha_y,
                                                                                       .transmission = 0.5f}});
    for (const float alpha : {0.0f, 0.2f})
        for (const float metallic : {0.0f, 1.0f})
            for (const float thickness : {150.0f, 400.0f})
                settings.push_back({fmt::format("film {} metallic {} alpha {}", thickness, metallic, alpha),
                                    MetallicRoughness{.base = {0.8f, 0.6f, 0.4f},
                                                      .metallic = metallic,
                                                      .alpha_x = alpha,
                                                      .alpha_y = alpha,
                                                      .film = film(thickness)}});
    for (const float alpha : {0.0f, 0.3f})
        settings.push_back({fmt::format("leaf, alpha {}", alpha),
                            MetallicRoughness{.base = {0.1f, 0.5f, 0.1f},
                                              .metallic = 0.1f,
                                              .alpha_x = alpha,
                                              .alpha_y = alpha,
                                              .transmission = 0.2f,
                                              .diffuse_transmission = 0.6f,
                                              .diffuse_transmission_color = {0.5f, 0.9f, 0.1f}}});
}

const MetallicRoughness kPlastic{.base = {0.8f, 0.5f, 0.2f}, .metallic = 0.2f, .alpha_x = 0.3f, .alpha_y = 0.3f};

void add_layered(std::vector<BsdfSetting>& settings) {
    for (const float alpha : {0.0f, 0.01f, 0.25f, 1.0f})
        settings.push_back({fmt::format("sheen alpha {}", alpha),
                            LayeredSurface::make(kPlastic, Sheen{{0.9f, 0.5f, 0.1f}, alpha}, {})});
    for (const float alpha : {0.0f, 0.02f, 0.3f}) {
        settings.push_back({fmt::format("coat alpha {}", alpha), LayeredSurface::make(kPlastic, {}, {0.8f, alpha})});
        settings.push_back({fmt::format("coat and sheen alpha {}", alpha),
                            LayeredSurface::make(kPlastic, Sheen{{0.3f, 0.3f, 0.6f}, 0.4f}, ClearCoat{1.0f, alpha})});
        settings.push_back(
            {fmt::format("coat alpha {} over a mirror", alpha),
             LayeredSurface::make(MetallicRoughness{.alpha_x = 0.0f, .alpha_y = 0.0f}, {}, {1.0f, alpha})});
        settings.push_back({.name = fmt::format("tilted coat and sheen alpha {}", alpha),
                            .bsdf = LayeredSurface::make(kPlastic, Sheen{{0.3f, 0.3f, 0.6f}, 0.4f},
                                                         {0.9f, alpha, normalize(Vec3f(0.3f, 0.2f, 1.0f))}),
                            .has_tilted_normal = true});
    }
}

void add_rough_diffuse_under_gloss(std::vector<BsdfSetting>& settings) {
    for (const float roughness : {0.3f, 1.0f})
        settings.push_back({fmt::format("rough diffuse {} under gloss", roughness),
                            MetallicRoughness{.base = {0.9f, 0.5f, 0.1f},
                                              .metallic = 0.1f,
                                              .alpha_x = 0.3f,
                                              .alpha_y = 0.3f,
                                              .diffuse_transmission = 0.4f,
                                              .diffuse_transmission_color = {0.5f, 0.9f, 0.1f},
                                              .diffuse_roughness = roughness}});
}

/// Sheets that light passes, bare and under layers.
void add_sheets(std::vector<BsdfSetting>& settings) {
    MetallicRoughness pane = kPlastic;
    pane.transmission = 0.7f;
    pane.alpha_y = 0.5f;
    MetallicRoughness leaf = kPlastic;
    leaf.diffuse_transmission = 0.6f;
    leaf.diffuse_transmission_color = {0.9f, 0.4f, 0.1f};
    for (const auto& [name, sheet] : {std::pair{"pane", pane}, std::pair{"leaf", leaf}}) {
        settings.push_back({fmt::format("{} of two alphas", name), sheet});
        settings.push_back({fmt::format("layers over a {}", name),
                            LayeredSurface::make(sheet, Sheen{{0.3f, 0.3f, 0.6f}, 0.4f}, ClearCoat{0.8f, 0.2f})});
    }
}

void add_bodies(std::vector<BsdfSetting>& settings, TransportMode mode, const char* mode_name) {
    const InterfaceFresnel tinted{.tint = {0.5f, 0.8f, 1.0f}, .weight = 0.9f, .film = film(300.0f)};
    RoughDielectric rough = RoughDielectric::make(1.4f, 0.1f, 0.4f);
    rough.tint = {0.9f, 0.7f, 0.5f};
    settings.push_back({fmt::format("anisotropic dielectric {}", mode_name), rough, mode});
    settings.push_back({fmt::format("bubble {}", mode_name), RoughDielectric::make(0.7f, 0.2f), mode});
    rough = RoughDielectric::make(1.7f, 1.0f, 0.05f);
    settings.push_back({fmt::format("combed dielectric {}", mode_name), rough, mode});
    rough = RoughDielectric::make(1.4f, 0.2f, 0.2f, tinted);
    settings.push_back({fmt::format("film on a dielectric {}", mode_name), rough, mode});
    settings.push_back({fmt::format("partly metal {}", mode_name), DielectricBody{rough, kPlastic, 0.6f}, mode});
    const SmoothDielectric smooth{.ior = 1.6f, .tint = {0.3f, 0.6f, 0.9f}, .fresnel = tinted};
    settings.push_back({fmt::format("smooth film {}", mode_name), smooth, mode});
    settings.push_back(
        {fmt::format("smooth, partly opaque {}", mode_name), DielectricBody{smooth, kPlastic, 0.5f}, mode});
    MetallicRoughness leaf = kPlastic;
    leaf.diffuse_transmission = 0.7f;
    for (const float ior : {0.7f, 1.5f})
        settings.push_back({fmt::format("leaf of glass {} {}", ior, mode_name),
                            DielectricBody{RoughDielectric::make(ior, 0.3f), leaf, 0.4f}, mode});
    settings.push_back({fmt::format("coated body {}", mode_name),
                        LayeredSurface::make(DielectricBody{rough, kPlastic, 0.7f}, {}, ClearCoat{0.7f, 0.1f}), mode});
    settings.push_back({fmt::format("varnished velvet glass {}", mode_name),
                        LayeredSurface::make(DielectricBody{RoughDielectric::make(1.5f, 0.3f), {}, 1.0f},
                                             Sheen{{0.9f, 0.6f, 0.9f}, 0.4f}, ClearCoat{0.9f, 0.0f}),
                        mode});
    settings.push_back({fmt::format("coated smooth body {}", mode_name),
                        LayeredSurface::make(DielectricBody{smooth, kPlastic, 0.7f}, {}, ClearCoat{0.8f, 0.2f}), mode});
}

void add_conductors(std::vector<BsdfSetting>& settings) {
    settings.push_back({"smooth conductor", SmoothConductor{gold()}});
    for (const float alpha : {0.001f, 0.01f, 0.05f, 0.2f, 0.5f, 1.0f}) {
        settings.push_back({fmt::format("gold alpha {}", alpha), RoughConductor{gold(), alpha}});
        settings.push_back({fmt::format("mirror alpha {}", alpha), RoughConductor{lossless_mirror(), alpha}});
    }
}

void add_dielectrics(std::vector<BsdfSetting>& settings) {
    for (const TransportMode mode : {TransportMode::Importance, TransportMode::Radiance}) {
        const char* mode_name = mode == TransportMode::Radiance ? "radiance" : "importance";
        for (const float ior : {1.1f, 1.5f, 2.5f}) {
            settings.push_back({fmt::format("smooth dielectric {} {}", ior, mode_name), SmoothDielectric{ior}, mode});
            for (const float alpha : {0.01f, 0.05f, 0.2f, 0.5f, 1.0f})
                settings.push_back({fmt::format("dielectric {} alpha {} {}", ior, alpha, mode_name),
                                    RoughDielectric::make(ior, alpha), mode});
        }
        add_bodies(settings, mode, mode_name);
    }
}

}  // namespace

Vec3f direction_at(float cos_theta) {
    return {std::sqrt(std::max(0.0f, 1.0f - cos_theta * cos_theta)), 0.0f, cos_theta};
}

std::vector<BsdfSetting> all_bsdf_settings() {
    std::vector<BsdfSetting> settings;
    settings.push_back({"diffuse", Diffuse{{0.8f, 0.5f, 0.0f}}});
    for (const float roughness : {0.0f, 0.4f, 1.0f})
        settings.push_back({fmt::format("rough diffuse {}", roughness), RoughDiffuse{{0.8f, 0.5f, 1.0f}, roughness}});
    add_metallic_roughness(settings);
    add_gltf_extensions(settings);
    add_layered(settings);
    add_sheets(settings);
    add_conductors(settings);
    add_dielectrics(settings);
    add_rough_diffuse_under_gloss(settings);  // last: each setting has a seed by its place
    return settings;
}

std::vector<BsdfSetting> non_delta_bsdf_settings() {
    std::vector<BsdfSetting> settings = all_bsdf_settings();
    std::erase_if(settings, [](const BsdfSetting& setting) { return !has_non_delta(setting.bsdf); });
    return settings;
}

std::vector<Vec3f> outgoing_directions(const Bsdf& bsdf) {
    std::vector<Vec3f> directions;
    for (const float cos_theta : {0.05f, 0.5f, 0.999f}) {
        directions.push_back(direction_at(cos_theta));
        if (is_two_sided_interface(bsdf)) directions.push_back(direction_at(-cos_theta));
    }
    // One that is not in the plane of the others.
    directions.push_back(normalize({-0.4f, 0.5f, 0.6f}));
    return directions;
}

}  // namespace etendue::test
