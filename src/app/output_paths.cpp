#include "app/output_paths.h"

namespace etendue {

OutputPaths OutputPaths::beside(const std::filesystem::path& exr) {
    OutputPaths paths{exr, exr, exr};
    paths.png.replace_extension(".png");
    paths.json.replace_extension(".json");
    return paths;
}

std::filesystem::path written_file(const std::filesystem::path& file) {
    constexpr int kMostLinks = 40;  // as the kernel
    std::filesystem::path target = std::filesystem::absolute(file);
    // Also of a link that leads to nothing: it will, as soon as another name has made what it leads to.
    for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(target); ++i)
        target = target.parent_path() / std::filesystem::read_symlink(target);
    return std::filesystem::weakly_canonical(target);
}

}  // namespace etendue
