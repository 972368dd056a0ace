#include "live/live_image.h"

#include "core/error.h"
#include "image/write.h"
#include "live/live_json.h"
#include "output/auto_exposure.h"
#include "output/data_image.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
namespace etendue {

namespace {

std::string query_text(const LiveRequest& request, std::string_view name) {
    const auto found = request.query.find(name);
    return found == request.query.end() ? std::string() : found->second;
}

template <typename Number>
Number number_of(const LiveRequest& request, std::string_view name, Number otherwise) {
    const std::string text = query_text(request, name);
    Number number = otherwise;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc{} && end == text.data() + text.size() ? number : otherwise;
}

/// Finds a layer by its name; null for the image itself.
const OutputLayer* layer_of(const OutputFrame& frame, const LiveRequest& request) {
    const std::string name = query_text(request, "layer");
    const auto found = std::ranges::find(frame.layers, name, &OutputLayer::name);
    return name.empty() || found == frame.layers.end() ? nullptr : &*found;
}

DataStyle style_of_layer(const OutputLayer& layer) {
    if (layer.is_matte) return DataStyle::Mattes;
    return names_ids(layer.name) ? DataStyle::Ids : style_of_values(layer.pixels);
}

/// Returns how `frame` is shown by itself.
DisplayView own_view(const OutputFrame& frame) {
    return {frame.working_space, frame.display, frame.view, frame.look, frame.exposure.value_or(0.0f)};
}

DisplayView view_of(const OutputFrame& frame, const LiveRequest& request) {
    DisplayView view = own_view(frame);
    const std::string display = query_text(request, "display");
    if (!display.empty() && display != view.display) view = {frame.working_space, display, {}, {}, view.exposure};
    if (const std::string named = query_text(request, "view"); !named.empty() && named != view.view) {
        view.view = named;
        view.look.clear();
    }
    view.exposure = std::clamp(number_of(request, "exposure", view.exposure), -100.0f, 100.0f);
    return view;
}

ImageF picture_of_frame(const OutputFrame& frame, const LiveRequest& request, const ColorConfig& colors) {
    const OutputLayer* const layer = layer_of(frame, request);
    const bool is_light = layer == nullptr || layer->is_color || layer->is_light;
    if (!is_light || (layer != nullptr && layer->pixels.channels < 3))
        return show_data(layer->pixels, style_of_layer(*layer)).pixels;
    return display_image(layer == nullptr ? frame.pixels : layer->pixels, view_of(frame, request), colors);
}

}  // namespace

void LiveImage::set(OutputFrame frame) {
    choose_missing_exposure(frame);
    auto next = std::make_shared<const OutputFrame>(std::move(frame));
    const std::scoped_lock lock(mutex_);
    held_ = {held_.version + 1, std::move(next)};
}

LiveImage::Held LiveImage::held() const {
    const std::scoped_lock lock(mutex_);
    return held_;
}

LiveAnswer LiveImage::png(const LiveRequest& request) const {
    const Held now = held();
    if (!now.frame || now.frame->pixels.pixels.empty()) return LiveAnswer::not_found();
    std::string key = std::to_string(now.version);
    for (const std::string_view name : {"layer", "display", "view", "exposure"})
        key += '\n' + query_text(request, name);
    {
        const std::scoped_lock lock(mutex_);
        if (key == png_key_) return {200, "image/png", png_};
    }
    std::string png;
    try {
        const std::vector<unsigned char> bytes = encode_png(picture_of_frame(*now.frame, request, colors_));
        png.assign(bytes.begin(), bytes.end());
    } catch (const SceneError& error) {
        return LiveAnswer::refused(error.what());  // no such display or view
    }
    const std::scoped_lock lock(mutex_);
    png_key_ = std::move(key);
    png_ = png;
    return {200, "image/png", std::move(png)};
}

LiveAnswer LiveImage::pixel(const LiveRequest& request) const {
    const Held now = held();
    if (!now.frame) return LiveAnswer::not_found();
    const OutputLayer* const layer = layer_of(*now.frame, request);
    const ImageF& image = layer == nullptr ? now.frame->pixels : layer->pixels;
    const float u = number_of(request, "u", -1.0f);
    const float v = number_of(request, "v", -1.0f);
    if (!(u >= 0.0f && u < 1.0f && v >= 0.0f && v < 1.0f) || image.pixels.empty())
        return LiveAnswer::refused("u and v must be in [0, 1)");
    const int x = static_cast<int>(u * static_cast<float>(image.width));
    const int y = static_cast<int>(v * static_cast<float>(image.height));
    nlohmann::json values = nlohmann::json::array();
    for (const float value : image.pixel(x, y))
        values.push_back(std::isfinite(value) ? nlohmann::json(value) : nullptr);
    const nlohmann::json json{{"x", x + now.frame->crop_x},
                              {"y", y + now.frame->crop_y},
                              {"channels", layer == nullptr ? "RGBA" : layer->channels},
                              {"values", std::move(values)}};
    return LiveAnswer::json(text_of(json));
}

std::optional<LiveImageFacts> LiveImage::facts() const {
    const Held now = held();
    if (!now.frame || now.frame->pixels.pixels.empty()) return std::nullopt;
    const OutputFrame& frame = *now.frame;
    LiveImageFacts facts{.version = now.version,
                         .width = frame.pixels.width,
                         .height = frame.pixels.height,
                         .spp = frame.spp,
                         .integrator = frame.integrator,
                         .space = frame.working_space};
    for (const OutputLayer& layer : frame.layers) facts.layers.push_back(layer.name);
    facts.shown = with_defaults(own_view(frame), colors_);
    return facts;
}

}  // namespace etendue
