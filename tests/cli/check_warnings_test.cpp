// Tests of the warnings of `ricochet check` for valid scenes. Each warning must appear if it applies, and only then.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "cli/run_program.h"
#include "io/sample_scene.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::run_ricochet;
using test::SampleFolder;

std::string obj_of(const TriangleMesh& mesh) {
    std::ostringstream out;
    out.precision(17);
    for (const Vec3& v : mesh.vertices) out << "v " << v.x << ' ' << v.y << ' ' << v.z << '\n';
    for (const Triangle& t : mesh.triangles) out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
    return out.str();
}

/// Returns an open cone about z, from a ring of the upper radius at z = 1 to a ring of the lower radius at z = 0.
TriangleMesh funnel_mesh(double upper, double lower) {
    constexpr std::uint32_t kSides = 24;
    TriangleMesh mesh;
    for (std::uint32_t k = 0; k < kSides; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / kSides;
        mesh.vertices.push_back({upper * std::cos(angle), upper * std::sin(angle), 1});
        mesh.vertices.push_back({lower * std::cos(angle), lower * std::sin(angle), 0});
        const std::uint32_t next = (k + 1) % kSides;
        mesh.triangles.push_back({2 * k, 2 * k + 1, 2 * next});
        mesh.triangles.push_back({2 * next, 2 * k + 1, 2 * next + 1});
    }
    return mesh;
}

/// Scene with meshes in its folder: `hull.obj`, a sphere of radius 1; `leaky.obj`, the same with a small hole; and
/// `funnel.obj`, 2 m wide at the top and 0.2 m at the bottom.
class CheckWarnings : public ::testing::Test {
protected:
    CheckWarnings() {
        TriangleMesh hull = testing::sphere_mesh({}, 1.0, 3);
        (void)folder_.write("hull.obj", obj_of(hull));
        hull.triangles.pop_back();
        (void)folder_.write("leaky.obj", obj_of(hull));
        (void)folder_.write("line.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nv 3 3 3\nf 1 2 3\nf 2 4 3\n");
        (void)folder_.write("funnel.obj", obj_of(funnel_mesh(1.0, 0.1)));
    }

    /// Returns the output of a quiet run of ten steps on standard error.
    std::string warnings_of_run(const std::string& parts) {
        const std::string simulation = R"("simulation": {"time_step": 0.01, "duration": 0.1},)";
        const std::string scene = folder_.write("r.json", R"({"ricochet": 1, )" + simulation + parts + "}").string();
        const std::string out = folder_.path("out").string();
        const test::ProgramResult result = run_ricochet({"run", scene, "--output", out, "--quiet"});
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        return result.errors;
    }

    /// Returns the output of check on standard error for a scene of these parts. The exit code must be 0.
    std::string warnings(const std::string& parts) {
        const std::string scene =
            folder_
                .write("s.json", R"({"ricochet": 1, "simulation": {"time_step": 0.01, "duration": 0.1},)" + parts + "}")
                .string();
        const test::ProgramResult result = run_ricochet({"check", scene});
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        EXPECT_NE(result.output.find(": ok: "), std::string::npos);
        std::string text = result.errors;
        const std::string prefix = "ricochet: warning: " + scene + ": ";
        for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) {
            text.erase(at, prefix.size());
        }
        return text;
    }

    static std::string collider(const std::string& keys) {
        return R"("materials": {"m": {"restitution": 0.5}}, "colliders": [{"name": "c", "material": "m", )" + keys +
               "}]";
    }
    static std::string mesh(const std::string& file) { return collider(R"("type": "mesh", "file": ")" + file + "\""); }
    static std::string emitter(const std::string& keys) {
        return R"(, "emitters": [{"name": "e", "burst": 10, )" + keys + "}]";
    }
    static std::string plane() { return collider(R"("type": "plane", "point": [0, 0, -0.5], "normal": [0, 0, 1])"); }
    static std::string gravity() { return R"(, "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}])"; }

    SampleFolder& folder() { return folder_; }

private:
    SampleFolder folder_;
};

TEST_F(CheckWarnings, WarnsOfALeakOnlyForParticlesThatStartInside) {
    const std::string inside = emitter(R"("type": "sphere", "center": [0, 0, 0], "radius": 0.5)");
    const std::string outside = emitter(R"("type": "sphere", "center": [0, 0, 3], "radius": 0.5)");
    const std::string text = warnings(mesh("leaky.obj") + inside);
    EXPECT_EQ(
        text.rfind("emitters[0] 'e': 64 of 64 begin inside colliders[0] 'c', which is open: 1 hole, the largest ", 0),
        0U)
        << text;
    EXPECT_NE(text.find("close the mesh"), std::string::npos);
    EXPECT_EQ(warnings(mesh("leaky.obj") + outside), "");
    EXPECT_EQ(warnings(mesh("hull.obj") + inside), "");
    EXPECT_EQ(warnings(mesh("funnel.obj") + inside), "");
}

TEST_F(CheckWarnings, WarnsOfOverlappingShellsInOneMesh) {
    const TriangleMesh cube = testing::box_mesh({0, 0, 0}, {1, 1, 1});
    const auto write = [&](const char* name, const TriangleMesh& other) {
        (void)folder().write(name, obj_of(testing::merged(cube, other)));
    };
    write("overlap.obj", testing::box_mesh({0.5, 0.25, 0.125}, {1.5, 1.25, 1.125}));
    write("touch.obj", testing::box_mesh({1, 0.25, 0.25}, {2, 0.75, 0.75}));
    write("nest.obj", testing::box_mesh({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}));
    const std::string one = R"(, "particles": [{"position": [0, 0, 3]}])";
    EXPECT_EQ(warnings(mesh("overlap.obj") + one).rfind("colliders[0] 'c': shells of its mesh overlap", 0), 0U);
    EXPECT_EQ(warnings(mesh("touch.obj") + one), "");
    EXPECT_EQ(warnings(mesh("nest.obj") + one), "");
    write("flush.obj", testing::box_mesh({0, 0.25, 0.25}, {0.75, 0.75, 0.75}));
    EXPECT_EQ(warnings(mesh("flush.obj") + one), "");
    const auto volume = [](const std::string& file) {
        return R"("emitters": [{"name": "e", "burst": 10, "type": "mesh", "volume": true, "file": ")" + file + "\"}]";
    };
    EXPECT_EQ(warnings(volume("overlap.obj")).rfind("emitters[0] 'e': shells of its mesh overlap", 0), 0U);
    EXPECT_EQ(warnings(volume("touch.obj")), "");
}

TEST_F(CheckWarnings, WarnsOfStartsOnBothSidesOfAClosedCollider) {
    const std::string across = emitter(R"("type": "box", "center": [1, 0, 0], "size": [1, 1, 1])");
    const std::string within = emitter(R"("type": "box", "center": [0, 0, 0], "size": [1, 1, 1])");
    for (const std::string& solid : {mesh("hull.obj"), collider(R"("type": "sphere", "radius": 1)"),
                                     collider(R"("type": "box", "size": [2, 2, 2])")}) {
        const std::string text = warnings(solid + across);
        EXPECT_NE(text.find("begin inside colliders[0] 'c', which is closed, the others outside"), std::string::npos)
            << text;
        EXPECT_EQ(warnings(solid + within), "");
    }
    EXPECT_EQ(warnings(collider(R"("type": "plane", "point": [1, 0, 0], "normal": [1, 0, 0])") + across), "");
    const std::string both = R"(, "particles": [{"position": [0, 0, 0]}, {"position": [0, 0, 3]}])";
    EXPECT_EQ(warnings(mesh("hull.obj") + both).rfind("particles: 1 of 2 begin inside", 0), 0U);
    EXPECT_EQ(warnings(mesh("hull.obj") + R"(, "particles": [{"position": [0, 0, 3]}])"), "");
}

// Tests colliders at the time at which particles are born. The collider is 3 m off the origin at first.
TEST_F(CheckWarnings, TestsMovingCollidersAtTheStartTimeOfParticles) {
    const std::string away = R"(, "motion": [{"time": 0, "position": [3, 0, 0], "rotation": {"axis": [0, 1, 0],
        "degrees": 180}}, {"time": 0.05, "position": [0, 0, 0]}])";
    const std::string both = R"(, "particles": [{"position": [0, 0, 0]}, {"position": [3, 0, 0]}])";
    const std::string inside = R"(, "particles": [{"position": [3, 0, 0]}])";
    for (const std::string solid : {R"("type": "mesh", "file": "hull.obj")", R"("type": "sphere", "radius": 1)"}) {
        const std::string text = warnings(collider(solid + away) + both);
        EXPECT_EQ(text.rfind("particles: 1 of 2 begin inside colliders[0] 'c', which is closed", 0), 0U) << text;
        EXPECT_EQ(warnings(collider(solid + away) + inside), "");
    }
    const std::string leaky = collider(R"("type": "mesh", "file": "leaky.obj")" + away);
    EXPECT_EQ(warnings(leaky + inside).rfind("particles: 1 of 1 begin inside colliders[0] 'c', which is open", 0), 0U);
    EXPECT_EQ(warnings(leaky + R"(, "particles": [{"position": [0, 0, 0]}])"), "");
    // The particles are born when the collider has arrived.
    const std::string late = emitter(R"("type": "point", "center": [0, 0, 0], "start": 0.05)");
    EXPECT_EQ(warnings(leaky + late).rfind("emitters[0] 'e': 64 of 64 begin inside", 0), 0U);
    // A funnel upside down, with particles rising from below, is entered like an upright one.
    const std::string wide = R"(, "particles": [{"position": [3, 0, 4], "radius": 0.2}])";
    const std::string funnel = collider(R"("type": "mesh", "file": "funnel.obj")" + away);
    EXPECT_NE(warnings(funnel + gravity() + wide).find("do not fit through the narrowest opening"), std::string::npos);
    // No position between the two bodies is free.
    const std::string large = emitter(R"("type": "point", "center": [3, 0, 0.5], "particle_radius": 0.7)");
    EXPECT_NE(warnings(collider(R"("type": "sphere", "radius": 1)" + away) + large).find("256 of 256 positions"),
              std::string::npos);
}

TEST_F(CheckWarnings, WarnsOfOverlapsWithTheirNumberFirstAndDepth) {
    const auto particles = [](double z) {
        return R"(, "particles": [{"position": [0, 0, 5], "radius": 0.5}, {"position": [3, 0, )" + std::to_string(z) +
               R"(], "radius": 0.5}])";
    };
    const std::string floor = collider(R"("type": "plane", "normal": [0, 0, 1])");
    EXPECT_EQ(warnings(floor + particles(0.25)),
              "1 sphere is born in overlap with a surface: the first is particle 1, 0.25 m deep in 'c'; the deepest is "
              "0.25 m; "
              "they can leave and slide, but nothing pushes them out: place them a radius away\n");
    EXPECT_EQ(warnings(floor + particles(0.5)), "");
}

TEST_F(CheckWarnings, WarnsOfSpheresThatOverlapIfTheyCollide) {
    const std::string contacts = R"("particle_contacts": {"restitution": 0.5},)";
    const auto particles = [](const std::string& x) {
        return R"("particles": [{"position": [9, 0, 5], "radius": 0.5}, {"position": [0, 0, 5], "radius": 0.5}, )"
               R"({"position": [)" +
               x + R"(, 0, 5], "radius": 0.25}])";
    };
    EXPECT_EQ(warnings(contacts + particles("0.5")),
              "2 spheres are born in overlap with others: the first is particle 1, 0.25 m deep in particle 2; the "
              "deepest is 0.25 m; they get no deeper, but nothing parts them at once: place them the sum of their "
              "radii apart\n");
    EXPECT_EQ(warnings(contacts + particles("0.75")), "");
    EXPECT_EQ(warnings(particles("0.5")), "");
}

TEST_F(CheckWarnings, WarnsOfAnEmitterWithoutFreePositions) {
    const std::string floor = collider(R"("type": "plane", "normal": [0, 0, 1])");
    const auto point = [](const std::string& z) {
        return emitter(R"("type": "point", "particle_radius": 0.5, "center": [0, 0, )" + z + "]");
    };
    EXPECT_EQ(
        warnings(floor + point("0.2")),
        "emitters[0] 'e': 256 of 256 positions that were tried overlap a surface: births there are refused; make the "
        "spheres smaller or move the emitter off\n");
    EXPECT_EQ(warnings(floor + point("0.5")), "");
    EXPECT_EQ(
        warnings(floor + emitter(R"("type": "box", "center": [0, 0, 1], "size": [1, 1, 2], "particle_radius": 0.5)")),
        "");
}

TEST_F(CheckWarnings, WarnsOfSpheresThatDoNotFitThroughAnOutlet) {
    const auto pour = [](const std::string& x, const std::string& radius) {
        return gravity() + emitter(R"("type": "sphere", "radius": 0.2, "center": [)" + x +
                                   R"(, 0, 3], "particle_radius": )" + radius);
    };
    const std::string text = warnings(mesh("funnel.obj") + pour("0", "[0.09, 0.02]"));
    EXPECT_EQ(text.rfind("emitters[0] 'e': spheres of up to 0.22 m across do not fit through the narrowest opening of "
                         "colliders[0] 'c', 0.198 m wide",
                         0),
              0U)
        << text;
    EXPECT_EQ(warnings(mesh("funnel.obj") + pour("0", "0.09")), "");
    EXPECT_EQ(warnings(mesh("funnel.obj") + pour("5", "0.11")), "");  // falls beside the funnel
    EXPECT_EQ(warnings(mesh("leaky.obj") + pour("0", "0.11")), "");   // a hole is not an outlet
}

TEST_F(CheckWarnings, WarnsOfRadiiThatCoordinatesHardlyResolve) {
    const std::string floor = collider(R"("type": "plane", "normal": [0, 0, 1])");
    const auto far = [](const std::string& x) {
        return emitter(R"("type": "point", "particle_radius": 0.001, "center": [)" + x + R"(, 0, 3])");
    };
    const std::string text = warnings(floor + far("1e11"));
    EXPECT_EQ(text.rfind("emitters[0] 'e': a radius of 0.001 m at coordinates of 1e+11 m is less than 1000 units", 0),
              0U)
        << text;
    EXPECT_EQ(warnings(floor + far("1e6")), "");
}

TEST_F(CheckWarnings, WarnsOfMeshesThatCoordinatesHardlyResolve) {
    const auto far = [](const std::string& x) {
        return collider(R"("type": "mesh", "file": "hull.obj", "scale": 1e-6, "position": [)" + x + ", 0, 0]") +
               emitter(R"("type": "point", "center": [)" + x + ", 0, 1e-5]");
    };
    const std::string text = warnings(far("24000"));
    EXPECT_EQ(
        text.rfind("colliders[0] 'c': edges of 2.4e-07 m on average at coordinates of 2.4e+04 m, where 4e-12 m lie "
                   "between one number and the next",
                   0),
        0U)
        << text;
    EXPECT_EQ(warnings(far("100")), "");
}

TEST_F(CheckWarnings, WarnsOfMeshesWithoutArea) {
    const std::string points = emitter(R"("type": "point", "center": [0, 0, 3])");
    EXPECT_EQ(warnings(mesh("line.obj") + points),
              "colliders[0] 'c': none of its triangles (2) has an area, so that nothing hits it: look at the file\n");
    EXPECT_EQ(warnings(mesh("hull.obj") + points), "");
}

// A particle at rest falls 0.49 mm in 0.01 s.
TEST_F(CheckWarnings, WarnsOfStepsInWhichParticlesFallThroughTheWholeScene) {
    const auto drop = [](const std::string& height) {
        return collider(R"("type": "plane", "normal": [0, 0, 1])") +
               emitter(R"("type": "point", "center": [0, 0, )" + height + "]");
    };
    const std::string text = warnings(drop("0.00048") + gravity());
    EXPECT_EQ(text.rfind("simulation.time_step: in one step of 0.01 s, a free fall from rest covers 0.000491 m", 0), 0U)
        << text;
    EXPECT_EQ(warnings(drop("0.0005") + gravity()), "");
    EXPECT_EQ(warnings(drop("0.00048")), "");
}

TEST_F(CheckWarnings, WarnsOfAMissingColliderIfImpactsAreRequested) {
    const std::string sparks = R"("emitters": [{"name": "e", "type": "point", "burst": 10},
        {"name": "sparks", "type": "child", "parent": "e", "on": "impact", "count": 3}])";
    EXPECT_EQ(warnings(sparks),
              "emitters[1] 'sparks': its particles are born at impacts, and there is nothing to hit: add colliders, or "
              "leave it out\n");
    EXPECT_EQ(warnings(collider(R"("type": "plane", "normal": [0, 0, 1])") + ", " + sparks), "");
    const std::string plain = R"("emitters": [{"name": "e", "type": "point", "burst": 10}])";
    EXPECT_EQ(warnings(plain), "");
    EXPECT_NE(warnings(plain + R"(, "output": {"contacts": true})").find("output.contacts: "), std::string::npos);
}

TEST_F(CheckWarnings, WarnsOfStepsBeyondAStabilityBound) {
    const auto stiff = [](const std::string& stiffness) {
        return R"("particles": [{"position": [0, 0, 1]}, {"position": [0, 0, 2]}], "springs": [{"type": "list", "springs": [
            {"first": 0, "second": 1, "stiffness": )" +
               stiffness + "}]}]";
    };
    EXPECT_NE(warnings(stiff("1e7")).find("up to which"), std::string::npos) << warnings(stiff("1e7"));
    EXPECT_EQ(warnings(stiff("10")), "");
}

TEST_F(CheckWarnings, NamesMethodsThatDoNotSupportTheSpheresOfAScene) {
    const auto of_pairs = [&](const std::string& contacts, bool falls) {
        const std::string gravity = R"("forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],)";
        return warnings((falls ? gravity : "") + R"("particle_contacts": {)" + contacts + R"(},
            "particles": [{"position": [0, 0, 1], "radius": 0.1}, {"position": [1, 0, 1], "radius": 0.1}])");
    };
    const auto names = [&](const std::string& contacts, bool falls) {
        return of_pairs(contacts, falls).find("particle_contacts.method") != std::string::npos;
    };
    EXPECT_TRUE(names(R"("method": "events", "restitution": 0.5)", true));
    EXPECT_FALSE(names(R"("method": "events", "restitution": 0.5)", false));
    EXPECT_FALSE(names(R"("method": "events")", true));
    EXPECT_FALSE(names(R"("restitution": 0.5)", true));
    EXPECT_TRUE(names(R"("method": "contacts", "restitution": 0.95)", false));
    EXPECT_FALSE(names(R"("method": "contacts")", false));
    EXPECT_FALSE(names(R"("method": "contacts", "restitution": 0.5)", true));
}

TEST_F(CheckWarnings, ARunNamesUnsupportedMethodsToo) {
    const auto told = [&](const std::string& method) {
        const std::string gravity = R"("forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],)";
        const std::string contacts = R"("particle_contacts": {"restitution": 0.5, "method": ")" + method + R"("},)";
        return warnings_of_run(gravity + contacts + R"("particles": [{"position": [0, 0, 1], "radius": 0.1}])");
    };
    EXPECT_NE(told("events").find("particle_contacts.method"), std::string::npos);
    EXPECT_EQ(told("auto"), "");
}

TEST_F(CheckWarnings, WarnsInEveryRunOfBoundsThatExcludeAnEmitter) {
    const std::string bounds = R"(, "bounds": {"lower": [-1, -1, -1], "upper": [1, 1, 1]})";
    const std::string advice =
        ": particles outside are removed at the end of a step; make `bounds` larger or move the emitter inside\n";
    const std::string outside = plane() + emitter(R"("type": "point", "center": [0, 0, 3.5])") + bounds;
    const std::string all =
        "emitters[0] 'e': 256 of 256 positions that were tried lie outside `bounds`, the farthest by "
        "2.5 m along z" +
        advice;
    EXPECT_EQ(warnings(outside), all);
    EXPECT_NE(warnings_of_run(outside).find(": " + all), std::string::npos);
    const std::string partly = emitter(R"("type": "box", "center": [1, 0, 0], "size": [0.5, 0.5, 0.5])");
    const std::string text = warnings(plane() + partly + bounds);
    EXPECT_NE(text.find(" of 256 positions that were tried lie outside `bounds`, the farthest by 0.2"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find(" m along x" + advice), std::string::npos) << text;
}

TEST_F(CheckWarnings, WarnsOfBoundsThatExcludeAnEmitterInAFrame) {
    const std::string bounds = R"(, "bounds": {"lower": [-1, -1, -1], "upper": [1, 1, 1]})";
    const std::string frame = R"(, "frames": {"f": {"translation": [0, 0, 5]}})";
    const std::string in_frame = emitter(R"("type": "point", "center": [0, 0, 0.5], "frame": "f")");
    EXPECT_NE(warnings(plane() + frame + in_frame + bounds).find("256 of 256"), std::string::npos);
}

TEST_F(CheckWarnings, AcceptsBoundsThatContainAllStartPositions) {
    const std::string bounds = R"(, "bounds": {"lower": [-1, -1, -1], "upper": [1, 1, 1]})";
    for (const char* shape : {R"("type": "point", "center": [0, 0, 1])",
                              R"("type": "disk", "center": [0, 0, 1], "normal": [0, 0, 1], "radius": 1)",
                              R"("type": "sphere", "center": [0, 0, 0.5], "radius": 0.5)"}) {
        EXPECT_EQ(warnings(plane() + emitter(shape) + bounds), "") << shape;
    }
    // Children start at the positions of their parents.
    const std::string child =
        R"(, {"name": "c", "type": "child", "parent": "e", "on": "impact", "count": 2, "lifetime": 1}])";
    std::string parent = emitter(R"("type": "point", "center": [0, 0, 0.5])");
    parent.pop_back();
    EXPECT_EQ(warnings(plane() + parent + child + bounds), "");
}

TEST_F(CheckWarnings, QuestionsTheSizeOfAMeshInMillimetresUntilAScaleIsStated) {
    TriangleMesh hopper = funnel_mesh(205.0, 20.0);
    for (Vec3& vertex : hopper.vertices) vertex.z *= 300.0;
    (void)folder().write("millimetres.obj", obj_of(hopper));
    const auto with_scale = [&](const std::string& scale, const std::string& height) {
        return warnings(collider(R"("type": "mesh", "file": "millimetres.obj")" + scale) +
                        emitter(R"("type": "point", "center": [0, 0, )" + height + "]"));
    };
    const std::string text = with_scale("", "900");
    EXPECT_NE(text.find("colliders[0].file: the mesh is 410 m large if its numbers are metres, 0.41 m if they are "
                        "millimetres; "),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("\"scale\": 0.001 for millimetres, or \"scale\": 1"), std::string::npos) << text;
    EXPECT_EQ(with_scale(R"(, "scale": 1)", "900"), "");
    EXPECT_EQ(with_scale(R"(, "scale": 0.001)", "0.9"), "");
}

TEST_F(CheckWarnings, QuestionsStartsFarFromTheCollidersAsAWrongUnit) {
    const std::string funnel = collider(R"("type": "mesh", "file": "funnel.obj")");  // 3 m along its diagonal
    const std::string wide =
        warnings(funnel + emitter(R"("type": "disk", "center": [0, 0, 380], "normal": [0, 0, -1], "radius": 120)"));
    EXPECT_NE(
        wide.find("emitters[0] 'e': particles begin up to 379 m away from the colliders, which measure 3 m together: "
                  "lengths are in metres"),
        std::string::npos)
        << wide;
    EXPECT_EQ(warnings(funnel + emitter(R"("type": "point", "center": [0, 0, 290])")), "");
    EXPECT_EQ(warnings(plane() + emitter(R"("type": "point", "center": [0, 0, 3800])")), "");
}

TEST_F(CheckWarnings, AcceptsFarStartsOfParticlesThatCanReachSomething) {
    const std::string far_away = emitter(R"("type": "point", "center": [0, 0, 380])");
    const std::string funnel = R"({"name": "f", "type": "mesh", "file": "funnel.obj")";
    const auto colliders = [](const std::string& list) { return R"("colliders": [)" + list + "]"; };
    EXPECT_NE(warnings(colliders(funnel + "}") + far_away), "");
    EXPECT_EQ(warnings(colliders(funnel + R"(}, {"type": "plane", "normal": [0, 0, 1]})") + far_away), "");
    EXPECT_EQ(
        warnings(colliders(funnel + R"(, "motion": [{"time": 0}, {"time": 1, "position": [0, 0, 1]}]})") + far_away),
        "");
    EXPECT_EQ(warnings(colliders(funnel + "}") +
                       emitter(R"("type": "point", "center": [0, 0, 380], "velocity": [0, 0, -4000])")),
              "");
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
