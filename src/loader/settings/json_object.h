// Reading a JSON object member by member, so that wrong types, wrong ranges and unknown keys all become errors.
#pragma once

#include "core/error.h"
#include "core/rgb.h"
#include "core/vec.h"
#include "scene/setting.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace etendue {

inline constexpr NumberRange kAnyNumber{};
inline constexpr NumberRange kPositive{.min = 0.0, .open_min = true};
inline constexpr NumberRange kUnit{.min = 0.0, .max = 1.0};

/// One object of a settings file. Each call asks for one member and names it as known; a member that is there and good
/// is stored, and true returned. `finish` reports the members that nobody asked for.
class JsonObject {
  public:
    /// `value` may be anything; if it is no object, that is the only error and all members are absent.
    JsonObject(const nlohmann::json& value, SourceLocation where, ProblemList& problems);

    bool text(std::string_view key, std::string& out);
    bool boolean(std::string_view key, bool& out);
    bool number(std::string_view key, const NumberRange& range, float& out);
    bool number(std::string_view key, const NumberRange& range, double& out);
    bool color(std::string_view key, const NumberRange& range, Rgb& out);
    bool vector(std::string_view key, Vec2f& out);
    bool vector(std::string_view key, Vec3f& out);
    bool vector(std::string_view key, Vec3d& out);
    /// The four numbers of a quaternion, x, y, z and w.
    bool quaternion(std::string_view key, std::array<double, 4>& out);

    template <typename Integer>
    bool integer(std::string_view key, std::int64_t min, std::int64_t max, Integer& out) {
        std::int64_t value = 0;
        if (!read_integer(member(key), at(key), min, max, value)) return false;
        out = static_cast<Integer>(value);
        return true;
    }

    /// Stores the member where `setting` has its value; `key` is the last part of its pointer.
    bool setting(const Setting& setting, std::string_view key, RenderSettings& out);

    /// One of `names`, each with the value it stands for.
    template <typename Value, std::size_t N>
    bool choice(std::string_view key, const std::array<std::pair<std::string_view, Value>, N>& names, Value& out) {
        std::string name;
        if (!text(key, name)) return false;
        std::array<std::string_view, N> known;
        for (std::size_t i = 0; i < N; ++i) {
            known[i] = names[i].first;
            if (names[i].first != name) continue;
            out = names[i].second;
            return true;
        }
        report_unknown_name(at(key), name, known);
        return false;
    }

    /// The member as it is, or null: for objects within, and for members of more than one type.
    [[nodiscard]] const nlohmann::json* member(std::string_view key);

    /// Calls `visit(name, value)` for every member, all of which are known then.
    template <typename Visit>
    void each(const Visit& visit) {
        for (const auto& [name, value] : object_->items()) {
            known_.push_back(name);
            visit(name, value);
        }
    }

    /// Returns where a key belongs that is not of this object, in words; empty if that is not known.
    using PlaceOfKey = std::string (*)(std::string_view key);

    /// An error for each member that has not been asked for, with its place elsewhere or the nearest one that has.
    void finish(PlaceOfKey place = nullptr);

    [[nodiscard]] bool has(std::string_view key) const { return object_->contains(key); }
    [[nodiscard]] SourceLocation at(std::string_view key) const;
    [[nodiscard]] const SourceLocation& where() const { return where_; }
    [[nodiscard]] ProblemList& problems() const { return problems_; }

  private:
    template <typename Element>
    bool read_list(std::string_view key, std::size_t least, std::size_t most, std::string_view elements,
                   std::vector<Element>& out, const auto& read_element);
    [[nodiscard]] std::optional<SettingValue> read_setting(const Setting& setting, std::string_view key);
    [[nodiscard]] SourceLocation element_at(std::string_view key, std::size_t index) const;
    bool check_array(const nlohmann::json& value, const SourceLocation& where, std::size_t length,
                     std::string_view elements);
    bool read_integer(const nlohmann::json* value, const SourceLocation& where, std::int64_t min, std::int64_t max,
                      std::int64_t& out);
    bool read_number(const nlohmann::json* value, const SourceLocation& where, const NumberRange& range, double& out);
    bool read_numbers(std::string_view key, const NumberRange& range, std::span<float> out);
    bool read_numbers(std::string_view key, const NumberRange& range, std::span<double> out);
    template <typename Number>
    bool read_each(std::string_view key, const NumberRange& range, std::span<Number> out);
    void report_unknown_name(const SourceLocation& where, std::string_view name,
                             std::span<const std::string_view> known);

    const nlohmann::json* object_;
    SourceLocation where_;
    ProblemList& problems_;
    std::vector<std::string> known_;
};

}  // namespace etendue
