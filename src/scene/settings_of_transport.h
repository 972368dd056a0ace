// Rows of the table of settings: the integrator and what is its own.
#pragma once

#include "scene/setting_place.h"

#include <array>
#include <optional>
#include <string>

namespace etendue {

inline constexpr std::array<std::pair<std::string_view, MergeAt>, 3> kMergeNames{{
    {"sds", MergeAt::SeenByDeltas},
    {"all", MergeAt::Everywhere},
    {"none", MergeAt::Nothing},
}};
inline constexpr std::array<std::pair<std::string_view, Heuristic>, 2> kHeuristicNames{{
    {"balance", Heuristic::Balance},
    {"power", Heuristic::Power},
}};

inline SettingValue strategy_value(const std::optional<Strategy>& strategy) {
    return strategy ? SettingValue(strategy_text(*strategy)) : SettingValue();
}

inline std::string connections_text(int count) {
    return count > 0 ? "cache:" + std::to_string(count) : "pairwise";
}

inline constexpr std::array kTransportSettings{
    Setting{.pointer = "/integrator/type",
            .option = "--integrator",
            .type = Name{.is_integrator = true},
            .decides = Decides::Samples,
            .help = "Light transport algorithm",
            .page = "integrators.md",
            .place = at([](auto& s) -> auto& { return s.integrator.type; })},
    Setting{.pointer = "/integrator/max_depth",
            .option = "--max-depth",
            .type = WholeNumber{1, kMostInt},
            .decides = Decides::Samples,
            .unit = "edges",
            .help = "Longest paths from camera to light; 1 is emission seen directly, and media add none",
            .place = at([](auto& s) -> auto& { return s.integrator.lengths.max_depth; })},
    Setting{.pointer = "/integrator/min_depth",
            .option = "--min-depth",
            .type = WholeNumber{1, kMostInt},
            .decides = Decides::Samples,
            .unit = "edges",
            .help = "Leave out paths that are shorter than this",
            .place = at([](auto& s) -> auto& { return s.integrator.lengths.min_depth; })},
    Setting{.pointer = "/integrator/roulette_depth",
            .option = "--roulette-depth",
            .type = WholeNumber{1, kMostInt},
            .decides = Decides::Samples,
            .unit = "rays",
            .help = "Russian roulette may end a path after this many rays. Rays behind clear surfaces and in media "
                    "count; `bdpt` divides the number between its two subpaths",
            .page = "integrators.md#russian-roulette",
            .place = at([](auto& s) -> auto& { return s.integrator.lengths.roulette_depth; })},
    Setting{.pointer = "/integrator/light_samples",
            .option = "--light-samples",
            .type = WholeNumber{1, kMostLightSamples},
            .decides = Decides::Samples,
            .help = "Number of lights that `path` and `direct` sample at each point that the camera sees directly, in "
                    "mirrors or through smooth glass. More samples reduce the noise of soft shadows and many lights, "
                    "and take longer",
            .page = "integrators.md#which-light-is-sampled",
            .place = at([](auto& s) -> auto& { return s.integrator.light_samples; })},
    Setting{.pointer = "/integrator/heuristic",
            .option = "--heuristic",
            .type = kChoiceOf<kHeuristicNames>,
            .decides = Decides::Samples,
            .help = "How `bdpt` and `vcm` weigh their strategies: `balance`, or `power` with the exponent 2",
            .place = named_at<kHeuristicNames>([](auto& s) -> auto& { return s.integrator.heuristic; })},
    Setting{.pointer = "/integrator/strategy",
            .option = "--strategy",
            .type = Form{kStrategyForm, "^([0-9]+,[0-9]+|merging)$", parses<parse_strategy>},
            .decides = Decides::Samples,
            .default_text = "all",
            .help = "Show only the paths of one strategy: S vertices from the light and T from the camera, both ends "
                    "counted. `merging` shows what `vcm` merges",
            .page = "integrators.md#one-strategy-at-a-time",
            .place = parsed_at<parse_strategy, strategy_value>([](auto& s) -> auto& { return s.integrator.strategy; })},
    Setting{.pointer = "/integrator/weighted",
            .type = YesNo{"--unweighted", "Show the paths of `--strategy` as if no other strategy found them"},
            .decides = Decides::Samples,
            .help = "Whether the paths of the strategy are weighted. Unweighted paths show as if no other strategy "
                    "found them, and merges show as in photon mapping",
            .place = at([](auto& s) -> auto& { return s.integrator.weighted; })},
    Setting{.pointer = "/integrator/connections",
            .option = "--bdpt-connections",
            .type = Form{kConnectionsForm, "^(pairwise|cache:[1-9][0-9]{0,2})$", parses<parse_connections>},
            .decides = Decides::Samples,
            .help = "Which light vertices an eye vertex connects to. `pairwise`: all of its own sample. `cache:N`: N "
                    "random ones from many samples",
            .page = "integrators.md#connections-to-a-cache",
            .place = parsed_at<parse_connections, connections_text>(
                [](auto& s) -> auto& { return s.integrator.cached_connections; })},
    Setting{.pointer = "/integrator/lamp_images",
            .type = YesNo{"--no-lamp-images", "Leave images of small lamps in mirrors and glass to chance"},
            .decides = Decides::Samples,
            .help = "Whether images of small lamps in mirrors and smooth glass get samples of their own",
            .page = "integrators.md#images-of-lamps",
            .place = at([](auto& s) -> auto& { return s.integrator.lamp_images; })},
    Setting{
        .pointer = "/integrator/aimed_emission",
        .type = YesNo{"--no-aimed-emission", "Aim no light paths at mirrors and smooth glass"},
        .decides = Decides::Samples,
        .help = "Whether lights aim a share of their paths at mirrors and smooth glass, in `light`, `bdpt` and `vcm`",
        .page = "integrators.md#aimed-emission",
        .place = at([](auto& s) -> auto& { return s.integrator.aimed_emission; })},
    Setting{.pointer = "/integrator/merge",
            .option = "--merge",
            .type = kChoiceOf<kMergeNames>,
            .decides = Decides::Samples,
            .help = "Where `vcm` merges. `sds`: where both subpaths arrive by way of a mirror or smooth glass. `all`: "
                    "at every vertex. `none`: nowhere, so that `vcm` is `bdpt`",
            .page = "integrators.md#vcm",
            .place = named_at<kMergeNames>([](auto& s) -> auto& { return s.integrator.merging.at; })},
    Setting{.pointer = "/integrator/merge_radius",
            .option = "--merge-radius",
            .type = RealNumber{{.min = 0.01, .max = 100.0}},
            .decides = Decides::Samples,
            .unit = "pixels",
            .help = "Radius within which `vcm` merges in the first sample of a pixel; the radius shrinks in later ones",
            .page = "integrators.md#vcm",
            .place = at([](auto& s) -> auto& { return s.integrator.merging.radius; })},
    Setting{.pointer = "/integrator/merge_alpha",
            .type = RealNumber{{.min = 0.1, .max = 1.0}},
            .decides = Decides::Samples,
            .help = "How slowly the merge radius of `vcm` shrinks: the radius is proportional to the number of samples "
                    "to the power (merge_alpha - 1) / 2. With 1, the radius and its blur stay the same",
            .page = "integrators.md#vcm",
            .place = at([](auto& s) -> auto& { return s.integrator.merging.alpha; })},
};

}  // namespace etendue
