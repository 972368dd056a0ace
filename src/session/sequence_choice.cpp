#include "session/sequence_choice.h"

#include "picture/render_setup.h"
#include "processor/ray_code.h"
#include "session/prepared_scene.h"

#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace etendue {

IntegratorChoice choose_in_frame(const std::filesystem::path& scene, SettingsOverrides overrides, int frame,
                                 const ColorConfig& colors, const ThreadPool& threads) {
    overrides.frame = frame;
    PreparedScene prepared = prepare_scene(scene, overrides);
    RenderSettings settings = prepared.scene.settings;
    const std::vector<std::string> to_choose = replace_auto(settings);
    const std::string working_space = resolve_colors(settings, colors);
    const World world =
        ray_code().compile_world(std::move(prepared.scene), colors, working_space, threads, prepared.problems, {});
    IntegratorChoice choice = choose_integrator(world, settings, to_choose, threads);
    choice.reason += fmt::format(" in frame {}, the first", frame);
    return choice;
}

}  // namespace etendue
