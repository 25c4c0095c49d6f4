// Attributes, colours and sizes, rates and children in scenes, tables and frames.
#include "io/emitter_scene.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "io/sample_scene.h"
#include "ricochet/io/frames.h"
#include "ricochet/io/scene.h"
#include "ricochet/io/scene/context.h"
#include "run/run_report.h"
#include "run/vtp_reader.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::kEmitterScene;
using test::SampleFolder;

std::string scene_with(std::string_view old_text, std::string_view new_text) {
    std::string scene = kEmitterScene;
    const std::size_t at = scene.find(old_text);
    if (at == std::string::npos) throw std::logic_error("not in the scene: " + std::string(old_text));
    return scene.replace(at, old_text.size(), new_text);
}

// Returns all errors in one text, each beginning with its path.
std::string errors_of(const SampleFolder& folder, const std::string& text) {
    try {
        (void)parse_scene(text, folder.path("s.json"));
        return "";
    } catch (const SceneError& error) {
        std::string all;
        for (const std::string& line : error.messages()) all += line + "\n";
        return all;
    }
}

TEST(EmitterScene, ReadsEveryKey) {
    const SampleFolder folder;
    const SimulationSetup setup = parse_scene(kEmitterScene, folder.path("s.json")).setup;
    EXPECT_EQ(setup.options.frame_rate, 25.0);
    EXPECT_EQ(setup.options.max_depth, 2U);
    EXPECT_EQ(setup.options.most_particles, 5000U);
    ASSERT_EQ(setup.attributes.size(), 6U);
    EXPECT_EQ(setup.attributes[0].fallback.x, 300.0);
    EXPECT_EQ(setup.attributes[1].components, 3);
    EXPECT_EQ(setup.attributes[3].name, "color");
    ASSERT_TRUE(setup.reference_camera.has_value());
    EXPECT_EQ(setup.reference_camera->image_height, 600.0);
    const EmitterDescription& shell = setup.emitters[0];
    EXPECT_EQ(std::get<ConeShape>(shell.shape).angle_degrees, 20.0);
    EXPECT_EQ(shell.rate_per_frame.mean, 2.0);
    EXPECT_EQ(shell.seed, 12U);
    ASSERT_EQ(shell.attributes.size(), 6U);
    EXPECT_EQ(shell.attributes[0].spread, (Vec3{0.1, 0.2, 0}));
    EXPECT_EQ(shell.attributes[4].mean, (Vec3{4, 5, 6}));
    ASSERT_EQ(shell.curves.size(), 5U);
    EXPECT_TRUE(shell.curves[0].of_lifetime);
    EXPECT_FALSE(shell.curves[4].of_lifetime);
    EXPECT_TRUE(std::holds_alternative<MeshVolumeShape>(setup.emitters[1].shape));
    const ParentRule& shards = *setup.emitters[2].parent;
    EXPECT_EQ(shards.emitter, 0U);
    EXPECT_EQ(shards.on, BirthEvent::impact);
    EXPECT_TRUE(shards.share && shards.recursive);
    EXPECT_EQ(setup.emitters[3].parent->emitter, 2U);
    EXPECT_FALSE(setup.emitters[3].parent->share);
    EXPECT_EQ(setup.particles[0].attributes[1], (Vec3{7, 8, 9}));
    EXPECT_TRUE(is_missing(setup.particles[1].attributes[0]));
}

struct Spoiled {
    const char* old_text;
    const char* new_text;
    const char* error;
};

const Spoiled kSpoiled[] = {
    {R"("plain": {})", R"("mass": {})", "attributes.mass: the name is one of the particles' own"},
    {R"("plain": {})", R"("color": {})", "attributes.color: the name is one of the particles' own"},
    {R"("plain": {})", R"("spin_x": {})", "attributes.spin_x: the name is one of the particles' own"},
    {R"("plain": {})", R"("a,b": {})", "the name has control characters, commas or quotes"},
    {R"("plain": {})", R"("a\u001b": {})", "contains a control character"},
    {R"("plain": {})", R"("t": {"components": 3}, "t_y": {})", "\"t\" would share a column of tables"},
    {R"("components": 1, "default": 300)", R"("components": 2, "default": 300)",
     "attributes.temperature.components: found 2, expected 1 or 3"},
    {R"("default": [1, 2, 3])", R"("default": 4)", "attributes.tint.default: found 4, expected [x, y, z]"},
    {R"("temperature": [900, 100])", R"("temprature": 5)",
     "emitters[0].attributes.temprature: there is no attribute \"temprature\"; did you mean \"temperature\"?"},
    {R"("temperature": [900, 100])", R"("temperature": [1, 2, 3])",
     "emitters[0].attributes.temperature: found a list of 3, expected a number or [mean, spread]"},
    {R"("temperature": [900, 100])", R"("temperature": [900, -1])",
     "emitters[0].attributes.temperature: found -1, expected a spread >= 0"},
    {R"("plain": 7)", R"("color": 7)", "emitters[0].attributes.color: there is no attribute"},
    {R"([[0.5, 0.25, 1], [0.1, 0.2, 0]])", R"([2, 0, 0])", "emitters[0].color: found 2 in the list, expected"},
    {R"("opacity": [0.5, 0.5])", R"("opacity": 1.5)", "emitters[0].opacity: found 1.5, expected"},
    {R"("particle_size": [0.2, 0.1])", R"("particle_size": [0.2, 0.3])", "emitters[0].particle_size: found [0.2, 0.3]"},
    {R"("lifetime": [2, 0.5], )", "", "emitters[0].over_life: only goes together with the key \"lifetime\""},
    {R"("vector_attributes": {"tint")", R"("vector_attributes": {"temperature")",
     "emitters[0].over_life.vector_attributes.temperature: the attribute has 1 components"},
    {R"("rate_per_frame": [2, 1])", R"("rate_per_frame": [2, 1], "rate": 4)",
     "emitters[0].rate_per_frame: the emitter has another rate already"},
    {R"("angle": 20)", R"("angle": 90)", "emitters[0].angle: found 90, expected"},
    {R"("seed": 12)", R"("seed": -1)", "emitters[0].seed: found -1"},
    {R"("parent": "shell", "on")", R"("parent": "shel", "on")",
     "emitters[2].parent: there is no emitter \"shel\"; did you mean \"shell\"?"},
    {R"("parent": "shell", "on")", R"("parent": "quark", "on")",
     "emitters[2].parent: there is no emitter \"quark\", known: \"shell\""},
    {R"("on": "impact")", R"("on": "bounce")",
     "emitters[2].on: found \"bounce\", expected one of \"life\", \"death\", \"impact\""},
    {R"("on": "impact")", R"("on": "life")", "emitters[2].share: a parent that lives on cannot be shared out"},
    {R"("count": [5, 2])", R"("count": [5, 2], "particle_radius": 1)",
     "emitters[2].particle_radius: radii follow from the parent's"},
    {R"("count": [5, 2])", R"("count": [5, 2], "burst": 3)",
     "emitters[2].burst: is not for emitters of type \"child\""},
    {R"("parent": "shards", "on": "death")", R"("parent": "shards", "on": "impact")",
     "emitters[3].parent: another emitter shares out the same parents"},
    {R"("reference_camera": {"position": [0, 0, 9], "target": [0, 0, 0], "field_of_view": 50, "image_height": 600},)",
     "", "emitters[1].rate_per_area: only goes together with the scene's \"reference_camera\""},
    {R"("target": [0, 0, 0])", R"("target": [0, 0, 9])", "reference_camera.target: the camera stands on its target"},
    {R"("position": [0, 0, 9])", R"("position": [0, 0, 0.2])",
     "emitters[1].rate_per_area: a part of it is not in front of the reference camera"},
    {R"("temperature": 450)", R"("temperature": [450, 1])",
     "particles[0].attributes.temperature: found a list of 2, expected a number"},
    {R"("opacity": 0.5, "size")", R"("opacity": -1, "size")", "particles[0].opacity: found -1"},
    {R"("frame_rate": 25)", R"("frame_rate": 0)", "simulation.frame_rate: found 0"},
};

TEST(EmitterScene, ChildrenThatWaitForEachOtherAreNamed) {
    const auto warnings = [](const std::string& parent) {
        return parse_scene(
                   R"({"ricochet": 1, "emitters": [{"name": "first", "type": "point", "burst": 1, "lifetime": 1},
            {"name": "a", "type": "child", "parent": ")" +
                       parent + R"(", "on": "death"},
            {"name": "b", "type": "child", "parent": "a", "on": "death"},
            {"name": "c", "type": "child", "parent": "b", "on": "death"}]})",
                   "s.json")
            .warnings;
    };
    EXPECT_TRUE(warnings("first").empty());
    const std::vector<std::string> itself = warnings("a");
    ASSERT_EQ(itself.size(), 1U);
    EXPECT_NE(itself[0].find("emitters[1].parent: leads back to this emitter"), std::string::npos) << itself[0];
    EXPECT_EQ(warnings("b").size(), 2U);
    EXPECT_EQ(warnings("c").size(), 3U);
}

TEST(EmitterScene, WrongValuesAreNamedByTheirPath) {
    const SampleFolder folder;
    for (const Spoiled& spoiled : kSpoiled) {
        EXPECT_NE(errors_of(folder, scene_with(spoiled.old_text, spoiled.new_text)).find(spoiled.error),
                  std::string::npos)
            << spoiled.error << "\n"
            << errors_of(folder, scene_with(spoiled.old_text, spoiled.new_text));
    }
}

TEST(EmitterScene, OpenMeshHasNoVolumeToEmitFrom) {
    const SampleFolder folder;
    (void)folder.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_NE(errors_of(folder, scene_with("rock.obj", "open.obj")).find("emitters[1].file: the mesh is not closed"),
              std::string::npos);
}

TEST(EmitterScene, FramesAndTablesContainTheAttributes) {
    const SampleFolder folder;
    Simulation simulation(parse_scene(kEmitterScene, folder.path("s.json")).setup);
    while (!simulation.finished()) simulation.step();
    const AttributeTable shown = simulation.shown_attributes();
    const auto file = folder.path("frame.vtp");
    (void)write_vtp(file, particle_frame(simulation.particles(), shown, simulation.time(), true));
    const VtkPolyData frame = read_vtp(file);
    for (const char* const name : {"temperature", "tint", "plain", "color", "opacity", "size"}) {
        EXPECT_NE(find_array(frame.point_arrays, name), nullptr) << name;
    }
    const auto& tint = std::get<std::vector<Vec3>>(find_array(frame.point_arrays, "tint")->values);
    EXPECT_EQ(tint[0], (Vec3{7, 8, 9}));
    EXPECT_EQ(tint[1], (Vec3{1, 2, 3}));
    EXPECT_EQ(scalar_values(*find_array(frame.point_arrays, "temperature"))[0], 450.0);
    EXPECT_EQ(scalar_values(*find_array(frame.point_arrays, "size"))[0], 0.3);

    const auto csv = folder.path("state.csv");
    write_state_csv(csv, simulation.particles(), shown, simulation.time());
    std::ifstream text(csv);
    const std::string state{std::istreambuf_iterator<char>(text), std::istreambuf_iterator<char>()};
    EXPECT_NE(
        state.find(",unsimulated_time,spin_x,spin_y,spin_z,lifetime,temperature,tint_x,tint_y,tint_z,plain,color_x"),
        std::string::npos);
    std::vector<AttributeDescription> declared(shown.columns().begin(), shown.columns().begin() + 3);
    const detail::ParticleTable table = detail::parse_particle_table(state, "state.csv", declared);
    EXPECT_TRUE(table.errors.empty()) << table.errors[0];
    ASSERT_EQ(table.attributes.size(), 6U);  // the table declares those for colour and size
    ASSERT_EQ(table.particles.size(), simulation.particles().size());
    EXPECT_EQ(table.particles[0].attributes[1], (Vec3{7, 8, 9}));
    EXPECT_EQ(table.particles[0].attributes[0].x, 450.0);
}

TEST(EmitterScene, UndeclaredColumnsAndValuesOutOfRangeAreRefused) {
    const auto errors = [](const char* text) {
        const detail::ParticleTable table =
            detail::parse_particle_table(text, "t.csv", {{"heat", 1, {}}, {"wind", 3, {}}});
        return table.errors.empty() ? std::string() : table.errors[0];
    };
    EXPECT_EQ(errors("x,y,z,heat,wind_x,wind_y,wind_z\n1,2,3,4,5,6,7\n"), "");
    EXPECT_NE(errors("x,y,z,haet\n").find("unknown column \"haet\", did you mean \"heat\"?"), std::string::npos);
    EXPECT_NE(errors("x,y,z,wind\n").find("unknown column \"wind\""), std::string::npos);
    EXPECT_NE(errors("x,y,z,heat_x\n").find("unknown column"), std::string::npos);
    EXPECT_NE(errors("x,y,z,opacity\n1,2,3,2\n").find("attribute \"opacity\", expected a number from 0 to 1"),
              std::string::npos);
    EXPECT_NE(errors("x,y,z,heat,heat\n").find("appears twice"), std::string::npos);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
