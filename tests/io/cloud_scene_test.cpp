// The key "cloud" of emitters: its effect, and one-line errors for invalid values.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "ricochet/io/frames.h"
#include "ricochet/io/scene.h"
#include "ricochet/io/vtk.h"

namespace ricochet {
namespace RICOCHET_FILE {

std::string scene_with(const std::string& child, const std::string& keys = "", const std::string& simulation = "") {
    return R"({"ricochet": 1, "simulation": {"time_step": 0.01, "duration": 1)" + simulation + R"(},
        "emitters": [{"name": "cores", "type": "point", "burst": 1},
                     {"name": "swarm", "type": "child", "parent": "cores", )" +
           child + "}]" + keys + "}";
}

std::string error_of(const std::string& text) {
    try {
        (void)parse_scene(text, "s.json");
    } catch (const SceneError& error) {
        EXPECT_EQ(error.messages().size(), 1U) << error.what();
        return error.messages()[0];
    }
    return "";
}

TEST(CloudScene, KeysSetTheRuleAndTheShapeOfThePositions) {
    const auto scene = parse_scene(scene_with(R"("on": "birth", "count": 5, "cloud": {"type": "sphere", "radius": 0.5,
        "surface": true, "turning": [0, 0, 3], "pull": 80, "damping": 6, "parent_ends": "die"})"),
                                   "s.json");
    const EmitterDescription& emitter = scene.setup.emitters[1];
    ASSERT_TRUE(is_cloud(emitter));
    EXPECT_EQ(emitter.parent->on, BirthEvent::birth);
    EXPECT_FALSE(emitter.parent->share);
    EXPECT_EQ(emitter.parent->cloud->turning, Vec3(0, 0, 3));
    EXPECT_EQ(emitter.parent->cloud->pull, 80.0);
    EXPECT_EQ(emitter.parent->cloud->damping, 6.0);
    EXPECT_EQ(emitter.parent->cloud->end, CloudEnd::die);
    ASSERT_TRUE(std::holds_alternative<SphereShape>(emitter.shape));
    EXPECT_TRUE(std::get<SphereShape>(emitter.shape).surface);
}

TEST(CloudScene, ImpactsOfALivingParentDoNotShareIt) {
    const auto scene = parse_scene(scene_with(R"("on": "impact", "cloud": {"type": "point"})"), "s.json");
    EXPECT_FALSE(scene.setup.emitters[1].parent->share);
}

TEST(CloudScene, InvalidCloudsAreRefusedInOneLine) {
    const std::string on = R"("on": "birth", )";
    const std::string point = on + R"("cloud": {"type": "point"})";
    const std::vector<std::pair<std::string, std::string>> wrongs = {
        {scene_with(on + R"("cloud": {"radius": 1})"), "emitters[1].cloud"},
        {scene_with(on + R"("cloud": {"type": "mesh"})"), R"(found "mesh")"},
        {scene_with(on + R"("cloud": {"type": "point", "pull": -1})"), "emitters[1].cloud.pull: found -1"},
        {scene_with(on + R"("cloud": {"type": "point", "parent_ends": "stay"})"), R"(expected one of "free", "die")"},
        {scene_with(on + R"("cloud": true)"), "expected an object"},
        {scene_with(R"("on": "death", "cloud": {"type": "point"})"), "a parent that has ended leads no cloud"},
        {scene_with(on + R"("inherit_velocity": 0.5, "cloud": {"type": "point"})"), "all of their parent's velocity"},
        {scene_with(on + R"("frame": "f", "cloud": {"type": "point"})"), R"(or a "cloud")"},
        {scene_with(on + R"("cloud": {"type": "point", "turning": [0, 0, 2000]})"), "take a shorter time step"},
        {scene_with(point, "", R"(, "response": "penalty")"), R"(the response "penalty")"},
        {scene_with(point, R"(, "particle_contacts": {"restitution": 1})"), "particle_contacts"},
        {scene_with(point, R"(, "particles": [{"position": [0, 0, 0]}, {"position": [1, 0, 0]}],
            "springs": [{"type": "list", "springs": [{"first": 0, "second": 1, "stiffness": 1}]}])"),
         "springs"},
        {R"({"ricochet": 1, "simulation": {"time_step": 0.01, "duration": 1}, "emitters": [
            {"type": "point", "burst": 1, "cloud": {"type": "point"}}]})",
         "belongs to \"child\""}};
    for (const auto& [text, message] : wrongs) {
        EXPECT_NE(error_of(text).find(message), std::string::npos) << text << '\n' << error_of(text);
    }
}

TEST(CloudScene, FramesStoreTheParentOfEachParticle) {
    Simulation simulation(
        parse_scene(scene_with(R"("on": "birth", "count": 2, "cloud": {"type": "point"})"), "s.json").setup);
    simulation.step();
    VtkPolyData frame = particle_frame(simulation.particles(), simulation.time());
    add_cloud_parents(frame, simulation.particles(), simulation.cloud_parents().value());
    const VtkArray* const parents = find_array(frame.point_arrays, "cloud_parent");
    ASSERT_NE(parents, nullptr);
    EXPECT_EQ(std::get<std::vector<std::int64_t>>(parents->values), (std::vector<std::int64_t>{-1, 0, 0}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
