// No particle leaks out of tumbling meshes. Points and spheres start inside a mesh, with gravity, friction and
// persistent contact. They stay inside, as computed in the mesh's own frame. The verifier checks every segment
// independently.
//
// A long run has three hundred particles and four hundred more steps.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "claims/hard_meshes.h"
#include "claims/moving_scene.h"
#include "ricochet/core/frame_tree.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/shared_meshes.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

class TumblingMesh : public ::testing::TestWithParam<std::string> {};

TEST_P(TumblingMesh, LosesNoParticleThatStartsInside) {
    const auto mesh = mesh_by_name(GetParam());
    if (!mesh) GTEST_SKIP() << missing_mesh_sentence(GetParam());
    const Box3 box = bounds(mesh->mesh);
    const double size = box.diagonal();
    const auto inside = std::make_shared<const TriangleMesh>(mesh->mesh);
    for (const auto& [radius, spin, step] :
         {std::tuple{0.0, 300.0, 0.01}, std::tuple{0.004, 90.0, 0.01}, std::tuple{0.002, 1500.0, 0.02}}) {
        SimulationSetup setup;
        setup.options.time_step = step;
        setup.options.duration = step * (test::is_long_run() ? 440 : 40);
        setup.options.verify = true;
        setup.options.seed = 11;
        setup.materials = {{"", 0.6, 0.3}};
        setup.forces.push_back(make_gravity({0, 0, -9.81 * size}));
        setup.frames = std::make_shared<const FrameTree>(std::vector{tumbling(size, spin)});
        setup.colliders = {{"mesh", MeshShape{inside, {}, "", {}}, 0, "tumbling"}};
        EmitterDescription emitter;
        emitter.shape = MeshVolumeShape{inside};
        emitter.frames = setup.frames;
        emitter.burst = static_cast<std::uint64_t>(test::scaled(test::is_long_run() ? 300 : 40));
        emitter.speed = {size, 0.5 * size};
        emitter.radius = {radius * size, 0.0};
        setup.emitters.push_back(std::move(emitter));
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        const SimulationStatistics& statistics = simulation.statistics();
        EXPECT_EQ(statistics.violations, 0U) << radius << " " << spin;
        EXPECT_EQ(statistics.energy_violations, 0U) << radius << " " << spin;
        EXPECT_EQ(statistics.frozen, 0U);
        EXPECT_GT(statistics.contacts, statistics.emitted);
    }
}

std::string name_of_mesh(const ::testing::TestParamInfo<std::string>& mesh) {
    return mesh.param.substr(0, mesh.param.find_first_of(".-"));
}

INSTANTIATE_TEST_SUITE_P(Made, TumblingMesh, ::testing::Values("box", "sphere", "star"), name_of_mesh);
INSTANTIATE_TEST_SUITE_P(Real, TumblingMesh, ::testing::Values("spot.obj", "bunny-closed.off"), name_of_mesh);

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
