#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "io/spring_scene.h"
#include "ricochet/io/scene.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::kSpringScene;
using test::SpringSceneFolder;

SceneDescription scene_of(const std::string& text = kSpringScene) {
    const SpringSceneFolder folder;
    return parse_scene(text, folder.path("s.json"));
}

std::string sample_with(std::string_view old_text, std::string_view new_text) {
    std::string scene = kSpringScene;
    const std::size_t at = scene.find(old_text);
    if (at == std::string::npos) throw std::logic_error("not in the sample: " + std::string(old_text));
    return scene.replace(at, old_text.size(), new_text);
}

// Returns the only error, beginning with its path.
std::string error_of(const std::string& text) {
    try {
        (void)scene_of(text);
    } catch (const SceneError& error) {
        EXPECT_EQ(error.messages().size(), 1U) << error.what();
        const std::string& line = error.messages().front();
        const std::size_t path = line.find("springs[");
        return path == std::string::npos ? line : line.substr(path);
    }
    return "no error";
}

// Two explicit particles, five of the rope, four each of the chain and the cloth, six of the sheet.
constexpr std::size_t kRope = 2;
constexpr std::size_t kChain = 7;
constexpr std::size_t kCloth = 11;
constexpr std::size_t kSheet = 15;

TEST(SpringScene, ParticlesOfBodiesFollowTheExplicitOnes) {
    const auto setup = scene_of().setup;
    ASSERT_EQ(setup.particles.size(), 21U);
    EXPECT_TRUE(setup.particles[0].pinned);
    EXPECT_FALSE(setup.particles[1].pinned);
    EXPECT_EQ(setup.particles[1].mass, 2.0);
    EXPECT_EQ(setup.particles[kRope].position, (Vec3{0, 0, 1}));
    EXPECT_EQ(setup.particles[kChain].position, (Vec3{0, 5, 1}));
    EXPECT_EQ(setup.particles[kSheet].position, (Vec3{9, 0, 0}));
    // The rope has 4 springs, the chain 3, the cloth 5 edges and one diagonal, the sheet 9. Two single ones follow at
    // the end.
    ASSERT_EQ(setup.springs.size(), 24U);
    EXPECT_EQ(setup.springs[0].first, kRope);
    EXPECT_EQ(setup.springs[4].first, kChain);
    EXPECT_EQ(setup.spring_faces.size(), 6U);
}

TEST(SpringScene, SingleSpringsMayJoinAnyParticles) {
    const auto setup = scene_of().setup;
    const Spring& first = setup.springs[22];
    EXPECT_EQ(first.first, 0U);
    EXPECT_EQ(first.second, 1U);
    EXPECT_EQ(first.rest_length, 2.0);  // the initial distance
    EXPECT_EQ(first.stiffness, 30.0);
    EXPECT_EQ(first.damping, 0.0);
    EXPECT_TRUE(std::isinf(first.breaking_stretch));
    const Spring& second = setup.springs[23];
    EXPECT_EQ(second.second, kRope);
    EXPECT_EQ(second.rest_length, 0.5);
    EXPECT_EQ(second.damping, 0.25);
    EXPECT_EQ(second.breaking_stretch, 2.0);
}

TEST(SpringScene, RopesHangWithTheForcesByDefault) {
    const auto setup = scene_of().setup;
    EXPECT_EQ(setup.springs[0].rest_length, 1.5);
    EXPECT_EQ(setup.springs[0].stiffness, 100.0);
    EXPECT_EQ(setup.springs[0].breaking_stretch, 0.5);
    EXPECT_EQ(setup.particles[kRope].mass, 1.0);
    EXPECT_EQ(setup.particles[kRope + 1].mass, 2.0);
    EXPECT_EQ(setup.particles[kRope + 1].radius, 0.1);
    EXPECT_LT(setup.particles[kRope + 2].position.y, -1.0);
    EXPECT_TRUE(setup.particles[kRope].pinned);
    EXPECT_TRUE(setup.particles[kRope + 4].pinned);
    const auto upward = scene_of(sample_with("\"length\": 6", "\"length\": 6, \"sag\": [0, 0, 2]")).setup;
    EXPECT_GT(upward.particles[kRope + 2].position.z, 2.0);
}

TEST(SpringScene, LinksDefineChains) {
    const auto setup = scene_of().setup;
    for (std::size_t i = 4; i < 7; ++i) {
        EXPECT_EQ(setup.springs[i].rest_length, 1.0);
        EXPECT_EQ(setup.springs[i].stiffness, 50.0);
    }
    EXPECT_TRUE(setup.particles[kChain].pinned);
    EXPECT_FALSE(setup.particles[kChain + 3].pinned);
}

TEST(SpringScene, ClothIsAtItsPlacementWithItsMassByArea) {
    const auto setup = scene_of().setup;
    double mass = 0.0;
    for (std::size_t i = 0; i < 4; ++i) mass += setup.particles[kCloth + i].mass;
    EXPECT_NEAR(mass, 6.0, 1e-14);
    EXPECT_EQ(setup.particles[kCloth + 2].position, (Vec3{2, 0, 11}));
    EXPECT_EQ(setup.particles[kCloth].radius, 0.01);
    EXPECT_EQ(setup.springs[7].stiffness, 70.0);
    EXPECT_EQ(setup.springs[7].rest_length, 2.0);
    EXPECT_EQ(setup.springs[12].stiffness, 7.0);
    // Vertices 0 and 3 are pinned by number, 1 by the box.
    EXPECT_TRUE(setup.particles[kCloth].pinned);
    EXPECT_TRUE(setup.particles[kCloth + 1].pinned);
    EXPECT_FALSE(setup.particles[kCloth + 2].pinned);
    EXPECT_TRUE(setup.particles[kCloth + 3].pinned);
}

TEST(SpringScene, SheetsNeedNoFile) {
    const auto setup = scene_of().setup;
    double mass = 0.0;
    for (std::size_t i = kSheet; i < 21; ++i) mass += setup.particles[i].mass;
    EXPECT_NEAR(mass, 6.0, 1e-14);
    EXPECT_EQ(setup.particles[20].position, (Vec3{11, 1, 0}));
}

TEST(SpringScene, SimulationBindsTheNetworkToItsParticles) {
    const Simulation simulation(std::move(scene_of().setup));
    EXPECT_EQ(simulation.springs().bonds().size(), 24U);
    EXPECT_EQ(simulation.springs().lost(), 0U);
    EXPECT_EQ(simulation.springs().coupled().size(), 21U);
    EXPECT_EQ(simulation.spring_faces().size(), 6U);
}

TEST(SpringScene, ErrorsHaveTheirPath) {
    EXPECT_EQ(error_of(sample_with("\"second\": 2", "\"second\": 99")),
              "springs[0].springs[1].second: there is no particle 99, the scene has 21 from the start (numbered from "
              "0)");
    EXPECT_EQ(error_of(sample_with("\"second\": 1", "\"second\": 0")),
              "springs[0].springs[0].second: both ends are particle 0, expected two particles");
    EXPECT_EQ(error_of(sample_with("\"rest_length\": 0.5", "\"rest_length\": 0")),
              "springs[0].springs[1].breaking_stretch: a spring without a rest length has no relative stretch, leave "
              "this key out");
    EXPECT_EQ(error_of(sample_with("\"stiffness\": 30", "\"stiffness\": -1")),
              "springs[0].springs[0].stiffness: found -1, expected a number >= 0 (N/m)");
    EXPECT_EQ(error_of(sample_with("\"nodes\": 5", "\"nodes\": 1")),
              "springs[1].nodes: found 1, expected a whole number >= 2 and <= 100000000");
    EXPECT_EQ(error_of(sample_with("\"to\": [4, 0, 1]", "\"to\": [0, 0, 1]")),
              "springs[1]: rope: both ends are at the same position, expected two positions");
    EXPECT_NE(error_of(sample_with("\"stiffness\": 100,", "\"stiffness\": 100, \"axial_stiffness\": 2,"))
                  .find("axial_stiffness"),
              std::string::npos);
    EXPECT_EQ(error_of(sample_with("\"pinned\": [0, 3]", "\"pinned\": [4]")),
              "springs[3].pinned: found vertex 4, expected a number below 4, the number of vertices");
    EXPECT_EQ(error_of(sample_with("\"lower\": [1.5, -1, 8]", "\"lower\": [2.5, -1, 8]")),
              "springs[3].pin_boxes[0]: no vertex of the cloth lies in this box, expected at least one");
    EXPECT_EQ(error_of(sample_with("\"side_u\": [2, 0, 0]", "\"side_u\": [0, 3, 0]")),
              "springs[4]: sheet: the sides are parallel or without length");
    EXPECT_NE(error_of(sample_with("flag.obj", "none.obj")).find("springs[3].file: "), std::string::npos);
    EXPECT_NE(error_of(sample_with("\"mass_per_area\": 3, ", "")).find("springs[4]"), std::string::npos);
}

TEST(SpringScene, ClothWithUnconnectedVerticesIsRefused) {
    const SpringSceneFolder folder;
    (void)folder.write("flag.obj", std::string(test::kFlag) + "v 7 7 7\n");
    try {
        (void)parse_scene(kSpringScene, folder.path("s.json"));
        ADD_FAILURE() << "was read";
    } catch (const SceneError& error) {
        EXPECT_NE(error.messages().front().find("no triangle with an area uses vertex 4"), std::string::npos);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
