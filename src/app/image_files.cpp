#include "app/image_files.h"

#include "app/peak_memory.h"
#include "app/phase_timer.h"
#include "core/write_file.h"
#include "output/aces_driver.h"
#include "output/exr_driver.h"
#include "output/preview_driver.h"

#include <filesystem>
#include <system_error>

namespace etendue {

void write_image_files(const OutputPaths& paths, ImageDescription& image, const ColorConfig& colors, PixelDepth depth,
                       const std::function<void()>& beside) {
    const PhaseTimer timer;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(std::filesystem::symlink_status(paths.json, ignored)))
        std::filesystem::remove(paths.json, ignored);
    if (image.frame.aces_container)
        AcesDriver(paths.exr, colors).write(image.frame);
    else
        ExrDriver(paths.exr, colors, depth).write(image.frame);
    PreviewDriver(paths.png, colors).write(image.frame);
    if (beside) beside();
    image.statistics.write = timer.elapsed();
    image.statistics.peak_memory_bytes = peak_memory_bytes();
    write_text(paths.json, to_json(image.statistics));
}

}  // namespace etendue
