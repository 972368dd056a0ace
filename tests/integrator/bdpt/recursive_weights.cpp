#include "integrator/bdpt/recursive_weights.h"

#include "integrator/bdpt/emitted_ray.h"
#include "transport/strategy_sums.h"

#include <cmath>
#include <cstddef>
#include <limits>

namespace etendue::test {

namespace {

using Value = Scattering::TwoWayValue;

/// The inner vertices in the order of the path, as a subpath from one of its ends has them.
struct Side {
    std::vector<WalkedVertex> vertices;
    std::vector<Value> values;                  ///< towards the next vertex
    std::vector<DepartingDensities> departing;  ///< towards the next vertex
    std::vector<bool> merges;                   ///< true where it merges as far as this side knows
};

/// Vertex 0 is the first of `inner`.
class GivenPath {
  public:
    GivenPath(const MisContext& mis, const CompletePath& path) : mis_(mis), path_(path) {}

    [[nodiscard]] std::vector<double> weights() {
        const std::size_t n = path_.inner.size();
        walk_from_eye();
        if (!has_light()) {
            std::vector<double> weights(2 * n + 2, 0.0);
            weights[0] = 1.0;
            return weights;
        }
        walk_from_light();
        std::vector<double> weights{weight_at_light(), weight_of_light_sample()};
        for (std::size_t i = 0; i + 1 < n; ++i) weights.push_back(weight_between(i));
        weights.push_back(weight_at_lens());
        for (std::size_t i = 0; i < n; ++i) weights.push_back(weight_of_merge(i));
        return weights;
    }

  private:
    [[nodiscard]] bool has_light() const { return path_.end.light != kNone; }
    [[nodiscard]] bool at_infinity() const { return mis_.world.lights().is_at_infinity(path_.end.light); }
    [[nodiscard]] bool can_be_hit() const { return mis_.world.lights().can_be_hit(path_.end.light); }
    [[nodiscard]] std::size_t last() const { return path_.inner.size() - 1; }

    /// From vertex `i` towards the eye, unit.
    [[nodiscard]] Vec3f to_eye(std::size_t i) const {
        const Vec3f next = i < last() ? path_.inner[i + 1]->position : path_.camera.lens;
        return normalize(next - path_.inner[i]->position);
    }
    /// And towards the light.
    [[nodiscard]] Vec3f to_light(std::size_t i) const { return i > 0 ? -to_eye(i - 1) : -path_.end.direction; }
    /// m², between vertices `i` and `i + 1`.
    [[nodiscard]] double squared_distance(std::size_t i) const {
        return static_cast<double>(length_squared(path_.inner[i + 1]->position - path_.inner[i]->position));
    }

    /// True if the strategy that made the path has vertex `i` from the light.
    [[nodiscard]] bool is_from_light(std::size_t i) const { return i + 1 < path_.s; }
    /// True if the path goes on by a delta. Ends of subpaths were left for elsewhere.
    [[nodiscard]] bool is_delta(std::size_t i) const {
        const bool is_end = path_.s > 0 && (i + 1 == path_.s || i + 2 == path_.s);
        return path_.inner[i]->is_left_by_delta && !is_end;
    }
    [[nodiscard]] bool scatters_freely(std::size_t i) const { return path_.inner[i]->has_non_delta() && !is_delta(i); }
    /// True if no hidden boundary lies between vertices `i - 1` and `i`; 0 is that on the light, then, and the last one
    /// is followed by that on the lens.
    [[nodiscard]] bool is_direct(std::size_t i) const {
        if (i < path_.inner.size() && is_from_light(i)) return path_.inner[i]->is_reached_directly;
        if (i + 1 == path_.s) return true;
        return i > 0 ? path_.inner[i - 1]->is_reached_directly : path_.end.is_reached_directly;
    }

    /// Vertex `i` for a walk that arrives from `wo`.
    [[nodiscard]] WalkedVertex seen_from(std::size_t i, const Vec3f& wo) const {
        WalkedVertex vertex = *path_.inner[i];
        vertex.wo = wo;
        return vertex;
    }
    /// Scatters at `vertex`, which is vertex `i`, along `w`; `delta_ratio` is for the walk that made the path.
    void scatter_along(Side& side, std::size_t i, const WalkedVertex& vertex, const Vec3f& w, TransportMode mode) {
        const Value value = vertex.evaluate_both_ways(w, mode);
        const float ratio = vertex.delta_reverse_ratio;
        const bool is_its_way = is_from_light(i) == (mode == TransportMode::Importance);
        side.vertices[i] = vertex;
        side.values[i] = value;
        side.departing[i] = is_delta(i) ? depart_by_delta(mis_.raised, vertex.densities,
                                                          is_its_way ? ratio : 1.0f / ratio, vertex.cosine(w))
                                        : depart(mis_.raised, vertex.densities, value.pdf_solid_angle,
                                                 value.reverse_pdf_solid_angle, vertex.cosine(w));
        side.departing[i].is_in_dense = vertex.is_in_dense();
    }
    void resize(Side& side) const {
        side.vertices.resize(path_.inner.size());
        side.values.resize(path_.inner.size());
        side.departing.resize(path_.inner.size());
        side.merges.resize(path_.inner.size());
    }

    void walk_from_light() {
        resize(light_);
        bool is_after_delta = false;
        for (std::size_t i = 0; i <= last(); ++i) {
            WalkedVertex vertex = seen_from(i, to_light(i));
            const auto cosine = static_cast<double>(vertex.cosine(vertex.wo));
            const Emission emission = i == 0 ? this->emission() : Emission{};
            DepartingDensities departing = i == 0 ? leave_light(mis_, emission) : light_.departing[i - 1];
            if (!is_direct(i)) departing.pass_hidden();
            is_after_delta = is_after_delta || !is_direct(i);
            vertex.densities =
                i == 0 ? arrive_from_light(mis_, emission, departing, vertex.position, cosine)
                       : departing.arrive(mis_.raised, squared_distance(i - 1), cosine, vertex.is_in_dense());
            vertex.is_after_delta = is_after_delta;
            light_.merges[i] = merges({.end = SubpathEnd::AtLight, .is_after_delta = is_after_delta}, i, vertex);
            is_after_delta = is_after_delta || is_delta(i);
            scatter_along(light_, i, vertex, to_eye(i), TransportMode::Importance);
        }
    }
    void walk_from_eye() {
        resize(eye_);
        bool only_deltas = true;
        for (std::size_t i = last() + 1; i-- > 0;) {
            WalkedVertex vertex = seen_from(i, to_eye(i));
            const auto cosine = static_cast<double>(vertex.cosine(vertex.wo));
            DepartingDensities departing = i == last() ? DepartingDensities() : eye_.departing[i + 1];
            if (!is_direct(i + 1)) departing.pass_hidden();
            vertex.densities = i == last()
                                   ? arrive_from_lens(mis_, departing, path_.camera, cosine)
                                   : departing.arrive(mis_.raised, squared_distance(i), cosine, vertex.is_in_dense());
            eye_.merges[i] = merges({.end = SubpathEnd::AtEye,
                                     .index = static_cast<int>(last() - i) + kDirectlySeen,
                                     .only_deltas = only_deltas,
                                     .is_direct = is_direct(i + 1)},
                                    i, vertex);
            only_deltas = only_deltas && is_delta(i);
            scatter_along(eye_, i, vertex, to_light(i), TransportMode::Radiance);
        }
    }

    /// Has `vertex`, which is vertex `i`, merge if it may.
    [[nodiscard]] bool merges(const ArrivalForMerging& arrival, std::size_t i, WalkedVertex& vertex) const {
        if (!scatters_freely(i) || !vertex.is_on_surface() || !merges_at(mis_.merging.at, arrival)) return false;
        vertex.merging = merge_place(mis_.world, vertex.hit, *vertex.surface.material);
        count_merge(mis_, arrival.end, vertex.position, vertex.merging.opacity, vertex.densities);
        return true;
    }

    [[nodiscard]] EmittedRay emitted() const { return emitted_ray(mis_.world, path_); }
    /// Returns the emission that LightEmitter::sample would have made.
    [[nodiscard]] Emission emission() const {
        const World& world = mis_.world;
        const PathLightEnd& end = path_.end;
        const float pdf = world.emitters().pdf(emitted(), mis_.aims);
        Emission emission;
        emission.light = end.light;
        emission.ray.time = end.time;
        emission.probability = world.emitters().probability(end.light);
        emission.sample.triangle = end.triangle;
        emission.sample.position = end.position;
        emission.sample.direction = end.direction;
        emission.sample.cos_theta = std::abs(end.cos_light);
        if (at_infinity()) {
            emission.sample.pdf_position_area = pdf;
            if (can_be_hit())
                emission.sample.pdf_direction_solid_angle =
                    world.environment().emission_pdf_solid_angle(end.light, -end.direction);
        } else {
            emission.sample.pdf_direction_solid_angle = pdf;
            if (can_be_hit())
                emission.sample.pdf_position_area = world.emitters().pdf_area(end.light, end.position, end.time);
        }
        return emission;
    }
    /// Returns the light sample that LightSampler::sample would have made for vertex 0.
    [[nodiscard]] ChosenLight chosen() const {
        const World& world = mis_.world;
        const PathLightEnd& end = path_.end;
        const Vec3f& position = path_.inner.front()->position;
        ChosenLight chosen;
        chosen.expected_samples = world.lights().probability(position, end.light);
        chosen.light = end.light;
        chosen.time = end.time;
        chosen.sample.wi = -end.direction;
        chosen.sample.cos_light = end.cos_light;
        chosen.sample.triangle = end.triangle;
        chosen.sample.is_delta = !can_be_hit();
        if (at_infinity()) {
            chosen.sample.pdf_solid_angle =
                chosen.expected_samples * world.environment().pdf_solid_angle(end.light, chosen.sample.wi);
            return chosen;
        }
        const float squared = length_squared(end.position - position);
        chosen.sample.distance = std::sqrt(squared);
        if (can_be_hit())
            chosen.sample.pdf_solid_angle =
                chosen.expected_samples * world.emitters().pdf_area(end.light, end.position, end.time) *
                world.lights().gain(end.light, end.triangle, end.position, position, end.time) * squared /
                std::abs(end.cos_light);
        return chosen;
    }

    [[nodiscard]] double weight_at_light() const {
        if (!can_be_hit()) return 0.0;
        const Vec3f& from = path_.inner.front()->position;
        const Vec3f direction = -path_.end.direction;
        DepartingDensities departing = eye_.departing.front();
        if (!is_direct(0)) departing.pass_hidden();
        if (at_infinity()) return sums_from_afar(mis_, from, path_.end.light, direction, departing).weight();
        const SubpathDensities arrived =
            departing.arrive(mis_.raised, static_cast<double>(length_squared(path_.end.position - from)),
                             std::abs(static_cast<double>(path_.end.cos_light)));
        return sums_at_emitter(mis_, from, emitted(), arrived).weight();
    }
    [[nodiscard]] double weight_of_light_sample() const {
        if (!mis_.world.traits().has_sampled_lights || !scatters_freely(0) || !is_direct(0)) return 0.0;
        const ChosenLight light = chosen();
        if (!(light.expected_samples > 0.0f)) return 0.0;
        return sums_of_light_sample(mis_, eye_.vertices.front(), light, eye_.values.front()).weight();
    }
    /// With vertices up to `i` from the light.
    [[nodiscard]] double weight_between(std::size_t i) const {
        if (!scatters_freely(i) || !scatters_freely(i + 1) || !is_direct(i + 1)) return 0.0;
        if (path_.inner[i]->is_in_dense() && path_.inner[i + 1]->is_in_dense()) return 0.0;
        return sums_between(mis_.raised, eye_.vertices[i + 1], light_.vertices[i], to_light(i + 1),
                            static_cast<float>(squared_distance(i)), eye_.values[i + 1], light_.values[i])
            .weight();
    }
    [[nodiscard]] double weight_at_lens() const {
        if (!scatters_freely(last()) || !is_direct(last() + 1)) return 0.0;
        return sums_at_lens(mis_, light_.vertices.back(), to_eye(last()), path_.camera, light_.values.back()).weight();
    }

    [[nodiscard]] double weight_of_merge(std::size_t i) const {
        if (!light_.merges[i] || !eye_.merges[i]) return 0.0;
        const Value& value = eye_.values[i];
        const double fewer = light_.vertices[i].densities.fewer_without_own_merge(
                                 mis_.raised, static_cast<double>(value.pdf_solid_angle)) +
                             eye_.vertices[i].densities.fewer_without_own_merge(
                                 mis_.raised, static_cast<double>(value.reverse_pdf_solid_angle));
        const double expected = mis_.merging.expected(path_.inner[i]->position, eye_.vertices[i].merging.opacity);
        return 1.0 / (1.0 + fewer / mis_.raised(expected));
    }

    const MisContext& mis_;
    const CompletePath& path_;
    Side light_;
    Side eye_;
};

}  // namespace

std::vector<double> recursive_weights(const MisContext& mis, const CompletePath& path) {
    return GivenPath(mis, path).weights();
}

}  // namespace etendue::test
