#include "core/content_hash.h"

#include "core/error.h"
#include "core/system_error_text.h"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <new>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <xxhash.h>

namespace etendue {

struct ContentHash::State {
    struct Free {
        void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
    };
    std::unique_ptr<XXH3_state_t, Free> xxh3{XXH3_createState()};
};

ContentHash::ContentHash() : state_(std::make_unique<State>()) {
    if (!state_->xxh3) throw std::bad_alloc();
    XXH3_128bits_reset(state_->xxh3.get());
}

ContentHash::~ContentHash() = default;

void ContentHash::add(std::span<const std::byte> bytes) {
    XXH3_128bits_update(state_->xxh3.get(), bytes.data(), bytes.size());
}

ContentHash::Digest ContentHash::digest() const {
    XXH128_canonical_t canonical;
    XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(state_->xxh3.get()));
    Digest digest;
    for (std::size_t i = 0; i < kSize; ++i) digest[i] = static_cast<std::byte>(canonical.digest[i]);
    return digest;
}

std::string hex(const ContentHash::Digest& digest) {
    std::string text;
    for (const std::byte byte : digest) text += fmt::format("{:02x}", static_cast<unsigned>(byte));
    return text;
}

std::string content_hex(std::string_view text) {
    ContentHash hash;
    hash.add(std::as_bytes(std::span(text)));
    return hex(hash.digest());
}

bool is_irregular(const std::filesystem::path& path) {
    std::error_code ignored;
    const std::filesystem::file_status status = std::filesystem::status(path, ignored);
    return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

void require_regular_file(const std::filesystem::path& path) {
    if (is_irregular(path)) throw IoError(fmt::format("cannot read {}: it is no regular file", path.string()));
}

std::ifstream open_regular_file(const std::filesystem::path& path) {
    return std::ifstream(is_irregular(path) ? std::filesystem::path() : path, std::ios::binary);
}

ContentHash::Digest hash_file(const std::filesystem::path& path) {
    const auto fail = [&] {
        throw IoError(fmt::format("cannot read {}: {}", path.string(), system_error_text(errno)));
    };
    require_regular_file(path);
    std::ifstream file(path, std::ios::binary);
    if (!file) fail();
    ContentHash hash;
    std::vector<char> buffer(std::size_t{1} << 20);
    while (file.read(buffer.data(), static_cast<std::streamsize>(buffer.size())) || file.gcount() > 0)
        hash.add(std::as_bytes(std::span(buffer).first(static_cast<std::size_t>(file.gcount()))));
    if (file.bad()) fail();
    return hash.digest();
}

}  // namespace etendue
