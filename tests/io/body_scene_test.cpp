// Scenes with frames that are rigid bodies moved by particles.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/scene_errors.h"
#include "ricochet/io/scene.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::errors_of;
using test::Lines;

std::string scene_of(const std::string& body, const std::string& collider = "", const std::string& frame = "",
                     const std::string& more = "") {
    const std::string box = R"({"name": "blade", "type": "box", "size": [1, 2, 0.5], "position": [0.5, 0, 0], )"
                            R"("frame": "wheel"})";
    return R"({"ricochet": 1, "particles": [{"position": [0, 0, 9]}], "colliders": [)" +
           (collider.empty() ? box : collider) + R"(], "frames": {"wheel": {"translation": [1, 0, 0], )" + frame +
           R"("body": {)" + body + "}}}" + more + "}";
}

TEST(BodyScene, MassCentreAndInertiaComeFromTheColliders) {
    for (const char* mass : {R"("density": 3)", R"("mass": 3)"}) {
        const SceneDescription scene = parse_scene(scene_of(mass), "s.json");
        ASSERT_EQ(scene.setup.bodies.size(), 1U);
        const BodyDescription& body = scene.setup.bodies[0];
        EXPECT_EQ(body.frame, "wheel");
        EXPECT_NEAR(body.mass, 3.0, 1e-14);
        EXPECT_LT(length(body.center - Vec3{0.5, 0, 0}), 1e-15);
        EXPECT_NEAR(body.inertia.zz, 3.0 * 5.0 / 12.0, 1e-14);
        EXPECT_EQ(body.joint, JointKind::free);
        EXPECT_NO_THROW(Simulation(parse_scene(scene_of(mass), "s.json").setup));
    }
}

TEST(BodyScene, GivenNumbersTakePrecedence) {
    const SceneDescription scene = parse_scene(
        scene_of(R"("mass": 2, "center": [0, 0, 1], "inertia": [3, 4, 5], "inertia_products": [0.1, 0.2, 0.3],
                    "joint": "hinge", "axis": [0, 2, 0], "rate": 1.5, "spring": 7, "spring_rest": 0.5, "damping": 0.2,
                    "drive": -1, "friction": 0.3, "motor_rate": 4, "motor_most": 9, "feels_forces": false)",
                 R"({"type": "plane", "normal": [0, 0, 1], "frame": "wheel"})"),
        "s.json");
    const BodyDescription& body = scene.setup.bodies[0];
    EXPECT_EQ(body.inertia, (SymmetricMatrix{3, 4, 5, 0.1, 0.2, 0.3}));
    EXPECT_EQ(body.center, Vec3(0, 0, 1));
    EXPECT_EQ(body.joint, JointKind::hinge);
    EXPECT_EQ(body.rate, 1.5);
    EXPECT_EQ(body.settings.spring, 7.0);
    EXPECT_EQ(body.settings.spring_rest, 0.5);
    EXPECT_EQ(body.settings.damping, 0.2);
    EXPECT_EQ(body.settings.drive, -1.0);
    EXPECT_EQ(body.settings.friction, 0.3);
    EXPECT_EQ(body.settings.motor_rate, 4.0);
    EXPECT_EQ(body.settings.motor_most, 9.0);
    EXPECT_FALSE(body.feels_forces);
}

TEST(BodyScene, InvalidBodiesAreRefused) {
    EXPECT_EQ(errors_of(scene_of(R"("joint": "free")")),
              (Lines{"frames.wheel.body: found neither \"mass\" nor \"density\", expected one of them"}));
    EXPECT_EQ(errors_of(scene_of(R"("mass": 1, "density": 1)")),
              (Lines{"frames.wheel.body: found both \"mass\" and \"density\", expected one of them"}));
    EXPECT_EQ(
        errors_of(scene_of(R"("mass": 1)", R"({"name": "p", "type": "plane", "normal": [0, 0, 1], "frame": "wheel"})")),
        (Lines{"frames.wheel.body: the collider \"p\" has no volume, expected closed colliders, or \"mass\", "
               "\"center\" and \"inertia\""}));
    EXPECT_EQ(errors_of(scene_of(R"("mass": 1, "rate": 2)")),
              (Lines{"frames.wheel.body.rate: a free body has no joint, expected a \"joint\" hinge or slider"}));
    EXPECT_EQ(errors_of(scene_of(R"("mass": 1, "joint": "hinge", "velocity": [1, 0, 0])")),
              (Lines{"frames.wheel.body.velocity: a body on a joint starts with its \"rate\""}));
    EXPECT_EQ(
        errors_of(scene_of(R"("mass": 1)", "", R"("motions": [{"type": "spin", "axis": [0, 0, 1], "rate": 1}], )")),
        (Lines{"frames.wheel.motions: forces and impulses move a body in the world; expected no such key"}));
    EXPECT_EQ(
        errors_of(scene_of(R"("mass": 1, "center": [0, 0, 0], "inertia": [1, 1, 1], "inertia_products": [2, 0, 0])")),
        (Lines{"frames.wheel.body: body 'wheel': the inertia is impossible for a body with a volume (moments above "
               "0, none above the sum of the others, consistent products)"}));
}

TEST(BodyScene, MotorWithoutForceIsRefusedAndOnlyTheWrongValueIsNamed) {
    EXPECT_EQ(errors_of(scene_of(R"("mass": 1, "joint": "hinge", "motor_rate": 2)")),
              (Lines{"frames.wheel.body.motor_rate: only goes together with the key \"motor_most\""}));
    EXPECT_EQ(errors_of(scene_of(R"("mass": 1, "inertia_products": [0, 0, 0])")),
              (Lines{"frames.wheel.body.inertia_products: only goes together with the key \"inertia\""}));
    EXPECT_EQ(errors_of(scene_of(R"("mass": 0)")),
              (Lines{"frames.wheel.body.mass: found 0, expected a number > 0 (kg)"}));
}

// A volume inside two colliders would count twice.
TEST(BodyScene, OverlappingCollidersGiveAWarningIfTheirVolumeCounts) {
    const auto boxes = [](double apart, const char* more) {
        const std::string box = R"({"type": "box", "size": [1, 1, 1], "frame": "wheel", "name": )";
        return parse_scene(
                   scene_of(R"("density": 1)" + std::string(more),
                            box + R"("a"}, )" + box + R"("b", "position": [)" + std::to_string(apart) + R"(, 0, 0]})"),
                   "s.json")
            .warnings;
    };
    EXPECT_EQ(boxes(1.0, ""), Lines{});
    EXPECT_EQ(boxes(0.2, R"(, "center": [0, 0, 0])").size(), 1U);
    const Lines overlapping = boxes(0.2, "");
    ASSERT_EQ(overlapping.size(), 1U);
    EXPECT_NE(overlapping[0].find("frames.wheel.body: the colliders \"a\" and \"b\" overlap"), std::string::npos)
        << overlapping[0];
    // With given numbers the volume is not used.
    const std::string given = R"("mass": 1, "center": [0, 0, 0], "inertia": [1, 1, 1])";
    const std::string ball = R"({"type": "sphere", "radius": 1, "frame": "wheel", "name": )";
    EXPECT_EQ(parse_scene(scene_of(given, ball + R"("a"}, )" + ball + R"("b"})"), "s.json").warnings, Lines{});
}

/// Returns two cubes in one mesh, the second moved along x.
std::string two_cubes(double apart) {
    const std::string faces =
        "f -8 -6 -5 -7\nf -4 -3 -1 -2\nf -8 -7 -3 -4\nf -6 -2 -1 -5\nf -8 -4 -2 -6\nf -7 -5 -1 -3\n";
    std::string text;
    for (const double x : {0.0, apart}) {
        for (int corner = 0; corner < 8; ++corner) {
            text += "v " + std::to_string(x + corner % 2) + " " + std::to_string(corner / 2 % 2) + " " +
                    std::to_string(corner / 4) + "\n";
        }
        text += faces;
    }
    return text;
}

TEST(BodyScene, MeshesThatAreClosedByPositionsHaveAMass) {
    const test::TemporaryFolder folder;
    const auto errors = [&](const std::string& obj) -> Lines {
        static_cast<void>(folder.write("part.obj", obj));
        const std::string mesh = R"({"name": "part", "type": "mesh", "file": "part.obj", "frame": "wheel"})";
        try {
            static_cast<void>(read_scene(folder.write("s.json", scene_of(R"("density": 10)", mesh))));
        } catch (const InputError& error) {
            return {error.what()};
        }
        return {};
    };
    const std::string touching = two_cubes(1.0);  // a wall that both list
    EXPECT_EQ(errors(touching), Lines{});
    const std::string fin = "v 0.5 0.5 1\nv 0.7 0.5 1\nv 0.6 0.5 2\nf -3 -2 -1\nf -3 -1 -2\n";  // listed on both sides
    EXPECT_EQ(errors(two_cubes(2.0) + fin), Lines{});
    const Lines open = errors("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    ASSERT_EQ(open.size(), 1U);
    EXPECT_NE(open[0].find("the collider \"part\" has no volume because its mesh is open"), std::string::npos)
        << open[0];
}

TEST(BodyScene, SelfIntersectingMeshGivesAWarningIfItsVolumeCounts) {
    const test::TemporaryFolder folder;
    const auto warnings = [&](double apart) {
        static_cast<void>(folder.write("cubes.obj", two_cubes(apart)));
        const std::string mesh = R"({"name": "cubes", "type": "mesh", "file": "cubes.obj", "frame": "wheel"})";
        return read_scene(folder.write("s.json", scene_of(R"("density": 1)", mesh))).warnings;
    };
    EXPECT_EQ(warnings(2.0), Lines{});
    const Lines crossing = warnings(0.5);
    ASSERT_EQ(crossing.size(), 1U);
    EXPECT_NE(
        crossing[0].find(
            "frames.wheel.body: the mesh \"cubes\" crosses itself, or nests shells that are wound alike: about 3"),
        std::string::npos)
        << crossing[0];
}

TEST(BodyScene, BodyIsAllowedWithAnEmptyListOfSprings) {
    EXPECT_EQ(errors_of(scene_of(R"("mass": 1)", "", "", R"(, "springs": [], "particle_forces": [])")), Lines{});
    EXPECT_EQ(errors_of(scene_of(R"("mass": 1)", "", "",
                                 R"(, "springs": [{"type": "rope", "from": [0, 0, 9], "to": [1, 0, 9], "nodes": 3,
                                     "mass": 1, "stiffness": 1}])")),
              (Lines{"frames.wheel.body: bodies that impulses move and springs do not go together yet, expected a "
                     "scene without the one or the other"}));
}

TEST(BodyScene, IncompatibleFeaturesAreRefused) {
    EXPECT_EQ(errors_of(scene_of(R"("mass": 1)", "", "",
                                 R"(, "emitters": [{"type": "point", "frame": "wheel", "rate": 5}])")),
              (Lines{"emitters[0].frame: impulses of particles move this body, and where it will be within a step is "
                     "not known at the births; expected an emitter in the world or in a frame that moves by itself"}));
    EXPECT_EQ(
        errors_of(scene_of(R"("mass": 1)",
                           R"({"name": "b", "type": "box", "size": [1, 1, 1], "frame": "wheel", "material": "felt"})",
                           "", R"(, "materials": {"felt": {"absorption": 0.5}})")),
        (Lines{"frames.wheel.body: the material \"felt\" of the collider \"b\" absorbs, reflects diffusely, or "
               "has a tangential factor, expected none that does on a body that impulses move"}));
    EXPECT_EQ(
        errors_of(scene_of(R"("mass": 1)",
                           R"({"name": "b", "type": "box", "size": [1, 1, 1], "frame": "wheel", "material": "rock"})",
                           "", R"(, "materials": {"rock": {"tangential_factor": 0.5}})"))
            .size(),
        1U);
    EXPECT_EQ(errors_of(scene_of(R"("mass": 1)", "", "", R"(, "simulation": {"response": "penalty"})")),
              (Lines{"colliders[0].frame: the response \"penalty\" knows no colliders that move, expected none, or "
                     "\"exact\""}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
