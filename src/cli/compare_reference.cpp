#include "cli/compare_reference.h"

#include "compare/image_pair.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Returns the time that a reference is rendered for: what is asked for, or ten times that of the longest variant.
RenderBudget reference_budget(const CompareArguments& arguments, const std::vector<VariantRenders>& renders,
                              const ThreadPool& threads) {
    if (arguments.reference_seconds) return budget_of(*arguments.reference_seconds, arguments, threads);
    double longest = 0.0;
    for (const VariantRenders& variant : renders)
        for (const SeedRender& render : variant.seeds) {
            const Snapshot& last = render.checkpoints.back();
            longest = std::max(longest, arguments.by_wall ? last.seconds : last.cpu_seconds);
        }
    return {.seconds = 10.0 * longest, .by_wall = arguments.by_wall};
}

/// Returns the reference of the file that was read.
Reference file_reference(const std::string& path, RequestedReference requested) {
    const bool is_of_comparison = requested.origin && requested.origin->has_other_renders;
    ReferenceReport file{
        .kind = "file",
        .text = fmt::format("The file {}{}.", path, is_of_comparison ? ", which another comparison has made" : "")};
    if (!requested.origin || !requested.origin->variance) return Reference(std::move(*requested.image), file);
    return Reference({std::move(*requested.image), std::move(*requested.origin->variance)}, std::move(file));
}

/// Reads a reference that is to be compared with images such as those of `variant`.
RequestedReference read_requested(const std::string& path, const Variant& variant, const ColorConfig& colors) {
    RequestedReference requested;
    const RenderOptions& sampling = variant.sampling;
    SceneLinearImage file = read_scene_linear(path, sampling.full_width, sampling.full_height, sampling.window,
                                              variant.settings.color.working_space, colors);
    requested.image = std::move(file.pixels);
    requested.notes = std::move(file.warnings);
    requested.origin = read_reference_origin(path, sampling.window);
    if (requested.origin && requested.origin->variance && file.is_converted) {
        requested.origin->variance.reset();
        requested.notes.push_back(
            fmt::format("the noise of '{}' is known in its own colour space alone, and is a part of all errors: "
                        "--working-space has that one",
                        path));
    }
    return requested;
}

}  // namespace

RequestedReference requested_reference(const CompareArguments& arguments, const std::vector<Variant>& variants,
                                       const ColorConfig& colors) {
    if (!arguments.reference.empty()) return read_requested(arguments.reference, variants.front(), colors);
    RequestedReference requested;
    if (arguments.reference_integrator.empty()) return requested;
    requested.variant = with_integrator(variants.front(), arguments.reference_integrator);
    requested.notes = reference_notes(*requested.variant, variants);
    return requested;
}

std::uint32_t first_seed(const CompareArguments& arguments, const std::vector<Variant>& variants,
                         RequestedReference& requested) {
    const std::uint32_t first = variants.front().settings.seed;
    if (!requested.origin) return first;
    const SeedRange& taken = requested.origin->seeds;
    const std::uint32_t count =
        static_cast<std::uint32_t>(arguments.seeds) * static_cast<std::uint32_t>(variants.size());
    // Differences of unsigned numbers, as seeds go on with 0 after the last.
    if (first - taken.first >= taken.count && taken.first - first >= count) return first;
    const bool is_given =
        std::ranges::any_of(arguments.common.given, [](const GivenOption& option) { return option.name == "--seed"; });
    const std::uint32_t after = taken.first + taken.count;
    requested.notes.push_back(
        is_given ? fmt::format("the reference was rendered with some of the same seeds, so that errors are not those "
                               "of independent images; --seed {} has others",
                               after)
                 : fmt::format("seeds begin with {}, after those of the reference", after));
    return is_given ? first : after;
}

std::optional<Reference> find_reference(const CompareArguments& arguments, RequestedReference requested,
                                        std::uint32_t seed, const std::vector<Variant>& variants,
                                        const std::vector<VariantRenders>& renders,
                                        const std::vector<FinishedImages>& images, const ThreadPool& threads,
                                        ComparisonReport& report) {
    if (requested.image) return file_reference(arguments.reference, std::move(requested));
    if (!requested.variant) return pool_reference(variants, images, report.pairs, report.notes);
    const auto rendered = render_reference(*requested.variant, reference_budget(arguments, renders, threads), seed,
                                           threads, arguments.quiet);
    if (!rendered) {
        report.notes.emplace_back(
            "there is no reference, so no errors are given: it was not rendered, because the comparison was "
            "interrupted");
        return std::nullopt;
    }
    return Reference(estimate_image(rendered->images),
                     {.kind = "integrator",
                      .text = fmt::format("Rendered by {} in {} parts of {} samples per pixel with seeds of their own, "
                                          "from {} on, in {:.3g} s, {:.3g} s of CPU time.",
                                          requested.variant->name, kReferenceRenders, rendered->spp, seed,
                                          rendered->seconds, rendered->cpu_seconds),
                      .seeds = {seed, kReferenceRenders},
                      .spp = kReferenceRenders * rendered->spp,
                      .seconds = rendered->seconds,
                      .cpu_seconds = rendered->cpu_seconds});
}

}  // namespace etendue
