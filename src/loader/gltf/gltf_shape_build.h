// Words to write a `Shape` with: what the tables of the schema are made of.
#pragma once

#include "loader/gltf/gltf_shape.h"

#include <cfloat>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace etendue::gltf_schema {

inline constexpr double kMaxInt = 2147483647.0;
inline constexpr double kMaxOffset = 9007199254740992.0;  // 2^53, exact in JSON
inline constexpr double kMaxVertices = 4294967294.0;      // so that every index fits 32 bits

constexpr Shape text(std::span<const std::string_view> allowed = {}) {
    return {.kind = Shape::Kind::Text, .texts = allowed};
}
constexpr Shape boolean() {
    return {.kind = Shape::Kind::Boolean};
}
constexpr Shape integer(double min, double max) {
    return {.kind = Shape::Kind::Integer, .min = min, .max = max};
}
constexpr Shape one_of(std::span<const std::int64_t> allowed) {
    return {.kind = Shape::Kind::Integer, .min = -kMaxInt, .max = kMaxInt, .integers = allowed};
}
constexpr Shape index_of(std::string_view target) {
    return {.kind = Shape::Kind::Integer, .target = target};
}
constexpr Shape number(double min = -FLT_MAX, double max = FLT_MAX) {
    return {.kind = Shape::Kind::Number, .min = min, .max = max};
}
constexpr Shape array(const Shape& element) {
    return {.kind = Shape::Kind::Array, .element = &element};
}
/// At least one.
constexpr Shape some(const Shape& element) {
    return {.kind = Shape::Kind::Array, .min_length = 1, .element = &element};
}
constexpr Shape array(const Shape& element, std::size_t length) {
    return {.kind = Shape::Kind::Array, .min_length = length, .max_length = length, .element = &element};
}
constexpr Shape map(const Shape& element) {
    return {.kind = Shape::Kind::Map, .element = &element};
}
template <std::size_t N>
constexpr Shape object(const ShapeField (&fields)[N]) {
    return {.kind = Shape::Kind::Object, .fields = fields, .field_count = N};
}
inline constexpr Shape object() {
    return {.kind = Shape::Kind::Object};
}

inline constexpr Shape kText = text();
inline constexpr Shape kNumber = number();

}  // namespace etendue::gltf_schema
