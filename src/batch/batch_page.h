// The report of a batch, on disk.
#pragma once

#include "report/batch_report.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace etendue {

/// Writes the report of one batch again and again, and makes each thumbnail once for as long as its image stays.
class BatchPageWriter {
  public:
    /// Writes below the directory `out`.
    explicit BatchPageWriter(std::filesystem::path out) : out_(std::move(out)) {}

    /// Writes report.json and index.html, each whole or not at all, with thumbnails of the units' PNG files; one that
    /// is missing or cannot be read leaves its place empty. Throws IoError if a file cannot be written.
    void write(const BatchReport& report);

  private:
    struct Kept {
        std::filesystem::file_time_type changed{};
        std::size_t most_bytes = 0;  ///< bytes that the thumbnail was allowed
        std::vector<unsigned char> file{};
    };
    [[nodiscard]] Thumbnails make_thumbnails(const BatchReport& report);

    std::filesystem::path out_;
    std::unordered_map<std::string, Kept> kept_{};  ///< by the PNG's path
};

}  // namespace etendue
