#include "loader/gltf/gltf_animation.h"

#include "core/shown_text.h"
#include "loader/json_text.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Spherical interpolation along the shorter way (appendix C.4).
std::vector<double> slerp(std::vector<double> a, const std::vector<double>& b, double t) {
    double cosine = 0.0;
    for (std::size_t i = 0; i < 4; ++i) cosine += a[i] * b[i];
    const double sign = cosine < 0.0 ? -1.0 : 1.0;
    const double angle = std::acos(std::min(1.0, std::abs(cosine)));
    // Where the two are nearly the same, sines vanish and straight lines do.
    const bool straight = angle < 1e-4;
    const double from = straight ? 1.0 - t : std::sin((1.0 - t) * angle) / std::sin(angle);
    const double to = straight ? t : std::sin(t * angle) / std::sin(angle);
    for (std::size_t i = 0; i < 4; ++i) a[i] = from * a[i] + to * sign * b[i];
    return a;
}

std::vector<double> evaluate(const AnimationKeys& keys, double seconds, bool is_rotation) {
    const auto value_of = [&](std::size_t key) {
        std::vector<double> value(keys.width);
        for (std::size_t c = 0; c < keys.width; ++c) value[c] = keys.number(key, 1, c);
        return value;
    };
    // Times of keys are single precision: a frame that is at a key has reached it, whichever way that was rounded.
    const auto next = std::ranges::upper_bound(keys.times, static_cast<float>(seconds));
    if (next == keys.times.begin()) return value_of(0);
    const auto k = static_cast<std::size_t>(next - keys.times.begin()) - 1;
    if (next == keys.times.end() || keys.interpolation == Interpolation::Step) return value_of(k);

    const double duration = static_cast<double>(keys.times[k + 1]) - static_cast<double>(keys.times[k]);
    const double t = std::max(seconds - static_cast<double>(keys.times[k]), 0.0) / duration;
    std::vector<double> value = value_of(k);
    const std::vector<double> after = value_of(k + 1);
    if (!keys.is_cubic()) {
        if (is_rotation) return slerp(std::move(value), after, t);
        for (std::size_t c = 0; c < keys.width; ++c) value[c] += (after[c] - value[c]) * t;
        return value;
    }
    // Hermite's basis, tangents per second (appendix C.5).
    const double t2 = t * t;
    const double t3 = t2 * t;
    for (std::size_t c = 0; c < keys.width; ++c)
        value[c] = (2 * t3 - 3 * t2 + 1) * value[c] + duration * (t3 - 2 * t2 + t) * keys.number(k, 2, c) +
                   (3 * t2 - 2 * t3) * after[c] + duration * (t3 - t2) * keys.number(k + 1, 0, c);
    return value;
}

/// Leaves out the keys of which a number is not finite, and returns how many these are.
std::size_t drop_bad_keys(AnimationKeys& keys) {
    const std::size_t row = keys.width * (keys.is_cubic() ? 3 : 1);
    const auto is_good = [](float v) { return std::isfinite(v); };
    std::size_t kept = 0;
    for (std::size_t k = 0; k < keys.times.size(); ++k) {
        const std::span<const float> numbers(keys.values.data() + k * row, row);
        if (!is_good(keys.times[k]) || !std::ranges::all_of(numbers, is_good)) continue;
        if (kept < k) {
            keys.times[kept] = keys.times[k];
            std::ranges::copy(numbers, keys.values.data() + kept * row);
        }
        ++kept;
    }
    const std::size_t dropped = keys.times.size() - kept;
    keys.times.resize(kept);
    keys.values.resize(kept * row);
    return dropped;
}

/// Reads the keys of a channel; nothing, with a problem reported, if there are none that can be used.
std::optional<AnimationKeys> read_keys(const GltfAnimation& animation, const GltfAnimation::Channel& channel,
                                       int components, IntegerTypes integers, AccessorReader& accessors,
                                       const SourceLocation& where, ProblemList& problems) {
    const auto fail = [&](const std::string& message) {
        problems.error(where, message);
        return std::nullopt;
    };
    if (channel.sampler >= animation.samplers.size())
        return fail(fmt::format("sampler {} does not exist", channel.sampler));
    const GltfAnimation::Sampler& sampler = animation.samplers[channel.sampler];
    std::optional<AttributeData> times = accessors.attribute(sampler.input, {1, 1}, where);
    std::optional<AttributeData> values =
        accessors.attribute(sampler.output, {components, components, integers}, where);
    if (!times || !values) return std::nullopt;

    AnimationKeys keys{std::move(times->values), std::move(values->values), 0, sampler.interpolation};
    const std::size_t rows = keys.times.size() * (keys.is_cubic() ? 3 : 1);
    keys.width = keys.values.size() / rows;
    if (keys.width == 0 || keys.width * rows != keys.values.size() ||
        (components > 1 && keys.width != static_cast<std::size_t>(components)))
        return fail(fmt::format("{} numbers do not make {} keys", keys.values.size(), keys.times.size()));
    if (const std::size_t dropped = drop_bad_keys(keys); dropped > 0)
        problems.warning(where, fmt::format("{} keys are not finite and are left out", dropped));
    if (keys.times.empty()) return std::nullopt;
    if (const auto late = std::ranges::adjacent_find(keys.times, std::ranges::greater()); late != keys.times.end())
        return fail(fmt::format("the time of key {} is before that of key {}", late - keys.times.begin() + 1,
                                late - keys.times.begin()));
    const auto equal = std::ranges::adjacent_find(keys.times);
    if (equal != keys.times.end())
        problems.warning(where, fmt::format("keys {} and {} have the same time: the later one counts from there on",
                                            equal - keys.times.begin(), equal - keys.times.begin() + 1));
    return keys;
}

/// Numbers in each value of a channel, as the accessor has them: what is pointed to decides whether that is right.
int output_components(const GltfDocument& document, const GltfAnimation& animation,
                      const GltfAnimation::Channel& channel) {
    if (channel.sampler >= animation.samplers.size()) return 1;
    const auto accessor = static_cast<std::size_t>(animation.samplers[channel.sampler].output);
    return std::clamp(component_count(document.model.accessors[accessor]), 1, 4);
}

/// Remembers what animations move, by JSON pointers.
class MovedPlaces {
  public:
    /// Adds what `animation` moves, or returns false and adds nothing if something of it is moved already.
    [[nodiscard]] bool add(const GltfAnimation& animation) {
        std::vector<std::string> places;
        for (const GltfAnimation::Channel& channel : animation.channels) {
            if (!channel.pointer.empty())
                places.push_back(channel.pointer + '/');
            else if (channel.node >= 0)
                places.push_back(fmt::format("/nodes/{}/{}/", channel.node, channel.path));
        }
        if (std::ranges::any_of(places, [&](const std::string& place) { return is_moved(place); })) return false;
        places_.insert(places.begin(), places.end());
        return true;
    }

  private:
    /// True if `place`, something in it or something that it is in is moved.
    [[nodiscard]] bool is_moved(const std::string& place) const {
        const auto inside = places_.lower_bound(place);
        if (inside != places_.end() && inside->starts_with(place)) return true;
        std::size_t end = 0;
        for (int depth = 0; depth <= kMaxJsonDepth; ++depth) {  // nothing stands deeper
            end = place.find('/', end + 1);
            if (end == std::string::npos) return false;
            if (places_.contains(place.substr(0, end + 1))) return true;
        }
        return false;
    }

    std::set<std::string> places_;
};

bool wants_none(const RenderSettings& settings) {
    return settings.animations == std::vector<std::string>{std::string(kNoAnimation)};
}

/// Finds the animations that `settings` name. Errors for names that are not there.
std::vector<const GltfAnimation*> find_named(const GltfDocument& document, const RenderSettings& settings,
                                             ProblemList& problems) {
    std::vector<std::string_view> names{kNoAnimation};
    std::multimap<std::string_view, const GltfAnimation*> by_name;
    for (const GltfAnimation& animation : document.animations) {
        names.push_back(animation.name);
        by_name.emplace(animation.name, &animation);
    }
    std::vector<const GltfAnimation*> found;
    std::set<std::string_view> asked;
    for (const std::string& name : settings.animations) {
        if (!asked.insert(name).second && by_name.contains(name)) continue;
        const auto [begin, end] = by_name.equal_range(name);
        for (auto entry = begin; entry != end; ++entry) found.push_back(entry->second);
        if (begin != end) continue;
        if (name == kNoAnimation)
            problems.error(settings.at("/animation"), "'none' stands alone: it asks for no animation");
        else
            problems.error(document.at("/animations"),
                           fmt::format("there is no animation '{}'; {}", shown(name),
                                       problems.is_full() ? std::string() : name_hint(name, names)));
    }
    return found;
}

/// Says which animations are left out.
void warn_of_conflicts(const GltfDocument& document, std::span<const GltfAnimation* const> left_out,
                       ProblemList& problems) {
    if (left_out.empty()) return;
    constexpr std::size_t kMostNames = 8;
    std::string names;
    for (std::size_t i = 0; i < std::min(left_out.size(), kMostNames); ++i)
        names += fmt::format("{}'{}'", i == 0 ? "" : ", ", shown(left_out[i]->name));
    if (left_out.size() > kMostNames) names += fmt::format(" and {} more", left_out.size() - kMostNames);
    problems.warning(document.at("/animations"),
                     fmt::format("not played, since what they move is moved by animations before them: {}; --animation "
                                 "NAME chooses",
                                 names));
}

}  // namespace

std::vector<const GltfAnimation*> choose_animations(const GltfDocument& document, const RenderSettings& settings,
                                                    ProblemList& problems) {
    const bool is_still = document.animations.empty() || wants_none(settings);
    if (is_still && settings.frame)
        problems.error(document.at(""),
                       fmt::format("{}, so all frames would be the same; render one image, without --frames and "
                                   "\"frames\"",
                                   wants_none(settings) ? "no animation is to play" : "the file has no animation"));
    else if (is_still && !wants_none(settings))
        problems.warning(document.at(""), "a time code was given, but the file has no animation");
    if (is_still) return {};

    std::vector<const GltfAnimation*> asked;
    if (settings.animations.empty())
        for (const GltfAnimation& animation : document.animations) asked.push_back(&animation);
    else
        asked = find_named(document, settings, problems);
    MovedPlaces moved;
    std::vector<const GltfAnimation*> left_out;
    std::erase_if(asked, [&](const GltfAnimation* animation) {
        if (moved.add(*animation)) return false;
        left_out.push_back(animation);
        return true;
    });
    warn_of_conflicts(document, left_out, problems);
    return asked;
}

AnimationSampler::AnimationSampler(const GltfDocument& document, std::span<const GltfAnimation* const> animations,
                                   AccessorReader& accessors, ProblemList& problems) {
    for (const GltfAnimation* animation : animations) read(document, *animation, accessors, problems);
}

void AnimationSampler::read(const GltfDocument& document, const GltfAnimation& animation, AccessorReader& accessors,
                            ProblemList& problems) {
    static const std::map<std::string, Target> kTargets{{"translation", Target::Translation},
                                                        {"rotation", Target::Rotation},
                                                        {"scale", Target::Scale},
                                                        {"weights", Target::Weights}};
    constexpr auto kFractions = static_cast<IntegerTypes>(kSignedFractions | kUnsignedFractions);
    // What is true or false is pointed to with plain bytes.
    constexpr auto kOfPointers = static_cast<IntegerTypes>(kFractions | kUnsigned);
    for (std::size_t c = 0; c < animation.channels.size(); ++c) {
        const GltfAnimation::Channel& channel = animation.channels[c];
        const SourceLocation where = document.at(fmt::format("{}/channels/{}", animation.pointer, c));
        if (!channel.pointer.empty()) {
            const int components = output_components(document, animation, channel);
            std::optional<AnimationKeys> keys =
                read_keys(animation, channel, components, kOfPointers, accessors, where, problems);
            // Four numbers of this name are a quaternion wherever they stand: that of an environment.
            const bool is_rotation = components == 4 && channel.pointer.ends_with("/rotation");
            if (keys) pointer_channels_.push_back({channel.pointer, is_rotation, where, std::move(*keys)});
            continue;
        }
        if (channel.node < 0) continue;
        const auto target = kTargets.find(channel.path);
        if (target == kTargets.end()) {
            problems.warning(where, fmt::format("'{}' cannot be animated; the channel is ignored", channel.path));
            continue;
        }
        const int components = target->second == Target::Rotation ? 4 : target->second == Target::Weights ? 1 : 3;
        const IntegerTypes integers = components == 3 ? kNoIntegers : kFractions;
        std::optional<AnimationKeys> keys =
            read_keys(animation, channel, components, integers, accessors, where, problems);
        if (keys) channels_.push_back({channel.node, target->second, std::move(*keys)});
    }
}

std::vector<PointerValue> AnimationSampler::pointer_values(double seconds) const {
    std::vector<PointerValue> values;
    for (const PointerChannel& channel : pointer_channels_)
        values.push_back({channel.pointer, evaluate(channel.keys, seconds, channel.is_rotation), channel.where});
    return values;
}

NodePoses AnimationSampler::poses(double seconds) const {
    NodePoses poses;
    for (const Channel& channel : channels_) {
        std::vector<double> value = evaluate(channel.keys, seconds, channel.target == Target::Rotation);
        NodePose& pose = poses[channel.node];
        switch (channel.target) {
            case Target::Translation:
                pose.translation = std::array{value[0], value[1], value[2]};
                break;
            case Target::Rotation:
                pose.rotation = std::array{value[0], value[1], value[2], value[3]};
                break;
            case Target::Scale:
                pose.scale = std::array{value[0], value[1], value[2]};
                break;
            case Target::Weights:
                pose.weights = std::move(value);
                break;
        }
    }
    return poses;
}

std::array<double, 2> AnimationSampler::time_span() const {
    std::array<double, 2> span{};
    for (const Channel& channel : channels_) {
        const bool is_first = &channel == channels_.data();
        const double first = static_cast<double>(channel.keys.times.front());
        const double last = static_cast<double>(channel.keys.times.back());
        span = {is_first ? first : std::min(span[0], first), is_first ? last : std::max(span[1], last)};
    }
    return span;
}

}  // namespace etendue
