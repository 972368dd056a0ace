#include "integrator/integrator.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(IntegratorRegistry, HoldsWhatTheDocumentationNames) {
    std::set<std::string> names;
    for (const IntegratorEntry& entry : integrator_registry()) {
        EXPECT_TRUE(names.insert(std::string(entry.name)).second) << entry.name << " twice";
        EXPECT_FALSE(entry.summary.empty());
        const auto integrator = make_integrator(entry.name, {});
        ASSERT_NE(integrator, nullptr);
        EXPECT_NE(integrator->make_scratch(), nullptr);
    }
    for (const char* name :
         {"path", "direct", "naive", "hemisphere", "light", "bdpt", "vcm", "whitted", "normals", "albedo"})
        EXPECT_TRUE(names.contains(name)) << name;
}

TEST(IntegratorRegistry, KnowsWhichShowLight) {
    for (const char* name : {"normals", "albedo"}) EXPECT_FALSE(find_integrator(name)->shows_light) << name;
    for (const char* name : {"path", "direct", "naive", "hemisphere", "light", "bdpt", "vcm", "whitted"})
        EXPECT_TRUE(find_integrator(name)->shows_light) << name;
}

TEST(IntegratorRegistry, UnknownNamesMakeNothing) {
    EXPECT_EQ(make_integrator("pathtracer", {}), nullptr);
    EXPECT_EQ(make_integrator("", {}), nullptr);
    EXPECT_EQ(find_integrator("pathtracer"), nullptr);
}

}  // namespace

}  // namespace etendue::test
