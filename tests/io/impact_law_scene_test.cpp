// Laws of impacts in scenes: the effect of each key, and one line for each invalid value.
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "io/scene_errors.h"
#include "ricochet/io/scene.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::errors_of;
using test::Lines;

std::string scene_with(const std::string& material, const std::string& more = "") {
    return R"({"ricochet": 1, "simulation": {"time_step": 0.5, "duration": 1)" + more + R"(}, "materials": {"m": {)" +
           material + R"(}}, "colliders": [{"type": "plane", "normal": [0, 0, 1], "material": "m"}]})";
}

TEST(ImpactLawScene, KeysSetTheMaterial) {
    const std::string keys = R"("friction": 0.2, "static_friction": 0.3, "tangential_restitution": 0.4,
        "tangential_factor": 0.9, "restitution_speed": 2, "restitution_exponent": 0.5)";
    const Material material = parse_scene(scene_with(keys), "s.json").setup.materials.at(0);
    EXPECT_EQ(material.static_friction, std::optional(0.3));
    EXPECT_EQ(material.tangential_restitution, 0.4);
    EXPECT_EQ(material.tangential_factor, 0.9);
    EXPECT_EQ(material.restitution_speed, std::optional(2.0));
    EXPECT_EQ(material.restitution_exponent, 0.5);
    const Material plain = parse_scene(scene_with(""), "s.json").setup.materials.at(0);
    EXPECT_FALSE(plain.needs_instant_impacts());
}

TEST(ImpactLawScene, RowsOfATableSetTheCoefficients) {
    const std::string rows = R"("impact_table": [{"speed": 1, "angle": 30, "restitution": 0.5,
        "tangential_restitution": 0.1, "tangential_factor": 0.7}, {"speed": 2, "angle": 30, "restitution": 0.4}])";
    const Material material = parse_scene(scene_with(rows), "s.json").setup.materials.at(0);
    ASSERT_EQ(material.impact_table.size(), 2U);
    EXPECT_EQ(material.impact_table[0].speed, 1.0);
    EXPECT_EQ(material.impact_table[0].angle, 30.0);
    EXPECT_EQ(material.impact_table[0].restitution, 0.5);
    EXPECT_EQ(material.impact_table[0].tangential_restitution, std::optional(0.1));
    EXPECT_EQ(material.impact_table[0].tangential_factor, std::optional(0.7));
    EXPECT_FALSE(material.impact_table[1].tangential_factor.has_value());
}

TEST(ImpactLawScene, SphereContactsHaveTheirOwnLaw) {
    const std::string scene = R"({"ricochet": 1, "simulation": {"time_step": 0.5, "duration": 1},
        "particle_contacts": {"tangential_restitution": 0.4, "restitution_speed": 2, "materials": {
            "steel": {}, "glass": {"tangential_restitution": 0.1, "restitution_speed": 3, "restitution_exponent": 0}}}})";
    const PairContactSettings contacts = parse_scene(scene, "s.json").setup.options.particle_contacts.value();
    EXPECT_EQ(contacts.tangential_restitution, 0.4);
    EXPECT_EQ(contacts.pairs.at(0).material.tangential_restitution, 0.4);
    EXPECT_EQ(contacts.pairs.at(0).material.restitution_speed, std::optional(2.0));
    EXPECT_EQ(contacts.pairs.at(1).material.tangential_restitution, 0.1);
    EXPECT_EQ(contacts.pairs.at(1).material.restitution_speed, std::optional(3.0));
    EXPECT_EQ(contacts.pairs.at(1).material.restitution_exponent, 0.0);
}

TEST(ImpactLawScene, SenselessLawsAreRefusedInOneLine) {
    EXPECT_EQ(errors_of(scene_with(R"("friction": 0.2, "static_friction": 0.1)")),
              Lines{"materials.m.static_friction: found 0.1, expected at least the friction 0.2"});
    EXPECT_EQ(errors_of(scene_with(R"("static_friction": 0.1)")),
              Lines{"materials.m.static_friction: found without a friction above 0, expected both keys: a contact that "
                    "slips has "
                    "the friction"});
    EXPECT_EQ(errors_of(scene_with(R"("restitution_exponent": 0.3)")),
              Lines{R"(materials.m.restitution_exponent: only goes together with the key "restitution_speed")"});
    EXPECT_EQ(errors_of(scene_with(R"("restitution_speed": 2, "impact_table": [{"restitution": 0.5}])")),
              Lines{"materials.m.restitution_speed: found beside an impact_table, expected one of them"});
    EXPECT_EQ(
        errors_of(scene_with(R"("impact_table": [{"speed": 2, "restitution": 0.5}, {"speed": 1, "restitution": 0}])")),
        Lines{"materials.m.impact_table: the rows are no grid, expected the same angles at each speed, in ascending "
              "order, first by speed, then by angle"});
    const auto spheres = [](const std::string& keys) {
        return errors_of(R"({"ricochet": 1, "simulation": {"time_step": 0.5, "duration": 1}, "particle_contacts": {)" +
                         keys + "}}");
    };
    EXPECT_TRUE(spheres(R"("restitution_speed": 1, "materials": {"a": {"restitution_exponent": 0.2}})").empty());
    EXPECT_EQ(spheres(R"("materials": {"a": {"restitution_exponent": 0.2}})").size(), 1U);
    const Lines penalty =
        errors_of(scene_with(R"("friction": 0.2, "tangential_restitution": 0.3)", R"(, "response": "penalty")"));
    ASSERT_EQ(penalty.size(), 1U);
    EXPECT_NE(penalty[0].find("materials.m: "), std::string::npos);
    EXPECT_NE(penalty[0].find(R"(the response "penalty")"), std::string::npos);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
