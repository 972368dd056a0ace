#include "integrator/path/glossy_lanes.h"

namespace etendue {

namespace {

/// Calls `move` with each pair of columns of one number, of which both are part.
template <typename Move, typename A, typename B>
void for_vector(const Move& move, A& a, B& b) {
    move(a.x, b.x);
    move(a.y, b.y);
    move(a.z, b.z);
}
template <typename Move, typename A, typename B>
void for_color(const Move& move, A& a, B& b) {
    move(a.r, b.r);
    move(a.g, b.g);
    move(a.b, b.b);
}

/// Calls `move(l, which, place)` for the lanes from `l` on of each group that has paths on gloss, `which`, to whom the
/// places from `place` on belong where they stand side by side.
template <typename Move>
void for_each_glossy_group(const BlockLanes& lanes, std::size_t paths, const Move& move) {
    std::size_t place = 0;
    for (std::size_t l = 0; l < paths; l += Wide::kWidth) {
        const WideMask which = lanes.is_glossy.load(l) != Wide(0.0f);
        const std::size_t lanes_here = count(which);
        if (lanes_here == 0) continue;
        move(l, which, place);
        place += lanes_here;
    }
}

}  // namespace

void GlossyLanes::take(const BlockLanes& lanes, std::size_t paths, const NumberPairs& choices,
                       const NumberPairs& directions, bool lights_only) {
    for_each_glossy_group(lanes, paths, [&](std::size_t l, WideMask which, std::size_t to) {
        const auto put = [&](Column& column, Wide values) { column.store_unaligned(to, compress(values, which)); };
        const auto move = [&](const etendue::Column& from, Column& column) { put(column, from.load(l)); };
        for_vector(move, lanes.light_wi, light_wi);
        if (lights_only) return;
        for_vector(move, lanes.tangent, tangent);
        for_vector(move, lanes.bitangent, bitangent);
        for_vector(move, lanes.normal, normal);
        for_vector(move, lanes.geometric_normal, geometric_normal);
        for_vector(move, lanes.wo, wo);
        put(u_lobe, choices.load(l).x);
        const Imath::Vec2<Wide> direction = directions.load(l);
        put(u_bsdf.x, direction.x);
        put(u_bsdf.y, direction.y);
    });
}

void GlossyLanes::give(BlockLanes& lanes, std::size_t paths, bool with_samples) const {
    for_each_glossy_group(lanes, paths, [&](std::size_t l, WideMask which, std::size_t from) {
        const auto move = [&](const Column& column, etendue::Column& to) {
            to.store(l, expand(column.load_unaligned(from), which, to.load(l)));
        };
        for_color(move, f_cos, lanes.f_cos);
        move(pdf, lanes.pdf);
        if (!with_samples) return;
        for_vector(move, next_direction, lanes.next_direction);
        for_color(move, next_weight, lanes.next_weight);
        move(next_pdf, lanes.next_pdf);
    });
}

void GlossyLanes::evaluate(std::size_t count) {
    for (std::size_t l = 0; l < count; l += Wide::kWidth) {
        const OrientedSurface<Wide> oriented = surface(l);
        const BasicBsdfValue<Wide> value =
            lobe(l).evaluate(oriented.leaning, oriented.seen_from(), oriented.frame.to_local(light_wi.load(l)));
        f_cos.store(l, value.f_cos);
        pdf.store(l, value.pdf_solid_angle);
    }
}

void GlossyLanes::evaluate_and_sample(std::size_t count) {
    for (std::size_t l = 0; l < count; l += Wide::kWidth) {
        const OrientedSurface<Wide> oriented = surface(l);
        const auto [value, sample] =
            lobe(l).evaluate_and_sample(oriented.leaning, oriented.seen_from(),
                                        oriented.frame.to_local(light_wi.load(l)), u_lobe.load(l), u_bsdf.load(l));
        f_cos.store(l, value.f_cos);
        pdf.store(l, value.pdf_solid_angle);
        next_direction.store(l, oriented.frame.to_world(sample.wi));
        next_weight.store(l, sample.weight);
        next_pdf.store(l, sample.pdf_solid_angle);
    }
}

}  // namespace etendue
