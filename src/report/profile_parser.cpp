// Reads profile.json for comparisons. The file may come from anywhere: everything is looked at before it is used.
#include "core/error.h"
#include "report/profile_comparison.h"
#include "report/profile_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

constexpr std::size_t kLongestText = 1000;
constexpr int kMostInt = std::numeric_limits<int>::max();
constexpr double kMostSeconds = 1e12;
/// Larger ones are no longer whole as floating-point numbers; no profile comes near.
constexpr std::uint64_t kMostCount = std::uint64_t{1} << 53;

class Document {
  public:
    Document(const nlohmann::json& json, const std::string& file) : json_(json), file_(file) {}

    [[noreturn]] void fail(const std::string& pointer, const std::string& message) const {
        throw SceneError({file_, pointer}, message);
    }

    const nlohmann::json& at(const std::string& pointer) const {
        const nlohmann::json::json_pointer place(pointer);
        if (!json_.contains(place)) fail(pointer, "is missing; this is no profile, or not all of one");
        return json_.at(place);
    }

    std::size_t size(const std::string& pointer) const {
        const nlohmann::json& json = at(pointer);
        if (!json.is_array()) fail(pointer, "must be an array");
        return json.size();
    }

    /// Reads a finite number in [least, kMostSeconds].
    double number(const std::string& pointer, double least = 0.0) const {
        const nlohmann::json& json = at(pointer);
        if (!json.is_number()) fail(pointer, "must be a number");
        const auto value = json.get<double>();
        if (!(value >= least && value <= kMostSeconds))
            fail(pointer, fmt::format("{:g} is not in [{:g}, {:g}]", value, least, kMostSeconds));
        return value;
    }

    /// Reads a number as `number` does, or null as NaN.
    double known_number(const std::string& pointer) const {
        return at(pointer).is_null() ? std::numeric_limits<double>::quiet_NaN() : number(pointer);
    }

    std::uint64_t count(const std::string& pointer, std::uint64_t least = 0, std::uint64_t most = kMostCount) const {
        const nlohmann::json& json = at(pointer);
        if (!json.is_number_unsigned()) fail(pointer, "must be a whole number");
        const auto value = json.get<std::uint64_t>();
        if (value < least || value > most) fail(pointer, fmt::format("{} is not in [{}, {}]", value, least, most));
        return value;
    }

    int whole(const std::string& pointer, int least) const {
        return static_cast<int>(count(pointer, static_cast<std::uint64_t>(least), kMostInt));
    }

    /// Safe to be shown on a terminal: its control characters are told to nobody.
    std::string text(const std::string& pointer) const {
        const nlohmann::json& json = at(pointer);
        if (!json.is_string()) fail(pointer, "must be a text");
        return shown(pointer, json.get_ref<const std::string&>());
    }

    /// An object of such texts.
    std::map<std::string, std::string> texts(const std::string& pointer) const {
        const nlohmann::json& json = at(pointer);
        if (!json.is_object()) fail(pointer, "must be an object");
        std::map<std::string, std::string> values;
        for (const auto& [key, value] : json.items()) {
            if (!value.is_string()) fail(pointer, "must be an object of texts");
            values[shown(pointer, key)] = shown(pointer, value.get_ref<const std::string&>());
        }
        return values;
    }

  private:
    /// `value`, if it may be shown.
    const std::string& shown(const std::string& pointer, const std::string& value) const {
        if (value.size() > kLongestText) fail(pointer, fmt::format("is longer than {} bytes", kLongestText));
        if (std::any_of(value.begin(), value.end(), [](char c) {
                const auto byte = static_cast<unsigned char>(c);
                return byte < 0x20 || byte == 0x7f;
            }))
            fail(pointer, "has control characters");
        return value;
    }

    const nlohmann::json& json_;
    const std::string& file_;
};

RayKindReport parse_kind(const Document& document, const std::string& place) {
    return {.kind = document.text(place + "/kind"),
            .rays = document.count(place + "/rays"),
            .seconds = document.number(place + "/seconds")};
}

ProfileRun parse_run(const Document& document, const std::string& place) {
    ProfileRun run{.integrator = document.text(place + "/integrator"),
                   .threads = document.whole(place + "/threads", 1),
                   .spp = static_cast<std::uint32_t>(document.whole(place + "/spp", 0)),
                   .samples = document.count(place + "/samples", 1)};
    const std::string repetitions = place + "/cpu_seconds";
    constexpr double kShortest = 1e-9;  // of which a logarithm can be taken
    for (std::size_t i = 0; i < document.size(repetitions); ++i)
        run.cpu_seconds.push_back(document.number(fmt::format("{}/{}", repetitions, i), kShortest));
    for (std::size_t i = 0; i < document.size(place + "/kinds"); ++i)
        run.kinds.push_back(parse_kind(document, fmt::format("{}/kinds/{}", place, i)));
    return run;
}

ProfileBaseline parse_document(const Document& document) {
    if (document.at("/format") != kProfileFormat)
        document.fail("/format", fmt::format("is not {}: another version has written this", kProfileFormat));
    ProfileBaseline baseline{
        .program = document.text("/program"),
        .created = document.text("/created"),
        .scene = document.text("/scene/name"),
        .width = document.whole("/scene/width", 1),
        .height = document.whole("/scene/height", 1),
        .max_depth = document.whole("/scene/max_depth", 0),
        .seed = static_cast<std::uint32_t>(document.count("/scene/seed", 0, std::numeric_limits<std::uint32_t>::max())),
        .settings = document.texts("/scene/settings"),
        .processor = document.text("/machine/processor"),
        .isa = document.text("/machine/isa"),
        .ray_tracer = document.text("/machine/ray_tracer"),
        .load = {{"load", document.known_number("/load/seconds")}},
        .first_pixel_seconds = document.known_number("/load/first_pixel_seconds"),
        .bvh = {.build_seconds = document.known_number("/bvh/build_seconds"),
                .instanced_triangles = document.count("/bvh/instanced_triangles"),
                .bytes = document.count("/bvh/bytes"),
                .quality = document.text("/bvh/quality")},
        .peak_memory_bytes = document.count("/memory/peak_bytes")};
    for (std::size_t i = 0; i < document.size("/runs"); ++i)
        baseline.runs.push_back(parse_run(document, fmt::format("/runs/{}", i)));
    return baseline;
}

}  // namespace

ProfileBaseline parse_profile(const std::string& json, const std::string& file) {
    try {
        const nlohmann::json parsed = nlohmann::json::parse(json);
        return parse_document(Document(parsed, file));
    } catch (const nlohmann::json::exception&) {
        throw SceneError({file, ""}, "is no profile.json: it is no JSON, or damaged");
    }
}

}  // namespace etendue
