#include "loader/settings/json_schema.h"

#include <cmath>
#include <functional>
#include <map>
#include <regex>
#include <stdexcept>

#include <fmt/format.h>

namespace etendue {
namespace {

using Json = nlohmann::json;

class Validator {
  public:
    explicit Validator(const Json& root) : root_(root) {}

    void check(const Json& schema, const Json& value, const std::string& pointer) {
        if (schema.is_boolean()) {
            if (!schema.get<bool>()) fail(pointer, "is not allowed");
            return;
        }
        for (const auto& [keyword, argument] : schema.items()) {
            const auto rule = rules().find(keyword);
            if (rule == rules().end()) throw std::runtime_error("unsupported schema keyword '" + keyword + "'");
            (this->*rule->second)(schema, argument, value, pointer);
        }
    }

    std::vector<std::string> violations;

  private:
    using Rule = void (Validator::*)(const Json& schema, const Json& argument, const Json& value, const std::string&);

    static const std::map<std::string, Rule>& rules() {
        static const std::map<std::string, Rule> table{
            {"$schema", &Validator::annotation},
            {"title", &Validator::annotation},
            {"description", &Validator::annotation},
            {"$defs", &Validator::annotation},
            {"$ref", &Validator::reference},
            {"type", &Validator::type},
            {"enum", &Validator::enumeration},
            {"properties", &Validator::properties},
            {"additionalProperties", &Validator::additional_properties},
            {"required", &Validator::required},
            {"items", &Validator::items},
            {"minItems", &Validator::min_items},
            {"maxItems", &Validator::max_items},
            {"minLength", &Validator::min_length},
            {"pattern", &Validator::pattern},
            {"minimum", &Validator::minimum},
            {"maximum", &Validator::maximum},
            {"exclusiveMinimum", &Validator::exclusive_minimum},
            {"oneOf", &Validator::one_of},
            {"anyOf", &Validator::any_of},
            {"not", &Validator::negation},
        };
        return table;
    }

    void fail(const std::string& pointer, const std::string& message) {
        violations.push_back(pointer + ": " + message);
    }

    bool accepts(const Json& schema, const Json& value) {
        Validator nested(root_);
        nested.check(schema, value, "");
        return nested.violations.empty();
    }

    std::size_t count_accepting(const Json& schemas, const Json& value) {
        std::size_t count = 0;
        for (const Json& schema : schemas) count += accepts(schema, value) ? 1 : 0;
        return count;
    }

    void annotation(const Json&, const Json&, const Json&, const std::string&) {}

    void reference(const Json&, const Json& argument, const Json& value, const std::string& pointer) {
        check(root_.at(Json::json_pointer(argument.get<std::string>().substr(1))), value, pointer);
    }

    void type(const Json&, const Json& argument, const Json& value, const std::string& pointer) {
        const std::string name = argument.get<std::string>();
        const bool integral = value.is_number() && value.get<double>() == std::trunc(value.get<double>());
        const bool good = name == "object"    ? value.is_object()
                          : name == "array"   ? value.is_array()
                          : name == "string"  ? value.is_string()
                          : name == "boolean" ? value.is_boolean()
                          : name == "number"  ? value.is_number()
                          : name == "integer" ? integral
                                              : throw std::runtime_error("unsupported type '" + name + "'");
        if (!good) fail(pointer, "is no " + name);
    }

    void enumeration(const Json&, const Json& argument, const Json& value, const std::string& pointer) {
        if (std::find(argument.begin(), argument.end(), value) == argument.end()) fail(pointer, "is not in the list");
    }

    void properties(const Json&, const Json& argument, const Json& value, const std::string& pointer) {
        if (!value.is_object()) return;
        for (const auto& [key, schema] : argument.items()) {
            if (value.contains(key)) check(schema, value[key], fmt::format("{}/{}", pointer, key));
        }
    }

    void additional_properties(const Json& schema, const Json& argument, const Json& value,
                               const std::string& pointer) {
        if (!value.is_object()) return;
        for (const auto& [key, member] : value.items()) {
            if (schema.contains("properties") && schema["properties"].contains(key)) continue;
            check(argument, member, fmt::format("{}/{}", pointer, key));
        }
    }

    void required(const Json&, const Json& argument, const Json& value, const std::string& pointer) {
        if (!value.is_object()) return;
        for (const Json& key : argument) {
            if (!value.contains(key.get<std::string>())) fail(pointer, "lacks " + key.get<std::string>());
        }
    }

    void items(const Json&, const Json& argument, const Json& value, const std::string& pointer) {
        if (!value.is_array()) return;
        for (std::size_t i = 0; i < value.size(); ++i) check(argument, value[i], pointer + "/" + std::to_string(i));
    }

    void min_items(const Json&, const Json& argument, const Json& value, const std::string& pointer) {
        if (value.is_array() && value.size() < argument.get<std::size_t>()) fail(pointer, "has too few elements");
    }

    void max_items(const Json&, const Json& argument, const Json& value, const std::string& pointer) {
        if (value.is_array() && value.size() > argument.get<std::size_t>()) fail(pointer, "has too many elements");
    }

    void min_length(const Json&, const Json& argument, const Json& value, const std::string& pointer) {
        if (value.is_string() && value.get<std::string>().size() < argument.get<std::size_t>())
            fail(pointer, "is short");
    }

    void pattern(const Json&, const Json& argument, const Json& value, const std::string& pointer) {
        if (value.is_string() && !std::regex_search(value.get<std::string>(), std::regex(argument.get<std::string>())))
            fail(pointer, "does not match the pattern");
    }

    void compare(const Json& value, const std::string& pointer, const std::function<bool(double)>& good) {
        if (value.is_number() && !good(value.get<double>())) fail(pointer, "is out of range");
    }

    void minimum(const Json&, const Json& argument, const Json& value, const std::string& pointer) {
        compare(value, pointer, [&](double v) { return v >= argument.get<double>(); });
    }

    void maximum(const Json&, const Json& argument, const Json& value, const std::string& pointer) {
        compare(value, pointer, [&](double v) { return v <= argument.get<double>(); });
    }

    void exclusive_minimum(const Json&, const Json& argument, const Json& value, const std::string& pointer) {
        compare(value, pointer, [&](double v) { return v > argument.get<double>(); });
    }

    void one_of(const Json&, const Json& argument, const Json& value, const std::string& pointer) {
        if (count_accepting(argument, value) != 1) fail(pointer, "does not fit exactly one alternative");
    }

    void any_of(const Json&, const Json& argument, const Json& value, const std::string& pointer) {
        if (count_accepting(argument, value) == 0) fail(pointer, "fits no alternative");
    }

    void negation(const Json&, const Json& argument, const Json& value, const std::string& pointer) {
        if (accepts(argument, value)) fail(pointer, "is not allowed");
    }

    const Json& root_;
};

}  // namespace

std::vector<std::string> schema_violations(const Json& schema, const Json& instance) {
    Validator validator(schema);
    validator.check(schema, instance, "");
    return validator.violations;
}

}  // namespace etendue
