// Rows of the table of settings: layers, colours, and what files tell.
#pragma once

#include "scene/setting_place.h"

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace etendue {

inline constexpr std::array<std::pair<std::string_view, MistFalloff>, 3> kFalloffNames{{
    {"quadratic", MistFalloff::Quadratic},
    {"linear", MistFalloff::Linear},
    {"inverse-quadratic", MistFalloff::InverseQuadratic},
}};

inline constexpr SettingPlace kAovsPlace{[](const RenderSettings& settings) -> SettingValue {
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

inline constexpr std::array kLayerSettings{
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
            .help = "Where layers go. `layers`: into channels of the image. `parts`: into parts of its file. `files`: "
                    "into files of their own",
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
            .help = "Distance from `mist.start` to where all is mist",
            .page = "aovs.md",
            .place = at([](auto& s) -> auto& { return s.mist.depth; })},
    Setting{.pointer = "/mist/falloff",
            .type = kChoiceOf<kFalloffNames>,
            .decides = Decides::Sums,
            .help = "How mist grows in between: with the square of the distance from its start, evenly, or with the "
                    "square root",
            .page = "aovs.md",
            .place = named_at<kFalloffNames>([](auto& s) -> auto& { return s.mist.falloff; })},
};

inline constexpr std::array kColourSettings{
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
            .help = "Write the EXR as SMPTE ST 2065-4 requires: ACES2065-1, 16-bit floats, uncompressed",
            .page = "colour.md#aces-containers-smpte-st-2065-4",
            .place = at([](auto& s) -> auto& { return s.color.aces_container; })},
};

inline constexpr std::array kMetadataSettings{
    Setting{.pointer = "/metadata/owner",
            .option = "--owner",
            .type = Name{},
            .decides = Decides::Display,
            .default_text = "none",
            .help = "Owner of the image, written into the EXR (`owner`)",
            .page = "colour.md#what-an-exr-says-about-itself",
            .place = at([](auto& s) -> auto& { return s.metadata.owner; })},
    Setting{.pointer = "/metadata/comments",
            .option = "--comments",
            .type = Name{},
            .decides = Decides::Display,
            .default_text = "none",
            .help = "Any text, written into the EXR (`comments`)",
            .page = "colour.md#what-an-exr-says-about-itself",
            .place = at([](auto& s) -> auto& { return s.metadata.comments; })},
};

}  // namespace etendue
