// A fingerprint of bytes, to tell whether they are the same as before; reading no file but a regular one.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace etendue {

/// XXH3, 128 bits: finds every accident, and no attacker's work.
class ContentHash {
  public:
    static constexpr std::size_t kSize = 16;
    using Digest = std::array<std::byte, kSize>;

    ContentHash();
    ~ContentHash();
    ContentHash(const ContentHash&) = delete;
    ContentHash& operator=(const ContentHash&) = delete;

    void add(std::span<const std::byte> bytes);
    /// Returns the digest of all bytes that have been added so far.
    [[nodiscard]] Digest digest() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Returns `digest` as 32 hexadecimal digits.
[[nodiscard]] std::string hex(const ContentHash::Digest& digest);

/// Returns the digest of `text` as 32 hexadecimal digits.
[[nodiscard]] std::string content_hex(std::string_view text);

/// True if `path` exists and is no regular file: reading a pipe would block, and a device may never end.
[[nodiscard]] bool is_irregular(const std::filesystem::path& path);

/// Throws IoError if `path` exists and is no regular file.
void require_regular_file(const std::filesystem::path& path);

/// Opens the file `path` for reading; if it is no regular file, the stream fails as if there were none.
[[nodiscard]] std::ifstream open_regular_file(const std::filesystem::path& path);

/// Returns the digest of the bytes of the file `path`. Throws IoError if the file cannot be read.
[[nodiscard]] ContentHash::Digest hash_file(const std::filesystem::path& path);

}  // namespace etendue
