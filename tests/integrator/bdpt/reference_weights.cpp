#include "integrator/bdpt/reference_weights.h"

#include "integrator/bdpt/emitted_ray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace etendue::test {

namespace {

double cosine(const WalkedVertex& vertex, const Vec3f& w) {
    return static_cast<double>(vertex.cosine(w));
}

/// Density per solid angle of going on along `to` when a walk of this `mode` arrives from `from`.
double scattering_density(const WalkedVertex& vertex, const Vec3f& from, const Vec3f& to, TransportMode mode) {
    if (!vertex.is_on_surface()) return static_cast<double>(vertex.medium->phase.pdf_solid_angle(from, to));
    return static_cast<double>(vertex.scattering().seen_from(from).evaluate(to, mode).pdf_solid_angle);
}

/// A path and what the strategies' densities are made of. Vertex 0 lies on the light, `inner[i - 1]` is vertex i, the
/// last one lies on the lens.
class Path {
  public:
    Path(const MisContext& mis, const CompletePath& path)
        : mis_(mis),
          end_(path.end),
          inner_(path.inner),
          is_connected_(path.s > 0),
          from_light_(path.s > 0 ? path.s - 1 : 0),
          camera_(path.camera),
          at_infinity_(end_.light != kNone && mis.world.lights().is_at_infinity(end_.light)),
          emitted_(emitted_ray(mis.world, path)) {}

    [[nodiscard]] std::size_t inner_count() const { return inner_.size(); }

    /// Per area, the vertex on the light, as the strategy with `s` > 0 vertices from the light makes it: if it is the
    /// only one it was sampled for the next, else for where its ray goes.
    [[nodiscard]] double on_light(std::size_t s) const {
        const World& world = mis_.world;
        if (end_.light == kNone) return 0.0;
        const auto chosen =
            static_cast<double>(s == 1 ? world.lights().probability(inner_.front()->position, end_.light)
                                       : world.emitters().probability(end_.light));
        // What only one direction or one point is made of has no density but that of the choice.
        if (!world.lights().can_be_hit(end_.light)) return chosen;
        if (!at_infinity_) {
            const float gain = s == 1 ? world.lights().gain(end_.light, end_.triangle, end_.position,
                                                            inner_.front()->position, end_.time)
                                      : 1.0f;
            return chosen * static_cast<double>(world.emitters().pdf_area(end_.light, end_.position, end_.time) * gain);
        }
        return chosen *
               static_cast<double>(s == 1 ? world.environment().pdf_solid_angle(end_.light, -end_.direction)
                                          : world.environment().emission_pdf_solid_angle(end_.light, -end_.direction));
    }

    /// Per area, vertex `i` > 0 from the light's side. Deltas have their share of `delta` instead of a density.
    [[nodiscard]] double from_light(std::size_t i) const {
        const World& world = mis_.world;
        if (end_.light == kNone) return 0.0;
        const WalkedVertex& vertex = *inner_[i - 1];
        if (i == 1) {
            const auto pdf = static_cast<double>(world.emitters().pdf(emitted_, mis_.aims));
            return pdf * cosine(vertex, end_.direction) / (at_infinity_ ? 1.0 : squared_distance(0));
        }
        const WalkedVertex& before = *inner_[i - 2];
        const double pdf = is_delta(i - 1) ? delta_from_light(i - 1)
                                           : scattering_density(before, -direction(i - 2), direction(i - 1),
                                                                TransportMode::Importance);
        return pdf * cosine(vertex, direction(i - 1)) / squared_distance(i - 1);
    }

    /// Per area, vertex `i` from the eye's side.
    [[nodiscard]] double from_eye(std::size_t i) const {
        if (i == inner_.size()) {
            return mis_.samples_per_light_path * static_cast<double>(camera_.importance_area) *
                   cosine(*inner_.back(), direction(inner_.size()));
        }
        if (i == 0 && (end_.light == kNone ? false : !mis_.world.lights().can_be_hit(end_.light))) return 0.0;
        const WalkedVertex& before = *inner_[i];
        const double pdf = is_delta(i + 1)
                               ? delta_from_eye(i + 1)
                               : scattering_density(before, direction(i + 1), -direction(i), TransportMode::Radiance);
        if (i > 0) return pdf * cosine(*inner_[i - 1], direction(i)) / squared_distance(i);
        return at_infinity_ ? pdf : pdf * std::abs(static_cast<double>(end_.cos_light)) / squared_distance(0);
    }

    /// True if vertices i - 1 and i can be those of a connection.
    [[nodiscard]] bool connects(std::size_t i) const {
        return scatters_freely(i - 1) && scatters_freely(i) && is_direct(i) && !(is_in_dense(i - 1) && is_in_dense(i));
    }

    /// True if subpaths merge at vertex i.
    [[nodiscard]] bool merges(std::size_t i) const {
        if (i == 0 || i > inner_.size() || !scatters_freely(i) || !inner_[i - 1]->is_on_surface()) return false;
        switch (mis_.merging.at) {
            case MergeAt::Nothing:
                return false;
            case MergeAt::SeenByDeltas:
                return is_seen_by_deltas(i) && is_lit_by_delta(i);
            case MergeAt::Everywhere:
                return true;
        }
        return false;
    }
    /// How many light subpaths are expected within the radius around vertex i, per density.
    [[nodiscard]] double expected_photons(std::size_t i) const {
        const WalkedVertex& vertex = *inner_[i - 1];
        return mis_.merging.expected(vertex.position, mis_.world.geometry().opacity(vertex.hit));
    }

  private:
    /// True if nothing but deltas lie between vertex i and the lens, one at least, or a hidden boundary.
    [[nodiscard]] bool is_seen_by_deltas(std::size_t i) const {
        for (std::size_t j = i + 1; j <= inner_.size(); ++j)
            if (!is_delta(j)) return false;
        return i < inner_.size() || !is_direct(i + 1);
    }
    /// True if a delta or a hidden boundary lies between the light and vertex i.
    [[nodiscard]] bool is_lit_by_delta(std::size_t i) const {
        for (std::size_t j = 1; j <= i; ++j)
            if (!is_direct(j) || (j < i && is_delta(j))) return true;
        return false;
    }
    [[nodiscard]] bool is_delta(std::size_t i) const {
        return i >= 1 && i <= inner_.size() && inner_[i - 1]->is_left_by_delta && !is_end_of_subpath(i);
    }
    /// True at the last vertices of both subpaths, which were left, if at all, elsewhere than to where this path goes.
    [[nodiscard]] bool is_end_of_subpath(std::size_t i) const {
        return is_connected_ && (i == from_light_ || i == from_light_ + 1);
    }
    [[nodiscard]] bool scatters_freely(std::size_t i) const {
        return i == 0 || i > inner_.size() || (inner_[i - 1]->has_non_delta() && !is_delta(i));
    }
    [[nodiscard]] bool is_in_dense(std::size_t i) const {
        return i >= 1 && i <= inner_.size() && inner_[i - 1]->is_in_dense();
    }
    /// True if nothing but the edge lies between vertices i - 1 and i.
    [[nodiscard]] bool is_direct(std::size_t i) const {
        if (i <= from_light_) return inner_[i - 1]->is_reached_directly;
        if (i > from_light_ + 1) return inner_[i - 2]->is_reached_directly;
        return is_connected_ || end_.is_reached_directly;
    }

    /// The deltas of both directions cancel but for this ratio, of which each side is given its part.
    [[nodiscard]] double delta_from_light(std::size_t i) const {
        return i <= from_light_ ? 1.0 : static_cast<double>(inner_[i - 1]->delta_reverse_ratio);
    }
    [[nodiscard]] double delta_from_eye(std::size_t i) const {
        return i <= from_light_ ? static_cast<double>(inner_[i - 1]->delta_reverse_ratio) : 1.0;
    }

    /// Returns the unit direction from vertex i to vertex i + 1.
    [[nodiscard]] Vec3f direction(std::size_t i) const {
        if (i == 0) return end_.direction;
        const Vec3f to = i < inner_.size() ? inner_[i]->position : camera_.lens;
        return normalize(to - inner_[i - 1]->position);
    }
    [[nodiscard]] double squared_distance(std::size_t i) const {
        const Vec3f from = i == 0 ? end_.position : inner_[i - 1]->position;
        return static_cast<double>(length_squared(inner_[i]->position - from));
    }

    const MisContext& mis_;
    const PathLightEnd& end_;
    std::span<const WalkedVertex* const> inner_;
    bool is_connected_;
    std::size_t from_light_;  ///< how many of `inner_`
    const CameraConnection& camera_;
    bool at_infinity_;
    EmittedRay emitted_;
};

}  // namespace

std::vector<double> reference_weights(const MisContext& mis, const CompletePath& complete) {
    constexpr double kNever = -std::numeric_limits<double>::infinity();
    const Path path(mis, complete);
    const std::size_t inner = path.inner_count();
    const std::size_t last = inner + 1;  // the vertex on the lens; it is s = last that has t = 1
    // In logarithms: products of densities leave the range of numbers.
    const auto from_light_up_to = [&](std::size_t i, std::size_t s) {
        double logarithm = std::log(path.on_light(s));
        for (std::size_t j = 1; j <= i; ++j) logarithm += std::log(path.from_light(j));
        return logarithm;
    };
    const auto from_eye_down_to = [&](std::size_t i) {
        double logarithm = 0.0;
        for (std::size_t j = i; j < last; ++j) logarithm += std::log(path.from_eye(j));
        return logarithm;
    };
    std::vector<double> densities(last + 1 + inner, kNever);
    densities[0] = from_eye_down_to(0);
    for (std::size_t s = 1; s <= last; ++s)
        if (path.connects(s)) densities[s] = from_light_up_to(s - 1, s) + from_eye_down_to(s);
    for (std::size_t i = 1; i <= inner; ++i)
        if (path.merges(i))
            densities[last + i] = from_light_up_to(i, i + 1) + from_eye_down_to(i) + std::log(path.expected_photons(i));
    const double largest = std::ranges::max(densities);
    double sum = 0.0;
    for (double& density : densities) {
        density = density == kNever ? 0.0 : mis.raised(std::exp(density - largest));
        sum += density;
    }
    for (double& density : densities) density /= sum;
    return densities;
}

}  // namespace etendue::test
