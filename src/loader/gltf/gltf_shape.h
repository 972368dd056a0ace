// What the JSON of a glTF document must look like before anything else reads it.
//
// tinygltf takes a default where a value has the wrong type, cuts numbers that do not fit, and uses references without
// looking whether their target exists. So every value that is used later is checked first, against a table of plain
// constants that reads like the specification's schema (gltf_shape_table.cpp).
#pragma once

#include "core/error.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace etendue {

struct ShapeField;

/// Describes what a JSON value must be; the functions below make shapes.
struct Shape {
    enum class Kind { Text, Boolean, Integer, Number, Array, Map, Object };

    Kind kind = Kind::Object;
    double min = 0.0;  ///< least number
    double max = 0.0;  ///< greatest number
    std::size_t min_length = 0;
    std::size_t max_length = std::numeric_limits<std::size_t>::max();
    const Shape* element = nullptr;      ///< shape of the elements of arrays and of maps from any key
    const ShapeField* fields = nullptr;  ///< fields of objects; other keys are ignored, as glTF demands
    std::size_t field_count = 0;
    std::string_view target{};                  ///< JSON pointer of the array that an index refers into
    std::span<const std::string_view> texts{};  ///< if not empty: the texts allowed
    std::span<const std::int64_t> integers{};   ///< if not empty: the integers allowed
};

struct ShapeField {
    std::string_view key;
    Shape shape;
    bool required = false;
};

/// The shape of a whole document.
[[nodiscard]] const Shape& gltf_shape();

/// Adds an error with its JSON pointer to `problems` for everything in `document` that is not as `shape` demands.
/// Numbers such as 3.0 where an integer is due, which JSON allows, are turned into integers.
void check_shape(nlohmann::json& document, const Shape& shape, const SourceLocation& file, ProblemList& problems);

}  // namespace etendue
