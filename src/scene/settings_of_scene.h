// Rows of the table of settings: what the scene shows, and how it moves.
#pragma once

#include "core/byte_size.h"
#include "scene/setting_place.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace etendue {

inline SettingValue byte_size_text(const std::optional<std::uint64_t>& bytes) {
    return bytes ? SettingValue(to_byte_size(*bytes)) : SettingValue();
}

/// Reads a size of memory for textures, which needs no smaller unit than mebibytes; 0 is as little as can be.
inline std::optional<std::uint64_t> parse_texture_memory(std::string_view text) {
    return text.find('K') == std::string_view::npos ? parse_byte_size(text) : std::nullopt;
}

inline bool is_some_text(std::string_view text) {
    return !text.empty();
}

inline bool are_frames(std::span<const double> numbers) {
    const double step = numbers.size() < 3 ? 1.0 : numbers[2];
    return numbers[0] <= numbers[1] && step >= 1.0 && (numbers[1] - numbers[0]) / step < FrameRange::kMost;
}

inline bool are_times(std::span<const double> numbers) {
    return numbers[0] <= numbers[1];
}

inline constexpr std::array kSceneSettings{
    Setting{.pointer = "/scene_name",
            .option = "--scene",
            .type = Name{},
            .decides = Decides::Samples,
            .default_text = "the file's own",
            .help = "Name of the scene to show, if the file has several",
            .place = at([](auto& s) -> auto& { return s.scene_name; })},
    Setting{.pointer = "/variant",
            .option = "--variant",
            .type = Name{},
            .decides = Decides::Samples,
            .default_text = "the file's own",
            .help = "Name of the file's set of materials (`KHR_materials_variants`)",
            .place = at([](auto& s) -> auto& { return s.variant; })},
    Setting{.pointer = "/light_units",
            .option = "--light-units",
            .type = kChoiceOf<kLightUnitNames>,
            .decides = Decides::Samples,
            .help = "Units of lights. `photometric`: candela, lux and emission count as they are, and the image is in "
                    "cd/m2. `radiometric`: emission is in watts; candela and lux are divided by 683.002 lm/W",
            .page = "gltf.md#light-and-its-units",
            .place = named_at<kLightUnitNames>([](auto& s) -> auto& { return s.light_units; })},
    Setting{
        .pointer = "/texture_memory",
        .option = "--texture-memory",
        .type = Form{"a number of up to six digits with M, G or T behind it, such as 8G", "^[0-9]{1,6}[MGT](i?B)?$",
                     parses<parse_texture_memory>},
        .decides = Decides::Schedule,
        .default_text = "half of the machine's",
        .help =
            "Memory for decoded textures, such as 8G or 512M. Scenes that need more read their textures piece by piece",
        .page = "gltf.md#textures",
        .place = parsed_at<parse_texture_memory, byte_size_text>([](auto& s) -> auto& { return s.texture_memory; })},
    Setting{.pointer = "/missing_textures",
            .option = "--missing-textures",
            .type = kChoiceOf<kMissingTexturesNames>,
            .decides = Decides::Schedule,
            .help = "`warn`: materials do without a texture that is missing or broken; `error`: the scene is refused",
            .page = "gltf.md#missing-textures",
            .place = named_at<kMissingTexturesNames>([](auto& s) -> auto& { return s.missing_textures; })},
    Setting{.pointer = "/accelerator",
            .option = "--accelerator",
            .type = kChoiceOf<kAcceleratorNames>,
            .decides = Decides::Samples,
            .help = "Structure that finds what rays meet. All but `embree` are for teaching: they are many times as "
                    "slow, and refuse motion blur and culled back faces",
            .page = "accelerators.md",
            .place = named_at<kAcceleratorNames>([](auto& s) -> auto& { return s.accelerator; })},
    Setting{.pointer = "/cull_backfaces",
            .option = "--cull-backfaces",
            .type = YesNo{},
            .decides = Decides::Samples,
            .help = "Hide the backs of single-sided surfaces from all rays. Closed glass and other bodies keep theirs",
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
};

inline constexpr std::array kAnimationSettings{
    Setting{.pointer = "/time_code",
            .option = "--time-code",
            .type = RealNumber{},
            .decides = Decides::Samples,
            .unit = "seconds",
            .default_text = "at rest",
            .help = "Show this moment of the animation",
            .place = at([](auto& s) -> auto& { return s.time_code; })},
    Setting{.pointer = "/animation",
            .option = "--animation",
            .type = Texts{{"the name of an animation, or none", "^.+$", is_some_text}, true},
            .decides = Decides::Samples,
            .needs = "/time_code",
            .default_text = "all whose targets do not conflict",
            .help = "Names of the animations to play, or `none`; the option may be given several times",
            .page = "gltf.md#animations",
            .place = at([](auto& s) -> auto& { return s.animations; })},
    Setting{
        .pointer = "/shutter",
        .option = "--shutter",
        .type = RealNumbers{{.is_single = true}, 2, 2, ':', "OPEN:CLOSE", "open <= close", are_times},
        .decides = Decides::Samples,
        .unit = "seconds",
        .help =
            "When the shutter opens and closes, counted from the moment shown. Whatever moves in between is blurred",
        .place = at([](auto& s) -> auto& { return s.shutter; })},
    Setting{.pointer = "/frames",
            .option = "--frames",
            .type = WholeNumbers{{-FrameRange::kMaxFrame, FrameRange::kMaxFrame},
                                 2,
                                 3,
                                 ':',
                                 "FRAME, FIRST:LAST or FIRST:LAST:STEP",
                                 "first <= last, step >= 1 and at most 100000 frames",
                                 are_frames,
                                 true},
            .decides = Decides::Schedule,
            .default_text = "one image",
            .help =
                "Render a sequence from its first frame to its last, every step-th of them. Frame f is at time code "
                "+ f / fps",
            .page = "render-json.md#sequences",
            .place = at([](auto& s) -> auto& { return s.frames; })},
    Setting{.pointer = "/fps",
            .option = "--fps",
            .type = RealNumber{{.min = 0.0, .open_min = true}},
            .decides = Decides::Sums,  // layers of motion, and what headers say
            .help = "Frames per second of a sequence",
            .place = at([](auto& s) -> auto& { return s.fps; })},
};

}  // namespace etendue
