// The table of settings: one row for each, and nothing else to do for it but its use.
#include "core/byte_size.h"
#include "scene/setting.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>

namespace etendue {

namespace {

constexpr std::int64_t kMostInt = std::numeric_limits<int>::max();
constexpr std::int64_t kMostSpp = 1 << 24;

constexpr std::array<std::pair<std::string_view, SamplerType>, 2> kSamplerNames{{
    {"sobol", SamplerType::Sobol},
    {"random", SamplerType::Random},
}};
constexpr std::array<std::pair<std::string_view, MergeAt>, 3> kMergeNames{{
    {"sds", MergeAt::BetweenDeltas},
    {"all", MergeAt::Everywhere},
    {"none", MergeAt::Nothing},
}};
constexpr std::array<std::pair<std::string_view, Heuristic>, 2> kHeuristicNames{{
    {"balance", Heuristic::Balance},
    {"power", Heuristic::Power},
}};
constexpr std::array<std::pair<std::string_view, PixelFilterType>, 4> kFilterNames{{
    {"blackman-harris", PixelFilterType::BlackmanHarris},
    {"box", PixelFilterType::Box},
    {"gaussian", PixelFilterType::Gaussian},
    {"mitchell", PixelFilterType::Mitchell},
}};
constexpr std::array<std::pair<std::string_view, MistFalloff>, 3> kFalloffNames{{
    {"quadratic", MistFalloff::Quadratic},
    {"linear", MistFalloff::Linear},
    {"inverse-quadratic", MistFalloff::InverseQuadratic},
}};

template <const auto& names>
constexpr auto kNamesOf = [] {
    std::array<std::string_view, names.size()> only{};
    for (std::size_t i = 0; i < only.size(); ++i) only[i] = names[i].first;
    return only;
}();

template <const auto& names>
constexpr Choice kChoiceOf{kNamesOf<names>};

// From the type that holds a value to the value, and back.

SettingValue to_value(bool value) {
    return value;
}
SettingValue to_value(int value) {
    return std::int64_t{value};
}
SettingValue to_value(std::uint32_t value) {
    return std::int64_t{value};
}
SettingValue to_value(float value) {
    return static_cast<double>(value);
}
SettingValue to_value(double value) {
    return value;
}
SettingValue to_value(const std::string& value) {
    return value.empty() ? SettingValue() : value;
}
template <std::size_t N>
SettingValue to_value(const std::array<int, N>& value) {
    return std::vector<std::int64_t>(value.begin(), value.end());
}
SettingValue to_value(const std::vector<std::string>& value) {
    return value;
}
SettingValue to_value(const Shutter& value) {
    return std::vector{value.open, value.close};
}
SettingValue to_value(const CameraPlace& value) {
    std::vector<double> numbers;
    for (const Vec3d& v : {value.eye, value.target, value.up}) numbers.insert(numbers.end(), {v.x, v.y, v.z});
    if (value.up == CameraPlace{}.up) numbers.resize(6);
    return numbers;
}
SettingValue to_value(const FrameRange& value) {
    std::vector<std::int64_t> numbers{value.first, value.last};
    if (value.step != 1) numbers.push_back(value.step);
    return numbers;
}
template <typename Value>
SettingValue to_value(const std::optional<Value>& value) {
    return value ? to_value(*value) : SettingValue();
}

template <typename Held>
Held from_value(const SettingValue& value) {
    if constexpr (std::is_same_v<Held, bool> || std::is_same_v<Held, std::string> ||
                  std::is_same_v<Held, std::vector<std::string>>) {
        return std::get<Held>(value);
    } else if constexpr (std::is_integral_v<Held>) {
        return static_cast<Held>(std::get<std::int64_t>(value));
    } else if constexpr (std::is_floating_point_v<Held>) {
        return static_cast<Held>(std::get<double>(value));
    } else if constexpr (std::is_same_v<Held, Shutter>) {
        // As floats, whoever asks: so a moment is the same from render.json and from the command line.
        const auto& times = std::get<std::vector<double>>(value);
        return {static_cast<double>(static_cast<float>(times.at(0))),
                static_cast<double>(static_cast<float>(times.at(1)))};
    } else if constexpr (std::is_same_v<Held, CameraPlace>) {
        const auto& numbers = std::get<std::vector<double>>(value);
        const auto vector = [&](std::size_t i) { return Vec3d(numbers.at(i), numbers.at(i + 1), numbers.at(i + 2)); };
        CameraPlace place{.eye = vector(0), .target = vector(3)};
        if (numbers.size() > 6) place.up = vector(6);
        return place;
    } else if constexpr (std::is_same_v<Held, FrameRange>) {
        const auto& numbers = std::get<std::vector<std::int64_t>>(value);
        return {static_cast<int>(numbers.at(0)), static_cast<int>(numbers.at(1)),
                numbers.size() > 2 ? static_cast<int>(numbers[2]) : 1};
    } else {
        Held held{};
        const auto& numbers = std::get<std::vector<std::int64_t>>(value);
        for (std::size_t i = 0; i < held.size(); ++i) held[i] = static_cast<int>(numbers.at(i));
        return held;
    }
}

const RenderSettings& defaults() {
    static const RenderSettings settings;
    return settings;
}

template <typename Held>
struct IsOptional : std::false_type {};
template <typename Value>
struct IsOptional<std::optional<Value>> : std::true_type {};

/// Holds the value where `Place` says, as it is.
template <typename Place>
constexpr SettingPlace at(Place /*place*/) {
    return {[](const RenderSettings& settings) { return to_value(Place{}(settings)); },
            [](RenderSettings& settings, const SettingValue& value) {
                auto& held = Place{}(settings);
                using Held = std::remove_reference_t<decltype(held)>;
                if (std::holds_alternative<std::monostate>(value))
                    held = Place{}(defaults());
                else if constexpr (IsOptional<Held>::value)
                    held = from_value<typename Held::value_type>(value);
                else
                    held = from_value<Held>(value);
            }};
}

/// Holds a value of an enumeration, by its name in `names`.
template <const auto& names, typename Place>
constexpr SettingPlace named_at(Place /*place*/) {
    return {[](const RenderSettings& settings) -> SettingValue {
                for (const auto& [name, value] : names)
                    if (value == Place{}(settings)) return std::string(name);
                return {};
            },
            [](RenderSettings& settings, const SettingValue& value) {
                Place{}(settings) = Place{}(defaults());
                if (const auto* const text = std::get_if<std::string>(&value))
                    for (const auto& [name, named] : names)
                        if (name == *text) Place{}(settings) = named;
            }};
}

/// Holds a value that `parse` makes of its text and `text_of` turns back.
template <auto parse, auto text_of, typename Place>
constexpr SettingPlace parsed_at(Place /*place*/) {
    return {[](const RenderSettings& settings) -> SettingValue { return text_of(Place{}(settings)); },
            [](RenderSettings& settings, const SettingValue& value) {
                auto& held = Place{}(settings);
                const auto* const text = std::get_if<std::string>(&value);
                const auto parsed = text == nullptr ? std::nullopt : parse(*text);
                if (parsed)
                    held = *parsed;
                else
                    held = Place{}(defaults());
            }};
}

SettingValue strategy_value(const std::optional<Strategy>& strategy) {
    return strategy ? SettingValue(strategy_text(*strategy)) : SettingValue();
}

std::string connections_text(int count) {
    return count > 0 ? "cache:" + std::to_string(count) : "pairwise";
}

std::string robust_text(int buckets) {
    return buckets > 0 ? "mon:" + std::to_string(buckets) : "mean";
}

SettingValue byte_size_text(const std::optional<std::uint64_t>& bytes) {
    return bytes ? SettingValue(to_byte_size(*bytes)) : SettingValue();
}

/// Reads a size of memory for textures, which needs no smaller unit than mebibytes; 0 is as little as can be.
std::optional<std::uint64_t> parse_texture_memory(std::string_view text) {
    return text.find('K') == std::string_view::npos ? parse_byte_size(text) : std::nullopt;
}

template <auto parse>
bool parses(std::string_view text) {
    return parse(text).has_value();
}

bool is_some_text(std::string_view text) {
    return !text.empty();
}

bool are_frames(std::span<const double> numbers) {
    return numbers[0] <= numbers[1] && (numbers.size() < 3 || numbers[2] >= 1);
}

bool are_times(std::span<const double> numbers) {
    return numbers[0] <= numbers[1];
}

bool is_window(std::span<const double> numbers) {
    return numbers[0] < numbers[2] && numbers[1] < numbers[3];
}

/// Three numbers for each of eye, target and, if it is given, up.
bool is_camera_place(std::span<const double> numbers) {
    if (numbers.size() % 3 != 0) return false;
    const auto vector = [&](std::size_t i) { return Vec3d(numbers[i], numbers[i + 1], numbers[i + 2]); };
    const Vec3d view = vector(3) - vector(0);
    const Vec3d up = numbers.size() > 6 ? vector(6) : CameraPlace{}.up;
    constexpr double kLeastSine = 1e-6;  // beyond what single precision tells apart
    return view.length() > 0.0 && view.normalized().cross(up).length() > kLeastSine * up.length();
}

constexpr SettingPlace kResolutionPlace{
    [](const RenderSettings& settings) -> SettingValue {
        return std::vector<std::int64_t>{settings.film.width, settings.film.height};
    },
    [](RenderSettings& settings, const SettingValue& value) {
        const auto* const size = std::get_if<std::vector<std::int64_t>>(&value);
        settings.film.width = size != nullptr ? static_cast<int>(size->at(0)) : FilmSettings{}.width;
        settings.film.height = size != nullptr ? static_cast<int>(size->at(1)) : FilmSettings{}.height;
    }};

/// Nothing is the filter's own radius, which the settings hold as 0.
constexpr SettingPlace kFilterRadiusPlace{
    [](const RenderSettings& settings) {
        return settings.film.filter_radius == 0.0f ? SettingValue() : to_value(settings.film.filter_radius);
    },
    [](RenderSettings& settings, const SettingValue& value) {
        const auto* const radius = std::get_if<double>(&value);
        settings.film.filter_radius = radius != nullptr ? static_cast<float>(*radius) : 0.0f;
    }};

constexpr SettingPlace kAovsPlace{[](const RenderSettings& settings) -> SettingValue {
                                      std::vector<std::string> texts;
                                      for (const AovDesc& aov : settings.aovs) texts.push_back(to_text(aov));
                                      return texts;
                                  },
                                  [](RenderSettings& settings, const SettingValue& value) {
                                      settings.aovs.clear();
                                      const auto* const texts = std::get_if<std::vector<std::string>>(&value);
                                      if (texts == nullptr) return;
                                      for (const std::string& text : *texts)
                                          if (std::optional<AovDesc> aov = parse_aov(text))
                                              settings.aovs.push_back(std::move(*aov));
                                  }};

constexpr std::array kRows{
    Setting{.pointer = "/integrator/type",
            .option = "--integrator",
            .type = Name{.is_integrator = true},
            .decides = Decides::Samples,
            .help = "Light transport algorithm",
            .page = "integrators.md",
            .place = at([](auto& s) -> auto& { return s.integrator.type; })},
    Setting{.pointer = "/spp",
            .option = "--spp",
            .type = WholeNumber{1, kMostSpp},
            .decides = Decides::Amount,
            .help = "Samples per pixel",
            .place = at([](auto& s) -> auto& { return s.spp; })},
    Setting{.pointer = "/size",
            .option = "--size",
            .type = WholeNumbers{{1, kMostSide}, 2, 2, 'x', "WIDTHxHEIGHT"},
            .decides = Decides::Samples,
            .unit = "pixels",
            .help = "Width and height of the image",
            .place = kResolutionPlace},
    Setting{
        .pointer = "/crop",
        .option = "--crop",
        .type = WholeNumbers{{-kMostSide, 2 * kMostSide}, 4, 4, ',', "x0,y0,x1,y1", "x0 < x1 and y0 < y1", is_window},
        .decides = Decides::Amount,
        .unit = "pixels",
        .default_text = "all",
        .help = "Render only the pixels from x0, y0 to before x1, y1, with y down from the top left corner; the window "
                "may go beyond the image",
        .place = at([](auto& s) -> auto& { return s.film.crop; })},
    Setting{.pointer = "/film/overscan",
            .option = "--overscan",
            .type = RealNumber{{.min = 0.0, .max = kMostSide}, true},
            .decides = Decides::Amount,
            .unit = "pixels",
            .help = "Render as many pixels beyond each edge of the image, which the EXR keeps outside of its display "
                    "window; a number below 1 is a share of the longer side",
            .page = "colour.md#overscan",
            .place = at([](auto& s) -> auto& { return s.film.overscan; })},
    Setting{.pointer = "/camera",
            .option = "--camera",
            .type = Name{},
            .decides = Decides::Samples,
            .default_text = "the first of the file",
            .help = "Name of the camera, or of its node",
            .place = at([](auto& s) -> auto& { return s.camera; })},
    Setting{.pointer = "/camera_place",
            .option = "--camera-place",
            .type = RealNumbers{{},
                                6,
                                9,
                                ',',
                                "ex,ey,ez,tx,ty,tz[,ux,uy,uz]",
                                "e unlike t, and u (default: 0,1,0) not along the view",
                                is_camera_place},
            .decides = Decides::Samples,
            .unit = "metres",
            .default_text = "where the scene has it",
            .help = "Place the camera at e, looking at t, with u (default: 0,1,0) upwards",
            .place = at([](auto& s) -> auto& { return s.camera_place; })},
    Setting{.pointer = "/scene_name",
            .option = "--scene",
            .type = Name{},
            .decides = Decides::Samples,
            .default_text = "the file's own",
            .help = "Name of the scene to show, of a file that has several",
            .place = at([](auto& s) -> auto& { return s.scene_name; })},
    Setting{.pointer = "/time_code",
            .option = "--time-code",
            .type = RealNumber{},
            .decides = Decides::Samples,
            .unit = "seconds",
            .default_text = "at rest",
            .help = "Moment of the animation to show",
            .place = at([](auto& s) -> auto& { return s.time_code; })},
    Setting{.pointer = "/animation",
            .option = "--animation",
            .type = Texts{{"the name of an animation, or none", "^.+$", is_some_text}, true},
            .decides = Decides::Samples,
            .needs = "/time_code",
            .default_text = "all whose targets do not conflict",
            .help = "Animations to play, by name, or `none`; may be given several times",
            .page = "gltf.md#animations",
            .place = at([](auto& s) -> auto& { return s.animations; })},
    Setting{.pointer = "/shutter",
            .option = "--shutter",
            .type = RealNumbers{{.is_single = true}, 2, 2, ':', "OPEN:CLOSE", "open <= close", are_times},
            .decides = Decides::Samples,
            .unit = "seconds",
            .help = "When the shutter opens and closes, from the moment shown: what moves in between is blurred",
            .place = at([](auto& s) -> auto& { return s.shutter; })},
    Setting{.pointer = "/frames",
            .option = "--frames",
            .type = WholeNumbers{{-FrameRange::kMaxFrame, FrameRange::kMaxFrame},
                                 2,
                                 3,
                                 ':',
                                 "FRAME, FIRST:LAST or FIRST:LAST:STEP",
                                 "first <= last and step >= 1",
                                 are_frames,
                                 true},
            .decides = Decides::Schedule,
            .default_text = "one image",
            .help = "Render a sequence, from its first frame to its last, and of these every step-th; frame f is at "
                    "time code + f / fps",
            .page = "render-json.md#sequences",
            .place = at([](auto& s) -> auto& { return s.frames; })},
    Setting{.pointer = "/fps",
            .option = "--fps",
            .type = RealNumber{{.min = 0.0, .open_min = true}},
            .decides = Decides::Sums,  // layers of motion, and what headers say
            .help = "Frames per second of a sequence",
            .place = at([](auto& s) -> auto& { return s.fps; })},
    Setting{.pointer = "/variant",
            .option = "--variant",
            .type = Name{},
            .decides = Decides::Samples,
            .default_text = "the file's own",
            .help = "Name of the file's set of materials (`KHR_materials_variants`)",
            .place = at([](auto& s) -> auto& { return s.variant; })},
    Setting{.pointer = "/seed",
            .option = "--seed",
            .type = WholeNumber{0, std::numeric_limits<std::uint32_t>::max()},
            .decides = Decides::Samples,
            .help = "Seed of everything random",
            .place = at([](auto& s) -> auto& { return s.seed; })},
    Setting{.pointer = "/sampler",
            .option = "--sampler",
            .type = kChoiceOf<kSamplerNames>,
            .decides = Decides::Samples,
            .help = "Sample sequence: `sobol`, Owen-scrambled and padded, or `random`, independent numbers",
            .place = named_at<kSamplerNames>([](auto& s) -> auto& { return s.sampler; })},
    Setting{.pointer = "/time",
            .option = "--time",
            .type = RealNumber{kNotNegative},
            .decides = Decides::Amount,
            .unit = "seconds",
            .help = "Start no new pass after this time; 0 for no limit",
            .place = at([](auto& s) -> auto& { return s.time_limit; })},
    Setting{.pointer = "/error",
            .option = "--error",
            .type = RealNumber{kNotNegative},
            .decides = Decides::Amount,
            .help = "Start no new pass once the image's estimated relative error is at most this: 0.05 is a clean "
                    "preview, 0.01 a clean image, 0 asks for none. It is a root mean square; values below half of "
                    "the image's own scale are measured against that half. Pixels get as many samples as they need, "
                    "`--spp` at most. This doubles the memory of the film",
            .page = "adaptive.md#what-the-error-is-relative-to",
            .place = at([](auto& s) -> auto& { return s.relative_error; })},
    Setting{.pointer = "/clamp_indirect",
            .option = "--clamp-indirect",
            .type = RealNumber{kNotNegative, true},
            .decides = Decides::Samples,
            .unit = "units of the image",
            .help = "Limit the largest component of each contribution of indirect light to this: fewer fireflies, and "
                    "light is missing; 0 for no limit",
            .page = "fireflies.md",
            .place = at([](auto& s) -> auto& { return s.clamp_indirect; })},
    Setting{.pointer = "/robust",
            .option = "--robust",
            .type = Form{kRobustForm, "^(mean|mon:([3579]|[12][13579]|31))$", parses<parse_robust>},
            .decides = Decides::Sums,
            .help = "`mean`, or `mon:N`, N odd and from 3 to 31: each pixel is the median of the means of N parts of "
                    "its samples, which a few fireflies do not move; too dark with few samples, right with many",
            .page = "fireflies.md",
            .place = parsed_at<parse_robust, robust_text>([](auto& s) -> auto& { return s.robust_buckets; })},
    Setting{.pointer = "/brightest",
            .option = "--brightest",
            .type = WholeNumber{0, kMostBrightest},
            .decides = Decides::Report,
            .help = "List this many of the brightest contributions, with the paths that brought them, in NAME.json, "
                    "and at the end if the option asks for it",
            .page = "fireflies.md",
            .place = at([](auto& s) -> auto& { return s.brightest; })},
    Setting{.pointer = "/adaptive",
            .option = "--adaptive",
            .type = YesNo{"--no-adaptive", "With `--error`, give all pixels as many samples"},
            .decides = Decides::Amount,
            .needs = "/error",
            .help = "With `--error`, give every pixel as many samples as it needs, `--spp` at most",
            .page = "adaptive.md",
            .place = at([](auto& s) -> auto& { return s.adaptive; })},
    Setting{.pointer = "/min_spp",
            .option = "--min-spp",
            .type = WholeNumber{1, kMostSpp},
            .decides = Decides::Amount,
            .needs = "/error",
            .help = "Samples that every pixel gets before an adaptive render leaves any out",
            .page = "adaptive.md",
            .place = at([](auto& s) -> auto& { return s.min_spp; })},
    Setting{.pointer = "/integrator/max_depth",
            .option = "--max-depth",
            .type = WholeNumber{1, kMostInt},
            .decides = Decides::Samples,
            .unit = "edges",
            .help = "Longest paths from camera to light; 1 is emission seen directly",
            .place = at([](auto& s) -> auto& { return s.integrator.lengths.max_depth; })},
    Setting{.pointer = "/integrator/min_depth",
            .option = "--min-depth",
            .type = WholeNumber{1, kMostInt},
            .decides = Decides::Samples,
            .unit = "edges",
            .help = "Shortest paths that are kept",
            .place = at([](auto& s) -> auto& { return s.integrator.lengths.min_depth; })},
    Setting{
        .pointer = "/integrator/roulette_depth",
        .option = "--roulette-depth",
        .type = WholeNumber{1, kMostInt},
        .decides = Decides::Samples,
        .unit = "rays",
        .help = "Rays, those behind panes and in media included, after which Russian roulette may end a path; `bdpt` "
                "shares them between its subpaths",
        .page = "integrators.md#russian-roulette",
        .place = at([](auto& s) -> auto& { return s.integrator.lengths.roulette_depth; })},
    Setting{.pointer = "/integrator/light_samples",
            .option = "--light-samples",
            .type = WholeNumber{1, kMostLightSamples},
            .decides = Decides::Samples,
            .help = "How many lights `path` and `direct` sample at what the eye sees directly, in mirrors or through "
                    "smooth glass; more take longer and reduce the noise of soft shadows and many lights",
            .page = "integrators.md#which-light-is-sampled",
            .place = at([](auto& s) -> auto& { return s.integrator.light_samples; })},
    Setting{.pointer = "/integrator/heuristic",
            .option = "--heuristic",
            .type = kChoiceOf<kHeuristicNames>,
            .decides = Decides::Samples,
            .help = "How `bdpt` and `vcm` weigh their strategies: `balance`, or `power` with the exponent 2",
            .place = named_at<kHeuristicNames>([](auto& s) -> auto& { return s.integrator.heuristic; })},
    Setting{
        .pointer = "/integrator/strategy",
        .option = "--strategy",
        .type = Form{kStrategyForm, "^([0-9]+,[0-9]+|merging)$", parses<parse_strategy>},
        .decides = Decides::Samples,
        .default_text = "all",
        .help = "Show only paths with S vertices from the light and T from the eye, both ends counted, or those that "
                "`vcm` merges",
        .page = "integrators.md#one-strategy-at-a-time",
        .place = parsed_at<parse_strategy, strategy_value>([](auto& s) -> auto& { return s.integrator.strategy; })},
    Setting{
        .pointer = "/integrator/weighted",
        .type = YesNo{"--unweighted", "Show the paths of `--strategy` as if no other strategy made them"},
        .decides = Decides::Samples,
        .help = "Whether the paths of the strategy are weighted; if not, they show as if no other strategy made them, "
                "and merges as photon mapping makes them",
        .place = at([](auto& s) -> auto& { return s.integrator.weighted; })},
    Setting{
        .pointer = "/integrator/connections",
        .option = "--bdpt-connections",
        .type = Form{kConnectionsForm, "^(pairwise|cache:[1-9][0-9]{0,2})$", parses<parse_connections>},
        .decides = Decides::Samples,
        .help =
            "How `bdpt` and `vcm` connect an eye vertex: to all light vertices of its own sample (`pairwise`), or N "
            "drawn from those of many samples (`cache:N`)",
        .page = "integrators.md#connections-to-a-cache",
        .place = parsed_at<parse_connections, connections_text>(
            [](auto& s) -> auto& { return s.integrator.cached_connections; })},
    Setting{.pointer = "/integrator/lamp_images",
            .type = YesNo{"--no-lamp-images", "Leave images of small lamps in mirrors and glass to chance"},
            .decides = Decides::Samples,
            .help = "Whether images of small lamps in mirrors and smooth glass get samples of their own",
            .page = "integrators.md#images-of-lamps",
            .place = at([](auto& s) -> auto& { return s.integrator.lamp_images; })},
    Setting{.pointer = "/integrator/aimed_emission",
            .type = YesNo{"--no-aimed-emission", "Let lights send all paths where they shine"},
            .decides = Decides::Samples,
            .help = "Whether lights send a share of the paths of `light`, `bdpt` and `vcm` towards mirrors and smooth "
                    "glass",
            .page = "integrators.md#aimed-emission",
            .place = at([](auto& s) -> auto& { return s.integrator.aimed_emission; })},
    Setting{.pointer = "/integrator/merge",
            .option = "--merge",
            .type = kChoiceOf<kMergeNames>,
            .decides = Decides::Samples,
            .help = "Which vertices `vcm` merges: those between two mirrors or smooth refractions, which no connection "
                    "finds (`sds`), `all`, or `none`, which is `bdpt`",
            .page = "integrators.md#vcm",
            .place = named_at<kMergeNames>([](auto& s) -> auto& { return s.integrator.merging.at; })},
    Setting{.pointer = "/integrator/merge_radius",
            .option = "--merge-radius",
            .type = RealNumber{{.min = 0.01, .max = 100.0}},
            .decides = Decides::Samples,
            .unit = "pixels",
            .help = "How far `vcm` merges in the first sample of a pixel; later samples merge less far",
            .page = "integrators.md#vcm",
            .place = at([](auto& s) -> auto& { return s.integrator.merging.radius; })},
    Setting{
        .pointer = "/integrator/merge_alpha",
        .type = RealNumber{{.min = 0.1, .max = 1.0}},
        .decides = Decides::Samples,
        .help =
            "How slowly the radius of `vcm` shrinks: with the power (merge_alpha - 1) / 2 of the number of samples; "
            "1 keeps it, and its blur",
        .page = "integrators.md#vcm",
        .place = at([](auto& s) -> auto& { return s.integrator.merging.alpha; })},
    Setting{.pointer = "/light_units",
            .option = "--light-units",
            .type = kChoiceOf<kLightUnitNames>,
            .decides = Decides::Samples,
            .help = "`photometric`: candela, lux and emission one to one, the image is in cd/m2; `radiometric`: "
                    "emission is in watts, candela and lux are divided by 683.002 lm/W",
            .page = "gltf.md#light-and-its-units",
            .place = named_at<kLightUnitNames>([](auto& s) -> auto& { return s.light_units; })},
    Setting{.pointer = "/film/filter",
            .type = kChoiceOf<kFilterNames>,
            .decides = Decides::Samples,
            .help = "Pixel filter",
            .place = named_at<kFilterNames>([](auto& s) -> auto& { return s.film.filter; })},
    Setting{.pointer = "/film/filter_radius",
            .type = RealNumber{{.min = 0.0, .max = 8.0, .open_min = true}, true},
            .decides = Decides::Samples,
            .unit = "pixels",
            .default_text = "the filter's own",
            .help = "Radius of the pixel filter",
            .place = kFilterRadiusPlace},
    Setting{.pointer = "/film/pixel_aspect",
            .option = "--pixel-aspect",
            .type = RealNumber{{.min = 0.015625, .max = 64.0}, true},
            .decides = Decides::Samples,
            .help = "Width of a pixel over its height",
            .place = at([](auto& s) -> auto& { return s.film.pixel_aspect; })},
    Setting{
        .pointer = "/texture_memory",
        .option = "--texture-memory",
        .type = Form{"a number of up to six digits with M, G or T behind it, such as 8G", "^[0-9]{1,6}[MGT](i?B)?$",
                     parses<parse_texture_memory>},
        .decides = Decides::Schedule,
        .default_text = "half of the machine's",
        .help = "Memory for decoded textures, such as 8G or 512M; scenes with more read them piece by piece as "
                "they are needed",
        .page = "gltf.md#textures",
        .place = parsed_at<parse_texture_memory, byte_size_text>([](auto& s) -> auto& { return s.texture_memory; })},
    Setting{.pointer = "/missing_textures",
            .option = "--missing-textures",
            .type = kChoiceOf<kMissingTexturesNames>,
            .decides = Decides::Schedule,
            .help = "`warn`: materials do without a texture that is missing or broken; `error`: the scene is refused",
            .page = "gltf.md#missing-textures",
            .place = named_at<kMissingTexturesNames>([](auto& s) -> auto& { return s.missing_textures; })},
    Setting{
        .pointer = "/accelerator",
        .option = "--accelerator",
        .type = kChoiceOf<kAcceleratorNames>,
        .decides = Decides::Samples,
        .help = "What finds the surfaces that rays meet; all but `embree` are for teaching, many times as slow, and "
                "refuse scenes in which something moves while the shutter is open",
        .page = "accelerators.md",
        .place = named_at<kAcceleratorNames>([](auto& s) -> auto& { return s.accelerator; })},
    Setting{.pointer = "/cull_backfaces",
            .option = "--cull-backfaces",
            .type = YesNo{},
            .decides = Decides::Samples,
            .help = "Let single-sided surfaces be invisible from behind, for all rays, but for those of bodies",
            .page = "gltf.md#culled-backs",
            .place = at([](auto& s) -> auto& { return s.cull_backfaces; })},
    Setting{.pointer = "/studio",
            .option = "--studio",
            .type = YesNo{},
            .decides = Decides::Samples,
            .default_text = "where nothing else emits light",
            .help = "Light the scene by the studio, in place of its environment",
            .page = "render-json.md#the-studio",
            .place = at([](auto& s) -> auto& { return s.studio; })},
    Setting{.pointer = "/ground",
            .option = "--ground",
            .type = YesNo{"--no-ground", "Leave the ground of the studio out"},
            .decides = Decides::Samples,
            .help = "Put a ground below the scene that the studio lights",
            .page = "render-json.md#the-studio",
            .place = at([](auto& s) -> auto& { return s.ground; })},
    Setting{.pointer = "/aovs",
            .option = "--aov",
            .type = Texts{{kAovForm, "^[A-Za-z0-9_-]{1,100}(=.+)?(:[0-9]{1,9})?(:half|:float)?$", parses<parse_aov>}},
            .decides = Decides::Sums,
            .help = "Layers to write besides the image, such as `depth` or `caustics=lpe:C D S+ L`: each is a source, "
                    "NAME=lpe:EXPRESSION or NAME=light:NAME; `:half` or `:float` behind it says how. The option adds "
                    "one, and can be given several times",
            .page = "aovs.md",
            .place = kAovsPlace},
    Setting{.pointer = "/aov_layout",
            .option = "--aov-layout",
            .type = kChoiceOf<kAovLayoutNames>,
            .decides = Decides::Display,
            .help = "Layers as channels of the image (`layers`), as parts of its file (`parts`) or in files of their "
                    "own (`files`)",
            .page = "aovs.md",
            .place = named_at<kAovLayoutNames>([](auto& s) -> auto& { return s.aov_layout; })},
    Setting{.pointer = "/mist/start",
            .type = RealNumber{{.min = 0.0}, true},
            .decides = Decides::Sums,
            .unit = "metres",
            .help = "Distance from the camera at which the layer `mist` begins",
            .page = "aovs.md",
            .place = at([](auto& s) -> auto& { return s.mist.start; })},
    Setting{.pointer = "/mist/depth",
            .type = RealNumber{{.min = 0.0, .open_min = true}, true},
            .decides = Decides::Sums,
            .unit = "metres",
            .help = "Distance from there to where all is mist",
            .page = "aovs.md",
            .place = at([](auto& s) -> auto& { return s.mist.depth; })},
    Setting{.pointer = "/mist/falloff",
            .type = kChoiceOf<kFalloffNames>,
            .decides = Decides::Sums,
            .help = "How mist grows in between: with the square of the distance from its start, evenly, or with the "
                    "square root",
            .page = "aovs.md",
            .place = named_at<kFalloffNames>([](auto& s) -> auto& { return s.mist.falloff; })},
    Setting{.pointer = "/color/exposure",
            .option = "--exposure",
            .type = RealNumber{{.min = -64.0, .max = 64.0}, true},
            .decides = Decides::Display,
            .unit = "stops",
            .default_text = "chosen from the image",
            .help = "Exposure of the preview image",
            .page = "colour.md#exposure",
            .place = at([](auto& s) -> auto& { return s.color.exposure; })},
    Setting{.pointer = "/color/display",
            .option = "--display",
            .type = Name{},
            .decides = Decides::Display,
            .default_text = "the config's",
            .help = "OpenColorIO display that the preview image is for",
            .page = "colour.md",
            .place = at([](auto& s) -> auto& { return s.color.display; })},
    Setting{.pointer = "/color/view",
            .option = "--view",
            .type = Name{},
            .decides = Decides::Display,
            .default_text = "the display's",
            .help = "OpenColorIO view of the preview image, one of its display's",
            .page = "colour.md",
            .place = at([](auto& s) -> auto& { return s.color.view; })},
    Setting{.pointer = "/color/look",
            .option = "--look",
            .type = Name{},
            .decides = Decides::Display,
            .default_text = "the view's own",
            .help = "OpenColorIO look of the preview image, in place of the view's own; several with commas, or none "
                    "(`etendue view --list` names displays, views and looks)",
            .page = "colour.md",
            .place = at([](auto& s) -> auto& { return s.color.look; })},
    Setting{.pointer = "/color/working_space",
            .option = "--working-space",
            .type = Name{},
            .decides = Decides::Samples,
            .default_text = "the config's role scene_linear",
            .help = "Scene-linear space to render in",
            .page = "colour.md",
            .place = at([](auto& s) -> auto& { return s.color.working_space; })},
    Setting{.pointer = "/color/output_space",
            .option = "--exr-space",
            .type = Name{},
            .decides = Decides::Display,
            .default_text = "the working space",
            .help = "Scene-linear space of the EXR, such as `ACES2065-1`",
            .page = "colour.md",
            .place = at([](auto& s) -> auto& { return s.color.output_space; })},
    Setting{.pointer = "/color/aces_container",
            .option = "--aces-container",
            .type = YesNo{},
            .decides = Decides::Display,
            .help = "Write the EXR as SMPTE ST 2065-4 asks: in ACES2065-1, 16-bit floats, not compressed",
            .page = "colour.md#aces-containers-smpte-st-2065-4",
            .place = at([](auto& s) -> auto& { return s.color.aces_container; })},
    Setting{.pointer = "/metadata/owner",
            .option = "--owner",
            .type = Name{},
            .decides = Decides::Display,
            .default_text = "none",
            .help = "Whose image it is, as the EXR tells it (`owner`)",
            .page = "colour.md#what-an-exr-says-about-itself",
            .place = at([](auto& s) -> auto& { return s.metadata.owner; })},
    Setting{.pointer = "/metadata/comments",
            .option = "--comments",
            .type = Name{},
            .decides = Decides::Display,
            .default_text = "none",
            .help = "Any text that the EXR is to tell (`comments`)",
            .page = "colour.md#what-an-exr-says-about-itself",
            .place = at([](auto& s) -> auto& { return s.metadata.comments; })},
};

}  // namespace

std::span<const Setting> settings_table() {
    return kRows;
}

}  // namespace etendue
