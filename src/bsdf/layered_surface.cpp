#include "bsdf/layered_surface.h"

#include "bsdf/cosine_average.h"
#include "core/frame.h"
#include "core/trigonometry.h"
#include "sampling/warp.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

/// Everything that depends on the parameters and wo but not on wi.
struct Layers {
    float passed_o;
    float p_coat, p_sheen;  ///< the rest goes to the base

    Layers(const LayeredSurface& surface, const Vec3f& wo) : passed_o(passed(surface, wo)) {
        const bool above = wo.z > 0.0f;
        const float coat = above ? 1.0f - surface.coat.passed(dot(wo, surface.coat.normal)) : 0.0f;
        const float sheen = above ? 1.0f - surface.sheen.passed(wo.z) : 0.0f;
        const float total = coat + sheen + passed_o;
        p_coat = coat / total;
        p_sheen = sheen / total;
    }

    [[nodiscard]] float p_base() const { return 1.0f - p_coat - p_sheen; }

    /// Share of light along `w` that passes the layers. There are none inside a body.
    [[nodiscard]] static float passed(const LayeredSurface& surface, const Vec3f& w) {
        if (surface.is_two_sided() && w.z < 0.0f) return 1.0f;
        // A thin sheet has its layers on both sides.
        const Vec3f upper{w.x, w.y, std::abs(w.z)};
        return surface.coat.passed(dot(upper, surface.coat.normal)) * surface.sheen.passed(upper.z);
    }
};

BsdfParts evaluate_base(const LayeredSurface& surface, const Vec3f& wo, const Vec3f& wi, TransportMode mode) {
    if (const auto* body = std::get_if<DielectricBody>(&surface.base)) return body->evaluate_parts(wo, wi, mode);
    return std::get<MetallicRoughness>(surface.base).evaluate_parts(wo, wi);
}

/// Light that the layers keep of what leaves a body, given back to its inside.
class InnerSide {
  public:
    explicit InnerSide(const LayeredSurface& surface)
        : surface_(surface), body_(std::get_if<DielectricBody>(&surface.base)) {}

    /// True if it holds anything for light from `wo`.
    [[nodiscard]] bool is_seen_from(const Vec3f& wo) const { return body_ != nullptr && wo.z < 0.0f; }

    /// Probability of `sample_rough`; a smooth interface decides when it has been sampled.
    [[nodiscard]] float choice(const Vec3f& wo) const {
        return is_seen_from(wo) && rough() != nullptr ? body_->interface_share * (1.0f - surface_.passed_average_plain)
                                                      : 0.0f;
    }
    [[nodiscard]] Vec3f sample_rough(const Vec3f& wo, Vec2f u) const { return rough()->sample_returned(wo, u); }

    /// Evaluates what rough interfaces send back; the density is without the probability of `choice`.
    [[nodiscard]] BsdfValue evaluate(const Vec3f& wo, const Vec3f& wi) const {
        if (!is_seen_from(wo) || wi.z >= 0.0f || rough() == nullptr) return {};
        const RoughDielectric::Returned returned = rough()->evaluate_returned(wo, wi);
        const float value = returned.single * kept(returned.out_o, returned.out_i) +
                            returned.multiple * (1.0f - surface_.passed_average_plain);
        return {Rgb(value * body_->interface_share), returned.pdf_solid_angle};
    }

    /// Returns what becomes of a sample that would leave a smooth interface: it passes the layers, or goes back inside
    /// as in a mirror.
    [[nodiscard]] BsdfSample leave_or_return(const Vec3f& wo, const BsdfSample& leaving, float u) const {
        const float passed = Layers::passed(surface_, leaving.wi);
        if (u < passed) {
            BsdfSample sample = leaving;
            sample.reverse_ratio *= Layers(surface_, leaving.wi).p_base() / passed;
            return sample;
        }
        const InterfaceFresnel::Split split = smooth_split(wo);
        const Vec3f mirrored = other_end(leaving.wi);
        const float weight =
            split.transmitted / (1.0f - split.reflection_share) * kept(leaving.wi, mirrored) / (1.0f - passed);
        return {.wi = mirror_direction(wo),
                .weight = Rgb(weight),
                .is_delta = true,
                .reverse_ratio = (1.0f - Layers::passed(surface_, mirrored)) / (1.0f - passed)};
    }

    /// Share of all light from `wo` that a smooth interface lets through along `leaving` and the layers send back.
    [[nodiscard]] float returned(const Vec3f& wo, const Vec3f& leaving) const {
        return body_->interface_share * smooth_split(wo).transmitted * kept(leaving, other_end(leaving));
    }

  private:
    [[nodiscard]] InterfaceFresnel::Split smooth_split(const Vec3f& wo) const {
        const auto& interface = std::get<SmoothDielectric>(body_->interface);
        return interface.fresnel(std::min(1.0f, -wo.z), 1.0f / interface.ior, false);
    }
    /// Where what comes back inside would have left if it were seen from there.
    [[nodiscard]] static Vec3f other_end(const Vec3f& leaving) { return {-leaving.x, -leaving.y, leaving.z}; }

    [[nodiscard]] const RoughDielectric* rough() const { return std::get_if<RoughDielectric>(&body_->interface); }

    /// Returns the share that the layers keep of light that would leave along `out_o`, or along `out_i` were it seen
    /// from its other end: the smaller of the two.
    [[nodiscard]] float kept(const Vec3f& out_o, const Vec3f& out_i) const {
        return 1.0f - std::max(Layers::passed(surface_, out_o), Layers::passed(surface_, out_i));
    }

    const LayeredSurface& surface_;
    const DielectricBody* body_;
};

BsdfParts evaluate_layer_parts(const LayeredSurface& surface, const Layers& layers, const Vec3f& wo, const Vec3f& wi,
                               TransportMode mode) {
    const BsdfParts base = evaluate_base(surface, wo, wi, mode);
    const float passed_i = Layers::passed(surface, wi);
    const float p_base = layers.p_base();
    // Between a body's inside and its layers, light does not go to and fro.
    const bool is_inside = surface.is_two_sided() && (wo.z < 0.0f || wi.z < 0.0f);
    const float diffuse_scale = layers.passed_o * passed_i / (is_inside ? 1.0f : surface.passed_average);
    const float specular_scale =
        std::lerp(std::min(layers.passed_o, passed_i), layers.passed_o * passed_i / surface.passed_average_plain,
                  surface.diffuseness);
    BsdfParts value{base.diffuse * diffuse_scale, base.specular * specular_scale, base.pdf_solid_angle * p_base};
    const InnerSide inner(surface);
    if (inner.is_seen_from(wo)) {
        const BsdfValue returned = inner.evaluate(wo, wi);
        value.specular += returned.f_cos;
        value.pdf_solid_angle = std::lerp(value.pdf_solid_angle, returned.pdf_solid_angle, inner.choice(wo));
        return value;
    }
    if (wo.z <= 0.0f || wi.z <= 0.0f) return value;
    if (surface.sheen.exists()) {
        const BsdfValue sheen = surface.sheen.evaluate(wo, wi);
        value.diffuse += sheen.f_cos * std::min(surface.coat.passed(dot(wo, surface.coat.normal)),
                                                surface.coat.passed(dot(wi, surface.coat.normal)));
        value.pdf_solid_angle += sheen.pdf_solid_angle * layers.p_sheen;
    }
    if (surface.coat.exists()) {
        const BsdfValue coat = surface.coat.evaluate(wo, wi, mode);
        value.specular += coat.f_cos;
        value.pdf_solid_angle += coat.pdf_solid_angle * layers.p_coat;
    }
    return value;
}

BsdfValue evaluate_layers(const LayeredSurface& surface, const Layers& layers, const Vec3f& wo, const Vec3f& wi,
                          TransportMode mode) {
    return evaluate_layer_parts(surface, layers, wo, wi, mode).sum();
}

/// The mirror direction of a smooth coat.
BsdfSample sample_smooth_coat(const LayeredSurface& surface, const Layers& layers, const Vec3f& wo, const Vec3f& wi,
                              TransportMode mode) {
    if (wi.z <= 0.0f) return {};
    float weight = surface.coat.smooth_reflectance(wo) / layers.p_coat;
    // Both cosines to the coat's normal are equal; those to the surface's are in its adjoint factor.
    if (mode == TransportMode::Importance) weight *= wi.z / wo.z;
    return {
        .wi = wi, .weight = Rgb(weight), .is_delta = true, .reverse_ratio = Layers(surface, wi).p_coat / layers.p_coat};
}

/// Probability with which a delta of the base is left to the base on its way back.
float base_choice_back(const LayeredSurface& surface, const Layers& layers, const Vec3f& wo, const BsdfSample& sample) {
    if (!surface.is_two_sided() && sample.wi.z < 0.0f)
        return Layers(surface.from_behind(), turned_about_y(sample.wi)).p_base();
    // What arrives inside a smooth body leaves it with the chance of passing.
    if (wo.z > 0.0f && sample.wi.z < 0.0f) return layers.passed_o;
    return Layers(surface, sample.wi).p_base();
}

/// Holds t_avg of the layers for the base's diffuse part and for a plain cosine lobe.
struct PassedAverages {
    float diffuse = 1.0f;
    float plain = 1.0f;
};

/// Returns the averages of layers that share their normal.
PassedAverages passed_averages(const MetallicRoughness& base, const Sheen& sheen, const ClearCoat& coat) {
    // Light that the base's own specular layer lets through to its diffuse part and out again.
    const auto through_base = [&](float mu) { return base.passed_by_specular(mu); };
    const auto through_layers = [&](float mu) { return coat.passed(mu) * sheen.passed(mu); };
    const float through_all = cosine_average([&](float mu) { return through_base(mu) * through_layers(mu); });
    const float total = cosine_average(through_base);
    return {total > 0.0f ? through_all / total : 1.0f, cosine_average(through_layers)};
}

/// Returns the mean share that a coat which leans leaves of a cosine lobe about z, of its directions on the side of
/// `geometric`: diffuse light goes to no others.
float passed_by_leaning(const ClearCoat& coat, const Vec3f& geometric) {
    constexpr int kAzimuths = 8;
    const Frame frame = Frame::from_normal(coat.normal);
    // About the coat's normal, on which alone its share depends.
    const Vec2f sums = unit_average([&](float mu) {
        const float sine = std::sqrt(1.0f - mu * mu);
        float lobe = 0.0f;
        for (int i = 0; i < kAzimuths; ++i) {
            const SinCos turn = sin_cos_turns((static_cast<float>(i) + 0.5f) / kAzimuths);
            for (const float side : {mu, -mu}) {
                const Vec3f w = frame.to_world({sine * turn.cos, sine * turn.sin, side});
                if (w.z > 0.0f && dot(w, geometric) > 0.0f) lobe += w.z;
            }
        }
        return Vec2f(lobe * coat.passed(mu), lobe);
    });
    return sums.y > 0.0f ? sums.x / sums.y : 1.0f;
}

BsdfSample sample_base(const LayeredSurface& surface, const Vec3f& wo, float u_lobe, Vec2f u, TransportMode mode) {
    return std::visit([&](const auto& base) { return base.sample(wo, u_lobe, u, mode); }, surface.base);
}

}  // namespace

LayeredSurface LayeredSurface::make(const std::variant<MetallicRoughness, DielectricBody>& base, const Sheen& sheen,
                                    const ClearCoat& coat, const Vec3f& geometric) {
    const auto* plain = std::get_if<MetallicRoughness>(&base);
    const MetallicRoughness& opaque = plain != nullptr ? *plain : std::get<DielectricBody>(base).opaque;
    const bool leans = plain != nullptr && coat.leans();
    PassedAverages averages = passed_averages(opaque, sheen, leans ? ClearCoat{} : coat);
    if (leans) {
        const float passed = passed_by_leaning(coat, geometric);
        averages = {averages.diffuse * passed, averages.plain * passed};
    }
    LayeredSurface surface{.base = base,
                           .sheen = sheen,
                           .coat = coat,
                           .passed_average = averages.diffuse,
                           .passed_average_plain = averages.plain,
                           .diffuseness = plain != nullptr ? std::min(opaque.alpha_x, opaque.alpha_y) : 0.0f};
    if (auto* const body = std::get_if<DielectricBody>(&surface.base)) body->passed_by_layers = averages.diffuse;
    return surface;
}

bool LayeredSurface::has_non_delta() const {
    return sheen.exists() || (coat.exists() && !coat.is_smooth()) ||
           std::visit([](const auto& lobe) { return lobe.has_non_delta(); }, base);
}

BsdfParts LayeredSurface::evaluate_parts(const Vec3f& wo, const Vec3f& wi, TransportMode mode) const {
    if (wo.z == 0.0f || wi.z == 0.0f || (wo.z < 0.0f && !is_two_sided())) return {};
    return evaluate_layer_parts(*this, Layers(*this, wo), wo, wi, mode);
}

BsdfValue LayeredSurface::evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode mode) const {
    if (wo.z == 0.0f || wi.z == 0.0f || (wo.z < 0.0f && !is_two_sided())) return {};
    return evaluate_layers(*this, Layers(*this, wo), wo, wi, mode);
}

BsdfSample LayeredSurface::sample(const Vec3f& wo, float u_lobe, Vec2f u, TransportMode mode) const {
    if (wo.z == 0.0f || (wo.z < 0.0f && !is_two_sided())) return {};
    const Layers layers(*this, wo);
    const InnerSide inner(*this);
    const float end_sheen = layers.p_coat + layers.p_sheen;
    const float end_layers = end_sheen + inner.choice(wo);  // one of the two is zero
    BsdfSample sample;
    if (u_lobe < layers.p_coat) {
        sample.wi = coat.sample_direction(wo, u_lobe / layers.p_coat, u);
        if (coat.is_smooth()) return sample_smooth_coat(*this, layers, wo, sample.wi, mode);
        if (sample.wi.z <= 0.0f) return {};
    } else if (u_lobe < end_sheen) {
        sample.wi = Sheen::sample(u);
    } else if (u_lobe < end_layers) {
        sample.wi = inner.sample_rough(wo, u);
        if (sample.wi.z >= 0.0f) return {};
    } else {
        const float u_rest = std::clamp((u_lobe - end_layers) / (1.0f - end_layers), 0.0f, kOneMinusEpsilon);
        sample = sample_base(*this, wo, u_rest, u, mode);
        if (!sample.is_delta && !(sample.pdf_solid_angle > 0.0f)) return {};
        if (sample.is_delta) {
            // The choice among deltas leaves `u` unused.
            if (sample.is_transmission && inner.is_seen_from(wo)) return inner.leave_or_return(wo, sample, u.x);
            const float passed_i = Layers::passed(*this, sample.wi);
            sample.weight *= std::min(layers.passed_o, passed_i) / (1.0f - end_layers);
            sample.reverse_ratio *= base_choice_back(*this, layers, wo, sample) / layers.p_base();
            return sample;
        }
    }
    if (sample.wi.z == 0.0f) return {};
    const BsdfValue value = evaluate_layers(*this, layers, wo, sample.wi, mode);
    if (!(value.pdf_solid_angle > 0.0f)) return {};
    sample.weight = value.f_cos / value.pdf_solid_angle;
    sample.pdf_solid_angle = value.pdf_solid_angle;
    return sample;
}

void LayeredSurface::add_deltas(const Vec3f& wo, DeltaList& deltas) const {
    if (wo.z == 0.0f || (wo.z < 0.0f && !is_two_sided())) return;
    const Layers layers(*this, wo);
    if (layers.p_coat > 0.0f && coat.is_smooth()) {
        const Vec3f wi = coat.sample_direction(wo, 0.0f, {});
        if (wi.z > 0.0f) deltas.add({.wi = wi, .weight = Rgb(coat.smooth_reflectance(wo)), .is_delta = true});
    }
    const InnerSide inner(*this);
    DeltaList below;
    std::visit([&](const auto& lobe) { lobe.add_deltas(wo, below); }, base);
    for (BsdfSample delta : below) {
        const float passed_i = Layers::passed(*this, delta.wi);
        if (delta.is_transmission && inner.is_seen_from(wo)) {
            deltas.add({.wi = mirror_direction(wo), .weight = Rgb(inner.returned(wo, delta.wi)), .is_delta = true});
            delta.weight *= passed_i;
        } else {
            delta.weight *= std::min(layers.passed_o, passed_i);
        }
        deltas.add(delta);
    }
}

}  // namespace etendue
