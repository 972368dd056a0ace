#include "regression/regression_scenes.h"

namespace etendue::test {

namespace {

constexpr std::string_view kScenes = kSceneDirectories[0];
constexpr std::string_view kRows = kSceneDirectories[1];

/// The rows are lit so that the naive integrator finds the light soon. A block holds a quarter of a sphere.
constexpr RegressionScene row(std::string_view name, int spp = 24) {
    return {kRows, name, 128, 64, 16, 0.01, {"path", 4, spp}, {"naive", 8, 128}};
}

/// Dark spheres, whose blocks lie inside them: noise of the bright walls would hide what changes there.
constexpr RegressionScene dark_row(std::string_view name) {
    return {kRows, name, 128, 64, 8, 0.01, {"path", 4, 32}, {"naive", 8, 384}};
}

/// What shows in few pixels or in faint colours.
constexpr RegressionScene fine_row(std::string_view name, int spp = 128) {
    return {kRows, name, 128, 64, 8, 0.01, {"path", 4, spp}, {"naive", 8, 1024}};
}

// The naive integrator cannot find a directional light (sun-and-sky, instances) or the points of row-lamps, and hardly
// the small lights of veach-mis; those references come from light's side, too. The mean of veach-mis is mostly what the
// camera sees of its smallest and brightest light.
constexpr RegressionScene kRegressionScenes[] = {
    {kScenes, "cornell-box", 64, 64, 16, 0.01, {"path", 4, 256}, {"naive", 8, 16384}},
    {kScenes, "cornell-glass", 64, 64, 16, 0.01, {"path", 4, 64}, {"naive", 8, 4096}},
    {kScenes, "furnace", 32, 32, 8, 0.01, {"path", 4, 16}, {"naive", 4, 64}},
    {kScenes, "instances", 96, 54, 8, 0.01, {"path", 4, 16}, {"bdpt", 8, 128}},
    {kScenes, "material-grid", 96, 54, 16, 0.01, {"path", 4, 48}, {"naive", 8, 2048}},
    {kScenes, "sun-and-sky", 96, 54, 8, 0.01, {"path", 4, 32}, {"bdpt", 8, 256}},
    {kScenes, "veach-mis", 96, 64, 8, 0.1, {"path", 4, 64}, {"bdpt", 8, 256}},
    fine_row("row-animated", 64),
    row("row-anisotropy"),
    fine_row("row-clearcoat"),
    row("row-compressed"),
    row("row-diffuse-transmission"),
    fine_row("row-dispersion"),
    row("row-emission"),
    row("row-geometry"),
    dark_row("row-ior"),
    row("row-iridescence"),
    {kRows, "row-lamps", 128, 64, 16, 0.01, {"path", 4, 48}, {"light", 8, 1024}},
    fine_row("row-models"),
    row("row-nested", 48),
    row("row-sheen"),
    dark_row("row-specular"),
    row("row-transmission"),
    row("row-volume"),
    row("row-volume-scatter", 48),
};

// For the noise of integrators: what path tracing makes of most of them in minutes is too noisy for blocks of pixels to
// tell anything, and their materials and shapes are in the others.
constexpr std::string_view kWithoutReference[] = {
    "ajar-door",       "caustic-ball",  "caustic-glass", "caustic-glasses", "caustic-mirror",
    "caustic-pool",    "caustic-prism", "caustic-ring",  "diamond",         "fog",
    "glossy-interior", "many-lights",   "radiometry",    "torus-in-glass",  "veach-bidir",
};

}  // namespace

std::span<const RegressionScene> regression_scenes() {
    return kRegressionScenes;
}

std::span<const std::string_view> scenes_without_reference() {
    return kWithoutReference;
}

}  // namespace etendue::test
