#include "integrator/path/path_places.h"

#include "core/in_place.h"
#include "transport/bodies.h"
#include "transport/shadow_catcher.h"
#include "wave/one_kind_tracer.h"
#include "world/section_ellipse.h"

#include <cmath>
#include <optional>

namespace etendue {

void TexturedLanes::set_up(const BlockLanes& surfaces, std::size_t count) {
    for (std::size_t l = 0; l < count; l += Wide::kWidth) {
        const Imath::Vec2<Wide> barycentric = surfaces.u.load(l);
        const Imath::Vec2<Wide> first = uv_edge1.load(l);
        const Imath::Vec2<Wide> second = uv_edge2.load(l);
        const Imath::Vec2<Wide> origin = uv0.load(l);
        uv.store(l, {origin.x + first.x * barycentric.x + second.x * barycentric.y,
                     origin.y + first.y * barycentric.x + second.y * barycentric.y});
        const Imath::Vec3<Wide> normal = surfaces.geometric_normal.load(l);
        const Imath::Vec3<Wide> wo = surfaces.wo.load(l);
        const SectionEllipse<Wide> section({-wo.x, -wo.y, -wo.z}, width.load(l), normal);
        const TextureEllipse<Wide> ellipse(section, surfaces.edge1.load(l), surfaces.edge2.load(l), normal, first,
                                           second);
        along.store(l, ellipse.along);
        across.store(l, ellipse.across);
    }
}

void PathPlaces::set_up(const PathContext& context) {
    const World& world = context.world;
    for (LaneList* list : {&block_.escaped, &block_.on_emitter, &block_.on_hidden, &block_.on_surface}) list->clear();
    LaneList leads_on;
    for (std::size_t k = 0; k < block_.count; ++k) {
        const bool has_end = paths_.hits[block_.first + k].has_end();
        leads_on.add_if(has_end, k);
        block_.escaped.add_if(!has_end, k);
    }
    for (const std::size_t k : leads_on) {
        const std::size_t i = block_.first + k;
        if (world.traits().has_bodies && scattering_.scatter_in_medium(context, k)) {
            block_.lanes.goes_on.set(k, 1.0f);
            continue;
        }
        if (world.traits().replaces_surfaces && path_history::is_seen(paths_.history[i]) &&
            world.materials().is_replaced(paths_.hits[i]))
            replace_surface(context, i);
        if (!paths_.hits[i].valid()) {
            block_.escaped.add(k);
            continue;
        }
        const PlainSurface* const plain = block_.paths[k].plain =
            context.settings.even_directions ? nullptr : world.materials().plain_surface(paths_.hits[i]);
        if (plain == nullptr && !set_up_any(context, k)) continue;
        if (paths_.edges(i) < context.settings.lengths.max_depth ||
            (plain == nullptr && block_.singles[k].point.material->is_clear))
            block_.on_surface.add(k);
        else
            paths_.end_path(context, block_.first + k, PathEnding::TooLong);
    }
    for (const std::size_t k : block_.escaped) paths_.end_path(context, block_.first + k, PathEnding::Escaped);
}

void PathPlaces::replace_surface(const PathContext& context, std::size_t i) {
    const World& world = context.world;
    const Interior interior = world.traits().has_bodies ? paths_.interiors[i] : Interior();
    const SeenInPlace seen = trace_seen_in_place(world, context.job, paths_.ray(i), interior, paths_.hits[i],
                                                 paths_.key(i), paths_.slot[i], light_.found, context.counters);
    if (seen.is_hole) light_.alpha[paths_.slot[i]] = alpha_over_background(paths_.throughput[i]);
    paths_.throughput.set(i, paths_.throughput[i] * seen.passed);
    paths_.hits[i] = {};
}

bool PathPlaces::set_up_any(const PathContext& context, std::size_t k) {
    const World& world = context.world;
    const std::size_t i = block_.first + k;
    set_up_singly(context, k);
    SurfacePoint& point = block_.singles[k].point;
    if (world.traits().has_bodies)
        block_.singles[k].crossing =
            crossing_at(world, point, {paths_.ray(i), paths_.interiors[i], paths_.hits[i], paths_.cone(i)});
    if (point.material->is_clear) block_.clear[k] = {paths_.receiver(i), paths_.metres_passed(i) + paths_.hits[i].t};
    block_.on_emitter.add_if(point.material->emits, k);
    if (block_.singles[k].crossing && block_.singles[k].crossing->is_covered) {
        block_.on_hidden.add(k);
        block_.lanes.goes_on.set(k, 1.0f);
        return false;
    }
    if (!point.material->unlit) return true;
    // Only what the eye sees directly or in mirrors shows an unlit surface; it lights nothing.
    if (paths_.is(path_history::kOnlyDeltas, i) && context.settings.lengths.is_long_enough(paths_.edges(i)))
        light_.add(i, world.materials().unlit_color(point), paths_.words.surface_source(point));
    paths_.end_path(context, block_.first + k, PathEnding::Unlit);
    return false;
}

void PathPlaces::set_up_singly(const PathContext& context, std::size_t k) {
    const std::size_t i = block_.first + k;
    block_.paths[k].plain = nullptr;
    make_in_place(block_.singles[k].point, [&] {
        return context.world.geometry().surface_point(paths_.hits[i], paths_.ray(i), paths_.cone(i));
    });
    block_.singles[k].crossing.reset();
}

void PathPlaces::set_up_plain(const PathContext& context) {
    const World& world = context.world;
    bool any = false;
    block_.on_texture.clear();
    for (std::size_t l = 0; l < block_.count; l += Wide::kWidth) {
        const Imath::Vec3<Wide> direction = paths_.direction.load(block_.first + l);
        block_.lanes.wo.store(l, {-direction.x, -direction.y, -direction.z});
    }
    for (const std::size_t k : block_.on_surface) {
        const PlainSurface* const plain = block_.paths[k].plain;
        if (plain == nullptr) continue;
        any = true;
        const Hit& hit = paths_.hits[block_.first + k];
        block_.lanes.set_hit(k, world.geometry().hit_triangle(hit), {hit.u, hit.v});
        if (paths_.words.are_followed()) block_.singles[k].point.material = world.materials().at(hit);
        block_.on_texture.add_if(plain->textured != nullptr, k);
    }
    if (any) block_.lanes.set_up_points(block_.count);
    if (block_.on_texture.empty()) return;
    for (const std::size_t k : block_.on_texture) {
        const Hit& hit = paths_.hits[block_.first + k];
        textured_.set_hit(k, world.geometry().hit_coordinates(hit, *block_.paths[k].plain),
                          std::abs(paths_.cone(block_.first + k).width_at(hit.t)));
    }
    textured_.set_up(block_.lanes, block_.count);
}

void PathPlaces::look_up_textures(const PathContext& context) {
    if (block_.on_texture.empty()) return;
    const World& world = context.world;
    lookups_.clear();
    for (const std::size_t k : block_.on_texture)
        world.materials().add_lookups(*block_.paths[k].plain, textured_.uv[k], textured_.footprint(k), lookups_);
    lookups_.finish();
    for (const std::size_t k : block_.on_texture) {
        textured_lobes_[k] = world.materials().lobe(*block_.paths[k].plain, lookups_);
        if (!textured_lobes_[k].is_plain()) set_up_singly(context, k);
    }
}

void PathPlaces::make_scattering(const PathContext& context) {
    const bool samples_lights = context.samples_lights() && context.world.traits().has_sampled_lights;
    block_.on_gloss.clear();
    block_.sampling.clear();
    for (const std::size_t k : block_.on_surface) {
        ShadedPath& path = block_.paths[k];
        block_.set_wide(k, path.plain != nullptr);
        if (path.is_wide) {
            const PlainSurface& plain = *path.plain;
            path.glossy = plain.textured != nullptr ? &textured_lobes_[k] : plain.untextured_lobe();
            block_.lanes.albedo.set(k, plain.albedo);
            if (path.glossy != nullptr && paths_.words.are_followed()) make_wide_scattering(k);
        } else {
            make_scattering_singly(context, k);
        }
        block_.lanes.is_glossy.set(k, path.glossy != nullptr ? 1.0f : 0.0f);
        block_.on_gloss.add_if(path.glossy != nullptr, k);
        block_.sampling.add_if(samples_lights && context.settings.lengths.keeps(paths_.edges(block_.first + k) + 1) &&
                                   (path.is_wide || block_.singles[k].scattering->has_non_delta()),
                               k);
    }
}

void PathPlaces::make_wide_scattering(std::size_t k) {
    SingleShading& single = block_.singles[k];
    single.storage = *block_.paths[k].glossy;
    single.scattering.emplace(single.storage,
                              Frame{block_.lanes.tangent[k], block_.lanes.bitangent[k], block_.lanes.normal[k]},
                              block_.lanes.geometric_normal[k], block_.lanes.wo[k]);
}

void PathPlaces::make_scattering_singly(const PathContext& context, std::size_t k) {
    const World& world = context.world;
    const std::size_t i = block_.first + k;
    ShadedPath& path = block_.paths[k];
    SingleShading& single = block_.singles[k];
    const SurfacePoint& point = single.point;
    const std::optional<Crossing>& crossing = single.crossing;
    const Vec3f wo = block_.lanes.wo[k];
    path.glossy = nullptr;
    block_.lanes.position.set(k, point.position);
    // Where the index depends on the wavelength, a path of all of them takes one to go on with.
    single.wavelength = {paths_.wavelength_nm[i], Rgb(1.0f)};
    single.chooses_wavelength = crossing && crossing->disperses() && paths_.wavelength_nm[i] == 0.0f;
    if (single.chooses_wavelength)
        single.wavelength = world.spectral_response().sample(
            sample_2d(context.job.sequence, paths_.key(i), body_dimension(context.rays, kWavelength)).x);
    const Bsdf& bsdf = world.materials().bsdf(point, wo, crossing ? crossing->relative_ior(single.wavelength.nm) : 0.0f,
                                              single.storage);
    const auto* diffuse = std::get_if<Diffuse>(&bsdf);
    // Lanes can only sample lobes, not directions uniformly.
    const bool takes_lanes = !context.settings.even_directions && !crossing;
    if (const auto* lobe = std::get_if<MetallicRoughness>(&bsdf); takes_lanes && lobe != nullptr && lobe->is_plain())
        path.glossy = lobe;
    block_.set_wide(k, path.glossy != nullptr || (takes_lanes && diffuse != nullptr));
    if (path.is_wide) {
        block_.lanes.geometric_normal.set(k, point.geometric_normal);
        block_.lanes.clearance.set(k, point.clearance);
        block_.lanes.tangent.set(k, point.shading.tangent);
        block_.lanes.bitangent.set(k, point.shading.bitangent);
        block_.lanes.normal.set(k, point.shading.normal);
        if (diffuse != nullptr) return block_.lanes.albedo.set(k, diffuse->albedo);
        if (!paths_.words.are_followed()) return;
    }
    single.scattering.emplace(bsdf, point.shading, point.geometric_normal, wo);
}

}  // namespace etendue
