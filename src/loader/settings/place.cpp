#include "loader/settings/place.h"

#include "loader/gltf/gltf_transform.h"
#include "loader/settings/render_json.h"
#include "scene/transform.h"

#include <string_view>

namespace etendue {

namespace {

/// Finds an up that is not parallel to where the thing looks, unless the document says which it is.
void check_view(Place& place, JsonObject& object) {
    const Vec3d towards = *place.look_at - *place.position;
    if (!(towards.length() > 0.0)) {
        object.problems().error(object.at("look_at"), "must differ from position");
        return;
    }
    constexpr double kParallel = 1e-6;
    const auto is_parallel = [&](const Vec3f& up) {
        const Vec3d across = Vec3d(up).cross(towards);
        return !(across.length() > kParallel * Vec3d(up).length() * towards.length());
    };
    if (object.has("up")) {
        if (is_parallel(place.up))
            object.problems().error(object.at("up"), "must not be zero or parallel to the viewing direction");
    } else if (is_parallel(place.up)) {
        place.up = {0.0f, 0.0f, -1.0f};
    }
}

}  // namespace

void read_place(JsonObject& object, Place& place) {
    object.text("node", place.node);
    // Where a position is wrong, that is the one thing to say: nobody is to look for a node in its place.
    Vec3d position(0.0);
    const bool has_position = object.vector("position", position);
    if (object.has("position")) place.position = position;
    if (Vec3d look_at; object.vector("look_at", look_at) && (has_position || !place.position)) place.look_at = look_at;
    object.vector("up", place.up);
    if (object.quaternion("rotation", place.rotation) && !rotation_matrix(place.rotation))
        object.problems().error(object.at("rotation"), "must not be zero");
    const auto refuse = [&](std::string_view key, std::string_view why) {
        if (object.has(key)) object.problems().error(object.at(key), std::string(why));
    };
    if (object.has("node")) refuse("position", "the node says where it is: leave one of both out");
    if (object.has("look_at")) refuse("rotation", "look_at says the same: leave one of both out");
    for (const std::string_view key : {"rotation", "look_at", "up"})
        if (!object.has("position")) refuse(key, "needs a position");
    if (!object.has("look_at")) refuse("up", "needs a look_at");
    if (place.position && place.look_at) check_view(place, object);
}

Mat4f placed(const Place& place, const Vec3d& origin) {
    if (place.look_at) {
        CameraDesc view;
        aim({.position = *place.position, .look_at = *place.look_at, .up = place.up}, origin, view);
        return view.to_world;
    }
    Mat4f to_world = to_float(rotation_matrix(place.rotation).value_or(Mat4d()));
    const Vec3f position(*place.position - origin);
    for (int i = 0; i < 3; ++i) to_world[3][i] = position[i];
    return to_world;
}

}  // namespace etendue
