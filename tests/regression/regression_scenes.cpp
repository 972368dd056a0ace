#include "regression/regression_scenes.h"

namespace etendue::test {

namespace {

// The naive integrator cannot find a directional light (sun-and-sky, instances), and hardly the small lights of
// veach-mis. The mean of veach-mis is mostly what the camera sees of its smallest and brightest light.
constexpr RegressionScene kScenes[] = {
    {"cornell-box", 64, 64, 16, 0.01, {"path", 4, 256}, {"naive", 8, 16384}},
    {"cornell-glass", 64, 64, 16, 0.01, {"path", 4, 64}, {"naive", 8, 4096}},
    {"furnace", 32, 32, 8, 0.01, {"path", 4, 16}, {"naive", 4, 64}},
    {"instances", 96, 54, 8, 0.01, {"path", 4, 16}, {"path", 8, 128}},
    {"material-grid", 96, 54, 16, 0.01, {"path", 4, 48}, {"naive", 8, 2048}},
    {"sun-and-sky", 96, 54, 8, 0.01, {"path", 4, 32}, {"path", 8, 256}},
    {"veach-mis", 96, 64, 8, 0.1, {"path", 4, 64}, {"path", 8, 256}},
};

}  // namespace

std::span<const RegressionScene> regression_scenes() {
    return kScenes;
}

}  // namespace etendue::test
