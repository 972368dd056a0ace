// The bytes behind "buffers" and data URIs.
#pragma once

#include "core/error.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace etendue {

/// The bytes of each buffer by the private name that replaces its URI, so that tinygltf never sees a name from the
/// file.
using GltfBuffers = std::map<std::string, std::vector<unsigned char>>;

/// Counts how much may still be decoded from a file. A few lines of JSON can refer to the same bytes any number of
/// times, so what comes out is bounded by a multiple of what went in.
class DecodeBudget {
  public:
    /// Is the message for a file that asks for more.
    static constexpr const char* kExceeded =
        "the file refers to the same things so often that it would take too much memory: more than 1 GiB and 64 times "
        "its size";
    /// Is the message for a file that asks for more arithmetic than is in proportion to its budget.
    static constexpr const char* kTooMuchWork =
        "the file deforms the same things so often that it would take too long to load";

    /// `bytes` are those of the file and of its buffers, as they were read.
    explicit DecodeBudget(std::uint64_t bytes);

    /// True if `bytes` more are not too much.
    [[nodiscard]] bool holds(std::uint64_t bytes) const { return bytes <= left_; }
    /// Takes `bytes` of what is left; false, and nothing is taken, if they are too much.
    [[nodiscard]] bool take(std::uint64_t bytes);

  private:
    std::uint64_t left_;
};

/// The name of buffer `index`.
[[nodiscard]] std::string buffer_name(std::size_t index);

/// True for a URI whose content stands in itself.
[[nodiscard]] bool is_data_uri(std::string_view uri);

/// The bytes of a base64 data URI; nothing if it is malformed.
[[nodiscard]] std::optional<std::vector<unsigned char>> decode_data_uri(const std::string& uri);

/// Why buffers could not be loaded, by their index. That is an error only for what reads one: buffers may stand in for
/// compressed views alone.
using AbsentBuffers = std::map<std::size_t, std::string>;

/// Loads every buffer of the checked `document` and replaces its `uri` by the key it has in the result. Each is exactly
/// `byteLength` long, or a byte where it is added to `absent`. `bin` is the binary chunk of a GLB. Files read are added
/// to `inputs`.
[[nodiscard]] GltfBuffers load_gltf_buffers(nlohmann::json& document, std::optional<std::span<const unsigned char>> bin,
                                            const std::filesystem::path& directory,
                                            std::vector<std::filesystem::path>& inputs, AbsentBuffers& absent);

}  // namespace etendue
