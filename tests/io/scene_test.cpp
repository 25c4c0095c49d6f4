#include "ricochet/io/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>

#include "io/sample_scene.h"
#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::kSampleScene;
using test::SampleFolder;
using test::scaled;
using Lines = std::vector<std::string>;

// Returns all errors of a scene text, without the folder's name.
Lines errors_of(const SampleFolder& folder, std::string_view text, const Lines& overrides = {}) {
    try {
        (void)parse_scene(text, folder.path("s.json"), overrides);
        return {};
    } catch (const SceneError& error) {
        const std::string prefix = folder.path("").string();
        Lines lines;
        for (std::string line : error.messages()) {
            for (auto at = line.find(prefix); at != std::string::npos; at = line.find(prefix)) {
                line.erase(at, prefix.size());
            }
            lines.push_back(line);
        }
        return lines;
    }
}

// Returns the sample with one text replaced. The text must be present.
std::string sample_with(std::string_view old_text, std::string_view new_text) {
    std::string scene = kSampleScene;
    const std::size_t at = scene.find(old_text);
    if (at == std::string::npos) throw std::logic_error("not in the sample: " + std::string(old_text));
    return scene.replace(at, old_text.size(), new_text);
}

// Returns a scene of one line with the given members after the version.
std::string scene_of(const std::string& members) {
    return "{\"ricochet\": 1" + (members.empty() ? "" : ", " + members) + "}";
}

TEST(Scene, ReadsEveryKeyOfTheFormat) {
    const SampleFolder folder;
    const SceneDescription scene = parse_scene(kSampleScene, folder.path("s.json"));
    const SimulationOptions& options = scene.setup.options;
    EXPECT_EQ(options.time_step, 0.01);
    EXPECT_EQ(options.duration, 2.0);
    EXPECT_EQ(options.integrator, IntegratorKind::symplectic_euler);
    EXPECT_EQ(options.seed, 7U);
    EXPECT_EQ(options.resting_speed, 0.002);
    EXPECT_EQ(options.bounce_budget, 50U);
    ASSERT_EQ(scene.setup.forces.size(), 2U);
    const ForceInput state{{}, {1, 0, 0}, 1.0, 0.0, 0.0};
    EXPECT_EQ(scene.setup.forces[0]->acceleration(state), (Vec3{0, 0, -9.81}));
    EXPECT_EQ(scene.setup.forces[1]->acceleration(state).x, -0.05);
    ASSERT_EQ(scene.setup.materials.size(), 2U);
    EXPECT_EQ(scene.setup.materials[0].restitution, 0.8);
    EXPECT_EQ(scene.setup.materials[0].friction, 0.3);
    EXPECT_EQ(scene.setup.materials[1].name, "old ice");
    EXPECT_EQ(scene.setup.bounds->lower, (Vec3{-10, -10, -10}));
    EXPECT_EQ(scene.setup.bounds->upper, (Vec3{10, 10, 10}));
    EXPECT_EQ(scene.output.every, 2U);
    EXPECT_EQ(scene.output.format, "vtp");
    EXPECT_EQ(scene.camera->position, (Vec3{0, -10, 3}));
    EXPECT_EQ(scene.camera->up, (Vec3{0, 0, 1}));
    EXPECT_EQ(scene.camera->field_of_view_degrees, 40.0);
    EXPECT_EQ(scene.warnings, Lines{});
    EXPECT_EQ(scene.file, folder.path("s.json").string());
}

TEST(Scene, ReadsColliders) {
    const SampleFolder folder;
    const SceneDescription scene = parse_scene(kSampleScene, folder.path("s.json"));
    ASSERT_EQ(scene.setup.colliders.size(), 2U);
    EXPECT_EQ(scene.setup.colliders[0].name, "floor");
    EXPECT_EQ(scene.setup.colliders[0].material, 1U);
    const auto& plane = std::get<PlaneShape>(scene.setup.colliders[0].shape);
    EXPECT_EQ(plane.point, (Vec3{0, 0, -1}));
    EXPECT_EQ(plane.normal, (Vec3{0, 0, 2}));
    EXPECT_EQ(scene.setup.colliders[1].material, 0U);
    const auto& mesh = std::get<MeshShape>(scene.setup.colliders[1].shape);
    EXPECT_EQ(mesh.mesh->triangles.size(), 4U);
    EXPECT_EQ(mesh.file, folder.path("rock.obj").string());
    EXPECT_EQ(mesh.placement.position, (Vec3{1, 2, 3}));
    EXPECT_EQ(mesh.placement.rotation_axis, (Vec3{0, 0, 1}));
    EXPECT_EQ(mesh.placement.rotation_degrees, 90.0);
    EXPECT_EQ(mesh.placement.scale, (Vec3{1, 1.5, -1}));
}

TEST(Scene, ReadsEmittersAndParticles) {
    const SampleFolder folder;
    const SceneDescription scene = parse_scene(kSampleScene, folder.path("s.json"));
    ASSERT_EQ(scene.setup.emitters.size(), 6U);
    const EmitterDescription& tap = scene.setup.emitters[0];
    EXPECT_EQ(tap.name, "tap");
    EXPECT_EQ(std::get<PointShape>(tap.shape).center, (Vec3{0, 0, 3}));
    EXPECT_EQ(tap.burst, 5U);
    EXPECT_EQ(tap.rate.mean, 20.0);
    EXPECT_EQ(tap.rate.spread, 2.0);
    EXPECT_EQ(tap.start, 0.5);
    EXPECT_EQ(tap.stop, 1.5);
    EXPECT_EQ(tap.limit, 30U);
    EXPECT_EQ(tap.direction, (Vec3{0, 0, -1}));
    EXPECT_EQ(tap.cone_degrees, 20.0);
    EXPECT_EQ(tap.speed.spread, 0.5);
    EXPECT_EQ(tap.velocity, (Vec3{1, 0, 0}));
    EXPECT_EQ(tap.mass.mean, 2.0);
    EXPECT_EQ(tap.lifetime.mean, 4.0);
    EXPECT_EQ(std::get<DiskShape>(scene.setup.emitters[1].shape).radius, 0.5);
    EXPECT_EQ(std::get<BoxShape>(scene.setup.emitters[2].shape).size, (Vec3{1, 2, 0}));
    EXPECT_TRUE(std::get<SphereShape>(scene.setup.emitters[3].shape).surface);
    ASSERT_EQ(scene.setup.particles.size(), 2U);
    EXPECT_EQ(scene.setup.particles[0].velocity, (Vec3{1, 0, 0}));
    EXPECT_EQ(scene.setup.particles[0].mass, 0.5);
    EXPECT_EQ(scene.setup.particles[1].position, (Vec3{0, 0, 2}));
}

TEST(Scene, MeshEmitterIsExactlyAtItsCollidersPosition) {
    const SampleFolder folder;
    SceneDescription scene = parse_scene(kSampleScene, folder.path("s.json"));
    const auto emitter = std::get<MeshSurfaceShape>(scene.setup.emitters[4].shape).mesh;
    const Simulation simulation(std::move(scene.setup));
    const auto collider = simulation.collider_mesh(1);
    ASSERT_TRUE(collider);
    EXPECT_EQ(emitter->vertices, collider->vertices);
    EXPECT_EQ(emitter->triangles, collider->triangles);
}

TEST(Scene, MeshThatIsUsedTwiceIsReadOnce) {
    const SampleFolder folder;
    const SceneDescription scene = parse_scene(
        scene_of(R"("colliders": [{"type": "mesh", "file": "rock.obj"}, {"type": "mesh", "file": "./x/../rock.obj"}],
                    "particles": [{"position": [5, 5, 5]}])"),
        folder.path("s.json"));
    EXPECT_EQ(std::get<MeshShape>(scene.setup.colliders[0].shape).mesh,
              std::get<MeshShape>(scene.setup.colliders[1].shape).mesh);
}

TEST(Scene, DefaultsMatchTheLibrary) {
    const SampleFolder folder;
    const SceneDescription scene =
        parse_scene(scene_of(R"("emitters": [{"type": "point"}], "particles": [{"position": [1, 2, 3]}],
                                "materials": {"m": {}}, "colliders": [{"type": "plane", "normal": [0, 0, 1]}],
                                "camera": {"position": [1, 0, 0], "target": [0, 0, 0]})"),
                    folder.path("s.json"));
    const SimulationOptions library;
    EXPECT_EQ(scene.setup.options.time_step, library.time_step);
    EXPECT_EQ(scene.setup.options.duration, library.duration);
    EXPECT_EQ(scene.setup.options.integrator, library.integrator);
    EXPECT_EQ(scene.setup.options.seed, library.seed);
    EXPECT_EQ(scene.setup.options.resting_speed, library.resting_speed);
    EXPECT_EQ(scene.setup.options.bounce_budget, library.bounce_budget);
    const EmitterDescription emitter;
    const EmitterDescription& read = scene.setup.emitters[0];
    EXPECT_EQ(read.burst, emitter.burst);
    EXPECT_EQ(read.rate.mean, emitter.rate.mean);
    EXPECT_EQ(read.start, emitter.start);
    EXPECT_EQ(read.stop, emitter.stop);
    EXPECT_EQ(read.direction, emitter.direction);
    EXPECT_EQ(read.cone_degrees, emitter.cone_degrees);
    EXPECT_EQ(read.speed.mean, emitter.speed.mean);
    EXPECT_EQ(read.mass.mean, emitter.mass.mean);
    EXPECT_EQ(read.lifetime.mean, emitter.lifetime.mean);
    EXPECT_EQ(read.limit, emitter.limit);
    const Particle particle;
    EXPECT_EQ(scene.setup.particles[0].velocity, particle.velocity);
    EXPECT_EQ(scene.setup.particles[0].mass, particle.mass);
    const Material material;
    EXPECT_EQ(scene.setup.materials[0].restitution, material.restitution);
    EXPECT_EQ(scene.setup.materials[0].friction, material.friction);
    EXPECT_EQ(scene.output.every, OutputOptions{}.every);
    EXPECT_EQ(scene.camera->field_of_view_degrees, CameraDescription{}.field_of_view_degrees);
    EXPECT_FALSE(scene.camera->up.has_value());
}

TEST(Scene, SurfaceMotionOfAMaterialIsRead) {
    const auto scene = [](const std::string& material) {
        return parse_scene(scene_of(R"("materials": {"belt": )" + material + R"(},
            "particles": [{"position": [0, 0, 1]}],
            "colliders": [{"type": "plane", "normal": [0, 0, 1], "material": "belt"}])"),
                           "s.json");
    };
    const SceneDescription belt = scene(R"({"friction": 0.4, "surface_motion": {"velocity": [1, 2, 0],
        "angular_velocity": [0, 0, 3], "center": [4, 5, 6]}})");
    EXPECT_EQ(belt.warnings, std::vector<std::string>{});
    const SurfaceMotion& motion = belt.setup.materials.at(0).motion;
    EXPECT_EQ(motion.velocity, (Vec3{1, 2, 0}));
    EXPECT_EQ(motion.angular_velocity, (Vec3{0, 0, 3}));
    EXPECT_EQ(motion.center, (Vec3{4, 5, 6}));
    const SceneDescription ice = scene(R"({"surface_motion": {"velocity": [1, 0, 0]}})");
    ASSERT_EQ(ice.warnings.size(), 1U);
    EXPECT_NE(ice.warnings[0].find("nothing comes of it without friction"), std::string::npos) << ice.warnings[0];
    EXPECT_THROW((void)scene(R"({"friction": 1, "surface_motion": {"velocity": [3e8, 0, 0]}})"), InputError);
}

TEST(Scene, ColliderWithoutAMaterialIsPerfectlyElastic) {
    const SampleFolder folder;
    const SceneDescription scene = parse_scene(scene_of(R"("materials": {"rubber": {"restitution": 0.5}},
                    "colliders": [{"type": "plane", "normal": [0, 0, 1]}, {"type": "plane", "normal": [0, 0, 1]},
                                  {"type": "plane", "normal": [0, 0, 1], "material": "rubber"}],
                    "particles": [{"position": [0, 0, 1]}])"),
                                               folder.path("s.json"));
    ASSERT_EQ(scene.setup.materials.size(), 2U);
    EXPECT_EQ(scene.setup.colliders[0].material, 1U);
    EXPECT_EQ(scene.setup.colliders[1].material, 1U);
    EXPECT_EQ(scene.setup.colliders[2].material, 0U);
    EXPECT_EQ(scene.setup.materials[1].restitution, 1.0);
    EXPECT_EQ(scene.setup.colliders[1].name, "plane1");
}

TEST(Scene, ReadsParticlesFromATable) {
    const SampleFolder folder;
    (void)folder.write("start.csv", "x,y,z,age\n1,2,3,0.5\n4,5,6,0.5\n");
    const SceneDescription scene =
        parse_scene(scene_of(R"("particles": {"file": "start.csv"})"), folder.path("s.json"));
    ASSERT_EQ(scene.setup.particles.size(), 2U);
    EXPECT_EQ(scene.setup.particles[1].position, (Vec3{4, 5, 6}));
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_NE(scene.warnings[0].find("\"age\""), std::string::npos);
    (void)folder.write("start.csv", "x,y,z\n1,2,a\n");
    EXPECT_EQ(errors_of(folder, scene_of(R"("particles": {"file": "start.csv"})")),
              (Lines{"s.json:1:39: particles.file: start.csv:2: found \"a\" in column \"z\", expected a number (m)"}));
}

// A run may be resumed if its fingerprint is unchanged.
TEST(Scene, FingerprintCoversEverythingThatAffectsTheRun) {
    const SampleFolder folder;
    (void)folder.write("start.csv", "x,y,z\n1,2,3\n");
    const std::string members = R"("colliders": [{"type": "mesh", "file": "rock.obj"}],
        "emitters": [{"type": "mesh", "file": "other.obj", "burst": 1}], "particles": {"file": "start.csv"})";
    (void)folder.write("other.obj", test::kSampleMesh);
    const auto fingerprint = [&](const std::string& more = "") {
        return parse_scene(scene_of((members + more).c_str()), folder.path("s.json")).fingerprint;
    };
    const std::uint64_t first = fingerprint();
    EXPECT_EQ(fingerprint(), first);
    EXPECT_EQ(fingerprint(R"(, "output": {"every": 3})"), first);
    EXPECT_NE(fingerprint(R"(, "simulation": {"seed": 3})"), first);
    for (const char* file : {"start.csv", "rock.obj", "other.obj"}) {
        const std::string before = folder.read(file);
        (void)folder.write(file, before + "\n");
        EXPECT_NE(fingerprint(), first) << file;
        (void)folder.write(file, before);
        EXPECT_EQ(fingerprint(), first) << file;
    }
    const SceneDescription scene = parse_scene(scene_of(members.c_str()), folder.path("s.json"));
    EXPECT_EQ(scene.files.size(), 3U);
}

struct Spoiled {
    const char* members;
    const char* error;
};

// A wrong member, and the one line that reports it.
const std::vector<Spoiled> kSpoiled = {
    // types
    {R"("simulation": [])", "s.json:1:31: simulation: found an empty list, expected an object {...} (simulation)"},
    {R"("simulation": {"seed": "7"})",
     "s.json:1:40: simulation.seed: found \"7\", expected a whole number >= 0 and <= 18446744073709551615"},
    {R"("simulation": {"seed": 1.5})",
     "s.json:1:40: simulation.seed: found 1.5, expected a whole number >= 0 and <= 18446744073709551615"},
    {R"("simulation": {"seed": 18446744073709551616})",
     "s.json:1:40: simulation.seed: found 1.8446744073709552e+19, expected a whole number >= 0 and <= "
     "18446744073709551615"},
    {R"("simulation": {"time_step": null})",
     "s.json:1:45: simulation.time_step: found null, expected a number > 0 (s)"},
    {R"("forces": {})", "s.json:1:27: forces: found an object, expected a list [...] of objects"},
    {R"("forces": [3])", "s.json:1:28: forces[0]: found 3, expected an object {...} (force)"},
    {R"("materials": [])",
     "s.json:1:30: materials: found an empty list, expected an object {\"name\": {...}} (material by name)"},
    {R"("colliders": [{"type": "plane", "normal": [0, 1]}])",
     "s.json:1:59: colliders[0].normal: found a list of 2, expected [x, y, z], not all zero"},
    {R"("colliders": [{"type": "plane", "normal": [0, "1", 0]}])",
     "s.json:1:59: colliders[0].normal: found \"1\" in the list, expected [x, y, z], not all zero"},
    {R"("emitters": [{"type": "sphere", "radius": 1, "surface": 1, "burst": 1}])",
     "s.json:1:73: emitters[0].surface: found 1, expected true or false"},
    {R"("emitters": [{"type": "point", "name": "", "burst": 1}])",
     "s.json:1:56: emitters[0].name: found \"\", expected a text that is not empty"},
    {R"("particles": 5)", "s.json:1:30: particles: found 5, expected a list [...] of objects, or {\"file\": ...}"},
    // ranges
    {R"("simulation": {"time_step": 0})", "s.json:1:45: simulation.time_step: found 0, expected a number > 0 (s)"},
    {R"("simulation": {"bounce_budget": 0})",
     "s.json:1:49: simulation.bounce_budget: found 0, expected a whole number >= 1 and <= 4294967295"},
    {R"("simulation": {"time_step": 1e-300, "duration": 1e300})",
     "s.json:1:45: simulation.time_step: 1e-300 s in 1e+300 s is inf steps, expected at most 1000000000000"},
    {R"("forces": [{"type": "drag", "coefficient": -1}])",
     "s.json:1:60: forces[0].coefficient: found -1, expected a number >= 0 (kg/s)"},
    {R"("particles": [{"position": [0, 1e80, 0]}])",
     "s.json:1:44: particles[0].position: found 1e+80 in the list, expected at most 1e+75 in magnitude"},
    {R"("particles": [{"position": [0, 0, 0], "radius": 1e300}])",
     "s.json:1:65: particles[0].radius: found 1e+300, expected at most 1e+75 in magnitude"},
    {R"("emitters": [{"type": "point", "burst": 1, "particle_radius": [1, 1e300]}])",
     "s.json:1:79: emitters[0].particle_radius: found the spread 1e+300, expected a smaller one"},
    {R"("particles": [{"position": [0, 0, 0], "mass": 1e-322}])",
     "s.json:1:63: particles[0].mass: found 1e-322, expected a number >= 1e-300 (kg)"},
    {R"("particles": [{"position": [0, 0, 0], "mass": 0}])",
     "s.json:1:63: particles[0].mass: found 0, expected a number >= 1e-300 (kg)"},
    {R"("emitters": [{"type": "point", "burst": 1, "mass": [1, 1]}])",
     "s.json:1:68: emitters[0].mass: found [1, 1], so down to 0; expected a number >= 1e-300 (kg) or [mean, spread] "
     "with spread >= 0 and mean - spread >= 1e-300, or a distribution {\"type\": ...}"},
    {R"("emitters": [{"type": "point", "burst": 1, "start": 2, "stop": 1}], "simulation": {"duration": 9})",
     "s.json:1:80: emitters[0].stop: found 1 s, expected a time after start (2 s)"},
    {R"("emitters": [{"type": "point", "rate": 1e10}])",
     "s.json:1:30: emitters[0]: with this emitter the scene gives birth to 1e+10 particles, expected at most "
     "4294967295"},
    {R"("bounds": {"lower": [0, 0, 0], "upper": [1, 0, 1]})",
     "s.json:1:57: bounds.upper: found y = 0, expected more than lower's 0"},
    {R"("camera": {"position": [1, 1, 1], "target": [1, 1, 1]})",
     "s.json:1:61: camera.target: the camera stands on its target, expected another point"},
    {R"("camera": {"position": [1, 1, 1], "target": [1, 1, 0], "up": [0, 0, 3]})",
     "s.json:1:78: camera.up: the camera looks along its up direction, expected another one"},
    // keys
    {R"("simulation": {"timestep": 1})", "s.json:1:32: simulation.timestep: unknown key; did you mean \"time_step\"?"},
    {R"("duration": 1)", "s.json:1:17: duration: unknown key; did you mean \"simulation.duration\"?"},
    {R"("gravity": [0, 0, -9.81])",
     "s.json:1:17: gravity: unknown key; known keys: \"ricochet\", \"$schema\", \"simulation\", \"forces\", "
     "\"particle_forces\", \"flows\", \"materials\", \"colliders\", \"frames\", \"emitters\", \"particles\", "
     "\"springs\", "
     "\"particle_contacts\", \"heat\", \"attributes\", \"reference_camera\", \"bounds\", \"counters\", \"output\", "
     "\"camera\", "
     "\"picture\""},
    {R"("emitters": [{"type": "box", "size": [1, 1, 1], "radius": 2, "burst": 1}])",
     "s.json:1:65: emitters[0].radius: not a key of type \"box\", it belongs to \"disk\", \"sphere\"; did you mean "
     "\"particle_radius\"?"},
    {R"("emitters": [{"type": "point", "center": [0, 0, 0], "size": 0.1, "burst": 1}])",
     "s.json:1:69: emitters[0].size: not a key of type \"point\", it belongs to \"box\"; did you mean "
     "\"particle_size\"?"},
    {R"("colliders": [{"type": "plane"}])",
     "s.json:1:31: colliders[0].normal: missing, expected [x, y, z], not all zero"},
    {R"("colliders": [{"name": "a"}])",
     "s.json:1:31: colliders[0].type: missing, expected one of \"plane\", \"mesh\", \"sphere\", \"cylinder\", \"box\""},
    {R"("colliders": [{"type": "plain", "normal": [0, 0, 1]}])",
     "s.json:1:40: colliders[0].type: found \"plain\", expected one of \"plane\", \"mesh\", \"sphere\", \"cylinder\", "
     "\"box\"; did you mean \"plane\"?"},
    {R"("emitters": [{"type": "mesh", "burst": 1}])",
     "s.json:1:30: emitters[0]: found none of the keys \"file\", \"collider\", expected exactly one of them"},
    {R"("emitters": [{"type": "mesh", "file": "rock.obj", "collider": "a", "burst": 1}])",
     "s.json:1:30: emitters[0]: found more than one of the keys \"file\", \"collider\", expected exactly one of them"},
    {R"("materials": {"a": {}, "a": {}})", "s.json:1:40: materials.a: the key appears twice in one object, keep one"},
    {R"("materials": {"": {}})", "s.json:1:31: materials: found an empty name, expected a name"},
    {R"("output": {"format": "vtk"})", "s.json:1:38: output.format: found \"vtk\", expected \"vtp\""},
    // names
    {R"("materials": {"rubber": {}}, "colliders": [{"type": "plane", "normal": [0, 0, 1], "material": "ruber"}])",
     "s.json:1:111: colliders[0].material: there is no material \"ruber\"; did you mean \"rubber\"?"},
    {R"("colliders": [{"type": "plane", "normal": [0, 0, 1], "material": "ice"}])",
     "s.json:1:82: colliders[0].material: there is no material \"ice\", the scene has none"},
    {R"("colliders": [{"type": "plane", "normal": [0, 0, 1], "name": "a"},
                      {"type": "plane", "normal": [0, 0, 1], "name": "a"}])",
     "s.json:2:70: colliders[1].name: the name \"a\" is taken by another collider, expected one of its own"},
    {R"("colliders": [{"type": "plane", "normal": [0, 0, 1], "name": "a"}],
        "emitters": [{"type": "mesh", "collider": "a", "burst": 1}])",
     "s.json:2:51: emitters[0].collider: there is no mesh collider \"a\", the scene has none"},
    // files
    {R"("colliders": [{"type": "mesh", "file": "rok.obj"}])",
     "s.json:1:56: colliders[0].file: there is no file rok.obj, did you mean \"rock.obj\"?"},
    {R"("colliders": [{"type": "mesh", "file": "sub"}])",
     "s.json:1:56: colliders[0].file: sub is a folder, expected a file"},
    {R"("particles": {"file": "rock.obj"})", "s.json:1:39: particles.file: found rock.obj, expected a .csv file"},
    {R"("particles": {"file": "a.csv"})", "s.json:1:39: particles.file: there is no file a.csv"},
    {R"("colliders": [{"type": "mesh", "file": "a\u0000b"}])",
     "s.json:1:56: colliders[0].file: \"a\\x00b\" contains a control character, expected plain text"},
    {R"("particles": [{"position": [0, 0, 0], "spin": [0, 0, 1]}])",
     "s.json:1:63: particles[0].spin: found for a point, which has none, expected a \"radius\" above 0 too"},
    // responses
    {R"("simulation": {"response": "rolback"})",
     "s.json:1:44: simulation.response: found \"rolback\", expected one of \"exact\", \"rollback\", \"project\", "
     "\"penalty\"; did you mean \"rollback\"?"},
    {R"("simulation": {"penalty": {"stiffness": 0}})",
     "s.json:1:57: simulation.penalty.stiffness: found 0, expected a number > 0 (N/m)"},
    {R"("simulation": {"rollback": {"time_tolerance": -1e-9}})",
     "s.json:1:63: simulation.rollback.time_tolerance: found -1e-09, expected a number > 0 (s)"},
    // part of the format, but not built
    {R"("particles": {"file": "a.vtp"})",
     "s.json:1:39: particles.file: a .vtp file of particles is part of the scene format but not built in this "
     "version, expected a .csv file"},
};

TEST(Scene, ErrorNamesTheFaultItsLocationAndTheExpectation) {
    const SampleFolder folder;
    for (const Spoiled& spoiled : kSpoiled) {
        EXPECT_EQ(errors_of(folder, scene_of(spoiled.members)), (Lines{spoiled.error})) << spoiled.members;
    }
}

// Three faces without a material, two of "rubber part", one of a group with two names.
constexpr const char* kGroupedMesh =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\ng left side\nf 2 3 4\nusemtl rubber part\nf 3 1 4\ng lid\n"
    "f 1 2 3\n";

// Returns a scene with the grouped mesh as a collider with the given members.
std::string grouped_scene(const std::string& members) {
    return scene_of(R"("materials": {"rubber": {}, "steel": {}, "ice": {}},
        "colliders": [{"type": "mesh", "file": "grouped.obj", "material": "steel", )" +
                    members + "}]");
}

Lines material_names(const SceneDescription& scene) {
    Lines names;
    for (const std::uint32_t i : std::get<MeshShape>(scene.setup.colliders.at(0).shape).triangle_materials) {
        names.push_back(scene.setup.materials.at(i).name);
    }
    return names;
}

TEST(SceneGroupMaterials, EveryTriangleHasTheMaterialOfItsGroup) {
    const SampleFolder folder;
    (void)folder.write("grouped.obj", kGroupedMesh);
    const auto names = [&](const std::string& members, const Lines& overrides = {}) {
        return material_names(parse_scene(grouped_scene(members), folder.path("s.json"), overrides));
    };
    EXPECT_EQ(names(R"("group_materials": {"rubber part": "rubber"})"),
              (Lines{"steel", "steel", "steel", "rubber", "rubber"}));
    // usemtl takes precedence over g, and a whole line over its words
    EXPECT_EQ(names(R"("group_materials": {"rubber part": "rubber", "lid": "ice", "side": "ice"})"),
              (Lines{"steel", "steel", "ice", "rubber", "rubber"}));
    EXPECT_EQ(names(R"("group_materials": {"lid": "ice", "left side": "rubber", "left": "ice"})"),
              (Lines{"steel", "steel", "rubber", "rubber", "ice"}));
    EXPECT_EQ(names(R"("group_materials": {"left": "ice", "side": "rubber"})"),
              (Lines{"steel", "steel", "ice", "ice", "steel"}));
    EXPECT_EQ(names(R"("name": "a")"), Lines{});
    EXPECT_EQ(names(R"("name": "a")", {"colliders[0].group_materials.lid=ice"}),
              (Lines{"steel", "steel", "steel", "steel", "ice"}));
}

// Two balls fall on the two halves of a plate. One half has restitution 1, the other 0.
TEST(SceneGroupMaterials, ParticlesBounceByTheMaterialOfThePart) {
    const SampleFolder folder;
    (void)folder.write("plate.obj",
                       "v -1 -1 0\nv 0 -1 0\nv 0 1 0\nv -1 1 0\nv 1 -1 0\nv 1 1 0\n"
                       "usemtl spring\nf 1 2 3 4\nusemtl mud\nf 2 5 6 3\n");
    Simulation simulation(parse_scene(scene_of(R"("simulation": {"time_step": 1, "duration": 1},
        "materials": {"elastic": {}, "dead": {"restitution": 0}},
        "colliders": [{"type": "mesh", "file": "plate.obj", "material": "elastic", "group_materials": {"mud": "dead"}}],
        "particles": [{"position": [-0.5, 0.2, 1], "velocity": [0, 0, -2]},
                      {"position": [0.5, 0.2, 1], "velocity": [0, 0, -2]}])"),
                                      folder.path("s.json"))
                              .setup);
    simulation.step();
    EXPECT_EQ(simulation.particles().velocity[0], Vec3(0, 0, 2));
    EXPECT_NEAR(simulation.particles().position[0].z, 1.0, 1e-14);
    EXPECT_EQ(simulation.particles().velocity[1], Vec3());
    EXPECT_NEAR(simulation.particles().position[1].z, 0.0, 1e-14);
}

TEST(SceneGroupMaterials, GroupsCountAsUseOfAMaterialAndUnusedEntriesGiveAWarning) {
    const SampleFolder folder;
    (void)folder.write("grouped.obj", kGroupedMesh);
    const SceneDescription scene = parse_scene(
        grouped_scene(R"("group_materials": {"rubber part": "rubber", "lid": "ice"})"), folder.path("s.json"));
    ASSERT_EQ(scene.warnings.size(), 2U);  // the other warning: nothing will move
    EXPECT_TRUE(scene.warnings[1].ends_with(
        "s.json:2:129: colliders[0].group_materials.lid: no triangle takes this material: all faces of the group also "
        "have a name that comes before (material before group before object)"))
        << scene.warnings[1];
}

TEST(SceneGroupMaterials, MissingNamesAreRefusedWithTheNearest) {
    const SampleFolder folder;
    (void)folder.write("grouped.obj", kGroupedMesh);
    const auto error = [&](const std::string& members) {
        const Lines errors = errors_of(folder, grouped_scene(members));
        return errors.size() == 1 ? errors[0].substr(errors[0].find("colliders")) : std::to_string(errors.size());
    };
    EXPECT_EQ(error(R"("group_materials": {"ruber_part": "rubber"})"),
              "colliders[0].group_materials.ruber_part: the mesh has no group \"ruber_part\"; did you mean \"rubber "
              "part\"?");
    EXPECT_EQ(error(R"("group_materials": {"xyzzy": "rubber"})"),
              "colliders[0].group_materials.xyzzy: the mesh has no group \"xyzzy\", it has: \"left side\", \"left\", "
              "\"side\", \"rubber part\", \"lid\"");
    EXPECT_EQ(error(R"("group_materials": {"lid": "ruber"})"),
              "colliders[0].group_materials.lid: there is no material \"ruber\"; did you mean \"rubber\"?");
    EXPECT_EQ(error(R"("group_materials": {"lid": 3})"),
              "colliders[0].group_materials.lid: found 3, expected a text that is not empty");
    EXPECT_EQ(error(R"("group_materials": "lid")"),
              "colliders[0].group_materials: found \"lid\", expected an object {\"name\": \"text\"}");
}

TEST(SceneGroupMaterials, MeshesWithoutGroupsAreRefused) {
    const SampleFolder folder;
    (void)folder.write("plain.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    (void)folder.write("plain.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    const auto error = [&](const std::string& file) {
        return errors_of(folder, scene_of(R"("materials": {"a": {}}, "colliders": [{"type": "mesh", "material": "a",
            "file": ")" + file + R"(", "group_materials": {"lid": "a"}}])"));
    };
    EXPECT_EQ(
        error("plain.obj"),
        (Lines{"s.json:2:53: colliders[0].group_materials: the mesh has no groups (no material, group or object with "
               "a name), leave this key out"}));
    EXPECT_EQ(error("plain.off"),
              (Lines{"s.json:2:53: colliders[0].group_materials: the mesh is a file of the format OFF, which has no "
                     "groups; expected OBJ, glTF or ASCII STL"}));
    EXPECT_EQ(error("none.obj").size(), 1U);
}

TEST(Scene, VersionMustBePresentAndKnown) {
    const SampleFolder folder;
    EXPECT_EQ(errors_of(folder, "{}"), (Lines{"s.json:1:1: ricochet: missing, expected 1"}));
    EXPECT_EQ(errors_of(folder, "{\"ricochet\": 2}"), (Lines{"s.json:1:14: ricochet: found 2, expected 1"}));
}

TEST(Scene, AllErrorsOfASceneAreReportedInTheOrderOfTheirLocations) {
    const SampleFolder folder;
    const Lines errors = errors_of(folder, R"({"ricochet": 1,
        "simulation": {"time_step": -1, "durtion": "x"},
        "coliders": [{"type": "mesh", "file": "nothing.obj", "material": "none"},
                     {"type": "plane", "normal": [0, 0, 0]}],
        "emitters": [{"type": "mesh", "collider": "x"}, {"type": "disk", "radius": -1}]})");
    EXPECT_EQ(errors, (Lines{
                          "s.json:2:37: simulation.time_step: found -1, expected a number > 0 (s)",
                          "s.json:2:41: simulation.durtion: unknown key; did you mean \"duration\"?",
                          "s.json:2:52: simulation.duration: found \"x\", expected a number >= 0 (s)",
                          "s.json:3:9: coliders: unknown key; did you mean \"colliders\"?",
                          "s.json:3:47: colliders[0].file: there is no file nothing.obj",
                          "s.json:3:74: colliders[0].material: there is no material \"none\", the scene has none",
                          "s.json:4:50: colliders[1].normal: found a vector of no length, expected [x, y, z], not all "
                          "zero",
                          "s.json:5:51: emitters[0].collider: there is no mesh collider \"x\", known: \"mesh0\"",
                          "s.json:5:57: emitters[1].normal: missing, expected [x, y, z], not all zero",
                          "s.json:5:84: emitters[1].radius: found -1, expected a number > 0 (m)",
                      }));
}

TEST(Scene, MeshErrorKeepsTheReadersFileAndLine) {
    const SampleFolder folder;
    (void)folder.write("bad.obj", "v 0 0 0\nv 1 0 0\nf 1 2 7\n");
    const Lines errors = errors_of(folder, scene_of(R"("colliders": [{"type": "mesh", "file": "bad.obj"}])"));
    ASSERT_EQ(errors.size(), 1U);
    EXPECT_EQ(errors[0].rfind("s.json:1:56: colliders[0].file: bad.obj:3: ", 0), 0U) << errors[0];
}

TEST(Scene, ErrorsEndAfterTen) {
    const SampleFolder folder;
    std::string text;
    for (int i = 0; i < 1000; ++i) text += (i == 0 ? "\"k" : ",\"k") + std::to_string(1000000 + i) + "\": 0";
    const Lines errors = errors_of(folder, scene_of(text));
    ASSERT_EQ(errors.size(), 11U);
    EXPECT_EQ(errors.back(), "... and 990 more of this file");
}

// Makes one edit of a word: swaps neighbours, or adds, removes or replaces a letter.
std::string misspelt(const std::string& word, RandomSequence& random) {
    const auto below = [&](std::size_t n) {
        return static_cast<std::size_t>(random.uniform() * static_cast<double>(n));
    };
    const char letter = static_cast<char>('a' + below(26));
    std::string result = word;
    const std::size_t at = below(word.size());
    switch (below(4)) {
        case 0:
            result.insert(at, 1, letter);
            break;
        case 1:
            result.erase(at, 1);
            break;
        case 2:
            result[at] = letter;
            break;
        default:
            std::swap(result[at], result[at + 1 < word.size() ? at + 1 : at - 1]);
    }
    return result;
}

// Returns every key of the sample, except the names that the user chooses.
std::vector<std::pair<std::size_t, std::string>> keys_of_the_sample() {
    const std::string scene = kSampleScene;
    std::vector<std::pair<std::size_t, std::string>> keys;
    for (std::size_t colon = scene.find("\":"); colon != std::string::npos; colon = scene.find("\":", colon + 1)) {
        const std::size_t begin = scene.rfind('"', colon - 1) + 1;
        const std::string key = scene.substr(begin, colon - begin);
        if (key != "rubber" && key != "old ice" && key != "stone") keys.emplace_back(begin, key);
    }
    return keys;
}

TEST(Scene, MisspeltKeyIsExactlyOneErrorThatSuggestsTheRightKey) {
    const SampleFolder folder;
    const auto keys = keys_of_the_sample();
    ASSERT_GT(keys.size(), 60U);
    std::set<std::string> known;
    for (const auto& [at, key] : keys) known.insert(key);
    RandomSequence random(5, 0, 0);
    int tried = 0;
    for (int round = 0; round < scaled(2000); ++round) {
        const auto& [at, key] = keys[static_cast<std::size_t>(random.uniform() * static_cast<double>(keys.size()))];
        const std::string wrong = misspelt(key, random);
        if (known.contains(wrong)) continue;
        SCOPED_TRACE(::testing::Message() << key << " as " << wrong);
        std::string scene = kSampleScene;
        scene.replace(at, key.size(), wrong);
        const Lines errors = errors_of(folder, scene);
        ASSERT_EQ(errors.size(), 1U) << errors[1];
        ASSERT_NE(errors[0].find("unknown key; did you mean"), std::string::npos) << errors[0];
        ASSERT_NE(errors[0].find("\"" + key + "\""), std::string::npos) << errors[0];
        ++tried;
    }
    EXPECT_GT(tried, scaled(2000) * 3 / 4 - 5);
}

TEST(Scene, KeysWithoutEffectGiveAWarning) {
    const SampleFolder folder;
    const auto warnings = [&](const std::string& members) {
        Lines lines = parse_scene(scene_of(members), folder.path("s.json")).warnings;
        for (std::string& line : lines) line.erase(0, folder.path("").string().size());
        return lines;
    };
    EXPECT_EQ(warnings(""), (Lines{"s.json: the scene has neither emitters nor particles, nothing will move"}));
    EXPECT_EQ(warnings(R"("materials": {"m": {}}, "particles": [{"position": [0, 0, 0]}])"),
              (Lines{"s.json:1:31: materials.m: no collider uses this material"}));
    EXPECT_EQ(warnings(R"("emitters": [{"type": "point"}])"),
              (Lines{"s.json:1:30: emitters[0]: emits nothing: it has neither a burst nor a rate"}));
    EXPECT_EQ(warnings(R"("emitters": [{"type": "point", "burst": 1, "start": 5}])"),
              (Lines{"s.json:1:69: emitters[0].start: emits nothing: it begins at 5 s, the scene ends at 1 s"}));
    EXPECT_EQ(warnings(R"("bounds": {"lower": [0, 0, 0], "upper": [1, 1, 1]}, "particles": [{"position": [0, 0, 2]}])"),
              (Lines{"s.json:1:82: particles: 1 of 1 start outside the bounds and are retired at once"}));
}

TEST(SceneOverride, ValuesAreChangedBeforeAnythingIsChecked) {
    const SampleFolder folder;
    const SceneDescription scene =
        parse_scene(sample_with("\"time_step\": 0.01", "\"time_step\": -1"), folder.path("s.json"),
                    {"simulation.time_step=0.5", "simulation.integrator=ballistic", "colliders[1].scale=[1, 2, 3]",
                     "materials[\"old ice\"].friction=0.25", "emitters[0].burst=1", "emitters[0].burst=9",
                     "output={\"every\": 7}"});
    EXPECT_EQ(scene.setup.options.time_step, 0.5);
    EXPECT_EQ(scene.setup.options.integrator, IntegratorKind::ballistic);
    EXPECT_EQ(std::get<MeshShape>(scene.setup.colliders[1].shape).placement.scale, (Vec3{1, 2, 3}));
    EXPECT_EQ(scene.setup.materials[1].friction, 0.25);
    EXPECT_EQ(scene.setup.emitters[0].burst, 9U);
    EXPECT_EQ(scene.output.every, 7U);
}

TEST(SceneOverride, MissingKeysAreAdded) {
    const SampleFolder folder;
    const SceneDescription scene = parse_scene(scene_of(""), folder.path("s.json"), {"simulation.seed=5"});
    EXPECT_EQ(scene.setup.options.seed, 5U);
}

TEST(SceneOverride, ErrorsNameTheArgumentAndThePath) {
    const SampleFolder folder;
    const auto error = [&](const std::string& argument) {
        const Lines errors = errors_of(folder, kSampleScene, {argument});
        return errors.size() == 1 ? errors[0] : "not one error but " + std::to_string(errors.size());
    };
    EXPECT_EQ(error("simulation.time_step=-1"),
              "s.json: --set simulation.time_step=-1: simulation.time_step: found -1, expected a number > 0 (s)");
    EXPECT_EQ(error("simulation.timestep=1"),
              "s.json: --set simulation.timestep=1: simulation.timestep: unknown key; did you mean \"time_step\"?");
    EXPECT_EQ(error("simulation.seed=abc"),
              "s.json: --set simulation.seed=abc: simulation.seed: found \"abc\", expected a whole number >= 0 and <= "
              "18446744073709551615");
    EXPECT_EQ(error("coliders[0].name=x"),
              "s.json: --set coliders[0].name=x: coliders: there is no such list; did you mean \"colliders\"?");
    EXPECT_EQ(error("colliders[2].name=x"),
              "s.json: --set colliders[2].name=x: colliders[2]: there is no such item, the list has 2");
    EXPECT_EQ(error("colliders[0].name.x=1"),
              "s.json: --set colliders[0].name.x=1: colliders[0].name.x: found \"floor\" there, expected an "
              "object");
    EXPECT_EQ(error("simulation[0]=1"),
              "s.json: --set simulation[0]=1: simulation[0]: found an object, expected a list");
    EXPECT_EQ(error("materials[\"old ice\"].restitution=2"),
              "s.json: --set materials[\"old ice\"].restitution=2: materials[\"old ice\"].restitution: found 2, "
              "expected a number >= 0 and <= 1");
    for (const char* malformed : {"", "=", "a", "=1", ".a=1", "a..b=1", "a[=1", "a[x]=1", "a[-1]=1", "a[]=1", "a[\"=1",
                                  "a[0]b=1", "a[99999999999999999999]=1"}) {
        EXPECT_EQ(error(malformed), "s.json: --set " + std::string(malformed) +
                                        ": expected PATH=VALUE, for example simulation.time_step=0.01 or "
                                        "colliders[0].scale=2");
    }
}

TEST(Scene, DamagedBytesAreReadOrRefusedCleanly) {
    const SampleFolder folder;
    RandomSequence random(9, 0, 0);
    const auto below = [&](std::size_t n) {
        return static_cast<std::size_t>(random.uniform() * static_cast<double>(n));
    };
    int refused = 0;
    for (int round = 0; round < scaled(1000); ++round) {
        SCOPED_TRACE(round);
        std::string scene = kSampleScene;
        for (std::size_t i = below(4); i < 4; ++i) {
            const std::size_t at = below(scene.size());
            switch (below(3)) {
                case 0:
                    scene[at] = static_cast<char>(below(256));
                    break;
                case 1:
                    scene.erase(at, 1 + below(20));
                    break;
                default:
                    scene.insert(at, scene.substr(below(scene.size()), below(40)));
            }
        }
        const Lines errors = errors_of(folder, scene);
        for (const std::string& line : errors) {
            ASSERT_EQ(line.rfind("s.json:", 0), 0U) << line;
            ASSERT_EQ(std::count_if(line.begin(), line.end(), [](char c) { return c >= 0 && c < 0x20; }), 0) << line;
        }
        refused += errors.empty() ? 0 : 1;
    }
    EXPECT_GT(refused, scaled(1000) / 2);
}

TEST(SceneFile, RefusesEverythingButSceneFiles) {
    const SampleFolder folder;
    const auto message = [](const std::filesystem::path& path) -> std::string {
        try {
            (void)read_scene(path);
        } catch (const SceneError& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_NE(message(folder.path("")).find("is a folder"), std::string::npos);
    EXPECT_NE(message(folder.path("none.json")).find("there is no file"), std::string::npos);
    EXPECT_NE(message("/dev/zero").find("is not a regular file"), std::string::npos);
    EXPECT_NE(message(folder.write("empty.json", "")).find("empty.json:1:1: not valid JSON"), std::string::npos);
    EXPECT_NE(message(folder.write("b.json", std::string("\x7F\x45LF\0\0\0", 7))).find("found a NUL byte"),
              std::string::npos);
    const std::filesystem::path huge = folder.write("huge.json", "");
    std::filesystem::resize_file(huge, kLargestSceneFile + 1);
    EXPECT_NE(message(huge).find("expected at most 67108864"), std::string::npos);
}

// Large meshes are generated on demand (meshes/README.md), so they may be missing here.
bool is_about_a_generated_mesh(const std::string& line) {
    return line.find("there is no file") != std::string::npos && line.find("/meshes/generated/") != std::string::npos;
}

TEST(SceneFile, EverySceneOfTheRepositoryIsReadWithoutAWarning) {
    int scenes = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(RICOCHET_SOURCE_DIR "/scenes")) {
        if (entry.path().extension() != ".json") continue;
        SCOPED_TRACE(entry.path().string());
        try {
            EXPECT_EQ(read_scene(entry.path()).warnings, Lines{});
        } catch (const SceneError& error) {
            for (const std::string& line : error.messages()) EXPECT_TRUE(is_about_a_generated_mesh(line)) << line;
        }
        ++scenes;
    }
    EXPECT_GE(scenes, 14);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
