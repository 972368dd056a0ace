#include "output/cryptomatte.h"

#include "core/murmur_hash3.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

std::uint32_t matte_id(std::string_view name) {
    constexpr std::uint32_t kExponentBits = 0xffu;
    constexpr std::uint32_t kExponentShift = 23;
    const std::uint32_t hash = murmur_hash3_32(name);
    const std::uint32_t exponent = std::clamp((hash >> kExponentShift) & kExponentBits, 1u, kExponentBits - 1u);
    return (hash & ~(kExponentBits << kExponentShift)) | (exponent << kExponentShift);
}

std::string matte_key(std::string_view layer) {
    return fmt::format("{:08x}", murmur_hash3_32(layer)).substr(0, 7);
}

std::string matte_manifest(std::span<const std::string> names) {
    nlohmann::json manifest = nlohmann::json::object();
    for (const std::string& name : names) manifest[name] = fmt::format("{:08x}", matte_id(name));
    return manifest.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string id_names(std::span<const std::string> names) {
    return nlohmann::json(names).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::vector<MatteCollision> matte_collisions(std::span<const std::string> names) {
    std::map<std::uint32_t, std::string_view> name_of;
    std::vector<MatteCollision> collisions;
    for (const std::string& name : names) {
        const auto [known, is_new] = name_of.try_emplace(matte_id(name), name);
        if (!is_new && known->second != name) collisions.push_back({std::string(known->second), name});
    }
    return collisions;
}

std::vector<ImageAttribute> matte_attributes(const std::string& layer, const std::string& manifest) {
    const std::string prefix = fmt::format("cryptomatte/{}/", matte_key(layer));
    std::vector<ImageAttribute> attributes{{prefix + "name", layer},
                                           {prefix + "hash", std::string("MurmurHash3_32")},
                                           {prefix + "conversion", std::string("uint32_to_float32")}};
    if (!manifest.empty()) attributes.push_back({prefix + "manifest", manifest});
    return attributes;
}

std::string matte_channel(std::string_view layer, std::size_t index) {
    constexpr std::string_view kChannels = "RGBA";
    return fmt::format("{}{:02}.{}", layer, index / kChannels.size(), kChannels[index % kChannels.size()]);
}

}  // namespace etendue
