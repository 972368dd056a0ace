// The rooms of the matrix of agreement by their traits, and which integrators can find all light of one.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace etendue::test {

enum class RoomLight { Area, Point, Spot, Directional, Environment, Mesh, VisibleEnvironment };
enum class BodyMaterial { Diffuse, Glossy, Conductor, Dielectric, RoughDielectric, Mirror, Pane };
enum class BodyNormals { Flat, Smooth, Mapped, NegativeScale, Touching };
enum class RoomCamera { Pinhole, ThinLens, Orthographic };
enum class RoomMedium { None, Absorbing, Scattering, Clear };
enum class MediumPlace { CameraIn, LightIn, BothIn, Between };

struct RoomTraits {
    RoomLight light = RoomLight::Area;
    BodyMaterial material = BodyMaterial::Glossy;
    BodyNormals normals = BodyNormals::Smooth;  ///< Touching: a block that stands on the floor and against the wall
    RoomCamera camera = RoomCamera::Pinhole;
    bool cropped = false;
    RoomMedium medium = RoomMedium::None;
    MediumPlace place = MediumPlace::BothIn;  ///< without a meaning where there is no medium

    /// Of zero extent or from one direction: eye paths cannot meet it.
    [[nodiscard]] bool has_delta_light() const;
    /// The body's surface reflects and refracts in exact directions; so does that of a clear one around the room,
    /// which light crosses once.
    [[nodiscard]] bool has_smooth_body() const;
    /// Smooth bodies stand above the frame in crops, so that light paths find all there is, and under delta lights,
    /// whose light nothing finds by way of the body when it is seen by way of the body.
    [[nodiscard]] bool body_is_seen() const;
};

[[nodiscard]] std::string_view name_of(RoomLight light);
[[nodiscard]] std::string_view name_of(BodyMaterial material);
[[nodiscard]] std::string_view name_of(BodyNormals normals);
[[nodiscard]] std::string_view name_of(RoomCamera camera);
[[nodiscard]] std::string_view name_of(RoomMedium medium);
[[nodiscard]] std::string_view name_of(MediumPlace place);

/// "area/diffuse/flat/pinhole/whole", "point/scattering/light in/thin lens/crop".
[[nodiscard]] std::string name_of(const RoomTraits& room);

/// Every room of the matrix.
[[nodiscard]] std::vector<RoomTraits> all_rooms();

/// The integrators of the matrix, in the order in which pairs of them are named.
[[nodiscard]] std::span<const std::string_view> matrix_integrators();

/// Why an integrator does not find all light of a room, or not in finite time, or is another one there.
enum class Exclusion {
    None,
    LightCannotBeHit,
    CausticOfDeltaLight,
    SeenBySmoothSurface,
    SeenEnvironment,
    InfiniteVarianceAtCamera,
    InfiniteVarianceAtLight,
    NothingMerges
};
[[nodiscard]] std::string_view reason_of(Exclusion exclusion);

[[nodiscard]] Exclusion exclusion_of(const RoomTraits& room, std::string_view integrator);

/// Those of the matrix that find all light of the room.
[[nodiscard]] std::vector<std::string> finders_of(const RoomTraits& room);

}  // namespace etendue::test
