// Contacts between spheres and their materials in scenes: the effect of each key, and one-line errors.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "io/scene_errors.h"
#include "ricochet/io/scene.h"
#include "ricochet/simulation.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::errors_of;
using test::Lines;

std::string scene_with(const std::string& contacts, const std::string& ball = "", const std::string& more = "") {
    return R"({"ricochet": 1, "particle_contacts": {)" + contacts + "}, " + more +
           R"("particles": [{"position": [0, 0, 1], "radius": 0.01)" + ball + "}]}";
}

const char* const kMaterials = R"("restitution": 0.6, "friction": 0.2,
    "materials": {"steel": {"restitution": 0.9}, "glass": {}},
    "pairs": [{"first": "glass", "second": "steel", "friction": 0.4, "rolling_friction": 0.01}])";

TEST(PairContactsScene, PairInheritsMissingKeysFromAllSpheres) {
    const SimulationSetup setup = parse_scene(scene_with(kMaterials, R"(, "material": "glass")"), "s.json").setup;
    const PairContactSettings& contacts = setup.options.particle_contacts.value();
    EXPECT_EQ(contacts.materials, (std::vector<std::string>{"steel", "glass"}));
    ASSERT_EQ(contacts.pairs.size(), 3U);
    EXPECT_EQ(contacts.pairs[0].first + contacts.pairs[0].second, "steelsteel");
    EXPECT_EQ(contacts.pairs[0].material.restitution, 0.9);
    EXPECT_EQ(contacts.pairs[0].material.friction, 0.2);
    EXPECT_EQ(contacts.pairs[1].material.restitution, 0.6);
    EXPECT_EQ(contacts.pairs[2].first + contacts.pairs[2].second, "glasssteel");
    EXPECT_EQ(contacts.pairs[2].material.restitution, 0.6);
    EXPECT_EQ(contacts.pairs[2].material.friction, 0.4);
    EXPECT_EQ(contacts.pairs[2].material.rolling_friction, 0.01);
    ASSERT_EQ(setup.attributes.size(), 1U);
    EXPECT_EQ(setup.attributes[0].name, kMaterialAttribute);
    EXPECT_EQ(setup.particles[0].attributes[0].x, 1.0);
}

TEST(PairContactsScene, EmittersNameTheMaterialOfTheirParticles) {
    SimulationSetup setup = parse_scene(scene_with(kMaterials, "",
                                                   R"("emitters": [{"type": "point", "rate": 1, "particle_radius": 0.01,
                                                "material": "glass"}],)"),
                                        "s.json")
                                .setup;
    ASSERT_EQ(setup.emitters[0].attributes.size(), 1U);
    EXPECT_EQ(setup.emitters[0].attributes[0].name, kMaterialAttribute);
    EXPECT_EQ(setup.emitters[0].attributes[0].mean.x, 1.0);
    EXPECT_NO_THROW(Simulation{std::move(setup)});
}

TEST(PairContactsScene, UnknownMaterialsAreRefusedAtTheirLocation) {
    EXPECT_EQ(errors_of(scene_with(kMaterials, R"(, "material": "stel")")),
              (Lines{"particles[0].material: there is no material among particle_contacts.materials \"stel\"; did you "
                     "mean \"steel\"?"}));
    EXPECT_EQ(errors_of(scene_with("", R"(, "material": "steel")")),
              (Lines{"particles[0].material: only goes together with particle_contacts.materials, which declares the "
                     "names; materials of walls are set at the walls"}));
    EXPECT_EQ(errors_of(scene_with(R"("materials": {"a": {}}, "pairs": [{"first": "a", "second": "b"}])")),
              (Lines{"particle_contacts.pairs[0].second: there is no material among particle_contacts.materials \"b\"; "
                     "did you mean \"a\"?"}));
    EXPECT_EQ(
        errors_of(scene_with(R"("materials": {"a": {"friction": 1}}, "pairs": [{"first": "a", "second": "a"}])")),
        (Lines{"particle_contacts.pairs[0].second: found \"a\" twice, expected two materials: contacts within one "
               "material are set in `materials`"}));
    EXPECT_EQ(
        errors_of(scene_with(kMaterials, R"(, "material": "steel", "attributes": {"material": 1})")),
        (Lines{"particles[0].material: found beside the attribute \"material\", which is its number: expected one "
               "of them"}));
    EXPECT_EQ(errors_of(scene_with(kMaterials, "", R"("attributes": {"material": {}},)")),
              (Lines{"attributes: declares \"material\", which is the number of one of particle_contacts' materials "
                     "here, expected another name"}));
}

TEST(PairContactsScene, PairWithoutNamesIsRefusedForThatAlone) {
    const auto refused = [](const std::string& pair) {
        return errors_of(scene_with(R"("materials": {"steel": {}, "glass": {}}, "pairs": [)" + pair + "]"));
    };
    const std::string first = "particle_contacts.pairs[0].first: ";
    const std::string second = "particle_contacts.pairs[0].second: ";
    const std::string missing = "missing, expected a text that is not empty";
    EXPECT_EQ(refused("{}"), (Lines{first + missing, second + missing}));
    EXPECT_EQ(refused(R"({"first": "steel"})"), (Lines{second + missing}));
    EXPECT_EQ(refused("1"),
              (Lines{"particle_contacts.pairs[0]: found 1, expected an object {...} (pair of materials)"}));
    EXPECT_EQ(refused(R"({"first": 1, "second": 2})"), (Lines{first + "found 1, expected a text that is not empty",
                                                              second + "found 2, expected a text that is not empty"}));
}

// Forty materials that are not sorted by name, and all their pairs in another order.
TEST(PairContactsScene, EachOfManyPairsKeepsItsPositionAndCountsOnce) {
    constexpr std::size_t kMany = 40;
    std::vector<std::string> names;
    std::string materials;
    for (std::size_t k = 0; k < kMany; ++k) {
        names.push_back("m" + std::to_string(7 * k % kMany));
        materials += (k == 0 ? "\"" : ", \"") + names[k] + "\": {}";
    }
    std::vector<std::pair<std::size_t, std::size_t>> order;
    std::string pairs;
    for (std::size_t a = 0; a < kMany; ++a) {
        for (std::size_t b = kMany; b-- > a + 1;) {
            order.push_back((a + b) % 2 == 0 ? std::pair(a, b) : std::pair(b, a));
            const std::string number = std::to_string(order.size());
            pairs += (pairs.empty() ? "" : ", ") + (R"({"first": ")" + names[order.back().first]) +
                     R"(", "second": ")" + names[order.back().second] + R"(", "friction": )" + number + "}";
        }
    }
    const std::string all = R"("materials": {)" + materials + R"(}, "pairs": [)" + pairs;
    const SimulationSetup setup = parse_scene(scene_with(all + "]", R"(, "material": "m0")"), "s.json").setup;
    const PairContactSettings& contacts = setup.options.particle_contacts.value();
    ASSERT_EQ(contacts.pairs.size(), kMany + order.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        const MaterialPair& pair = contacts.pairs[kMany + k];
        EXPECT_EQ(pair.first, names[order[k].first]);
        EXPECT_EQ(pair.second, names[order[k].second]);
        EXPECT_EQ(pair.material.friction, static_cast<double>(k + 1));
    }
    EXPECT_EQ(
        errors_of(scene_with(all + R"(, {"first": "m11", "second": "m3"}, {"first": "m3", "second": "m11"}])")),
        (Lines{"particle_contacts.pairs[780].second: \"m11\" and \"m3\" are there already, expected each pair once",
               "particle_contacts.pairs[781].second: \"m3\" and \"m11\" are there already, expected each pair "
               "once"}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
