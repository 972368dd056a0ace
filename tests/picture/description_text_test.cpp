// What parts say of themselves: anybody can write one.
#include "picture/description_text.h"

#include "core/error.h"

#include <string>

#include <gtest/gtest.h>

namespace etendue {

namespace {

const LayerLayout kLayout{.light = 7, .values = 13, .nearest = 4, .has_moments = true, .mattes = 1, .matte_slots = 4};

ImageDescription description_of(const AovOutput& aov) {
    ImageDescription description;
    description.aovs = {aov};
    return description;
}

std::string refusal(const ImageDescription& description) {
    try {
        (void)parse_description(to_text(description), kLayout, "a.partial");
    } catch (const IoError& error) {
        return error.what();
    }
    return "";
}

TEST(ImageDescription, TakesWhatTheFilmHas) {
    for (const AovOutput& aov :
         {AovOutput{"caustics", "RGB", AovKind::Layer, 6}, AovOutput{"N", "XYZ", AovKind::Values, 10},
          AovOutput{"P", "XYZ", AovKind::Nearest, 1}, AovOutput{"samples", "X", AovKind::Samples},
          AovOutput{"variance", "RGB", AovKind::Variance}, AovOutput{"mean", "RGB", AovKind::Mean},
          AovOutput{"ids", "rgbargba", AovKind::Matte, 0}})
        EXPECT_EQ(refusal(description_of(aov)), "") << aov.name;
    ImageDescription buckets;
    buckets.buckets = {5, 2, 3};
    buckets.removed_light = 6;
    EXPECT_EQ(refusal(buckets), "");
}

TEST(ImageDescription, RefusesWhatTheFilmHasNot) {
    for (const AovOutput& aov :
         {AovOutput{"caustics", "RGB", AovKind::Layer, 7}, AovOutput{"caustics", "RG", AovKind::Layer, 0},
          AovOutput{"N", "XYZ", AovKind::Values, 11}, AovOutput{"N", "", AovKind::Values, 0},
          AovOutput{"N", "XYZ", AovKind::Values, ~std::size_t{0}}, AovOutput{"P", "XYZ", AovKind::Nearest, 2},
          AovOutput{"samples", "XY", AovKind::Samples}, AovOutput{"variance", "X", AovKind::Variance},
          AovOutput{"rays", "X", AovKind::Rays}, AovOutput{"ids", "rgbargbargba", AovKind::Matte, 0},
          AovOutput{"ids", "rgba", AovKind::Matte, 1}, AovOutput{"deep", "", AovKind::Deep}})
        EXPECT_NE(refusal(description_of(aov)), "") << aov.name << " " << aov.first;
    for (const BucketLayers& buckets :
         {BucketLayers{5, 3, 0}, BucketLayers{5, 0, 4}, BucketLayers{5, 100000000000, 0}, BucketLayers{7, 0, 0}}) {
        ImageDescription description;
        description.buckets = buckets;
        EXPECT_NE(refusal(description), "") << buckets.count << " " << buckets.first_light;
    }
    ImageDescription removed;
    removed.removed_light = 7;
    EXPECT_NE(refusal(removed), "");
}

TEST(ImageDescription, KeepsTheWarnings) {
    ImageDescription description;
    description.statistics.warnings = {"warning: one", "warning: two"};
    EXPECT_EQ(parse_description(to_text(description), kLayout, "a.partial").statistics.warnings,
              description.statistics.warnings);
}

TEST(ImageDescription, RefusesNamesThatLeadElsewhere) {
    for (const char* name : {"../../etc/passwd", "a/b", "", ".", "a b"})
        EXPECT_NE(refusal(description_of({name, "RGB", AovKind::Layer, 0})), "") << name;
}

}  // namespace

}  // namespace etendue
