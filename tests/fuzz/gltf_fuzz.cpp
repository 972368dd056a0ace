// Feeds the loader with whatever libFuzzer makes of a corpus of glTF files: it must load or refuse, never crash, hang
// or take memory without bound. Beside each lie the files of tests/fuzz/beside, which it may name; they stay as they
// are.
//
// Usage: fuzz_gltf [libFuzzer options] CORPUS_DIRECTORY; tools/lab/fuzz makes the corpus and runs it.
#include "loader/loader.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

namespace {

/// A directory in memory that goes with the process.
class Workplace {
  public:
    Workplace() {
        std::string pattern = "/dev/shm/etendue-fuzz-XXXXXX";
        const char* made = mkdtemp(pattern.data());
        if (made == nullptr) std::abort();
        directory_ = made;
        std::filesystem::copy(ETENDUE_SOURCE_DIR "/tests/fuzz/beside", directory_);
    }
    ~Workplace() {
        std::error_code ignored;
        std::filesystem::remove_all(directory_, ignored);
    }
    Workplace(const Workplace&) = delete;
    Workplace& operator=(const Workplace&) = delete;

    [[nodiscard]] std::filesystem::path file() const { return directory_ / "scene.gltf"; }

  private:
    std::filesystem::path directory_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Workplace workplace;
    std::ofstream(workplace.file(), std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    // Animations too, and what moves while a shutter is open.
    etendue::LoadOptions options;
    options.adjust = [](etendue::RenderSettings& settings) {
        settings.time_code = 0.25;
        settings.shutter = {0.0, 0.5};
    };
    // Text and GLB alike: the loader looks at the first bytes.
    const etendue::LoadedScene loaded = etendue::inspect_scene(workplace.file(), options);
    if (!loaded.problems.has_errors()) static_cast<void>(etendue::compute_bounds(loaded.scene));
    return 0;
}
