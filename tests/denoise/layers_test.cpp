// Which channels of a file are light, features and halves.
#include "denoise/layers.h"

#include "support/text.h"

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {

namespace {

using Names = std::vector<std::string>;

/// The names, and those of their halves.
Names with_halves(const Names& names) {
    Names all = names;
    for (const std::string& name : names) all.push_back(half_channel(name));
    return all;
}

std::string refusal(const Names& names, const Names& features = default_features(), const Names& required = {}) {
    try {
        (void)plan_layers(names, std::nullopt, features, required);
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "";
}

TEST(Layers, OnlyWhatTheFileSaysIsLight) {
    Names names{"R", "G", "B", "half.R", "half.G", "half.B"};
    for (const char* layer : {"variance", "caustics"})
        for (const char* half : {"", "half_"})
            for (const char* channel : {"R", "G", "B"}) names.push_back(std::string(half) + layer + "." + channel);
    const auto lights_of = [&](const std::optional<Names>& lights) {
        Names found;
        for (const LayerChannels& layer : plan_layers(names, lights, default_features(), {}).lights)
            found.push_back(layer.name);
        return found;
    };
    EXPECT_EQ(lights_of(std::nullopt), (Names{"", "caustics", "variance"}));
    EXPECT_EQ(lights_of(Names{"caustics"}), (Names{"", "caustics"}));
    EXPECT_EQ(lights_of(Names{}), Names{""});
}

TEST(Layers, WithoutHalvesOnlyWhatIsSaidToBeLight) {
    const Names names{"R", "G", "B", "A", "albedo.R", "albedo.G", "albedo.B", "caustics.R", "caustics.G", "caustics.B"};
    const auto plan_of = [&](const std::optional<Names>& lights) {
        return plan_layers(names, lights, Names{"albedo", "N"}, {}, HalvesUse::None);
    };
    EXPECT_EQ(plan_of(std::nullopt).lights.size(), 1u) << "nobody knows what the others are";
    const LayerPlan plan = plan_of(Names{"caustics"});
    ASSERT_EQ(plan.lights.size(), 2u);
    EXPECT_EQ(plan.lights[1].name, "caustics");
    EXPECT_EQ(plan.lights[1].whole, (std::vector<int>{7, 8, 9}));
    ASSERT_EQ(plan.features.size(), 1u);
    EXPECT_EQ(plan.features[0].name, "albedo");
    EXPECT_EQ(plan.kept.size(), names.size());
}

TEST(Layers, TheFirstWithColoursIsTheImageOfAFileOfBlenders) {
    const Names names{"ViewLayer.Combined.A", "ViewLayer.Combined.B", "ViewLayer.Combined.G", "ViewLayer.Combined.R",
                      "ViewLayer.Depth.Z",    "Back.Combined.B",      "Back.Combined.G",      "Back.Combined.R"};
    const LayerPlan plan = plan_layers(names, std::nullopt, Names{"albedo", "N"}, {}, HalvesUse::None);
    ASSERT_EQ(plan.lights.size(), 1u);
    EXPECT_EQ(plan.lights[0].name, "ViewLayer.Combined");
    EXPECT_EQ(plan.lights[0].whole, (std::vector<int>{3, 2, 1}));
    EXPECT_EQ(plan.kept.size(), names.size());
    EXPECT_TRUE(test::contains(refusal(names), "half_ViewLayer.Combined.R"));
}

TEST(Layers, AreFoundByTheirNames) {
    Names names = with_halves({"R", "G", "B", "albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y", "N.Z", "depth.Z",
                               "diffuse.direct.R", "diffuse.direct.G", "diffuse.direct.B"});
    names.insert(names.end(), {"A", "id.R", "id.G", "id.B", "samples.Y"});
    const LayerPlan plan = plan_layers(names, std::nullopt, default_features(), {});
    ASSERT_EQ(plan.lights.size(), 2u);
    EXPECT_EQ(plan.lights[0].name, "");
    EXPECT_EQ(plan.lights[0].whole, (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(plan.lights[0].half, (std::vector<int>{13, 14, 15}));
    EXPECT_EQ(plan.lights[1].name, "diffuse.direct");
    ASSERT_EQ(plan.features.size(), 3u);
    EXPECT_EQ(plan.features[1].name, "N");
    EXPECT_EQ(plan.features[1].half, (std::vector<int>{19, 20, 21}));
    EXPECT_EQ(plan.features[2].whole, (std::vector<int>{9}));
    EXPECT_EQ(plan.kept.size(), names.size() - 13) << "all but the halves";
}

TEST(Layers, AnyLayerCanBeAFeature) {
    const Names names = with_halves({"R", "G", "B", "shadow.Y", "N.X", "N.Y", "N.Z"});
    const LayerPlan plan = plan_layers(names, std::nullopt, Names{"shadow"}, Names{"shadow"});
    ASSERT_EQ(plan.features.size(), 1u);
    EXPECT_EQ(plan.features[0].name, "shadow");
    EXPECT_EQ(plan.lights.size(), 1u);
}

TEST(Layers, WithoutHalvesThereIsNoWay) {
    EXPECT_TRUE(test::contains(refusal({"R", "G", "B", "A"}), "--aov denoising"));
    EXPECT_TRUE(test::contains(refusal({"R", "G", "B", "half.R", "half.G"}), "--aov denoising"));
    EXPECT_TRUE(test::contains(refusal({"R", "G", "half.R", "half.G", "half.B"}), "no channel B"));
    EXPECT_TRUE(test::contains(refusal({"Y"}), "no channel R"));
    EXPECT_TRUE(test::contains(refusal({}), "no channel R"));
}

TEST(Layers, FeaturesThatWereAskedForMustBeThere) {
    const Names names = with_halves({"R", "G", "B"});
    EXPECT_EQ(refusal(names), "");
    EXPECT_TRUE(test::contains(refusal(names, Names{"N"}, Names{"N"}), "no layer 'N'"));
    Names without_half = names;
    without_half.insert(without_half.end(), {"N.X", "N.Y", "N.Z", "half_N.X"});
    EXPECT_TRUE(test::contains(refusal(without_half, Names{"N"}, Names{"N"}), "half_N"));
    EXPECT_EQ(refusal(without_half), "") << "and are left out if they were not";
}

TEST(Layers, ThereIsAMostOfFeatures) {
    Names names{"R", "G", "B"};
    Names features;
    for (char letter = 'a'; letter < 'g'; ++letter) {
        features.emplace_back(1, letter);
        for (const char* channel : {".R", ".G", ".B"}) names.push_back(features.back() + channel);
    }
    EXPECT_TRUE(test::contains(refusal(with_halves(names), features, features), "16 are the most"));
    features.pop_back();
    EXPECT_EQ(refusal(with_halves(names), features, features), "");
    const Names wide = with_halves({"R", "G", "B", "m.a", "m.b", "m.c", "m.d", "m.e"});
    EXPECT_TRUE(test::contains(refusal(wide, Names{"m"}, Names{"m"}), "more than 4 channels"));
}

}  // namespace

}  // namespace etendue
