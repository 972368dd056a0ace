#include "loader/gltf/gltf_animation.h"

#include <algorithm>
#include <cmath>
#include <map>
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
    const auto next = std::ranges::upper_bound(keys.times, seconds, {}, [](float t) { return static_cast<double>(t); });
    if (next == keys.times.begin()) return value_of(0);
    const auto k = static_cast<std::size_t>(next - keys.times.begin()) - 1;
    if (next == keys.times.end() || keys.interpolation == Interpolation::Step) return value_of(k);

    const double duration = static_cast<double>(keys.times[k + 1]) - static_cast<double>(keys.times[k]);
    const double t = (seconds - static_cast<double>(keys.times[k])) / duration;
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
    const auto is_bad = [](float v) { return !std::isfinite(v); };
    if (std::ranges::any_of(keys.times, is_bad) || std::ranges::any_of(keys.values, is_bad))
        return fail("a key is not finite");
    if (std::ranges::adjacent_find(keys.times, std::ranges::greater_equal()) != keys.times.end())
        return fail("the times of the keys do not increase");
    const std::size_t rows = keys.times.size() * (keys.is_cubic() ? 3 : 1);
    keys.width = keys.values.size() / rows;
    if (keys.width == 0 || keys.width * rows != keys.values.size() ||
        (components > 1 && keys.width != static_cast<std::size_t>(components)))
        return fail(fmt::format("{} numbers do not make {} keys", keys.values.size(), keys.times.size()));
    return keys;
}

/// Numbers in each value of a channel, as the accessor has them: what is pointed to decides whether that is right.
int output_components(const GltfDocument& document, const GltfAnimation& animation,
                      const GltfAnimation::Channel& channel) {
    if (channel.sampler >= animation.samplers.size()) return 1;
    const auto accessor = static_cast<std::size_t>(animation.samplers[channel.sampler].output);
    return std::clamp(component_count(document.model.accessors[accessor]), 1, 4);
}

}  // namespace

const GltfAnimation* find_animation(const GltfDocument& document, const RenderSettings& settings,
                                    ProblemList& problems) {
    const std::string& name = settings.animation;
    if (document.animations.empty()) {
        if (settings.frame)
            problems.error(document.at(""),
                           "the file has no animation, so all frames would be the same; render one "
                           "image, without --frames and \"frames\"");
        else
            problems.warning(document.at(""), "a time code was given, but the file has no animation");
        return nullptr;
    }
    if (name.empty()) return &document.animations.front();
    const auto found = std::ranges::find(document.animations, name, &GltfAnimation::name);
    if (found != document.animations.end()) return &*found;
    std::vector<std::string_view> names;
    names.reserve(document.animations.size());
    for (const GltfAnimation& animation : document.animations) names.push_back(animation.name);
    problems.error(document.at("/animations"),
                   fmt::format("there is no animation '{}'; {}", name, name_hint(name, names)));
    return nullptr;
}

AnimationSampler::AnimationSampler(const GltfDocument& document, const GltfAnimation& animation,
                                   AccessorReader& accessors, ProblemList& problems) {
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

}  // namespace etendue
