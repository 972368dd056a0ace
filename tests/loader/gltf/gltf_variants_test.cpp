#include "loader/gltf/gltf_builder.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

/// A triangle that is red, blue in winter and green in spring and summer.
GltfBuilder seasons() {
    GltfBuilder builder;
    nlohmann::json& primitive = builder.add_triangle();
    primitive["material"] = 0;
    primitive["extensions"]["KHR_materials_variants"] = {
        {"mappings", {{{"material", 1}, {"variants", {0}}}, {{"material", 2}, {"variants", {1, 2}}}}}};
    builder.json["materials"] = {{{"name", "red"}}, {{"name", "blue"}}, {{"name", "green"}}};
    builder.json["extensionsUsed"] = {"KHR_materials_variants"};
    builder.json["extensions"]["KHR_materials_variants"] = {
        {"variants", {{{"name", "winter"}}, {{"name", "spring"}}, {{"name", "summer"}}, {{"name", "autumn"}}}}};
    return builder;
}

std::string material_in(const std::string& variant) {
    LoadedScene loaded = seasons().load();
    EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    loaded.scene.settings.variant = variant;
    EXPECT_FALSE(validate(loaded.scene).has_errors());
    apply_variant(loaded.scene);
    const Handle<MaterialDesc> material = loaded.scene.meshes.at(0).primitives.at(0).material;
    return loaded.scene.materials.at(static_cast<std::size_t>(material.index)).name;
}

TEST(Variants, ChooseTheMaterials) {
    EXPECT_EQ(material_in(""), "red");
    EXPECT_EQ(material_in("winter"), "blue");
    EXPECT_EQ(material_in("spring"), "green");
    EXPECT_EQ(material_in("summer"), "green");
    EXPECT_EQ(material_in("autumn"), "red") << "no mapping";
}

TEST(Variants, UnknownNamesAreErrors) {
    LoadedScene loaded = seasons().load();
    loaded.scene.settings.variant = "wimter";
    EXPECT_TRUE(has_problem(validate(loaded.scene), Severity::Error, "did you mean 'winter'?"));
}

TEST(Variants, IndicesAreChecked) {
    GltfBuilder builder = seasons();
    builder.json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"][0]["variants"] = {4};
    EXPECT_TRUE(has_problem(builder.load().problems, Severity::Error, "there are 4", "/mappings/0/variants/0"));
}

}  // namespace
}  // namespace etendue
