#include "loader/gltf/gltf_shape.h"

#include "core/shown_text.h"
#include "loader/json_text.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using Json = nlohmann::json;

/// One walk over a document. Recursion is as deep as the shape, not as the document.
class Checker {
  public:
    Checker(const Json& root, const SourceLocation& file, ProblemList& problems)
        : root_(root), file_(file), problems_(problems) {}

    void check(Json& value, const Shape& shape, const std::string& pointer) {
        switch (shape.kind) {
            case Shape::Kind::Text:
                return check_text(value, shape, pointer);
            case Shape::Kind::Boolean:
                if (!value.is_boolean()) wrong_kind(pointer, "true or false", value);
                return;
            case Shape::Kind::Integer:
                return check_integer(value, shape, pointer);
            case Shape::Kind::Number:
                return check_number(value, shape, pointer);
            case Shape::Kind::Array:
                return check_array(value, shape, pointer);
            case Shape::Kind::Map:
                return check_map(value, shape, pointer);
            case Shape::Kind::Object:
                return check_object(value, shape, pointer);
        }
    }

  private:
    void error(const std::string& pointer, std::string message) {
        problems_.error({file_.file, pointer}, std::move(message));
    }

    void wrong_kind(const std::string& pointer, std::string_view expected, const Json& value) {
        error(pointer, fmt::format("must be {}, but is {}", expected, json_kind(value)));
    }

    void check_text(const Json& value, const Shape& shape, const std::string& pointer) {
        if (!value.is_string()) return wrong_kind(pointer, "a string", value);
        const std::string& text = value.get_ref<const std::string&>();
        if (shape.texts.empty() || std::ranges::find(shape.texts, text) != shape.texts.end()) return;
        error(pointer, fmt::format("must be one of {}, but is '{}'", fmt::join(shape.texts, ", "), shown(text)));
    }

    void check_integer(Json& value, const Shape& shape, const std::string& pointer) {
        if (!value.is_number()) return wrong_kind(pointer, "an integer", value);
        const double number = value.get<double>();
        if (number != std::trunc(number)) {
            return error(pointer, fmt::format("must be an integer, but is {}", number));
        }
        if (!shape.target.empty()) {
            const std::size_t count = target_size(shape.target);
            if (number >= 0.0 && number < static_cast<double>(count)) return make_integer(value);
            return error(pointer,
                         fmt::format("refers to number {} of {}, but there are {}", number, shape.target, count));
        }
        if (!(number >= shape.min && number <= shape.max)) {
            return error(pointer,
                         fmt::format("must be an integer in [{}, {}], but is {}", shape.min, shape.max, number));
        }
        make_integer(value);
        if (shape.integers.empty()) return;
        if (std::ranges::find(shape.integers, value.get<std::int64_t>()) != shape.integers.end()) return;
        error(pointer, fmt::format("must be one of {}, but is {}", fmt::join(shape.integers, ", "), number));
    }

    /// Only for numbers that a table's range has already bounded far below 2^63. -0 becomes 0.
    static void make_integer(Json& value) {
        const double number = value.get<double>();
        if (value.is_number_integer() && (number < 0.0 || value.is_number_unsigned())) return;
        value = number < 0.0 ? Json(static_cast<std::int64_t>(number)) : Json(static_cast<std::uint64_t>(number));
    }

    void check_number(const Json& value, const Shape& shape, const std::string& pointer) {
        if (!value.is_number()) return wrong_kind(pointer, "a number", value);
        const double number = value.get<double>();
        if (number >= shape.min && number <= shape.max) return;
        error(pointer, fmt::format("must be a number in [{}, {}], but is {}", shape.min, shape.max, number));
    }

    void check_array(Json& value, const Shape& shape, const std::string& pointer) {
        if (!value.is_array()) return wrong_kind(pointer, "an array", value);
        if (value.size() < shape.min_length || value.size() > shape.max_length) {
            return error(pointer, shape.min_length == shape.max_length
                                      ? fmt::format("must have {} elements, but has {}", shape.min_length, value.size())
                                      : fmt::format("must have at least {} elements, but has {}", shape.min_length,
                                                    value.size()));
        }
        for (std::size_t i = 0; i < value.size(); ++i) check(value[i], *shape.element, child_pointer(pointer, i));
    }

    void check_map(Json& value, const Shape& shape, const std::string& pointer) {
        if (!value.is_object()) return wrong_kind(pointer, "an object", value);
        for (auto& [key, element] : value.items()) check(element, *shape.element, child_pointer(pointer, key));
    }

    void check_object(Json& value, const Shape& shape, const std::string& pointer) {
        if (!value.is_object()) return wrong_kind(pointer, "an object", value);
        for (const ShapeField& field : std::span(shape.fields, shape.field_count)) {
            const auto found = value.find(field.key);
            if (found != value.end()) {
                check(*found, field.shape, child_pointer(pointer, field.key));
            } else if (field.required) {
                error(pointer, fmt::format("'{}' is missing", field.key));
            }
        }
    }

    /// How many elements the top-level array `target` has; 0 if it is missing or no array.
    std::size_t target_size(std::string_view target) {
        const auto known = target_sizes_.find(target);
        if (known != target_sizes_.end()) return known->second;
        const Json::json_pointer pointer{std::string(target)};
        const std::size_t size = root_.contains(pointer) && root_[pointer].is_array() ? root_[pointer].size() : 0;
        target_sizes_.emplace(target, size);
        return size;
    }

    const Json& root_;
    const SourceLocation& file_;
    ProblemList& problems_;
    std::map<std::string_view, std::size_t> target_sizes_;
};

}  // namespace

void check_shape(Json& document, const Shape& shape, const SourceLocation& file, ProblemList& problems) {
    Checker(document, file, problems).check(document, shape, "");
}

}  // namespace etendue
