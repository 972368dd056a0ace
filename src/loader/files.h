// The only door to the file system that a scene file gets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// Largest JSON text that is parsed: 1 GiB, and 16 MiB for settings. The parsed form takes several times as much
/// memory.
inline constexpr std::uintmax_t kMaxJsonBytes = std::uintmax_t{1} << 30;
inline constexpr std::uintmax_t kMaxSettingsBytes = std::uintmax_t{1} << 24;

/// Largest GLB (whose lengths are 32 bits) or buffer file that is read.
inline constexpr std::uintmax_t kMaxBufferBytes = std::uintmax_t{1} << 33;

/// The regular file that the relative reference `uri` (RFC 3986, percent-encoded) names below `directory`, with
/// symbolic links resolved. Throws RefusedInput if it leads out of `directory` (by a scheme, an absolute path, `..` or
/// a link), IoError if it is no name (control characters, a broken escape) or names no regular file.
[[nodiscard]] std::filesystem::path resolve_uri(const std::filesystem::path& directory, std::string_view uri);

/// Returns the regular file that the plain file name `name`, such as one in render.json, where '%' has no meaning,
/// leads to below `directory`, with symbolic links resolved; throws RefusedInput if `name` leads out of `directory`,
/// IoError if `name` is no name or names no regular file.
[[nodiscard]] std::filesystem::path resolve_name(const std::filesystem::path& directory, std::string_view name);

/// The regular file that `name` is below `directory` or, if it is not there, below one of `assets`, with symbolic links
/// resolved: `name` may lead there from `directory`, as an absolute path or from one of `assets`, the first that has
/// it. Throws IoError as `resolve_name`, also with the reason why the first of `assets` that has it refuses it.
[[nodiscard]] std::filesystem::path resolve_asset(const std::filesystem::path& directory,
                                                  std::span<const std::filesystem::path> assets, std::string_view name);

/// Text with its percent-encoded bytes (RFC 3986, section 2.1) decoded. Throws IoError at a broken escape.
[[nodiscard]] std::string percent_decode(std::string_view text);

/// The file's extension in lower case, with its dot.
[[nodiscard]] std::string lower_extension(const std::filesystem::path& file);

/// The first `wanted` bytes of a file, or all of it if `wanted` is 0. Throws IoError if it is not a regular file,
/// cannot be read, is shorter than `wanted` or longer than `limit` bytes.
[[nodiscard]] std::vector<unsigned char> read_bytes(const std::filesystem::path& file, std::uintmax_t limit,
                                                    std::uintmax_t wanted = 0);

}  // namespace etendue
