// Each row of the table of settings: render.json, option, schema, page, canonical form and identity agree on it.
#include "cli/settings_options.h"
#include "cli/settings_pages.h"
#include "loader/settings/json_schema.h"
#include "loader/settings/render_json.h"
#include "program/small_files.h"
#include "scene/canonical_settings.h"
#include "session/prepared_scene.h"
#include "session/render_identity.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue::test {

namespace {

using nlohmann::ordered_json;

constexpr double kMostFloat = std::numeric_limits<float>::max();

/// Holds values of a setting: good ones, of which the first two are as near to each other as can be and neither is the
/// default, and some that are just beyond its range.
struct Samples {
    std::vector<SettingValue> good;
    std::vector<SettingValue> bad;
};

double next_to(double number, double towards, bool is_single) {
    return is_single ? static_cast<double>(std::nextafter(static_cast<float>(number), static_cast<float>(towards)))
                     : std::nextafter(number, towards);
}

Samples samples_of(const RealNumber& type) {
    const auto [min, max, open_min, open_max] = type.range;
    const bool has_min = type.range.has_min();
    const bool has_max = type.range.has_max();
    const double middle = has_min && has_max ? 0.5 * (min + max) + 0.25 : std::max(min, 0.0) + 1.5;
    Samples samples{{middle, next_to(middle, max, type.is_single)}, {}};
    if (has_min) samples.good.emplace_back(open_min ? next_to(min, max, type.is_single) : min);
    if (has_max) samples.good.emplace_back(open_max ? next_to(max, min, type.is_single) : max);
    if (has_min) samples.bad.emplace_back(open_min ? min : next_to(min, -kMostFloat, type.is_single));
    if (has_max) samples.bad.emplace_back(open_max ? max : next_to(max, kMostFloat, type.is_single));
    return samples;
}

Samples samples_of(const WholeNumbers& type) {
    const auto ascending = [&](std::size_t count, std::int64_t first) {
        std::vector<std::int64_t> numbers;
        for (std::size_t i = 0; i < count; ++i) numbers.push_back(first + static_cast<std::int64_t>(i));
        return numbers;
    };
    const auto [least, most] = type.each;
    const std::size_t count = type.least_count;
    const std::int64_t last = most - static_cast<std::int64_t>(count) + 1;
    Samples samples{
        {ascending(count, least + 7), ascending(count, least + 8), ascending(count, least), ascending(count, last)},
        {ascending(count, least - 1), ascending(count, last + 1)}};
    return samples;
}

/// Holds samples of settings for which no program can make them up.
const std::map<std::string_view, Samples> kKnown{
    {"/robust", {{"mon:3", "mon:5", "mean", "mon:31"}, {"mon:1", "mon:4", "mon:33", "median"}}},
    {"/integrator/connections",
     {{"cache:1", "cache:2", "pairwise", "cache:999"}, {"cache:0", "cache:1000", "cache:", "all"}}},
    {"/integrator/strategy", {{"1,2", "1,3", "merging", "0,2"}, {"1", "1,2,3", "-1,2", "merges"}}},
    {"/camera_place",
     {{std::vector{0.0, 1.0, 2.0, 0.0, 0.0, 0.0}, std::vector{0.0, std::nextafter(1.0, 2.0), 2.0, 0.0, 0.0, 0.0},
       std::vector{0.0, 1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0}},
      {std::vector{1.0, 1.0, 1.0, 1.0, 1.0, 1.0}}}},
    {"/texture_memory", {{"1M", "2M", "999999T"}, {"1", "M", "1K", "-1G", "1.5G", "1000000M"}}},
};

Samples samples_of(const Setting& setting) {
    if (const auto known = kKnown.find(setting.pointer); known != kKnown.end()) return known->second;
    if (const auto* const number = std::get_if<WholeNumber>(&setting.type))
        return {{number->least + 5, number->least + 6, number->least, number->most},
                {number->least - 1, number->most + 1}};
    if (const auto* const number = std::get_if<RealNumber>(&setting.type)) return samples_of(*number);
    if (const auto* const numbers = std::get_if<WholeNumbers>(&setting.type)) return samples_of(*numbers);
    if (const auto* const numbers = std::get_if<RealNumbers>(&setting.type);
        numbers != nullptr && numbers->least_count == 6) {
        const std::vector<double> good{1.5, 0.0, 0.0, 0.0, 0.0, 1.0};
        std::vector<double> next = good;
        next[0] = std::nextafter(1.5, 2.0);
        std::vector<double> with_up = good;
        with_up.insert(with_up.end(), {0.0, 0.0, 1.0});
        return {{good, next, with_up},
                {std::vector{1.0, 2.0, 3.0, 1.0, 2.0, 3.0}, std::vector{0.0, 0.0, 0.0, 0.0, 2.0, 0.0}}};
    }
    if (std::holds_alternative<RealNumbers>(setting.type)) {
        const double next = next_to(1.5, 2.0, true);
        return {{std::vector{0.0, 1.5}, std::vector{0.0, next}, std::vector{-1.0, -1.0}}, {std::vector{1.0, 0.5}}};
    }
    if (std::holds_alternative<YesNo>(setting.type)) return {{true, false}, {}};
    if (const auto* const name = std::get_if<Name>(&setting.type))
        return name->is_integrator ? Samples{{"bdpt", "light"}, {}} : Samples{{"a \"b\" \\", "a \"b\" \\ "}, {""}};
    if (const auto* const choice = std::get_if<Choice>(&setting.type)) {
        Samples samples{{}, {"no such name"}};
        for (const std::string_view name : choice->names) samples.good.emplace_back(std::string(name));
        return samples;
    }
    if (const auto* const texts = std::get_if<Texts>(&setting.type); texts != nullptr && texts->takes_one)
        return {{std::vector<std::string>{"walk"}, std::vector<std::string>{"walk", "wave"}},
                {std::vector<std::string>{""}}};
    if (std::holds_alternative<Texts>(setting.type))
        return {{std::vector<std::string>{"depth"}, std::vector<std::string>{"depth", "N:half"}},
                {std::vector<std::string>{"N="}}};
    return {};
}

/// Writes a render.json with that value alone.
nlohmann::json document_with(const Setting& setting, const SettingValue& value) {
    nlohmann::json document = nlohmann::json::object();
    document[nlohmann::json::json_pointer(std::string(setting.pointer))] =
        nlohmann::json::parse(to_text(setting, value));
    return document;
}

/// Returns the text of the setting that render.json gives; nothing if it is refused.
std::optional<std::string> read_back(const Setting& setting, const SettingValue& value) {
    ProblemList problems;
    const RenderJson json = read_render_json({}, document_with(setting, value).dump(), problems);
    if (problems.has_errors()) return std::nullopt;
    return to_text(setting, setting.place.read(json.settings));
}

/// Returns the text of the setting that the option's `words` give; nothing if they are refused.
std::optional<std::string> parsed_back(const Setting& setting, const std::vector<std::string>& words) {
    CLI::App app;
    SettingsOverrides overrides;
    add_settings_options(app, overrides);
    try {
        app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    } catch (const CLI::ParseError&) {
        return std::nullopt;
    }
    RenderSettings settings;
    overrides.apply(settings);
    EXPECT_EQ(settings.options.contains(std::string(setting.pointer)), setting.pointer != "/aovs");
    return to_text(setting, setting.place.read(settings));
}

std::string schema_file() {
    return std::string(ETENDUE_SOURCE_DIR) + "/scenes/render.schema.json";
}

class SettingsTable : public testing::TestWithParam<const Setting*> {
  protected:
    const Setting& setting_ = *GetParam();
    Samples samples_ = samples_of(setting_);
};

TEST_P(SettingsTable, HasSamples) {
    ASSERT_GE(samples_.good.size(), 2u) << "tell samples of its form above";
    for (const SettingValue& value : samples_.good) EXPECT_EQ(problem_with(setting_, value), std::nullopt);
    for (const SettingValue& value : samples_.bad) EXPECT_NE(problem_with(setting_, value), std::nullopt);
    EXPECT_EQ(problem_with(setting_, default_value(setting_)), std::nullopt);
}

TEST_P(SettingsTable, IsReadAsTheSchemaHasItAndAsItIsWritten) {
    const nlohmann::json schema = nlohmann::json::parse(read_file(schema_file()));
    for (const SettingValue& value : samples_.good) {
        const std::string text = to_text(setting_, value);
        EXPECT_EQ(read_back(setting_, value), text);
        EXPECT_TRUE(schema_violations(schema, document_with(setting_, value)).empty()) << text;
    }
    for (const SettingValue& value : samples_.bad) {
        const std::string text = to_text(setting_, value);
        EXPECT_EQ(read_back(setting_, value), std::nullopt) << text;
        const bool is_order = std::holds_alternative<RealNumbers>(setting_.type);  // no schema can say that
        EXPECT_EQ(schema_violations(schema, document_with(setting_, value)).empty(), is_order) << text;
    }
}

TEST_P(SettingsTable, IsTheSameByItsOption) {
    for (const SettingValue& value : samples_.good) {
        const std::vector<std::string> words = option_words(setting_, value);
        if (words.empty()) continue;
        EXPECT_EQ(parsed_back(setting_, words), to_text(setting_, value)) << words.front();
    }
    for (const SettingValue& value : samples_.bad) {
        const std::vector<std::string> words = option_words(setting_, value);
        if (words.empty()) continue;
        EXPECT_EQ(parsed_back(setting_, words), std::nullopt) << words.back();
    }
}

TEST_P(SettingsTable, IsValidatedWhereverItComesFrom) {
    for (const SettingValue& value : samples_.bad) {
        SceneDesc scene;
        setting_.place.write(scene.settings, value);
        // Some bad values cannot be held: another value is read back, and there is nothing to validate.
        if (to_text(setting_, setting_.place.read(scene.settings)) != to_text(setting_, value)) continue;
        const ProblemList problems = validate(scene);
        ASSERT_TRUE(problems.has_errors()) << to_text(setting_, value);
        EXPECT_EQ(problems.all().front().where.pointer, setting_.pointer);
    }
}

TEST_P(SettingsTable, IsPartOfWhatItDecides) {
    RenderSettings one;
    if (const Setting* const needed = find_setting(setting_.needs))
        needed->place.write(one, samples_of(*needed).good.front());
    RenderSettings other = one;
    setting_.place.write(one, samples_.good[0]);
    setting_.place.write(other, samples_.good[1]);
    const std::string name = setting_name(setting_);
    const bool are_other_sums = decides_pixels(setting_.decides);
    EXPECT_EQ(settings_identity(one) != settings_identity(other), are_other_sums);
    EXPECT_EQ(settings_identity(one).contains(name), are_other_sums);
    EXPECT_EQ(requested_settings(one) != requested_settings(other), decides_files(setting_.decides));
    SceneDesc scene;
    scene.settings = one;
    const std::string hash = settings_hash(scene, PixelDepth::Half);
    scene.settings = other;
    EXPECT_EQ(settings_hash(scene, PixelDepth::Half) != hash, decides_files(setting_.decides));
    const std::vector<std::string> changes = changed_settings(setting_texts(one), setting_texts(other));
    EXPECT_EQ(changes, std::vector<std::string>{name + ": " + to_text(setting_, samples_.good[0]) + " -> " +
                                                to_text(setting_, samples_.good[1])});
}

TEST_P(SettingsTable, NamesWhatThereIs) {
    EXPECT_EQ(find_setting(setting_.needs) == nullptr, setting_.needs.empty());
    EXPECT_FALSE(setting_.help.empty());
    EXPECT_NE(setting_.help.back(), '.');
    EXPECT_FALSE(std::holds_alternative<std::monostate>(default_value(setting_)) && setting_.default_text.empty());
}

std::vector<const Setting*> all_rows() {
    std::vector<const Setting*> rows;
    for (const Setting& setting : settings_table()) rows.push_back(&setting);
    return rows;
}

INSTANTIATE_TEST_SUITE_P(All, SettingsTable, testing::ValuesIn(all_rows()), [](const auto& row) {
    std::string name = setting_name(*row.param);
    std::ranges::replace(name, '.', '_');
    return name;
});

TEST(SettingsFiles, AreAsTheTableHasThem) {
    const bool updates = std::getenv("ETENDUE_UPDATE") != nullptr;
    const auto require_same = [&](const std::string& file, const std::string& made) {
        if (updates) write_file(file, made);
        EXPECT_EQ(read_file(file), made) << file << " is to be made again: tools/dev/update_settings";
    };
    require_same(schema_file(), schema_text(with_settings(ordered_json::parse(read_file(schema_file())))));
    const std::string page = std::string(ETENDUE_SOURCE_DIR) + "/docs/render-json.md";
    require_same(page, with_settings_table(read_file(page)));
}

// Settings that nobody reads any more would stay in the schema.
TEST(SettingsFiles, HaveNothingElse) {
    const ordered_json schema = ordered_json::parse(read_file(schema_file()));
    for (const char* object : {"integrator", "film", "color", "metadata"})
        for (const auto& [key, value] : schema["properties"][object]["properties"].items())
            EXPECT_NE(find_setting(std::string("/") + object + "/" + key), nullptr) << object << "/" << key;
}

TEST(CanonicalSettings, AreTheSameForAFrameOfWhateverSequence) {
    RenderSettings one;
    one.frames = FrameRange{0, 10, 1};
    one.frame = 6;
    one.fps = 12.0;
    RenderSettings other;
    other.time_code = 0.5;
    other.fps = 12.0;  // which layers of motion and headers have
    EXPECT_EQ(settings_identity(one), settings_identity(other));
    EXPECT_EQ(requested_settings(one), requested_settings(other));
}

TEST(CanonicalSettings, LeaveOutWhatHasNoEffect) {
    RenderSettings settings;
    settings.min_spp = 7;
    settings.animations = {"walk"};
    EXPECT_EQ(requested_settings(settings), requested_settings({}));
    settings.relative_error = 0.1;
    settings.time_code = 0.0;
    EXPECT_EQ(requested_settings(settings),
              "{\"/animation\": [\"walk\"], \"/error\": 0.1, \"/min_spp\": 7, \"/time_code\": 0}");
}

}  // namespace

}  // namespace etendue::test
