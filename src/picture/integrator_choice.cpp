#include "picture/integrator_choice.h"

#include "core/error.h"
#include "picture/render_setup.h"
#include "processor/ray_code.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Counts the edges of the paths of direct light.
constexpr int kDirectEdges = 2;
/// Says how many times as long an integrator must take for a less simple one to be chosen.
constexpr double kWorthwhile = 1.25;

/// Returns how many times as long something takes, in words.
std::string times(double ratio) {
    constexpr double kMost = 10'000.0;
    if (!(ratio < kMost)) return "over 10,000";
    return ratio < 9.95 ? fmt::format("{:.1f}", ratio) : fmt::format("{:.0f}", ratio);
}

/// Returns the sentence that says why `findings` have `best` chosen of `integrators`.
std::string reason_for(const PilotFindings& findings, std::size_t best, const std::vector<std::size_t>& integrators) {
    std::string others;
    for (const std::size_t other : integrators) {
        if (other == best) continue;
        others += fmt::format("{}'{}' takes {} times", others.empty() ? "" : " and ", kComparedNames.at(other),
                              times(findings.time_to_error(other) / findings.time_to_error(best)));
    }
    if (others.empty()) return fmt::format("'{}', which alone serves what is asked for", kComparedNames.at(best));
    return fmt::format("'{}': for as little noise {} as long", kComparedNames.at(best), others);
}

}  // namespace

std::vector<std::string> integrators_to_choose(const RenderSettings& settings) {
    std::vector<std::string> integrators;
    for (const std::string_view name : kComparedNames) {
        RenderSettings with = settings;
        with.integrator.type = name;
        const auto& strategy = settings.integrator.strategy;
        if (strategy && !shows_strategy(with.integrator.type, *strategy)) continue;
        (void)create_integrator(with);
        integrators.emplace_back(name);
    }
    return integrators;
}

std::vector<std::string> replace_auto(RenderSettings& settings) {
    if (settings.integrator.type != kAutoIntegrator) return {};
    std::vector<std::string> integrators = integrators_to_choose(settings);
    settings.integrator.type = integrators.front();
    return integrators;
}

IntegratorChoice choose_integrator(const World& world, const RenderSettings& settings,
                                   const std::vector<std::string>& integrators, const ThreadPool& threads) {
    std::vector<std::size_t> compared;
    for (const std::string& name : integrators)
        compared.push_back(static_cast<std::size_t>(std::ranges::find(kComparedNames, name) - kComparedNames.begin()));
    if (settings.integrator.lengths.max_depth <= kDirectEdges || !world.traits().has_lights)
        return {integrators.front(),
                fmt::format("'{}', since paths of so few edges need no other", integrators.front())};
    const FilmSettings& film = settings.film;
    const PilotFindings findings = ray_code().run_pilot(world, settings.integrator, film.width, film.height, threads);
    // The pilot is small: of integrators that are about as good, the simplest is taken.
    std::size_t best = compared.front();
    for (const std::size_t integrator : compared)
        if (kWorthwhile * findings.time_to_error(integrator) < findings.time_to_error(best)) best = integrator;
    return {std::string(kComparedNames.at(best)), reason_for(findings, best, compared)};
}

}  // namespace etendue
