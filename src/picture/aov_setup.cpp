#include "picture/aov_setup.h"

#include "core/pointed_text.h"
#include "core/shown_text.h"
#include "integrator/integrator.h"
#include "lightpath/label_classes.h"
#include "lightpath/usual_expressions.h"
#include "output/cryptomatte.h"
#include "picture/aov_sources.h"
#include "picture/light_names.h"
#include "picture/matte_names.h"
#include "picture/render_setup.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr int kUsualRanks = 6;
constexpr int kMostRanks = 32;
/// Larger manifests are left out: files are opened for their headers.
constexpr std::size_t kLargestManifest = std::size_t{16} << 20;

/// Channels of the file that the writer makes.
bool is_reserved(const std::string& name) {
    return name == "rgba" || name == kHalf || name.starts_with("half_");
}

/// True if `name` is that of the Cryptomatte `matte` and digits behind it.
bool is_rank_of(std::string_view matte, std::string_view name) {
    if (!name.starts_with(matte) || name.size() == matte.size()) return false;
    return std::ranges::all_of(name.substr(matte.size()), [](char c) { return c >= '0' && c <= '9'; });
}

/// Makes the plan, layer by layer.
class Planner {
  public:
    Planner(const SceneDesc& scene, ProblemList& problems) : scene_(scene), problems_(problems) {}

    AovPlan plan() {
        for (const AovDesc& aov : scene_.settings.aovs) add(aov);
        const RenderSettings& settings = scene_.settings;
        if (plan_.outputs.empty() && settings.robust_buckets == 0 && settings.clamp_indirect == 0.0f) return {};
        if (plan_.has_halves && settings.robust_buckets > 0)
            throw SceneError(
                settings.at("/robust"),
                "layers for denoising hold half of the samples, and what is not in them is the other half: "
                "that is so of means, and not of the medians of mon:N; leave one of both out");
        if (set_.layout.is_deep && settings.robust_buckets > 0)
            throw SceneError(settings.at("/robust"),
                             "a deep image composites to the means of the samples, and the medians of mon:N are none: "
                             "leave one of both out");
        check_names();
        finish_expressions();
        finish_fireflies();
        set_.frames_of_shutter = static_cast<float>((settings.shutter.close - settings.shutter.open) * settings.fps);
        set_.mist = settings.mist;
        plan_.set = std::make_shared<AovSet>(std::move(set_));
        return std::move(plan_);
    }

  private:
    [[noreturn]] static void fail(const AovDesc& aov, const std::string& what) {
        throw SceneError(aov.location, fmt::format("layer '{}': {}", aov.name, what));
    }

    void add(const AovDesc& aov) {
        const bool is_group = aov.name == aov.source;
        if (is_group && aov.source == aov_source::kPasses.name) {
            for (const UsualExpression& usual : partition_expressions())
                add_expression(aov, std::string(usual.name), std::string(usual.expression));
        } else if (is_group && aov.source == aov_source::kLights.name) {
            std::set<std::string> taken;
            for (const std::string& name : light_names(scene_))
                add_expression(aov, "light_" + layer_name(name, taken),
                               fmt::format("C .* <L'{}'>", label_pattern(name)));
        } else if (is_group && aov.source == aov_source::kDenoising.name) {
            plan_.has_halves = true;
            for (const FirstHitValue value : {FirstHitValue::Albedo, FirstHitValue::Normal, FirstHitValue::Depth})
                add_first_hit(aov, std::string(first_hit_entry(value).name), first_hit_entry(value));
        } else if (is_group && aov.source == aov_source::kCryptomatte.name) {
            for (const MatteSource& matte : aov_source::kMattes) add_matte(aov, matte);
        } else {
            add_one(aov);
        }
    }

    void add_one(const AovDesc& aov) {
        const std::string_view source = aov.source;
        if (source.starts_with(aov_source::kExpression))
            return add_expression(aov, aov.name, aov.source.substr(aov_source::kExpression.size()));
        if (source.starts_with(aov_source::kLight))
            return add_expression(aov, aov.name, light_expression(aov.source.substr(aov_source::kLight.size())));
        for (const UsualExpression& usual : usual_expressions())
            if (usual.name == source) return add_expression(aov, aov.name, std::string(usual.expression));
        for (const FirstHitEntry& entry : first_hit_table())
            if (entry.name == source) return add_first_hit(aov, aov.name, entry);
        if (source == aov_source::kSamples.name)
            return (void)add_output(aov, {aov.name, "X", AovKind::Samples, 0, 0.0f, true});
        if (source == aov_source::kVariance.name) {
            set_.layout.has_moments = true;
            return (void)add_output(aov, {aov.name, "RGB", AovKind::Variance, 0, 0.0f, true});
        }
        if (source == aov_source::kRays.name) {
            set_.layout.has_ray_counts = true;
            return (void)add_output(aov, {aov.name, "X", AovKind::Rays});
        }
        if (source == aov_source::kMean.name) return (void)add_output(aov, {aov.name, "RGB", AovKind::Mean});
        if (source == aov_source::kRemoved.name) {
            if (scene_.settings.clamp_indirect == 0.0f)
                fail(aov, "nothing is taken away without a limit (--clamp-indirect)");
            // Which light layer that is, is known once all expressions are.
            return (void)add_output(aov, {aov.name, "RGB", AovKind::Layer, kRemovedLayer});
        }
        for (const MatteSource& matte : aov_source::kMattes)
            if (matte.name == source) return add_matte(aov, matte);
        if (source == aov_source::kDeep.name) {
            if (aov.name != aov.source) fail(aov, "a deep image is no layer: ask for 'deep', and it has that name");
            if (aov.is_float == false) fail(aov, "depths are 32-bit floats: leave ':half' away");
            set_.layout.is_deep = true;
            return (void)add_output(aov, {aov.name, {}, AovKind::Deep, 0, 0.0f, true});
        }
        for (const std::string_view group : {aov_source::kPasses.name, aov_source::kLights.name,
                                             aov_source::kDenoising.name, aov_source::kCryptomatte.name})
            if (source == group)
                fail(aov, fmt::format("'{}' stands for several layers, which have names of their own: leave '{}=' away",
                                      source, aov.name));
        fail(aov, fmt::format("there is no source '{}'; {}", source, name_hint(source, aov_source_names())));
    }

    void add_expression(const AovDesc& aov, const std::string& name, const std::string& text) {
        const std::string& type = scene_.settings.integrator.type;
        const IntegratorEntry* const entry = find_integrator(type);
        if (entry != nullptr && !entry->has_expressions)
            fail(aov,
                 fmt::format("'{}' does not tell paths apart; these do: {}", type,
                             integrators_that([](const IntegratorEntry& other) { return other.has_expressions; })));
        if (!add_output(aov, {name, "RGB", AovKind::Layer, expressions_.size()}, text)) return;
        try {
            expressions_.push_back(parse_expression(text));
            // Alone, so that what is wrong with it is not blamed on another.
            (void)PathAutomaton(std::span(expressions_).last(1), {});
        } catch (const ExpressionError& error) {
            fail(aov, fmt::format("{}\n{}", error.what(), pointed_text(text, error.offset(), 4)));
        }
        expression_texts_.push_back(text);
        expression_sources_.push_back(&aov);
    }

    void add_first_hit(const AovDesc& aov, const std::string& name, const FirstHitEntry& entry) {
        LayerLayout& layout = set_.layout;
        std::size_t& count = entry.is_nearest ? layout.nearest : layout.values;
        AovOutput output{name,
                         std::string(entry.channels),
                         entry.is_nearest ? AovKind::Nearest : AovKind::Values,
                         count,
                         entry.background,
                         entry.is_float};
        if (entry.value == FirstHitValue::ObjectId) output.manifest = names_of_ids(aov, object_names(scene_));
        if (entry.value == FirstHitValue::MaterialId) output.manifest = names_of_ids(aov, material_names(scene_));
        if (!add_output(aov, std::move(output), entry.name)) return;
        count += entry.channels.size();
        (entry.is_nearest ? set_.nearest : set_.values).push_back(entry.value);
    }

    void add_matte(const AovDesc& aov, const MatteSource& matte) {
        if (aov.is_float == false) fail(aov, "ids are 32-bit floats, and others in 16 bits: leave ':half' away");
        const int ranks = aov.ranks.value_or(kUsualRanks);
        if (ranks < 1 || ranks > kMostRanks) fail(aov, fmt::format("1 to {} ranks, not {}", kMostRanks, ranks));
        LayerLayout& layout = set_.layout;
        const std::vector<std::string> names = matte.names(scene_);
        AovOutput output{
            aov.name == aov.source ? std::string(matte.layer) : aov.name, {}, AovKind::Matte, layout.mattes};
        output.is_float = true;
        output.manifest = manifest_of(aov, names);
        for (int rank = 0; rank < ranks; rank += 2) output.channels += "RGBA";
        const std::size_t channels = output.channels.size();  // two of each rank, their number rounded up to even
        if (!add_output(aov, std::move(output), fmt::format("{} {}", matte.name, ranks))) return;
        ++layout.mattes;
        // Twice as many ids as are written, so that those that come late may still become important.
        layout.matte_slots = std::max(layout.matte_slots, channels);
        MatteIds ids{.by_material = matte.by_material};
        for (const std::string& name : names) ids.ids.push_back(matte_id(name));
        set_.mattes.push_back(std::move(ids));
    }

    /// Returns the names of the ids from 1 on, as JSON; empty if it would be too large.
    std::string names_of_ids(const AovDesc& aov, const std::vector<std::string>& names) {
        std::string list = id_names(names);
        if (list.size() <= kLargestManifest) return list;
        problems_.note(aov.location, fmt::format("the names of ids, {} bytes, are left out of the file", list.size()));
        return {};
    }

    /// Empty if it would be too large. Notes names that cannot be told apart.
    std::string manifest_of(const AovDesc& aov, const std::vector<std::string>& names) {
        const std::vector<MatteCollision> collisions = matte_collisions(names);
        if (!collisions.empty())
            problems_.note(aov.location,
                           fmt::format("{} names have the id of another, the first of them '{}' that of '{}': their "
                                       "mattes are one",
                                       collisions.size(), collisions.front().second, collisions.front().first));
        std::string manifest = matte_manifest(names);
        if (manifest.size() <= kLargestManifest) return manifest;
        problems_.note(aov.location, fmt::format("a manifest of {} bytes is left out of the file; mattes can be picked "
                                                 "in the image, but not by name",
                                                 manifest.size()));
        return {};
    }

    /// False if it is there already, as groups may ask for it: of the same kind, with the same `detail`. Then the type
    /// counts that was asked for by the layer's own name.
    bool add_output(const AovDesc& aov, AovOutput output, std::string_view detail = {}) {
        if (is_reserved(output.name)) fail(aov, fmt::format("the file has '{}' for itself", output.name));
        if (aov.is_float) output.is_float = *aov.is_float;
        std::string content = fmt::format("{} {}", static_cast<int>(output.kind), detail);
        const auto same = std::ranges::find(plan_.outputs, output.name, &AovOutput::name);
        if (same == plan_.outputs.end()) {
            plan_.outputs.push_back(std::move(output));
            origins_.push_back({&aov, std::move(content)});
            return true;
        }
        Origin& origin = origins_[static_cast<std::size_t>(same - plan_.outputs.begin())];
        const AovDesc& earlier = *origin.aov;
        const bool either_is_group = earlier.name != output.name || aov.name != output.name;
        if (either_is_group && origin.content == content) {
            if (aov.name == output.name) {
                same->is_float = output.is_float;
                origin.aov = &aov;
            }
        } else if (earlier != aov)
            fail(aov, fmt::format("there are two of this name, this one of '{}' and one of '{}' ({})", aov.source,
                                  earlier.source, earlier.location.str()));
        return false;
    }

    /// The ranks of a matte are in channels of layers NAME00, NAME01 …, which others may be called by. Programs take
    /// all that looks so for ranks, of however many there are, and put the parts of a file together, so that this holds
    /// in all layouts.
    void check_names() const {
        for (std::size_t i = 0; i < plan_.outputs.size(); ++i) {
            const AovOutput& output = plan_.outputs[i];
            for (std::size_t m = 0; m < plan_.outputs.size(); ++m)
                if (plan_.outputs[m].kind == AovKind::Matte && is_rank_of(plan_.outputs[m].name, output.name))
                    throw SceneError(
                        origins_[i].aov->location,
                        fmt::format("layer '{}': programs would take it for a part of the Cryptomatte '{}' ({}): give "
                                    "one of both another name",
                                    output.name, plan_.outputs[m].name, origins_[m].aov->location.str()));
            if (output.kind == AovKind::Matte) continue;
            for (const MatteSource& matte : aov_source::kMattes)
                if (output.name == matte.layer || is_rank_of(matte.layer, output.name))
                    throw SceneError(
                        origins_[i].aov->location,
                        fmt::format("layer '{}': programs would take it for a part of a Cryptomatte, which "
                                    "'{}' is: give it another name",
                                    output.name, matte.name));
        }
    }

    void finish_expressions() {
        if (expressions_.empty()) return;
        set_.layout.light = expressions_.size();
        set_.lamp_count = scene_.lights.size();
        set_.instance_count = scene_.instances.size();
        try {
            set_.automaton = std::make_shared<PathAutomaton>(expressions_, path_names(scene_));
        } catch (const ExpressionError& error) {
            fail(*expression_sources_.back(), error.what());
        }
        // A name that may be a light's or a material's is among them twice.
        const std::vector<std::string> unmatched = set_.automaton->unmatched_names();
        for (const std::string& name : std::set<std::string>(unmatched.begin(), unmatched.end()))
            problems_.note(expression_sources_[first_with_name(name)]->location,
                           fmt::format("no light, object or material is named '{}', which a layer asks for", name));
    }

    /// The first expression that asks for `name`.
    [[nodiscard]] std::size_t first_with_name(const std::string& name) const {
        const auto first = std::ranges::find_if(expression_texts_, [&name](const std::string& text) {
            return text.find('\'' + name + '\'') != std::string::npos ||
                   text.find('"' + name + '"') != std::string::npos;
        });
        return static_cast<std::size_t>(first - expression_texts_.begin());
    }

    /// The layers that fireflies are controlled with, behind all others of their kind.
    void finish_fireflies() {
        if (scene_.settings.clamp_indirect > 0.0f) {
            set_.removed_light = set_.layout.light++;
            for (AovOutput& output : plan_.outputs)
                if (output.kind == AovKind::Layer && output.first == kRemovedLayer) output.first = *set_.removed_light;
        }
        set_.add_buckets(static_cast<std::size_t>(scene_.settings.robust_buckets));
    }

    static constexpr std::size_t kRemovedLayer = std::numeric_limits<std::size_t>::max();

    const SceneDesc& scene_;
    ProblemList& problems_;
    AovPlan plan_;
    AovSet set_;
    /// Holds which request an output of the plan comes from, and the output's kind and detail as text.
    struct Origin {
        const AovDesc* aov;
        std::string content;
    };
    std::vector<Origin> origins_;
    std::vector<PathExpression> expressions_;
    std::vector<std::string> expression_texts_;
    std::vector<const AovDesc*> expression_sources_;
};

}  // namespace

AovPlan make_aov_plan(const SceneDesc& scene, ProblemList& problems) {
    AovPlan plan = Planner(scene, problems).plan();
    const RenderSettings& settings = scene.settings;
    const bool has_layers =
        std::ranges::any_of(plan.outputs, [](const AovOutput& aov) { return aov.kind != AovKind::Deep; });
    if (settings.color.aces_container && has_layers && settings.aov_layout != AovLayout::Files)
        throw SceneError(settings.at("/aov_layout"),
                         "an ACES container (SMPTE ST 2065-4) holds one image: write layers in files of their own "
                         "(--aov-layout files)");
    return plan;
}

bool has_half(const AovOutput& output) {
    return output.kind != AovKind::Matte && output.kind != AovKind::Deep;
}

std::string half_name(const AovOutput& output) {
    // With a point, Blender would take it for a layer of its own, and show that in place of the image.
    return fmt::format("{}_{}", kHalf, output.name);
}

std::vector<std::string> layers_with_files(const AovPlan& plan, bool each_has_file) {
    std::vector<std::string> names;
    for (const AovOutput& output : plan.outputs)
        if (each_has_file || output.kind == AovKind::Deep) names.push_back(output.name);
    if (!each_has_file || !plan.has_halves) return names;
    names.emplace_back(kHalf);
    for (const AovOutput& output : plan.outputs)
        if (has_half(output)) names.push_back(half_name(output));
    return names;
}

}  // namespace etendue
