// Rows of the table of settings: the samples of a pixel, and when there are enough.
#pragma once

#include "scene/setting_place.h"

#include <array>
#include <cstdint>
#include <limits>
#include <string>

namespace etendue {

inline constexpr std::int64_t kMostSpp = 1 << 24;

inline constexpr std::array<std::pair<std::string_view, SamplerType>, 2> kSamplerNames{{
    {"sobol", SamplerType::Sobol},
    {"random", SamplerType::Random},
}};

inline std::string robust_text(int buckets) {
    return buckets > 0 ? "mon:" + std::to_string(buckets) : "mean";
}

inline constexpr std::array kSampleSettings{
    Setting{.pointer = "/spp",
            .option = "--spp",
            .type = WholeNumber{1, kMostSpp},
            .decides = Decides::End,
            .help = "Samples per pixel",
            .place = at([](auto& s) -> auto& { return s.spp; })},
    Setting{.pointer = "/seed",
            .option = "--seed",
            .type = WholeNumber{0, std::numeric_limits<std::uint32_t>::max()},
            .decides = Decides::Samples,
            .help = "Seed of everything random",
            .place = at([](auto& s) -> auto& { return s.seed; })},
    Setting{.pointer = "/sampler",
            .option = "--sampler",
            .type = kChoiceOf<kSamplerNames>,
            .decides = Decides::Samples,
            .help = "Sequence of the samples. `sobol`: Owen-scrambled and padded. `random`: independent numbers",
            .place = named_at<kSamplerNames>([](auto& s) -> auto& { return s.sampler; })},
    Setting{.pointer = "/time",
            .option = "--time",
            .type = RealNumber{kNotNegative},
            .decides = Decides::End,
            .unit = "seconds",
            .help = "Start no new pass after this time; 0 for no limit",
            .place = at([](auto& s) -> auto& { return s.time_limit; })},
    Setting{.pointer = "/error",
            .option = "--error",
            .type = RealNumber{kNotNegative},
            .decides = Decides::End,
            .help = "Start no new pass once the image's estimated relative error is at most this. 0.05 is a clean "
                    "preview, 0.01 a clean image, 0 sets no limit. The error is a root mean square. Values below half "
                    "of the image's own scale are measured against that half. Pixels get the samples they need, "
                    "`--spp` at most. The film takes twice the memory",
            .page = "adaptive.md#what-the-error-is-relative-to",
            .place = at([](auto& s) -> auto& { return s.relative_error; })},
    Setting{.pointer = "/clamp_indirect",
            .option = "--clamp-indirect",
            .type = RealNumber{kNotNegative, true},
            .decides = Decides::Samples,
            .unit = "units of the image",
            .help = "Limit the largest component of each contribution of indirect light to this; 0 sets no limit. "
                    "Fireflies get fewer, but light is missing",
            .page = "fireflies.md",
            .place = at([](auto& s) -> auto& { return s.clamp_indirect; })},
    Setting{.pointer = "/robust",
            .option = "--robust",
            .type = Form{kRobustForm, "^(mean|mon:([3579]|[12][13579]|31))$", parses<parse_robust>},
            .decides = Decides::Sums,
            .help =
                "`mean`, or `mon:N`: split the samples of a pixel into N groups and take the median of their means. "
                "The median removes a few fireflies; with few samples the image is too dark",
            .page = "fireflies.md",
            .place = parsed_at<parse_robust, robust_text>([](auto& s) -> auto& { return s.robust_buckets; })},
    Setting{.pointer = "/brightest",
            .option = "--brightest",
            .type = WholeNumber{0, kMostBrightest},
            .decides = Decides::Report,
            .help = "List this many of the brightest contributions, with their paths, in NAME.json and, if the option "
                    "is given, on stderr",
            .page = "fireflies.md",
            .place = at([](auto& s) -> auto& { return s.brightest; })},
    Setting{.pointer = "/adaptive",
            .option = "--adaptive",
            .type = YesNo{"--no-adaptive", "With `--error`, give all pixels as many samples"},
            .decides = Decides::End,
            .needs = "/error",
            .help = "With `--error`, give every pixel as many samples as it needs, `--spp` at most",
            .page = "adaptive.md",
            .place = at([](auto& s) -> auto& { return s.adaptive; })},
    Setting{.pointer = "/min_spp",
            .option = "--min-spp",
            .type = WholeNumber{1, kMostSpp},
            .decides = Decides::End,
            .needs = "/error",
            .help = "Samples that every pixel gets before an adaptive render skips any pixel",
            .page = "adaptive.md",
            .place = at([](auto& s) -> auto& { return s.min_spp; })},
};

}  // namespace etendue
