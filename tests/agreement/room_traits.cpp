#include "agreement/room_traits.h"

#include <cstddef>

#include <fmt/format.h>

namespace etendue::test {

namespace {

constexpr std::string_view kIntegrators[] = {"naive", "path", "light", "bdpt", "vcm"};

constexpr RoomLight kLights[] = {RoomLight::Area,        RoomLight::Point,       RoomLight::Spot,
                                 RoomLight::Directional, RoomLight::Environment, RoomLight::Mesh};
constexpr BodyMaterial kMaterials[] = {BodyMaterial::Diffuse, BodyMaterial::Glossy, BodyMaterial::Conductor,
                                       BodyMaterial::Dielectric, BodyMaterial::RoughDielectric};
constexpr BodyNormals kNormals[] = {BodyNormals::Flat, BodyNormals::Smooth, BodyNormals::Mapped,
                                    BodyNormals::NegativeScale};
constexpr RoomCamera kCameras[] = {RoomCamera::Pinhole, RoomCamera::ThinLens, RoomCamera::Orthographic};
constexpr RoomMedium kMedia[] = {RoomMedium::Absorbing, RoomMedium::Scattering};
constexpr MediumPlace kPlaces[] = {MediumPlace::CameraIn, MediumPlace::LightIn, MediumPlace::BothIn,
                                   MediumPlace::Between};

template <typename Enum, std::size_t N>
std::string_view name_in(const std::string_view (&names)[N], Enum value) {
    return names[static_cast<std::size_t>(value)];
}

bool camera_is_in(MediumPlace place) {
    return place == MediumPlace::CameraIn || place == MediumPlace::BothIn;
}

bool light_is_in(MediumPlace place) {
    return place == MediumPlace::LightIn || place == MediumPlace::BothIn;
}

/// Seen by each camera, whole and cropped.
void add_views(RoomTraits room, std::vector<RoomTraits>& rooms) {
    for (const RoomCamera camera : kCameras) {
        for (const bool cropped : {false, true}) {
            room.camera = camera;
            room.cropped = cropped;
            rooms.push_back(room);
        }
    }
}

void add_media_rooms(std::vector<RoomTraits>& rooms) {
    for (const RoomLight light : {RoomLight::Area, RoomLight::Point, RoomLight::Environment})
        for (const RoomMedium medium : kMedia)
            for (const MediumPlace place : kPlaces)
                for (const RoomCamera camera : {RoomCamera::Pinhole, RoomCamera::Orthographic}) {
                    // What is infinitely far away is in no body.
                    if (light == RoomLight::Environment && light_is_in(place)) continue;
                    // Light paths through the cloud come to the ball from everywhere: leaning normals would make a few
                    // of their splats very bright.
                    const BodyNormals normals = place == MediumPlace::Between ? BodyNormals::Flat : BodyNormals::Smooth;
                    rooms.push_back(
                        {.light = light, .normals = normals, .camera = camera, .medium = medium, .place = place});
                }
}

}  // namespace

bool RoomTraits::has_delta_light() const {
    return light == RoomLight::Point || light == RoomLight::Spot || light == RoomLight::Directional;
}

bool RoomTraits::has_smooth_body() const {
    return material == BodyMaterial::Dielectric || material == BodyMaterial::Mirror || medium == RoomMedium::Clear;
}

bool RoomTraits::body_is_seen() const {
    // Nor do light paths find what a pane reflects to the eye.
    return (!has_smooth_body() || (!cropped && !has_delta_light())) && material != BodyMaterial::Pane;
}

std::string_view name_of(RoomLight light) {
    return name_in({"area", "point", "spot", "directional", "environment", "mesh", "visible environment"}, light);
}

std::string_view name_of(BodyMaterial material) {
    return name_in({"diffuse", "glossy", "conductor", "dielectric", "rough dielectric", "mirror", "pane"}, material);
}

std::string_view name_of(BodyNormals normals) {
    return name_in({"flat", "smooth", "mapped", "negative scale", "touching"}, normals);
}

std::string_view name_of(RoomCamera camera) {
    return name_in({"pinhole", "thin lens", "orthographic"}, camera);
}

std::string_view name_of(RoomMedium medium) {
    return name_in({"none", "absorbing", "scattering", "clear"}, medium);
}

std::string_view name_of(MediumPlace place) {
    return name_in({"camera in", "light in", "both in", "between"}, place);
}

std::string name_of(const RoomTraits& room) {
    const bool in_medium = room.medium != RoomMedium::None;
    return fmt::format("{}/{}/{}/{}/{}", name_of(room.light), in_medium ? name_of(room.medium) : name_of(room.material),
                       in_medium ? name_of(room.place) : name_of(room.normals), name_of(room.camera),
                       room.cropped ? "crop" : "whole");
}

std::vector<RoomTraits> all_rooms() {
    std::vector<RoomTraits> rooms;
    add_media_rooms(rooms);
    for (const RoomLight light : kLights)
        for (const BodyMaterial material : kMaterials)
            for (const BodyNormals normals : kNormals)
                add_views({.light = light, .material = material, .normals = normals}, rooms);
    for (const RoomLight light : {RoomLight::Area, RoomLight::Environment, RoomLight::Mesh})
        add_views({.light = light, .material = BodyMaterial::Mirror}, rooms);
    for (const BodyMaterial material : kMaterials)
        add_views({.light = RoomLight::VisibleEnvironment, .material = material}, rooms);
    for (const RoomCamera camera : kCameras)
        rooms.push_back({.light = RoomLight::Environment,
                         .camera = camera,
                         .medium = RoomMedium::Clear,
                         .place = MediumPlace::CameraIn});
    for (const RoomLight light : kLights) {
        for (const BodyMaterial material :
             {BodyMaterial::Diffuse, BodyMaterial::Glossy, BodyMaterial::Conductor, BodyMaterial::RoughDielectric})
            rooms.push_back({.light = light, .material = material, .normals = BodyNormals::Touching});
        for (const RoomCamera camera : kCameras)
            rooms.push_back(
                {.light = light, .material = BodyMaterial::Pane, .normals = BodyNormals::Flat, .camera = camera});
    }
    return rooms;
}

std::span<const std::string_view> matrix_integrators() {
    return kIntegrators;
}

std::string_view reason_of(Exclusion exclusion) {
    return name_in(
        {"", "eye paths cannot meet a point or a direction by chance",
         "light from a point or a direction by way of a smooth surface: eye paths cannot find its way back",
         "what the eye sees in or through a smooth surface cannot be connected to the camera",
         "the environment seen directly starts light paths, and no camera can be connected to what is infinitely far "
         "away",
         "light scatters right before the pinhole or the lens: the variance of connections to it is infinite",
         "light scatters right before a light of no extent: the variance of connections to it is infinite",
         "the eye sees nothing in or through a smooth surface: nothing merges, and `vcm` is `bdpt`"},
        exclusion);
}

Exclusion exclusion_of(const RoomTraits& room, std::string_view integrator) {
    if (integrator == "naive" && room.has_delta_light()) return Exclusion::LightCannotBeHit;
    if (integrator == "path" && room.has_delta_light() && room.has_smooth_body()) return Exclusion::CausticOfDeltaLight;
    if (integrator == "path" && room.medium == RoomMedium::Scattering && light_is_in(room.place) &&
        room.has_delta_light())
        return Exclusion::InfiniteVarianceAtLight;
    if (integrator == "vcm" && !(room.has_smooth_body() && room.body_is_seen())) return Exclusion::NothingMerges;
    if (integrator == "light") {
        if (room.has_smooth_body() && room.body_is_seen()) return Exclusion::SeenBySmoothSurface;
        if (room.light == RoomLight::VisibleEnvironment) return Exclusion::SeenEnvironment;
        if (room.medium == RoomMedium::Scattering && camera_is_in(room.place) &&
            room.camera != RoomCamera::Orthographic)
            return Exclusion::InfiniteVarianceAtCamera;
    }
    return Exclusion::None;
}

std::vector<std::string> finders_of(const RoomTraits& room) {
    std::vector<std::string> names;
    for (const std::string_view name : kIntegrators)
        if (exclusion_of(room, name) == Exclusion::None) names.emplace_back(name);
    return names;
}

}  // namespace etendue::test
