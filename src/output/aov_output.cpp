#include "output/aov_output.h"

#include "output/cryptomatte.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace etendue {

namespace {

std::vector<float> resolve_mean(const Film& film) {
    const std::vector<float> rgba = film.resolve();
    std::vector<float> rgb;
    rgb.reserve(rgba.size() / 4 * 3);
    for (std::size_t i = 0; i < rgba.size(); i += 4) rgb.insert(rgb.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
    return rgb;
}

std::vector<float> resolve_values(const Film& film, const AovOutput& output) {
    std::vector<float> values = film.resolve_values(output.first, output.channels.size());
    if (output.background != 0.0f)
        for (float& value : values) value += output.background;
    return values;
}

std::vector<float> resolve(const Film& film, const AovOutput& output) {
    switch (output.kind) {
        case AovKind::Layer:
            return film.resolve_light(output.first);
        case AovKind::Values:
            return resolve_values(film, output);
        case AovKind::Nearest:
            return film.resolve_nearest(output.first, output.channels.size(), output.background);
        case AovKind::Samples:
            return film.resolve_sample_counts();
        case AovKind::Variance:
            return film.resolve_variance();
        case AovKind::Rays:
            return film.resolve_ray_counts();
        case AovKind::Mean:
            return resolve_mean(film);
        case AovKind::Matte:
            return film.resolve_matte(output.first, output.channels.size() / 2);
        case AovKind::Deep:
            break;
    }
    return {};
}

}  // namespace

DeepPixels resolve_deep_pixels(const Film& film) {
    DeepPixels deep;
    const std::vector<std::vector<DeepSample>> image = film.resolve_deep();
    std::size_t count = 0;
    for (const std::vector<DeepSample>& samples : image) count += samples.size();
    deep.counts.reserve(image.size());
    deep.colors.pixels.reserve(4 * count);
    deep.depths.reserve(2 * count);
    for (const std::vector<DeepSample>& samples : image) {
        deep.counts.push_back(static_cast<std::uint32_t>(samples.size()));
        for (const DeepSample& s : samples) {
            deep.colors.pixels.insert(deep.colors.pixels.end(), {s.r, s.g, s.b, s.alpha});
            deep.depths.insert(deep.depths.end(), {s.front, s.back});
        }
    }
    deep.colors.channels = 4;
    deep.colors.width = static_cast<int>(deep.depths.size() / 2);
    deep.colors.height = 1;
    return deep;
}

OutputLayer resolve_layer(const Film& film, const AovOutput& output) {
    OutputLayer layer{.name = output.name, .channels = output.channels, .is_float = output.is_float};
    layer.is_light = output.kind == AovKind::Layer || output.kind == AovKind::Mean;
    layer.is_color = layer.is_light || (output.kind == AovKind::Values && output.channels == "RGB");
    if (output.kind == AovKind::Matte) {
        layer.is_matte = true;
        layer.attributes = matte_attributes(output.name, output.manifest);
    } else if (!output.manifest.empty()) {
        layer.attributes.push_back({"etendue:names/" + output.name, output.manifest});
    }
    layer.pixels.width = film.window().width();
    layer.pixels.height = film.window().height();
    layer.pixels.channels = static_cast<int>(output.channels.size());
    layer.pixels.pixels = resolve(film, output);
    return layer;
}

}  // namespace etendue
