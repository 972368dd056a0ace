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
    if (integrators.size() == 1)
        return fmt::format("'{}', which alone serves what is asked for", kComparedNames.at(best));
    const auto add = [](std::string& list, const std::string& item) { list += (list.empty() ? "" : " and ") + item; };
    std::string told;
    std::string untold;
    for (const std::size_t other : integrators) {
        const std::string name = fmt::format("'{}'", kComparedNames.at(other));
        if (!findings.is_told.at(other))
            add(untold, name);
        else if (other != best)
            add(told, fmt::format("{} takes {}{} times", name, findings.is_told.at(best) ? "" : "at least ",
                                  times(findings.time_to_error(other) / findings.time_to_error(best))));
    }
    std::string reason = fmt::format("'{}'", kComparedNames.at(best));
    if (!told.empty()) reason += fmt::format(": for as little noise {} as long", told);
    if (!untold.empty())
        reason += fmt::format("{} a pilot's few samples tell too little of the noise of {}", told.empty() ? ":" : ";",
                              untold);
    return reason;
}

}  // namespace

// The pilot is small: of integrators that are about as good, the simplest is taken, and of two bounds neither is
// better.
IntegratorChoice choose_by(const PilotFindings& findings, const std::vector<std::size_t>& integrators) {
    std::size_t best = integrators.front();
    for (const std::size_t i : integrators)
        if ((findings.is_told.at(i) || findings.is_told.at(best)) &&
            kWorthwhile * findings.time_to_error(i) < findings.time_to_error(best))
            best = i;
    return {std::string(kComparedNames.at(best)), reason_for(findings, best, integrators)};
}

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
    compared.reserve(integrators.size());
    for (const std::string& name : integrators)
        compared.push_back(static_cast<std::size_t>(std::ranges::find(kComparedNames, name) - kComparedNames.begin()));
    if (settings.integrator.lengths.max_depth <= kDirectEdges || !world.traits().has_lights)
        return {integrators.front(),
                fmt::format("'{}', since paths of so few edges need no other", integrators.front())};
    const FilmSettings& film = settings.film;
    return choose_by(ray_code().run_pilot(world, settings.integrator, film.width, film.height, threads), compared);
}

}  // namespace etendue
