#include "cli/variant_options.h"

#include "cli/command_mistakes.h"
#include "cli/settings_options.h"
#include "session/usage_error.h"

#include <array>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace etendue {

namespace {

/// Lists options that may be given to all variants alike, but not to one.
constexpr std::array kOptionsForAll{
    OptionOfRender{"--time", "all variants render alike, for --time of 'compare'"},
    OptionOfRender{"--seed", "every variant gets seeds of its own; the first of all is --seed of 'compare'"},
    OptionOfRender{"--spp", "all variants render alike, for --time or with --spp of 'compare'"}};

constexpr const char* kImagesOfCompare = "images that are kept have 32-bit floats in the working space";

constexpr std::array kOptionsOfRender{OptionOfRender{"--error", "the errors of all variants are measured"},
                                      OptionOfRender{"--adaptive", "here all pixels get as many samples"},
                                      OptionOfRender{"--no-adaptive", "here all pixels get as many samples anyway"},
                                      OptionOfRender{"--min-spp", "here all pixels get as many samples"},
                                      OptionOfRender{"--frames", "here --time-code names the moment"},
                                      OptionOfRender{"--fps", "here --time-code names the moment, in seconds"},
                                      OptionOfRender{"--brightest", "here no sample is listed"},
                                      OptionOfRender{"--aov", "here the image alone is compared"},
                                      OptionOfRender{"--aov-layout", "here the image alone is compared"},
                                      OptionOfRender{"--deep", "here the image alone is compared"},
                                      OptionOfRender{"--exr-space", kImagesOfCompare},
                                      OptionOfRender{"--aces-container", kImagesOfCompare},
                                      OptionOfRender{"--owner", kImagesOfCompare},
                                      OptionOfRender{"--comments", kImagesOfCompare},
                                      OptionOfRender{"--half", kImagesOfCompare},
                                      OptionOfRender{"--float", kImagesOfCompare}};

}  // namespace

std::span<const OptionOfRender> options_compare_sets() {
    return kOptionsOfRender;
}

RenderRequest with_options(const RenderRequest& common, const std::string& options) {
    RenderRequest request = common;
    CLI::App parser("", "render");
    // Its --help would be an exception that nobody expects.
    parser.set_help_flag();
    add_settings_options(parser, request.overrides);
    try {
        parser.parse(options, false);
    } catch (const CLI::ParseError& error) {
        throw UsageError(
            fmt::format("in the options of a variant, '{}': {}", options, mistake_in_words(parser, error)));
    }
    refuse_options(parser, kOptionsForAll);
    refuse_options(parser, kOptionsOfRender);
    request.given = merged(common.given, given_options(std::as_const(parser).get_options()));
    return request;
}

}  // namespace etendue
