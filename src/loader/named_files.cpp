#include "loader/named_files.h"

#include "core/error.h"
#include "loader/files.h"
#include "loader/gltf/glb.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

namespace etendue {

namespace {

/// Members that name a file, of glTF and its extensions and of render.json.
constexpr std::array<std::string_view, 4> kFileMembers{"uri", "image", "ies", "scene"};

/// Keeps the values of these members, and no document.
class NameReader : public nlohmann::json_sax<nlohmann::json> {
  public:
    std::vector<std::string> names;

    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override { return true; }
    bool end_object() override { return true; }
    bool start_array(std::size_t) override { return true; }
    bool end_array() override { return true; }

    bool key(string_t& name) override {
        names_file_ = std::ranges::find(kFileMembers, name) != kFileMembers.end();
        return true;
    }
    bool string(string_t& value) override {
        constexpr std::size_t kLongestName = 4096;  // of the system's paths; data URIs are longer
        if (std::exchange(names_file_, false) && !value.empty() && value.size() < kLongestName) add(value);
        return true;
    }
    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }

  private:
    /// Adds the name as it stands and with its percent-encoded bytes decoded: the loader tries both.
    void add(const std::string& value) {
        names.push_back(value);
        try {
            if (std::string decoded = percent_decode(value); decoded != value) names.push_back(std::move(decoded));
        } catch (const IoError&) {
            // It names no file that way.
        }
    }

    bool names_file_ = false;
};

/// The file's JSON; of a binary file, that of its first chunk and no more.
std::vector<unsigned char> json_of(const std::filesystem::path& file) {
    std::vector<unsigned char> start = read_bytes(file, kMaxBufferBytes, 4);
    if (!is_glb(start)) return read_bytes(file, kMaxJsonBytes);
    start = read_bytes(file, kMaxBufferBytes, kGlbJsonOffset);
    const std::size_t length = glb_json_length(std::span(start).first<kGlbJsonOffset>());
    std::vector<unsigned char> bytes = read_bytes(file, kMaxJsonBytes, kGlbJsonOffset + length);
    bytes.erase(bytes.begin(), bytes.begin() + kGlbJsonOffset);
    return bytes;
}

}  // namespace

std::vector<std::string> named_files(const std::filesystem::path& file) try {
    const std::vector<unsigned char> json = json_of(file);
    NameReader reader;
    nlohmann::json::sax_parse(json.begin(), json.end(), &reader);
    return std::move(reader.names);
} catch (const IoError&) {
    return {};
}

}  // namespace etendue
