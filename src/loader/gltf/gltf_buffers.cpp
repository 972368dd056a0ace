#include "loader/gltf/gltf_buffers.h"

#include "core/shown_text.h"
#include "loader/files.h"
#include "loader/json_text.h"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

namespace etendue {

namespace {

/// Loads one buffer after the other and remembers which files are taken.
class BufferLoader {
  public:
    BufferLoader(std::optional<std::span<const unsigned char>> bin, const std::filesystem::path& directory,
                 std::vector<std::filesystem::path>& inputs)
        : bin_(bin), directory_(directory), inputs_(inputs) {}

    /// Loads as much of a buffer as there is. Views take its first `viewed` bytes. Throws IoError.
    std::vector<unsigned char> load(const nlohmann::json& buffer, bool is_first, std::uintmax_t viewed) {
        // Some exporters round the length up.
        constexpr std::uintmax_t kMostTooMany = 3;
        const auto claimed = buffer["byteLength"].get<std::uintmax_t>();
        if (claimed == 0) throw IoError("the buffer has no bytes");
        const bool is_rounded_up = viewed > 0 && claimed > viewed && claimed - viewed <= kMostTooMany;
        const std::uintmax_t length = is_rounded_up ? viewed : claimed;
        if (!buffer.contains("uri")) return from_chunk(length, is_first);
        const std::string& uri = buffer["uri"].get_ref<const std::string&>();
        return is_data_uri(uri) ? from_data_uri(uri, length) : from_file(uri, length);
    }

  private:
    std::vector<unsigned char> from_chunk(std::uintmax_t length, bool is_first) const {
        if (!bin_ || !is_first) throw IoError("the buffer has neither a URI nor a binary chunk to take its bytes from");
        if (length > bin_->size()) {
            throw IoError(fmt::format("the buffer claims {} bytes, but the binary chunk has {}", length, bin_->size()));
        }
        const auto bytes = bin_->first(static_cast<std::size_t>(length));
        return {bytes.begin(), bytes.end()};
    }

    static std::vector<unsigned char> from_data_uri(const std::string& uri, std::uintmax_t length) {
        std::optional<std::vector<unsigned char>> bytes = decode_data_uri(uri);
        if (!bytes) throw IoError("the data URI is empty or not base64");
        if (length > bytes->size()) {
            throw IoError(fmt::format("the buffer claims {} bytes, but its data URI has {}", length, bytes->size()));
        }
        bytes->resize(static_cast<std::size_t>(length));
        return std::move(*bytes);
    }

    std::vector<unsigned char> from_file(const std::string& uri, std::uintmax_t length) {
        try {
            const std::filesystem::path path = resolve_uri(directory_, uri);
            const bool again = std::ranges::find(inputs_, path) != inputs_.end();
            std::vector<unsigned char> bytes = read_bytes(path, again ? repeatable_ : kMaxBufferBytes, length);
            if (again)
                repeatable_ -= bytes.size();
            else
                inputs_.push_back(path);
            return bytes;
        } catch (const IoError& error) {
            throw IoError(fmt::format("buffer file '{}': {}", shown(uri), error.what()));
        }
    }

    std::optional<std::span<const unsigned char>> bin_;
    const std::filesystem::path& directory_;
    std::vector<std::filesystem::path>& inputs_;
    /// Bytes of files that several buffers name which may still be read: a document of a few lines could name one large
    /// file thousands of times.
    std::uintmax_t repeatable_ = std::uintmax_t{1} << 28;
};

bool same_but_for_case(std::string_view text, std::string_view lower) {
    return std::ranges::equal(text, lower, [](char a, char b) {
        return (a >= 'A' && a <= 'Z' ? static_cast<char>(a + ('a' - 'A')) : a) == b;
    });
}

/// Returns how many bytes of each buffer are taken by views, the views of meshopt's extension included.
std::vector<std::uintmax_t> viewed_bytes(const nlohmann::json& document) {
    std::vector<std::uintmax_t> ends(document["buffers"].size(), 0);
    const auto add = [&](const nlohmann::json& view) {
        if (!view.is_object() || !view.contains("buffer") || !view["buffer"].is_number_unsigned()) return;
        const auto buffer = view["buffer"].get<std::size_t>();
        if (buffer >= ends.size()) return;
        const auto number = [&](const char* key) {
            const auto found = view.find(key);
            return found != view.end() && found->is_number_unsigned() ? found->get<std::uintmax_t>() : 0;
        };
        ends[buffer] = std::max(ends[buffer], number("byteOffset") + number("byteLength"));
    };
    if (document.contains("bufferViews"))
        for (const nlohmann::json& view : document["bufferViews"]) {
            add(view);
            if (!view.contains("extensions")) continue;
            for (const auto& [name, extension] : view["extensions"].items()) add(extension);
        }
    return ends;
}

}  // namespace

DecodeBudget::DecodeBudget(std::uint64_t bytes) {
    // Bytes grow at most fourfold on their way to floats; the rest is room for what is compressed, shared and placed
    // often.
    constexpr std::uint64_t kGrowth = 64;
    constexpr std::uint64_t kLeast = std::uint64_t{1} << 30;
    left_ = kLeast + kGrowth * bytes;
}

bool DecodeBudget::take(std::uint64_t bytes) {
    if (!holds(bytes)) return false;
    left_ -= bytes;
    return true;
}

std::string buffer_name(std::size_t index) {
    return fmt::format("buffer-{}", index);
}

bool is_data_uri(std::string_view uri) {
    constexpr std::string_view kScheme = "data:";
    return uri.size() >= kScheme.size() && same_but_for_case(uri.substr(0, kScheme.size()), kScheme);
}

std::optional<std::vector<unsigned char>> decode_data_uri(const std::string& uri) {
    // White space, which editors break lines with, is no part of it.
    const auto without_space = [](std::string text) {
        std::erase_if(text, [](char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; });
        return text;
    };
    const std::size_t comma = uri.find(',');
    const std::size_t last = uri.rfind(';', comma);
    if (comma == std::string::npos || last == std::string::npos ||
        !same_but_for_case(without_space(uri.substr(last + 1, comma - last - 1)), "base64"))
        return std::nullopt;
    // RFC 3986: any character may be written as its code.
    const std::string content = without_space(percent_decode(std::string_view(uri).substr(comma + 1)));

    // tinygltf knows a few media types only, and stops without a word at a character that is not base64.
    std::vector<unsigned char> bytes;
    std::string media_type;
    const std::string known = "data:application/octet-stream;base64," + content;
    if (!tinygltf::DecodeDataURI(&bytes, media_type, known, 0, false)) return std::nullopt;
    const std::size_t digits = content.substr(0, content.find('=')).size();
    if (bytes.size() != digits * 3 / 4) return std::nullopt;
    return bytes;
}

GltfBuffers load_gltf_buffers(nlohmann::json& document, std::optional<std::span<const unsigned char>> bin,
                              const std::filesystem::path& directory, std::vector<std::filesystem::path>& inputs,
                              AbsentBuffers& absent) {
    GltfBuffers result;
    if (!document.contains("buffers")) return result;
    BufferLoader loader(bin, directory, inputs);
    nlohmann::json& buffers = document["buffers"];
    const std::vector<std::uintmax_t> viewed = viewed_bytes(document);
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        const std::string name = buffer_name(i);
        try {
            std::vector<unsigned char> bytes = loader.load(buffers[i], i == 0, viewed[i]);
            buffers[i]["byteLength"] = bytes.size();
            result.emplace(name, std::move(bytes));
        } catch (const IoError& error) {
            absent.emplace(i, error.what());
            buffers[i]["byteLength"] = 1;
            result.emplace(name, std::vector<unsigned char>(1));
        }
        buffers[i]["uri"] = name;
    }
    return result;
}

}  // namespace etendue
