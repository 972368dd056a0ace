#include "live/explorer.h"

#include "core/log.h"
#include "integrator/integrator.h"
#include "picture/integrator_choice.h"
#include "picture/scene_completion.h"
#include "processor/ray_code.h"
#include "render/render.h"
#include "render/tiles.h"
#include "session/usage_error.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr std::uint32_t kMostExplorerSpp = 1u << 16;
constexpr int kMostShrink = 8;
constexpr double kFrameSeconds =
    1.0 / 45.0;                        // of all images that are shown while the camera moves: leaves time to show
constexpr double kSliceSeconds = 0.2;  // of a pass, so that both images go on side by side

/// Returns true for what "Other options" of a page may change: no more can, once the world is compiled, and the
/// integrator has a field of its own.
bool may_be_chosen(const Setting& setting) {
    const bool is_of_samples = setting.group == SettingGroup::Transport || setting.group == SettingGroup::Samples;
    return is_of_samples && setting.decides == Decides::Samples && setting.pointer != "/integrator/type";
}

/// Gives `overrides` the options in `text`, "--max-depth 3 --unweighted".
std::vector<GivenOption> give_words(const std::string& text, SettingsOverrides& overrides) {
    std::vector<GivenOption> given;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        const std::size_t equals = word.find('=');
        GivenOption option{word.substr(0, equals), std::nullopt};
        const Setting* const setting = setting_of_option(option.name);
        if (setting == nullptr || !may_be_chosen(*setting))
            throw UsageError(
                fmt::format("'{}' is no option that can be changed here: --max-depth, --light-samples, "
                            "--strategy and others of light transport can, and --clamp-indirect and --seed",
                            option.name));
        const bool is_flag = std::holds_alternative<YesNo>(setting->type);
        if (equals != std::string::npos)
            option.value = word.substr(equals + 1);
        else if (std::string value; !is_flag && words >> value)
            option.value = value;
        overrides.give(option.name, option.value.value_or(""));
        given.push_back(std::move(option));
    }
    return given;
}

std::vector<GivenOption> options_of(const ExplorerChoice& choice) {
    SettingsOverrides unused;
    std::vector<GivenOption> more = give_words(choice.more, unused);
    const std::vector<GivenOption> own{{"--integrator", choice.integrator},
                                       {"--max-depth", std::to_string(choice.max_depth)}};
    return merged(own, more);
}

std::string text_of_place(const CameraPlace& place) {
    // To a millionth of the distance, however far from the origin that is.
    const double step = std::pow(10.0, std::floor(std::log10(length(place.eye - place.target))) - 6.0);
    const auto number = [&](double x) { return fmt::format("{:.15g}", std::round(x / step) * step + 0.0); };
    const auto point = [&](const Vec3d& v) { return fmt::format("{},{},{}", number(v.x), number(v.y), number(v.z)); };
    const auto text = [](const Vec3d& v) { return fmt::format("{:.6g},{:.6g},{:.6g}", v.x, v.y, v.z); };
    return fmt::format("{},{}{}", point(place.eye), point(place.target),
                       place.up == CameraPlace{}.up ? "" : "," + text(place.up));
}

}  // namespace

Explorer::Explorer(PreparedScene prepared, const std::vector<GivenOption>& given, const ThreadPool& threads,
                   TakeImage take)
    : threads_(threads), given_(given), take_(std::move(take)), is_taken_(static_cast<bool>(take_)) {
    // Images here are whole, and have no end.
    for (const char* const name : {"--crop", "--overscan", "--error"}) given_ = without(std::move(given_), name);
    SceneDesc scene = std::move(prepared.scene);
    replaced_ = replaced_material(scene);
    const std::string working_space = resolve_colors(scene.settings, colors_);
    const Bounds bounds = compute_bounds(scene);
    scene_.name = scene.name;
    scene_.file = scene.file;
    scene_.origin = scene.origin;
    scene_.cameras = scene.cameras;
    scene_.settings = scene.settings;
    world_ = ray_code().compile_world(std::move(scene), colors_, working_space, threads_, prepared.problems, {});
    for (const Problem& problem : prepared.problems.all()) log_warning("{}", problem.str());

    const CameraPose& pose = pose_of(world_->camera().model());
    const float ahead = dot(bounds.center() - pose.position, pose.forward);
    const float size = length(bounds.size());
    distance_ = static_cast<double>(ahead > 0.05f * size ? ahead : std::max(0.5f * size, 1e-3f));
    const Vec3d eye = Vec3d(pose.position) + scene_.origin;
    own_camera_ = {.eye = eye, .target = eye + Vec3d(pose.forward) * distance_};
    // A camera that is upright is turned around the vertical; any other keeps what it calls up, as does one that looks
    // straight up or down.
    constexpr float kUpright = 1e-3f;
    if (std::abs(pose.right.y) > kUpright || std::hypot(pose.forward.x, pose.forward.z) < kUpright)
        own_camera_.up = Vec3d(pose.up);
    own_camera_ = scene_.settings.camera_place.value_or(own_camera_);

    // One for both images, which stays while the camera moves.
    if (!scene_.settings.color.exposure) {
        scene_.settings.color.exposure = 0.0f;
        given_.push_back({"--exposure", "0"});
    }

    std::vector<std::string> to_choose = replace_auto(scene_.settings);
    const std::string first = scene_.settings.integrator.type;
    const std::string second = first == "bdpt" ? "path" : "bdpt";
    for (const bool is_first : {true, false}) {
        const std::string integrator = is_first ? first : second;
        const ExplorerChoice choice{is_first, integrator, scene_.settings.integrator.lengths.max_depth, ""};
        wishes_.sides.at(is_first ? 0 : 1) = std::pair(choice, settings_of(choice));
    }
    fulfil(std::exchange(wishes_, {}));
}

RenderSettings Explorer::settings_of(const ExplorerChoice& choice) const {
    SettingsOverrides overrides;
    for (const GivenOption& option : options_of(choice)) overrides.give(option.name, option.value.value_or(""));
    RenderSettings settings;
    {
        const std::scoped_lock lock(mutex_);
        settings = scene_.settings;
    }
    overrides.apply(settings);
    // The scene or the command line may name a strategy that this integrator does not have.
    std::optional<Strategy>& strategy = settings.integrator.strategy;
    if (strategy && !shows_strategy(settings.integrator.type, *strategy)) strategy.reset();
    if (settings.integrator.type == kAutoIntegrator) throw UsageError("'auto' is no integrator: choose one");
    (void)create_integrator(settings);
    if (const auto reason = replaced_ ? misses_alpha(settings.integrator.type, *replaced_) : std::nullopt)
        throw UsageError(*reason);
    settings.film.crop.reset();
    settings.film.overscan = 0.0f;
    settings.relative_error = 0.0;
    settings.aovs.clear();
    return settings;
}

void Explorer::move_camera(const std::string& place, bool moves) {
    SettingsOverrides overrides;
    overrides.give("--camera-place", place);
    RenderSettings settings;
    overrides.apply(settings);
    // What commands say is what is rendered.
    SettingsOverrides rounded;
    rounded.give("--camera-place", text_of_place(*settings.camera_place));
    rounded.apply(settings);
    const std::scoped_lock lock(mutex_);
    // The camera is stored before the render restarts, so that the page that moved it never receives an older place.
    scene_.settings.camera_place = settings.camera_place;
    wishes_.camera = settings.camera_place;
    moved_at_ = moves ? Clock::now() : Clock::time_point{};
    has_wishes_ = true;
    news_.notify_all();
}

void Explorer::choose(std::size_t side, const ExplorerChoice& choice) {
    RenderSettings settings = settings_of(choice);
    const std::scoped_lock lock(mutex_);
    wishes_.sides.at(side) = std::pair(choice, std::move(settings));
    has_wishes_ = true;
    news_.notify_all();
}

void Explorer::fulfil(Wishes wishes) {
    for (std::size_t i = 0; i < sides_.size(); ++i) {
        if (!wishes.sides.at(i)) continue;
        Side& side = sides_.at(i);
        side.rendering.reset();
        side.integrator = create_integrator(wishes.sides.at(i)->second);
        const std::scoped_lock lock(mutex_);
        std::tie(side.choice, side.settings) = std::move(*wishes.sides.at(i));
        if (!side.choice.is_shown) side.image.set({});
    }
    if (wishes.camera) {
        for (Side& side : sides_) side.rendering.reset();
        SceneDesc view;
        {
            const std::scoped_lock lock(mutex_);
            view.settings = scene_.settings;
        }
        view.settings.camera_place = wishes.camera;  // another may have been asked for since
        view.cameras = scene_.cameras;
        view.origin = scene_.origin;
        view.file = scene_.file;
        world_ = ray_code().with_camera(std::move(*world_), view);
    }
    // Both begin anew, so that they have had equal time.
    for (Side& side : sides_) restart(side);
    count_news();
}

void Explorer::restart(Side& side) {
    side.rendering.reset();
    side.shrink = 0;
    const std::scoped_lock lock(mutex_);
    side.cpu_seconds = 0.0;
    side.rays = 0;
}

Explorer::Side* Explorer::next_side() {
    Side* next = nullptr;
    for (Side& side : sides_) {
        if (!side.choice.is_shown) continue;
        // While the camera moves, its small images are all there is to make.
        if (side.shrink > 0 && does_camera_move()) continue;
        if (side.shrink == 1 && side.rendering && side.rendering->state().spp_done >= kMostExplorerSpp) continue;
        // One that has shown nothing yet comes first, then the one that has had less time.
        const auto rank = [](const Side& s) { return std::pair(s.shrink > 0, s.cpu_seconds); };
        if (next == nullptr || rank(side) < rank(*next)) next = &side;
    }
    return next;
}

void Explorer::begin(Side& side, int shrink) {
    RenderSettings settings = side.settings;
    settings.film.width = std::max(1, settings.film.width / shrink);
    settings.film.height = std::max(1, settings.film.height / shrink);
    side.shrink = shrink;
    side.rendering.emplace(*world_, *side.integrator, make_render_options(settings), threads_);
}

void Explorer::advance(Side& side, const StopPredicate& end) {
    const bool is_first = side.shrink == 0;
    const auto pixels = static_cast<double>(side.settings.film.width) * side.settings.film.height;
    if (is_first) {
        const auto shown = std::ranges::count_if(sides_, [](const Side& s) { return s.choice.is_shown; });
        const double fitting = kFrameSeconds / static_cast<double>(shown) / side.seconds_per_sample;
        begin(side, std::clamp(static_cast<int>(std::ceil(std::sqrt(pixels / fitting))), 1, kMostShrink));
    } else if (side.shrink > 1) {
        begin(side, 1);
    }
    ProgressiveRender& rendering = *side.rendering;
    const std::uint32_t done = rendering.state().spp_done;
    const auto fitting =
        static_cast<std::uint32_t>(std::clamp(kSliceSeconds / (side.seconds_per_sample * pixels), 1.0, 64.0));
    const std::uint32_t count = is_first ? 1 : std::min(pass_size(done, kMostExplorerSpp), fitting);
    const std::uint64_t samples_before = rendering.state().counters.samples;
    const double wall_before = rendering.state().wall_seconds;
    // The first image is small, and is finished whatever is asked for meanwhile: a camera that moves would show
    // nothing.
    rendering.add_samples(count, [&] { return end() || (!is_first && has_wishes_); });
    const RenderState& now = rendering.state();
    if (const std::uint64_t samples = now.counters.samples - samples_before; samples > 0)
        side.seconds_per_sample = (now.wall_seconds - wall_before) / static_cast<double>(samples);
    {
        const std::scoped_lock lock(mutex_);
        side.cpu_seconds = side.shrink == 1 ? now.cpu_seconds : 0.0;
        side.rays = now.counters.rays.total();
    }
    if (now.pass_size == 0) publish(side);
}

void Explorer::publish(Side& side) {
    const RenderState& state = side.rendering->state();
    const ColorSettings& color = side.settings.color;
    OutputFrame frame;
    frame.pixels = rgba_image(state.film);
    frame.working_space = color.working_space;
    frame.display = color.display;
    frame.view = color.view;
    frame.look = color.look;
    frame.exposure = color.exposure;
    frame.integrator = side.settings.integrator.type;
    frame.spp = side.shrink == 1 ? static_cast<int>(state.spp_done) : 0;
    frame.render_seconds = state.wall_seconds;
    hand_over(side, frame);
    side.image.set(std::move(frame));
    count_news();
}

void Explorer::hand_over(Side& side, const OutputFrame& frame) {
    constexpr std::chrono::milliseconds kBetweenImages(500);
    const bool is_last = side.rendering->state().spp_done >= kMostExplorerSpp;
    const Clock::time_point now = Clock::now();
    if (!is_taken_ || side.shrink != 1 || (!is_last && now - side.taken < kBetweenImages)) return;
    side.taken = now;
    const char* const place = &side == &sides_[0] ? "left" : "right";
    is_taken_ = take_(fmt::format("{}, {}: {}", scene_.name, place, frame.integrator), frame);
}

void Explorer::count_news() {
    const std::scoped_lock lock(mutex_);
    ++serial_;
    news_.notify_all();
}

void Explorer::run(const StopPredicate& end) {
    while (!end()) {
        if (has_wishes_) {
            Wishes wishes;
            {
                const std::scoped_lock lock(mutex_);
                wishes = std::exchange(wishes_, {});
                has_wishes_ = false;
            }
            fulfil(std::move(wishes));
        }
        Side* const side = is_watched() ? next_side() : nullptr;
        if (side != nullptr) {
            advance(*side, end);
            continue;
        }
        std::unique_lock lock(mutex_);
        news_.wait_for(lock, std::chrono::milliseconds(100), [&] { return has_wishes_.load(); });
    }
}

std::array<ExplorerSide, 2> Explorer::sides() const {
    const std::scoped_lock lock(mutex_);
    std::array<ExplorerSide, 2> sides;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const Side& side = sides_.at(i);
        std::vector<GivenOption> own = options_of(side.choice);
        if (const auto& place = scene_.settings.camera_place) own.push_back({"--camera-place", text_of_place(*place)});
        sides.at(i) = {side.choice, side.cpu_seconds, side.rays, command_line("etendue render", merged(given_, own))};
    }
    return sides;
}

CameraPlace Explorer::camera() const {
    const std::scoped_lock lock(mutex_);
    return scene_.settings.camera_place.value_or(own_camera_);
}

std::uint64_t Explorer::serial() const {
    const std::scoped_lock lock(mutex_);
    return serial_;
}

void Explorer::wait_for_news(std::uint64_t serial) {
    looked_at_ = Clock::now();
    std::unique_lock lock(mutex_);
    news_.wait_for(lock, std::chrono::seconds(1), [&] { return serial_ > serial; });
}

std::pair<int, int> Explorer::size() const {
    return {scene_.settings.film.width, scene_.settings.film.height};
}

}  // namespace etendue
