// etendue view: an EXR as a display shows it.
#include "cli/commands.h"
#include "cli/settings_options.h"
#include "cli/view_listing.h"
#include "core/error.h"
#include "core/log.h"
#include "core/standard_output.h"
#include "image/layers.h"
#include "image/write.h"
#include "output/data_image.h"
#include "output/display_image.h"
#include "output/output_space.h"
#include "output/software_name.h"
#include "picture/output_paths.h"
#include "session/file_color_space.h"
#include "session/input_files.h"
#include "session/output_directory.h"
#include "session/usage_error.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace etendue {

namespace {

struct ViewArguments {
    std::string file;
    std::filesystem::path output;
    std::optional<std::string> layer;
    std::string input_space;
    std::string display;
    std::string view;
    std::string look;
    std::optional<float> exposure;  ///< stops; none for what the file says
    std::optional<DataRange> range;
    int bits = 8;
    bool list = false;
    bool json = false;
    bool quiet = false;
};

/// "0:25.5".
DataRange parse_range(const std::string& text) {
    DataRange range;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%f:%f%c", &range.low, &range.high, &rest) != 2 || !std::isfinite(range.low) ||
        !std::isfinite(range.high) || !(range.low < range.high))
        throw CLI::ValidationError("--range", fmt::format("'{}' is not LOW:HIGH with LOW < HIGH", text));
    return range;
}

/// Calls `action`, whose complaints about the contents of a file get its name.
auto of_file(const std::string& file, const auto& action) {
    try {
        return action();
    } catch (const IoError& error) {
        throw SceneError({file, {}}, error.what());
    }
}

/// Calls `action`, whose complaints about a name are about an option.
auto of_option(const char* option, const auto& action) {
    try {
        return action();
    } catch (const SceneError& error) {
        throw SceneError({option, {}}, error.problems().all().front().message);
    }
}

/// True if `layer` has ranks of the Cryptomatte `matte`.
bool has_ranks_of(const ImageLayer& layer, const std::string& matte) {
    const std::string& channel = layer.channels.front();
    const auto is_digit = [&](std::size_t i) { return std::isdigit(static_cast<unsigned char>(channel[i])) != 0; };
    return channel.size() == matte.size() + 4 && channel.starts_with(matte) && is_digit(matte.size()) &&
           is_digit(matte.size() + 1);
}

bool is_cryptomatte(const ImageLayer& layer, const LayeredImage& image) {
    if (layer.kind != LayerKind::Color || layer.channels.size() != 4) return false;
    // Not all files have the metadata.
    return layer.name.find("Crypto") != std::string::npos ||
           std::ranges::any_of(image.mattes, [&](const std::string& matte) { return has_ranks_of(layer, matte); });
}

/// Returns the layer of the heaviest two ids of the Cryptomatte `matte`, or nothing if `image` has no such Cryptomatte.
std::optional<ImageLayer> first_ranks(const LayeredImage& image, const std::string& matte) {
    if (std::ranges::find(image.mattes, matte) == image.mattes.end()) return std::nullopt;
    for (const ImageLayer& layer : image.layers)
        if (layer.channels.front() == matte + "00.R") return layer;
    return std::nullopt;
}

ImageLayer chosen_layer(const LayeredImage& image, const ViewArguments& arguments) {
    auto layer = arguments.layer ? find_layer(image, *arguments.layer) : main_layer(image);
    if (!layer && arguments.layer) layer = first_ranks(image, *arguments.layer);
    if (!layer) {
        std::vector<std::string> names;
        for (const ImageLayer& known : image.layers) names.push_back(known.name.empty() ? "(main)" : known.name);
        constexpr std::size_t kMostNamed = 40;
        const std::size_t more = names.size() - std::min(names.size(), kMostNamed);
        names.resize(names.size() - more);
        throw SceneError({arguments.file, {}}, fmt::format("it has no layer and no channel '{}'; there are {}{}",
                                                           arguments.layer.value_or(""), fmt::join(names, ", "),
                                                           more > 0 ? fmt::format(" and {} more", more) : ""));
    }
    if (!layer->problem.empty()) throw SceneError({arguments.file, {}}, layer->problem);
    return *layer;
}

// ---- Layers of numbers.

bool is_colors(const ImageLayer& layer, bool is_matte, const ViewArguments& arguments) {
    if (!arguments.input_space.empty() && layer.channels.size() >= 3) return true;
    return (layer.kind == LayerKind::Color || layer.kind == LayerKind::Luminance) && !is_matte;
}

DataStyle style_of(const ImageLayer& layer, bool is_matte, const ImageF& image) {
    if (is_matte) return DataStyle::Mattes;
    if (layer.kind == LayerKind::Single && (layer.is_integer || names_ids(layer.name))) return DataStyle::Ids;
    return style_of_values(image);
}

ImageF show_numbers(const ImageLayer& layer, bool is_matte, const ImageF& image, const ViewArguments& arguments,
                    std::vector<ImageAttribute>& attributes) {
    const DataStyle style = arguments.range ? DataStyle::Range : style_of(layer, is_matte, image);
    DataPicture picture = show_data(image, style, arguments.range);
    if (!arguments.quiet) {
        const bool is_asked =
            !arguments.display.empty() || !arguments.view.empty() || !arguments.look.empty() || arguments.exposure;
        log_info("{}: numbers, {}{}", layer.name, picture.made,
                 is_asked ? "; display, view, look and exposure are for colours" : "");
    }
    attributes = {{"Software", std::string(software_name())}, {"etendue:data", picture.made}};
    return std::move(picture.pixels);
}

// ---- Layers of colours.

/// Y as R, G and B; alpha, which is associated, does not matter over black.
ImageF as_rgb(ImageF image) {
    if (image.channels >= 3) return image;
    ImageF rgb(image.width, image.height, 3);
    const auto channels = static_cast<std::size_t>(image.channels);
    for (std::size_t i = 0; i < rgb.pixels.size(); ++i) rgb.pixels[i] = image.pixels[i / 3 * channels];
    return rgb;
}

/// With names that the config has. Throws SceneError that names the option.
DisplayView display_view(const ViewArguments& arguments, std::string space, float exposure, const ColorConfig& colors) {
    DisplayView view{std::move(space), arguments.display, arguments.view, arguments.look, exposure};
    view = of_option("--display", [&] { return with_defaults(view, colors); });
    of_option("--display", [&] { (void)colors.views(view.display); });
    of_option("--view", [&] { (void)colors.looks_of_view(view.display, view.view); });
    of_option("--look", [&] { colors.require_look(view.look); });
    return view;
}

ImageF show_colors(ImageF image, const ImageInfo& part, const ViewArguments& arguments, const ColorConfig& colors,
                   std::vector<ImageAttribute>& attributes) {
    if (!part.is_float && arguments.input_space.empty())
        throw SceneError({arguments.file, {}},
                         "it holds integers, which are encoded already; give an EXR or HDR file, or say what they are "
                         "with --input-space");
    const FileColors from = arguments.input_space.empty()
                                ? colors_of_file(part, {}, arguments.file, colors)
                                : of_option("--input-space", [&] {
                                      return colors_of_file(part, arguments.input_space, arguments.file, colors);
                                  });
    if (!from.assumed.empty() && !arguments.quiet) log_warning("warning: {}", from.assumed);
    image = as_rgb(std::move(image));
    if (from.to_space) apply_matrix(image, *from.to_space);
    std::string space = from.space;
    if (!find_matrix(space, colors.default_working_space(), colors)) {
        // Exposure multiplies light.
        convert_space(image, space, colors.default_working_space(), colors);
        space = colors.default_working_space();
    }
    if (arguments.range && !arguments.quiet)
        log_info(
            "note: --range is for layers of numbers, and this one has colours: --exposure makes them darker or "
            "brighter");
    const float exposure = arguments.exposure.value_or(std::clamp(part.exposure.value_or(0.0f), -64.0f, 64.0f));
    const DisplayView view = display_view(arguments, std::move(space), exposure, colors);
    attributes = display_attributes(view);
    attributes.push_back({"etendue:inputSpace", from.space});
    return display_image(image, view, colors);
}

// ---- The command.

ExitCode run_list(const ViewArguments& arguments, const ColorConfig& colors) {
    std::optional<ViewedFile> file;
    if (!arguments.file.empty()) {
        file = of_file(arguments.file, [&] {
            return ViewedFile{arguments.file, read_layers(std::filesystem::path(arguments.file)), {}};
        });
        file->color_space = space_of_file(file->image.parts.front(), colors);
    }
    if (arguments.json)
        print_data(list_as_json(colors, file));
    else
        print_text(list_as_text(colors, file));
    return ExitCode::Success;
}

ExitCode run_view(const ViewArguments& arguments) {
    const ColorConfig colors = ColorConfig::from_environment();
    if (arguments.list) return run_list(arguments, colors);
    const std::filesystem::path path = arguments.file;
    require_files_kept("--output", std::array{arguments.output}, {path});
    const LayeredImage file = of_file(arguments.file, [&] { return read_layers(path); });
    const ImageLayer layer = chosen_layer(file, arguments);
    const bool is_matte = is_cryptomatte(layer, file);
    const bool colored = is_colors(layer, is_matte, arguments);
    if (colored) (void)display_view(arguments, colors.default_working_space(), 0.0f, colors);
    make_directory_of(arguments.output);
    require_writable(arguments.output);
    ImageF pixels = of_file(arguments.file, [&] { return read_layer(path, layer); });

    ImageWriteOptions options;
    options.depth = arguments.bits == 16 ? PixelDepth::UInt16 : PixelDepth::UInt8;
    const ImageInfo& part = file.parts[static_cast<std::size_t>(layer.part)];
    const ImageF shown = colored ? show_colors(std::move(pixels), part, arguments, colors, options.attributes)
                                 : show_numbers(layer, is_matte, pixels, arguments, options.attributes);
    options.attributes.push_back({"etendue:layer", layer.name});
    write_image(arguments.output, shown, options);
    return ExitCode::Success;
}

/// Throws UsageError for what cannot be followed.
void check(const ViewArguments& arguments) {
    if (arguments.json && !arguments.list) throw UsageError("--json prints what --list lists");
    if (arguments.list) return;
    if (arguments.file.empty()) throw UsageError("there is no file to view; --list alone lists displays and views");
    if (arguments.output.empty())
        throw UsageError(fmt::format("--output is missing: the PNG to write, such as -o {}",
                                     std::filesystem::path(arguments.file).stem().string() + ".view.png"));
    if (arguments.output.extension() != ".png")
        throw UsageError(fmt::format("--output '{}' must end in .png", arguments.output.string()));
}

void add_view_options(CLI::App& command, ViewArguments& arguments) {
    command.add_option("FILE", arguments.file, "EXR or HDR file");
    command.add_option("-o,--output", arguments.output, "PNG file to write");
    command.add_option("--layer", arguments.layer,
                       "Layer to show, one channel by its whole name, or a Cryptomatte (default: the first layer of "
                       "colours)");
    command.add_option("--input-space", arguments.input_space,
                       "Colour space of the file (default: what the file says); also shows X, Y, Z as a colour");
    command.add_option("--display", arguments.display, "OpenColorIO display (default: the config's)");
    command.add_option("--view", arguments.view, "OpenColorIO view, one of the display's (default: the display's)");
    command.add_option("--look", arguments.look,
                       "OpenColorIO look, in place of the view's own; several with commas, or none");
    command
        .add_option("--exposure", arguments.exposure,
                    "Stops by which colours are made brighter first (default: what the file says, or else 0)")
        ->check(real_range(-64.0, 64.0));
    command.add_option_function<std::string>(
        "--range", [&arguments](const std::string& text) { arguments.range = parse_range(text); },
        "Of numbers that are no colours, the values shown as black and as white: LOW:HIGH (default: the smallest and "
        "the largest; -1:1 for vectors within that)");
    command.add_option("--bits", arguments.bits, "Bits of a channel of the PNG: 8 (default) or 16")
        ->check(CLI::IsMember({8, 16}));
    command.add_flag("--list", arguments.list,
                     "Write no file; list the displays, views and looks of the config, and the file's layers");
    command.add_flag("--json", arguments.json, "List as JSON");
    command.add_flag("--quiet", arguments.quiet, "No notes or warnings; errors only");
}

}  // namespace

void add_view_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<ViewArguments>();
    CLI::App* command = app.add_subcommand("view", "Show an EXR, or a layer of one, as a PNG for a display");
    add_view_options(*command, *arguments);
    command->footer(
        "Colours go from the file's space, times 2 to the exposure, through look and view to the display; what is\n"
        "transparent lies over black. Other layers are shown without a view: one channel as grey from its smallest to\n"
        "its largest value, vectors that are within -1 to 1 with 0 as grey, ids in a colour for each. $OCIO may name\n"
        "another OpenColorIO config.\n\n"
        "Exit codes: 0 written or listed, 1 the PNG cannot be written, 2 usage error, 3 a file that cannot be read, "
        "or\n"
        "a name that neither the file nor the config has.\n\n"
        "Examples:\n"
        "  etendue view box.exr -o box.png --exposure 1.5\n"
        "  etendue view box.exr -o p3.png --display 'Display P3 - Display' --bits 16\n"
        "  etendue view box.exr -o box.png --look 'ACES 1.3 Reference Gamut Compression'\n"
        "  etendue view layers.exr -o normals.png --layer N\n"
        "  etendue view layers.exr -o depth.png --layer depth --range 0:20\n"
        "  etendue view camera.exr -o plate.png --input-space lin_rec2020 --view Un-tone-mapped\n"
        "  etendue view --list\n"
        "  etendue view layers.exr --list --json");
    command->callback([arguments, &action] {
        action = [arguments] {
            check(*arguments);
            return run_view(*arguments);
        };
    });
}

}  // namespace etendue
