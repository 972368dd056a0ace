#include "wave/aov/layered_render.h"

#include "integrator/agreement_render.h"

#include <atomic>
#include <utility>

namespace etendue::test {

AovSet expression_layers(const AgreementCase& agreement, const std::vector<std::string>& expressions) {
    const SceneDesc scene = agreement_scene(agreement);
    PathNames names;
    for (const MaterialDesc& material : scene.materials) names.materials.push_back(material.name);
    for (const LightDesc& light : scene.lights) names.lights.push_back(light.name);
    for (const InstanceDesc& instance : scene.instances) names.lights.push_back(instance.name);
    names.lights.emplace_back("environment");
    std::vector<PathExpression> parsed;
    parsed.reserve(expressions.size());
    for (const std::string& text : expressions) parsed.push_back(parse_expression(text));
    AovSet aovs;
    aovs.layout.light = expressions.size();
    aovs.automaton = std::make_shared<PathAutomaton>(parsed, names);
    aovs.lamp_count = scene.lights.size();
    aovs.instance_count = scene.instances.size();
    return aovs;
}

RenderResult render_layers(const World& world, const Integrator& integrator, const AgreementCase& agreement,
                           std::shared_ptr<const AovSet> aovs, std::uint32_t seed) {
    const ThreadPool threads;
    const std::atomic<bool> stop{false};
    RenderOptions options = render_options(agreement);
    options.seed = seed;
    options.aovs = std::move(aovs);
    return render(world, integrator, options, threads, stop, {});
}

RenderResult render_layers(const World& world, const std::string& integrator, const AgreementCase& agreement,
                           std::shared_ptr<const AovSet> aovs, std::uint32_t seed) {
    return render_layers(world, *make_integrator(integrator, {.lengths = agreement.lengths}), agreement,
                         std::move(aovs), seed);
}

}  // namespace etendue::test
