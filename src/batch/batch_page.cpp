#include "batch/batch_page.h"

#include "core/error.h"
#include "core/parallel.h"
#include "core/write_file.h"
#include "image/jpeg.h"
#include "image/scale_down.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

namespace fs = std::filesystem;

/// A page opens at once up to about this size: 1,200 thumbnails of full size, or 10,000 small ones.
constexpr std::size_t kBytesOfAll = 24'000'000;
constexpr std::size_t kMostBytes = 20'000;
/// With fewer, nothing can be told from a thumbnail.
constexpr std::size_t kLeastBytes = 1'000;

struct ThumbnailSize {
    int side;  ///< pixels of the longer side
    int quality;
};

/// From the best to the smallest.
constexpr std::array<ThumbnailSize, 7> kSizes{
    {{320, 85}, {320, 70}, {240, 70}, {160, 70}, {112, 65}, {80, 55}, {56, 45}}};

/// The best that has no more than `most` bytes; none if there is no such.
std::vector<unsigned char> encode_thumbnail(const ImageF& image, std::size_t most) {
    for (const ThumbnailSize& size : kSizes) {
        const int width =
            image.width >= image.height
                ? size.side
                : std::max(1, static_cast<int>(static_cast<std::int64_t>(size.side) * image.width / image.height));
        std::vector<unsigned char> file = encode_jpeg(scale_down(image, width), size.quality);
        if (file.size() <= most) return file;
    }
    return {};
}

std::vector<unsigned char> make_thumbnail(const fs::path& png, std::size_t most) {
    try {
        return encode_thumbnail(read_scaled_down(png, kSizes.front().side), most);
    } catch (const IoError&) {
        return {};  // the page shows an empty place: the image itself is none the worse
    }
}

}  // namespace

Thumbnails BatchPageWriter::make_thumbnails(const BatchReport& report) {
    const auto has_preview = [](const BatchUnit& unit) { return has_image(unit.outcome) && !unit.preview.empty(); };
    const auto count = static_cast<std::size_t>(std::ranges::count_if(report.units, has_preview));
    Thumbnails thumbnails;
    thumbnails.files.resize(report.units.size());
    const std::size_t most = std::min(kMostBytes, kBytesOfAll / std::max<std::size_t>(count, 1));
    if (most < kLeastBytes) {
        thumbnails.note = "There are too many images for thumbnails; the links lead to them all the same.";
        return thumbnails;
    }
    if (most < kMostBytes / 2)
        thumbnails.note = fmt::format("The thumbnails are coarse, at most {} bytes each, as there are so many.", most);
    std::vector<std::pair<std::size_t, Kept*>> changed;
    for (std::size_t i = 0; i < report.units.size(); ++i) {
        const BatchUnit& unit = report.units[i];
        if (!has_preview(unit)) continue;
        std::error_code error;
        const auto time = fs::last_write_time(out_ / unit.preview, error);
        Kept& kept = kept_[unit.preview];
        if (kept.changed == time && kept.most_bytes == most && !error) continue;
        kept.changed = time;
        kept.most_bytes = most;
        changed.emplace_back(i, &kept);
    }
    if (!changed.empty()) {
        const ThreadPool threads;
        threads.parallel_for(changed.size(), [&](std::size_t i, int) {
            changed[i].second->file = make_thumbnail(out_ / report.units[changed[i].first].preview, most);
        });
    }
    for (std::size_t i = 0; i < report.units.size(); ++i)
        if (has_preview(report.units[i])) thumbnails.files[i] = kept_.at(report.units[i].preview).file;
    return thumbnails;
}

void BatchPageWriter::write(const BatchReport& report) {
    write_text(out_ / "report.json", to_json(report));
    write_text(out_ / "index.html", make_batch_page(report, make_thumbnails(report)));
}

}  // namespace etendue
