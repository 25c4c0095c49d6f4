#include "ricochet/io/run_writer.h"

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <utility>

#include "geometry/temporary_folder.h"
#include "io/example_frames.h"
#include "ricochet/core/error.h"
#include "ricochet/io/run_files.h"
#include "ricochet/io/run_folder.h"
#include "ricochet/io/vtk_reader.h"

namespace ricochet {
namespace {

using test::TemporaryFolder;

// Particles fall on a floor with a tetrahedron on it for ten steps.
SimulationSetup falling_particles(bool totals = true) {
    SimulationSetup setup;
    setup.options.time_step = 0.1;
    setup.options.duration = 1.0;
    setup.options.triangle_totals = totals;
    setup.forces.push_back(make_gravity({0, 0, -10}));
    setup.materials = {{"plain", 0.5, 0.0}};
    setup.colliders.push_back({"floor", PlaneShape{}, 0});
    setup.colliders.push_back({"block", MeshShape{std::make_shared<TriangleMesh>(test::example_mesh()), {}, ""}, 0});
    for (int i = 0; i < 50; ++i) {
        Particle particle;
        particle.position = {0.02 * i + 0.003, 0.1, 1.5 + 0.01 * i};
        setup.particles.push_back(particle);
    }
    return setup;
}

std::int64_t hits_of(const VtkPolyData& collider) {
    const auto& hits = std::get<std::vector<std::int64_t>>(find_array(collider.cell_arrays, "hits")->values);
    return std::accumulate(hits.begin(), hits.end(), std::int64_t{0});
}

TEST(RunWriter, LeavesFramesCollidersInfoAndSummary) {
    const TemporaryFolder folder;
    SimulationSetup setup = falling_particles();
    const Box3 region = particle_region(setup);
    Simulation simulation(std::move(setup));
    RunWriter writer(folder.path(""), {}, simulation, region);
    for (writer.write_frame(simulation); !simulation.finished();) {
        simulation.step();
        if (simulation.step_index() % 4 == 0) writer.write_frame(simulation);
    }
    RunSummary summary = writer.finish(simulation);
    writer.write_summary(summary);

    const RunFolder run = open_run_folder(folder.path(""));
    std::vector<std::uint64_t> steps;
    for (const FrameFile& frame : run.frames) steps.push_back(frame.step);
    EXPECT_EQ(steps, (std::vector<std::uint64_t>{0, 4, 8, 10}));
    EXPECT_EQ(summary.frames, 4U);
    EXPECT_EQ(read_vtp(run.frames.back().path).time, simulation.time());
    ASSERT_EQ(run.info.colliders.size(), 2U);
    EXPECT_EQ(run.info.colliders[1].file, run.colliders[1].filename());

    EXPECT_GT(summary.colliders[0].hits, 0U);
    EXPECT_GT(summary.colliders[1].hits, 0U);
    EXPECT_EQ(summary.colliders[0].hits + summary.colliders[1].hits, simulation.statistics().contacts);
    EXPECT_LT(summary.colliders[0].impulse.z, 0.0);
    EXPECT_EQ(hits_of(read_vtp(run.colliders[1])), static_cast<std::int64_t>(summary.colliders[1].hits));
    const auto json = nlohmann::json::parse(folder.read(kSummaryFile));
    EXPECT_EQ(json["colliders"][1]["triangles"], 4);
    EXPECT_EQ(json["steps"], 10);
}

TEST(RunWriter, ARunThatJustBeganCanBeOpened) {
    const TemporaryFolder folder;
    Simulation simulation(falling_particles());
    RunWriter writer(folder.path(""), {}, simulation, {});
    EXPECT_EQ(hits_of(read_vtp(folder.path(collider_file_name(1, "block")))), 0);
    EXPECT_TRUE(std::filesystem::exists(folder.path(kColliderSeriesFile)));
    EXPECT_TRUE(std::filesystem::exists(folder.path(kRunInfoFile)));
    EXPECT_FALSE(std::filesystem::exists(folder.path(kSummaryFile)));
}

TEST(RunWriter, TheFinalStateIsOneFrameEvenWhenItWasJustWritten) {
    const TemporaryFolder folder;
    Simulation simulation(falling_particles());
    RunWriter writer(folder.path(""), {}, simulation, {});
    writer.write_frame(simulation);
    writer.write_frame(simulation);
    EXPECT_EQ(writer.finish(simulation).frames, 1U);
}

TEST(RunWriter, CollidersHaveNoTotalsWhenTheSimulationKeepsNone) {
    const TemporaryFolder folder;
    Simulation simulation(falling_particles(false));
    RunWriter writer(folder.path(""), {}, simulation, {});
    while (!simulation.finished()) simulation.step();
    (void)writer.finish(simulation);
    for (const auto& file : open_run_folder(folder.path("")).colliders) EXPECT_TRUE(read_vtp(file).cell_arrays.empty());
}

TEST(ParticleRegion, HoldsParticlesEmittersAndBounds) {
    SimulationSetup setup;
    EXPECT_TRUE(particle_region(setup).empty());
    Particle particle;
    particle.position = {5, 0, 0};
    setup.particles.push_back(particle);
    EmitterDescription emitter;
    emitter.shape = SphereShape{{0, 0, 10}, 2.0, false};
    setup.emitters.push_back(emitter);
    const Box3 region = particle_region(setup);
    EXPECT_EQ(region.lower, Vec3(-2, -2, 0));
    EXPECT_EQ(region.upper, Vec3(5, 2, 12));
}

TEST(RunInfo, UpIsAgainstGravityAlongTheNearestAxis) {
    SceneDescription scene;
    EXPECT_EQ(run_info_of(scene).up, Vec3(0, 0, 1));
    scene.setup.forces.push_back(make_linear_drag(0.1));
    scene.setup.forces.push_back(make_gravity({0.5, -9.81, 0}));
    EXPECT_EQ(run_info_of(scene).up, Vec3(0, 1, 0));
    scene.camera = CameraDescription{{1, 2, 3}, {0, 0, 0}, Vec3{0, 0, 4}, 40.0};
    EXPECT_EQ(run_info_of(scene).up, Vec3(0, 0, 1));
    EXPECT_EQ(run_info_of(scene).camera->fov_degrees, 40.0);
}

}  // namespace
}  // namespace ricochet
