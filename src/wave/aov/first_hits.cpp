#include "wave/aov/first_hits.h"

#include "transport/scattered_cone.h"
#include "wave/aov/aov_set.h"
#include "wave/aov/surface_albedo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace etendue {

namespace {

/// One surface, seen by one sample; what several values need is found once.
class FirstHit {
  public:
    FirstHit(const World& world, const TileJob& job, const CameraSample& sample, const Ray& ray, const Hit& hit)
        : world_(world),
          job_(job),
          sample_(sample),
          hit_(hit),
          wo_(-ray.direction),
          ray_(ray),
          point_(world.geometry().surface_point(
              hit, ray,
              world.traits().has_textures ? camera_cone(world, job.full_width, job.full_height, ray) : RayCone{})) {}

    void append(FirstHitValue value, std::vector<float>& to) {
        const auto put = [&](std::initializer_list<float> numbers) { to.insert(to.end(), numbers); };
        const auto put_rgb = [&](const Rgb& c) { put({c.r, c.g, c.b}); };
        const auto put_normal = [&](const Vec3f& n) {
            const Vec3f facing = dot(point_.geometric_normal, wo_) < 0.0f ? -n : n;
            put({facing.x, facing.y, facing.z});
        };
        switch (value) {
            case FirstHitValue::Depth:
                return put({world_.camera().depth(point_.position, ray_.time)});
            case FirstHitValue::Position: {
                Vec3f position = point_.position;
                if (world_.origin() != Vec3d(0.0)) position = Vec3f(Vec3d(position) + world_.origin());
                return put({position.x, position.y, position.z});
            }
            case FirstHitValue::Normal:
                return put_normal(point_.shading.normal);
            case FirstHitValue::GeometricNormal:
                return put_normal(point_.geometric_normal);
            case FirstHitValue::Uv:
                return put({point_.uv[0].x, point_.uv[0].y});
            case FirstHitValue::Albedo:
                return put_rgb(albedo().diffuse + albedo().specular);
            case FirstHitValue::AlbedoDiffuse:
                return put_rgb(albedo().diffuse);
            case FirstHitValue::AlbedoSpecular:
                return put_rgb(albedo().specular);
            case FirstHitValue::ObjectId:
                return put({static_cast<float>(hit_.instance + 1)});
            case FirstHitValue::MaterialId:
                return put({static_cast<float>(world_.materials().index(point_) + 1)});
            case FirstHitValue::Motion: {
                // What is behind the camera then has no place on the film.
                const std::optional<Vec2f> first = position_on_film(0.0f);
                const std::optional<Vec2f> last = position_on_film(1.0f);
                const Vec2f way = first && last ? way_on_film(*first, *last) : Vec2f(0.0f, 0.0f);
                return put({way.x, way.y});
            }
            case FirstHitValue::Mist:
                // The film's sums begin at the value of what is behind all surfaces.
                return put({mist() - first_hit_entry(value).background});
            case FirstHitValue::Vector: {
                const std::optional<Vec2f> first = position_on_film(0.0f);
                const std::optional<Vec2f> middle = position_on_film(0.5f);
                const std::optional<Vec2f> last = position_on_film(1.0f);
                const float frames = job_.aovs->frames_of_shutter;
                if (!first || !middle || !last || !(frames > 0.0f)) return put({0.0f, 0.0f, 0.0f, 0.0f});
                // From half of the shutter's time to a frame; Blender's y is up.
                const Vec2f scale(2.0f / frames, -2.0f / frames);
                const Vec2f before = way_on_film(*middle, *first) * scale;
                const Vec2f after = way_on_film(*last, *middle) * scale;
                return put({before.x, before.y, after.x, after.y});
            }
        }
    }

  private:
    /// Returns the place of this point of the surface at another time, pixels from the corner of the full image,
    /// wherever the camera's depths and film end; none behind the camera.
    [[nodiscard]] std::optional<Vec2f> position_on_film(float time) const {
        Hit then = hit_;
        then.time = time;
        const std::optional<Vec2f> film = world_.camera().project(world_.geometry().surface_point(then).position, time);
        if (!film) return std::nullopt;
        return Vec2f(film->x * static_cast<float>(job_.full_width), film->y * static_cast<float>(job_.full_height));
    }

    /// Returns the way from `first` to `last`, the shorter one around if the film goes on beyond its sides.
    [[nodiscard]] Vec2f way_on_film(const Vec2f& first, const Vec2f& last) const {
        Vec2f way = last - first;
        const auto width = static_cast<float>(job_.full_width);
        if (world_.traits().film_wraps) way.x -= width * std::round(way.x / width);
        return way;
    }

    /// Returns the metres from the camera to the surface; the ray begins at its near plane.
    [[nodiscard]] float distance() const {
        const float depth = world_.camera().depth(point_.position, ray_.time);
        const float on_ray = depth - world_.camera().depth(ray_.origin, ray_.time);
        return on_ray > 0.0f ? hit_.t * depth / on_ray : hit_.t;
    }
    /// Returns the share of the surface that mist hides.
    [[nodiscard]] float mist() const {
        const MistSettings& mist = job_.aovs->mist;
        const float share = std::clamp((distance() - mist.start) / mist.depth, 0.0f, 1.0f);
        switch (mist.falloff) {
            case MistFalloff::Quadratic:
                return share * share;
            case MistFalloff::Linear:
                return share;
            case MistFalloff::InverseQuadratic:
                return std::sqrt(share);
        }
        return share;
    }

    const SurfaceAlbedo& albedo() {
        if (!albedo_) albedo_ = surface_albedo(world_, point_, ray_, hit_, {job_.sequence, sample_.key});
        return *albedo_;
    }

    const World& world_;
    const TileJob& job_;
    const CameraSample& sample_;
    const Hit& hit_;
    Vec3f wo_;
    const Ray& ray_;
    SurfacePoint point_;
    std::optional<SurfaceAlbedo> albedo_;
};

void find_ids(const World& world, const AovSet& aovs, const Hit& hit, std::span<std::uint32_t> ids) {
    for (std::size_t m = 0; m < aovs.mattes.size(); ++m) {
        const MatteIds& matte = aovs.mattes[m];
        ids[m] = matte.ids[matte.by_material ? world.materials().index(hit) : hit.instance];
    }
}

}  // namespace

void find_first_hits(const World& world, const TileJob& job, std::span<const CameraSample> samples,
                     std::span<const Ray> rays, std::span<const Hit> hits, TileBuffer& tile) {
    if (job.aovs == nullptr || !job.aovs->needs_first_hits()) return;
    const AovSet& aovs = *job.aovs;
    WaveHits& found = tile.wave_hits();
    // Behind the values of first hits are those of buckets, which know nothing of surfaces.
    found.reset(aovs.layout, aovs.layout.values - aovs.buckets.value_count(), samples.size());
    std::vector<float> values;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (!hits[i].valid()) continue;
        found.set_distance(i, hits[i].t);
        if (aovs.layout.is_deep)
            found.depth(i) = world.camera().depth(rays[i].origin + rays[i].direction * hits[i].t, rays[i].time);
        find_ids(world, aovs, hits[i], found.ids(i));
        if (aovs.values.empty() && aovs.nearest.empty()) continue;
        FirstHit hit(world, job, samples[i], rays[i], hits[i]);
        values.clear();
        for (const FirstHitValue value : aovs.values) hit.append(value, values);
        for (const FirstHitValue value : aovs.nearest) hit.append(value, values);
        std::ranges::copy(values, found.values(i).begin());
    }
}

}  // namespace etendue
