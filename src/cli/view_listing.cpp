#include "cli/view_listing.h"

#include "core/shown_text.h"

#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using OrderedJson = nlohmann::ordered_json;

void list_displays(const ColorConfig& colors, std::string& text) {
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "displays, with their views (* is the default)\n");
    for (const std::string& display : colors.displays()) {
        fmt::format_to(out, "  {}{}\n", shown_text(display), display == colors.default_display() ? " *" : "");
        for (const std::string& view : colors.views(display)) {
            const std::string looks = colors.looks_of_view(display, view);
            fmt::format_to(out, "    {}{}{}\n", shown_text(view), view == colors.default_view(display) ? " *" : "",
                           looks.empty() ? "" : fmt::format(", look {}", shown_text(looks)));
        }
    }
    fmt::format_to(out, "looks\n");
    for (const std::string& look : colors.looks()) fmt::format_to(out, "  {}\n", shown_text(look));
}

void list_layers(const ViewedFile& file, std::string& text) {
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "layers of {} ({}; * is the default)\n", shown_text(file.path),
                   file.color_space.empty() ? "colour space not said" : shown_text(file.color_space));
    const auto main = main_layer(file.image);
    for (const ImageLayer& layer : file.image.layers) {
        const ImageInfo& part = file.image.parts[static_cast<std::size_t>(layer.part)];
        fmt::format_to(out, "  {}{}: {} {}, {}x{}{}\n", layer.name.empty() ? "(main)" : shown_text(layer.name),
                       layer.name == main->name ? " *" : "", layer_kind_name(layer.kind),
                       shown_text(fmt::format("{}", fmt::join(layer.channels, " "))), part.width, part.height,
                       layer.problem.empty() ? "" : fmt::format(", cannot be read: {}", shown_text(layer.problem)));
    }
}

OrderedJson displays_json(const ColorConfig& colors) {
    OrderedJson displays = OrderedJson::array();
    for (const std::string& display : colors.displays()) {
        OrderedJson views = OrderedJson::array();
        for (const std::string& view : colors.views(display))
            views.push_back({{"name", view}, {"looks", colors.looks_of_view(display, view)}});
        displays.push_back({{"name", display}, {"default_view", colors.default_view(display)}, {"views", views}});
    }
    return displays;
}

OrderedJson file_json(const ViewedFile& file) {
    OrderedJson layers = OrderedJson::array();
    for (const ImageLayer& layer : file.image.layers) {
        const ImageInfo& part = file.image.parts[static_cast<std::size_t>(layer.part)];
        layers.push_back({{"name", layer.name},
                          {"kind", layer_kind_name(layer.kind)},
                          {"channels", layer.channels},
                          {"part", layer.part},
                          {"size", {part.width, part.height}},
                          {"problem", layer.problem.empty() ? OrderedJson() : OrderedJson(layer.problem)}});
    }
    const auto main = main_layer(file.image);
    return {{"path", file.path},
            {"color_space", file.color_space.empty() ? OrderedJson() : OrderedJson(file.color_space)},
            {"default_layer", main ? OrderedJson(main->name) : OrderedJson()},
            {"layers", layers}};
}

}  // namespace

std::string list_as_text(const ColorConfig& colors, const std::optional<ViewedFile>& file) {
    std::string text = fmt::format("OpenColorIO config: {}\n", shown_text(colors.origin()));
    list_displays(colors, text);
    if (file) list_layers(*file, text);
    return text;
}

std::string list_as_json(const ColorConfig& colors, const std::optional<ViewedFile>& file) {
    const OrderedJson json = {{"config", colors.origin()},
                              {"default_display", colors.default_display()},
                              {"displays", displays_json(colors)},
                              {"looks", colors.looks()},
                              {"file", file ? file_json(*file) : OrderedJson()}};
    return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

const char* layer_kind_name(LayerKind kind) {
    switch (kind) {
        case LayerKind::Color:
            return "colour";
        case LayerKind::Luminance:
            return "luminance";
        case LayerKind::Vector:
            return "vector";
        case LayerKind::Single:
            break;
    }
    return "channel";
}

}  // namespace etendue
