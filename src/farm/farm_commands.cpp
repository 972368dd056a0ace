#include "farm/farm_commands.h"

#include "picture/output_paths.h"
#include "process/shell_word.h"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

std::string render_command(const FarmImage& image, const std::filesystem::path& output, const std::string& samples,
                           const FarmOptions& options) {
    std::vector<GivenOption> words{{"", image.job.scene.string()}};
    if (image.job.frame) words.push_back({"--frames", fmt::format("{}", *image.job.frame)});
    if (image.job.first_frame && image.job.first_frame != image.job.frame)
        words.push_back({"--first-frame", fmt::format("{}", *image.job.first_frame)});
    words.push_back({"-o", output.string()});
    if (!samples.empty()) words.push_back({"--samples", samples});
    words.push_back({"--resume", std::nullopt});
    words.push_back({"--checkpoint-every", fmt::format("{}", options.checkpoint_minutes)});
    words.push_back({"--threads", fmt::format("{}", options.threads)});
    words.push_back({"--quiet", std::nullopt});
    if (!image.texture_memory.empty()) words.push_back({"--texture-memory", image.texture_memory});
    words.insert(words.end(), options.options.begin(), options.options.end());
    return command_line(fmt::format("exec {} render", quoted(options.program.string())), words);
}

}  // namespace

std::string whole_image_command(const FarmImage& image, const FarmOptions& options) {
    return render_command(image, image.render_output, {}, options);
}

std::string part_command(const FarmImage& image, const SampleRange& range, const FarmOptions& options) {
    // `render` puts the number of a frame into the name of its part, too.
    const ImageJob unnumbered{};
    const std::filesystem::path folder = parts_folder(options.output, image.job.output);
    return render_command(image, part_file(folder, unnumbered, range), fmt::format("{}:{}", range.begin, range.end),
                          options);
}

std::string merge_command(const FarmImage& image, const FarmOptions& options) {
    const std::filesystem::path folder = parts_folder(options.output, image.job.output);
    std::string parts;
    for (const SampleRange& range : image.ranges)
        parts += fmt::format(" {}", quoted(part_file(folder, image.job, range).string()));
    // Merging is the same with all instruction sets: a node that lacks that of the renders can do it.
    const std::string merge = fmt::format("env -u ETENDUE_ISA {} merge", quoted(options.program.string()));
    // Renamed at once: whoever is ended in the middle of removing parts has left none that look as if some were
    // missing.
    const std::string from = quoted(folder.string());
    const std::string away = quoted(folder.string() + ".merged");
    return fmt::format(
        "if [ -e {0} ] || ! [ -e {1} ]; then {2}{3} -o {4} --quiet{5} && rm -rf -- {6} && mv -T -- {0} {6}; fi "
        "&& "
        "rm -rf -- {6}",
        from, quoted(OutputPaths::beside(image.job.output).json.string()), merge, parts,
        quoted(image.job.output.string()), options.depth == PixelDepth::Float ? " --float" : "", away);
}

}  // namespace etendue
