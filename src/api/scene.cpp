#include "api/scene_state.h"
#include "loader/loader.h"
#include "picture/render_setup.h"
#include "picture/scene_completion.h"

#include <system_error>
#include <utility>

#include <etendue/scene.h>

namespace etendue {

namespace {

std::vector<Message> to_messages(const ProblemList& problems, const GivenSettings& given) {
    std::vector<Message> messages;
    for (const Problem& problem : problems.all()) messages.push_back(to_message(problem, given));
    return messages;
}

/// Where the loader looks for the settings of the scene at `path`.
std::string render_json_of(const std::filesystem::path& path) {
    std::error_code code;
    const std::filesystem::path parent = path.has_parent_path() ? path.parent_path() : ".";
    return ((std::filesystem::is_directory(path, code) ? path : parent) / "render.json").string();
}

}  // namespace

Scene::Scene(const std::filesystem::path& path, std::string_view settings, std::optional<int> frame)
    : state_(std::make_unique<State>()) {
    state_->given.text = settings;
    state_->given.render_json = render_json_of(path);
    translating(state_->given, [&] {
        LoadedScene loaded = load_scene(path, {.frame = frame, .settings = std::string(settings)});
        complete_scene(loaded.scene, loaded.swept, loaded.problems);
        state_->scene = std::move(loaded.scene);
        state_->messages = to_messages(loaded.problems, state_->given);
    });
}

Scene::~Scene() = default;
Scene::Scene(const Scene& other) : state_(std::make_unique<State>(*other.state_)) {}
Scene::Scene(Scene&& other) noexcept = default;

Scene& Scene::operator=(Scene other) noexcept {
    std::swap(state_, other.state_);
    return *this;
}

const std::string& Scene::name() const {
    return state_->scene.name;
}

int Scene::width() const {
    return make_render_options(state_->scene.settings).window.width();
}

int Scene::height() const {
    return make_render_options(state_->scene.settings).window.height();
}

std::span<const Message> Scene::messages() const {
    return state_->messages;
}

}  // namespace etendue
