// The arguments of `etendue compare`.
#pragma once

#include "compare/comparison_measures.h"
#include "compare/comparison_renders.h"
#include "compare/comparison_variants.h"

#include <optional>
#include <string>
#include <vector>

namespace etendue {

/// Holds a variant as the command line has it: "power: --heuristic power".
struct NamedOptions {
    std::string name;
    std::string options;
};

struct CompareArguments {
    std::string scene;
    std::string output;
    std::vector<std::string> integrators;
    std::vector<NamedOptions> variants;
    RenderRequest common;  ///< options that all variants share
    std::string command;   ///< this comparison's
    std::optional<double> seconds;
    bool by_wall = false;
    int seeds = 4;
    std::string reference;
    std::string reference_integrator;
    std::optional<double> reference_seconds;
    std::vector<NamedRegion> regions;
    std::vector<std::string> inset_classes;
    std::optional<int> longest_strategy;
    bool keep_images = false;
    std::string live;  ///< as `live_port` reads it
    int threads = 0;
    bool quiet = false;
    bool json = false;
};

/// Returns what ends a render after `seconds` on the clock, or after what all threads would take in them if they had
/// the machine to themselves.
[[nodiscard]] inline RenderBudget budget_of(double seconds, const CompareArguments& arguments,
                                            const ThreadPool& threads) {
    return {.seconds = arguments.by_wall ? seconds : seconds * threads.thread_count(), .by_wall = arguments.by_wall};
}

}  // namespace etendue
