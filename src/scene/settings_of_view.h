// Rows of the table of settings: the size of the image, its camera and the filter of its pixels.
#pragma once

#include "scene/setting_place.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

inline constexpr std::array<std::pair<std::string_view, PixelFilterType>, 4> kFilterNames{{
    {"blackman-harris", PixelFilterType::BlackmanHarris},
    {"box", PixelFilterType::Box},
    {"gaussian", PixelFilterType::Gaussian},
    {"mitchell", PixelFilterType::Mitchell},
}};

inline bool is_window(std::span<const double> numbers) {
    return numbers[0] < numbers[2] && numbers[1] < numbers[3];
}

/// Three numbers for each of eye, target and, if it is given, up.
inline bool is_camera_place(std::span<const double> numbers) {
    if (numbers.size() % 3 != 0) return false;
    const auto vector = [&](std::size_t i) { return Vec3d(numbers[i], numbers[i + 1], numbers[i + 2]); };
    const Vec3d view = vector(3) - vector(0);
    const Vec3d up = numbers.size() > 6 ? vector(6) : CameraPlace{}.up;
    constexpr double kLeastSine = 1e-6;  // beyond what single precision tells apart
    return view.length() > 0.0 && view.normalized().cross(up).length() > kLeastSine * up.length();
}

inline constexpr SettingPlace kResolutionPlace{
    [](const RenderSettings& settings) -> SettingValue {
        return std::vector<std::int64_t>{settings.film.width, settings.film.height};
    },
    [](RenderSettings& settings, const SettingValue& value) {
        const auto* const size = std::get_if<std::vector<std::int64_t>>(&value);
        settings.film.width = size != nullptr ? static_cast<int>(size->at(0)) : FilmSettings{}.width;
        settings.film.height = size != nullptr ? static_cast<int>(size->at(1)) : FilmSettings{}.height;
    }};

/// Nothing is the filter's own radius, which the settings hold as 0.
inline constexpr SettingPlace kFilterRadiusPlace{
    [](const RenderSettings& settings) {
        return settings.film.filter_radius == 0.0f ? SettingValue() : to_value(settings.film.filter_radius);
    },
    [](RenderSettings& settings, const SettingValue& value) {
        const auto* const radius = std::get_if<double>(&value);
        settings.film.filter_radius = radius != nullptr ? static_cast<float>(*radius) : 0.0f;
    }};

inline constexpr std::array kViewSettings{
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
        .decides = Decides::Window,
        .unit = "pixels",
        .default_text = "all",
        .help = "Render only the pixels from x0, y0 up to but not including x1, y1; y grows downwards from the top "
                "left corner. The window may reach beyond the image",
        .place = at([](auto& s) -> auto& { return s.film.crop; })},
    Setting{.pointer = "/film/overscan",
            .option = "--overscan",
            .type = RealNumber{{.min = 0.0, .max = kMostSide}, true},
            .decides = Decides::Window,
            .unit = "pixels",
            .help = "Render this many extra pixels at each edge. The EXR stores them outside its display window. A "
                    "number below 1 is a share of the longer side",
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
            .type = RealNumbers{{{.min = -kFarthest, .max = kFarthest}},
                                6,
                                9,
                                ',',
                                "ex,ey,ez,tx,ty,tz[,ux,uy,uz]",
                                "e unlike t, and u (default: 0,1,0) not along the view",
                                is_camera_place},
            .decides = Decides::Samples,
            .unit = "metres",
            .default_text = "where the scene has it",
            .help = "Put the camera at e and let it look at t, with u (default: 0,1,0) upwards",
            .place = at([](auto& s) -> auto& { return s.camera_place; })},
    Setting{.pointer = "/film/filter",
            .type = kChoiceOf<kFilterNames>,
            .decides = Decides::Samples,
            .help = "Pixel filter",
            .place = named_at<kFilterNames>([](auto& s) -> auto& { return s.film.filter; })},
    Setting{.pointer = "/film/filter_radius",
            .type = RealNumber{{.min = 0.1, .max = 8.0}, true},
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
};

}  // namespace etendue
