// Writes the report of a batch that never was, for tools/ci/check_batch_page: every outcome, names and errors that
// would like to be markup, and as many units as are asked for.
//
// Usage: sample_batch DIRECTORY UNITS [running] [PNG...]. The batch goes on still if it is "running". The images are
// the files that are named, or else some that are made.
#include "batch/batch_ledger.h"
#include "batch/batch_page.h"
#include "image/write.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

namespace fs = std::filesystem;

/// The first units are called so; the others are frames of sequences.
constexpr std::array kHostileNames{
    "shots/</script><script>document.title='x'<!--",
    "shots/\"><img src=x onerror=alert(1)>",
    "shots/'quoted' & %41 ?a=b#c",
    "javascript:alert(1)",
    "shots/back\\slash and \xe2\x80\xae right to left",
};
constexpr const char* kHostileError =
    "shots/a/scene.gltf: /materials/3: the texture \"<img src=x onerror=alert(1)>\" cannot be read: no such file\n"
    "    </script><script>alert(2)</script>\n    put the file there, or take it out of the material";
constexpr std::array kScenes{"sq010/sh020/kitchen", "sq010/sh030/hall", "sq020/sh010/street", "props/lamp"};

ImageF made_image(int width, int height) {
    ImageF image(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float u = static_cast<float>(x) / static_cast<float>(width);
            const float v = static_cast<float>(y) / static_cast<float>(height);
            image.pixel(x, y)[0] = 0.5f + 0.5f * std::sin(9.0f * u * v);
            image.pixel(x, y)[1] = u;
            image.pixel(x, y)[2] = 0.2f + 0.6f * v;
        }
    return image;
}

/// Puts the image of a unit where it says that it is.
void place_image(const fs::path& png, int index, const std::vector<fs::path>& given) {
    fs::create_directories(png.parent_path());
    if (given.empty()) {
        const std::array<std::pair<int, int>, 3> sizes{{{480, 270}, {200, 300}, {64, 64}}};
        const auto [width, height] = sizes.at(static_cast<std::size_t>(index) % sizes.size());
        write_image(png, made_image(width, height), {.depth = PixelDepth::UInt8});
    } else {
        fs::copy_file(given[static_cast<std::size_t>(index) % given.size()], png, fs::copy_options::overwrite_existing);
    }
}

void fill_failed(BatchUnit& unit, int index) {
    unit.attempts = 2;
    if (index % 3 == 0) {
        unit.signal = "SIGSEGV";
        unit.error = "the process crashed while it rendered";
        for (int line = 1; line <= 20; ++line)
            unit.log.push_back(fmt::format("[info] line {} <b>of</b> the log", line));
    } else {
        unit.error = kHostileError;
        unit.log = {"[warning] a texture is missing", "[error] </script>\xff not UTF-8"};
    }
}

void fill_statistics(BatchUnit& unit, int index) {
    const double seconds = 4.0 + 55.0 * std::pow(std::sin(0.37 * index), 2.0) + (index % 41 == 7 ? 190.0 : 0.0);
    unit.width = 1920;
    unit.height = index % 7 == 3 ? 1920 : 1080;
    unit.spp = 256 << (index % 3);
    unit.integrator = index % 3 == 0 ? "bdpt" : "path";
    unit.halt_reason = index % 2 == 0 ? "samples" : "error";
    unit.seconds = UnitSeconds{0.4, 0.9, seconds, 0.2};
    unit.estimated_seconds = seconds * (0.9 + 0.01 * (index % 21));
    unit.rays = static_cast<std::uint64_t>(seconds * 2.1e6);
    unit.rays_per_second = 2.1e6 - 3e4 * (index % 13);
    unit.peak_memory_bytes = (700ull + 90 * static_cast<unsigned>(index % 17)) << 20;
    unit.host = index % 5 == 4 ? "render02" : "render01";
    unit.attempts = unit.outcome == UnitOutcome::UpToDate ? 0 : 1;
    if (index % 6 == 1) unit.warnings = {"warning: <b>a texture</b> is missing"};
}

void fill_running(BatchUnit& unit) {
    unit.width = 1920;
    unit.height = 1080;
    unit.spp = 110;
    unit.spp_requested = 256;
    unit.integrator = "path";
    unit.fraction = 0.43;
    unit.seconds_left = 85.0;
    unit.host = "render01";
}

UnitOutcome outcome_of(int index) {
    switch (index % 23) {
        case 6:
        case 11:
            return UnitOutcome::Failed;
        case 13:
            return UnitOutcome::Interrupted;
        case 16:
            return UnitOutcome::Running;
        case 17:
            return UnitOutcome::RunningElsewhere;
        case 22:
            return UnitOutcome::NotStarted;
        case 2:
        case 3:
        case 19:
            return UnitOutcome::UpToDate;
        default:
            return UnitOutcome::Rendered;
    }
}

BatchUnit make_unit(int index) {
    BatchUnit unit;
    const auto hostile = static_cast<std::size_t>(index);
    if (hostile < kHostileNames.size()) {
        unit.scene = unit.name = kHostileNames.at(hostile);
    } else {
        unit.scene = kScenes.at(static_cast<std::size_t>(index / 6) % kScenes.size());
        unit.frame = 1 + index;
        unit.name = fmt::format("{}.{:04}", unit.scene, *unit.frame);
        if (index % 11 == 5) unit.variant = "night & rain";
    }
    unit.image = unit.name + ".exr";
    unit.preview = unit.name + ".png";
    unit.camera = "main";
    unit.outcome = outcome_of(index);
    if (unit.outcome != UnitOutcome::UpToDate)
        unit.reason = index % 4 == 0 ? "the settings changed: spp" : "no image yet";
    if (unit.outcome == UnitOutcome::Failed)
        fill_failed(unit, index);
    else if (has_image(unit.outcome))
        fill_statistics(unit, index);
    else if (unit.outcome == UnitOutcome::Running)
        fill_running(unit);
    return unit;
}

void write_sample(const fs::path& directory, int count, const std::vector<fs::path>& given, bool is_running) {
    BatchReport report{.title = "renders <2026>",
                       .output_directory = fs::absolute(directory).string(),
                       .program = "etendue 0.5 \"sample\"",
                       .command = "etendue batch shots props -o renders --frames 1:400 --retries 2",
                       .started = "2026-11-22T08:12:03Z",
                       .ended = is_running ? "" : "2026-11-22T09:47:51Z",
                       .seconds = 5748.0,
                       .state = is_running ? BatchState::Running : BatchState::Ended,
                       .written = is_running ? utc_time() : "2026-11-22T09:47:51Z",
                       .seconds_left = is_running ? std::optional(4210.0) : std::nullopt,
                       .host = "render01",
                       .threads = 16};
    for (int i = 0; i < count; ++i) {
        report.units.push_back(make_unit(i));
        const fs::path png = directory / report.units.back().preview;
        if (has_image(report.units.back().outcome)) place_image(png, i, given);
    }
    BatchPageWriter(directory).write(report);
}

}  // namespace

}  // namespace etendue

int main(int argc, char** argv) {
    if (argc < 3) {
        std::fputs("usage: sample_batch DIRECTORY UNITS [running] [PNG...]\n", stderr);
        return 2;
    }
    std::filesystem::create_directories(argv[1]);
    const bool is_running = argc > 3 && std::string(argv[3]) == "running";
    etendue::write_sample(argv[1], std::atoi(argv[2]), {argv + (is_running ? 4 : 3), argv + argc}, is_running);
    return 0;
}
