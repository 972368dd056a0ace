// Reading extension objects out of tinygltf's own JSON values. Types have been checked with the document.
#pragma once

#include <string>

#include <tiny_gltf.h>

namespace etendue {

/// The extension `name` among `extensions`, or null.
[[nodiscard]] inline const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions,
                                                           const std::string& name) {
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

/// The number `key` of `object`, or `fallback`.
[[nodiscard]] inline double number_or(const tinygltf::Value& object, const std::string& key, double fallback) {
    return object.Has(key) && object.Get(key).IsNumber() ? object.Get(key).GetNumberAsDouble() : fallback;
}

/// Element `index` of the array `key` of `object`, or `fallback`.
[[nodiscard]] inline double element_or(const tinygltf::Value& object, const std::string& key, int index,
                                       double fallback) {
    if (!object.Has(key) || !object.Get(key).IsArray()) return fallback;
    const tinygltf::Value& array = object.Get(key);
    if (static_cast<std::size_t>(index) >= array.ArrayLen() || !array.Get(index).IsNumber()) return fallback;
    return array.Get(index).GetNumberAsDouble();
}

/// The integer `key` of `object`, or `fallback`.
[[nodiscard]] inline int integer_or(const tinygltf::Value& object, const std::string& key, int fallback) {
    return object.Has(key) && object.Get(key).IsInt() ? object.Get(key).GetNumberAsInt() : fallback;
}

/// Calls `visit` with every element of the array `key` of `object`.
template <typename Visit>
void for_each_element(const tinygltf::Value& object, const std::string& key, const Visit& visit) {
    if (!object.Has(key) || !object.Get(key).IsArray()) return;
    const tinygltf::Value& array = object.Get(key);
    for (int i = 0; static_cast<std::size_t>(i) < array.ArrayLen(); ++i) visit(array.Get(i));
}

}  // namespace etendue
