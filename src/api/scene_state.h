// What a Scene holds.
#pragma once

#include "api/translate.h"
#include "scene/scene_desc.h"

#include <vector>

#include <etendue/scene.h>

namespace etendue {

struct Scene::State {
    SceneDesc scene;  ///< complete and valid
    std::vector<Message> messages;
    GivenSettings given;
};

}  // namespace etendue
