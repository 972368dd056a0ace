#include "bsdf_settings.h"

#include <cmath>

#include <fmt/format.h>

namespace etendue::test {

namespace {

FresnelMetal gold() {
    return FresnelMetal::from_f0_f82({1.0f, 0.78f, 0.34f}, {0.96f, 0.92f, 0.7f});
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
                                           .alpha = alpha,
                                           .f0 = Rgb(f0),
                                           .transmission = transmission}});
                }
    settings.push_back({"all white, f0 1", MetallicRoughness{.base = Rgb(1.0f), .metallic = 0.0f, .f0 = Rgb(1.0f)}});
    for (const float alpha : {0.0f, 0.04f, 0.5f})
        settings.push_back(
            {fmt::format("coloured specular, alpha {}", alpha), MetallicRoughness{.base = {0.8f, 0.5f, 0.2f},
                                                                                  .metallic = 0.1f,
                                                                                  .alpha = alpha,
                                                                                  .f0 = {0.02f, 0.1f, 0.3f},
                                                                                  .f90 = 0.6f,
                                                                                  .transmission = 0.3f}});
    settings.push_back({"all black", MetallicRoughness{.base = Rgb(0.0f), .metallic = 0.0f, .f0 = Rgb(0.0f)}});
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
    }
}

}  // namespace

Vec3f direction_at(float cos_theta) {
    return {std::sqrt(std::max(0.0f, 1.0f - cos_theta * cos_theta)), 0.0f, cos_theta};
}

std::vector<BsdfSetting> all_bsdf_settings() {
    std::vector<BsdfSetting> settings;
    settings.push_back({"diffuse", Diffuse{{0.8f, 0.5f, 0.0f}}});
    add_metallic_roughness(settings);
    add_conductors(settings);
    add_dielectrics(settings);
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
