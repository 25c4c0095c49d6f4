#include "run/run_writer.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/dynamics/forces.h"
#include "run/example_frames.h"
#include "run/run_folder.h"
#include "run/vtp_reader.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::TemporaryFolder;

// Particles fall on a floor with a tetrahedron on it for ten steps.
SimulationSetup falling_particles(bool totals = true) {
    SimulationSetup setup;
    setup.options.time_step = 0.1;
    setup.options.duration = 1.0;
    setup.options.triangle_totals = totals;
    setup.forces.push_back(make_gravity({0, 0, -10}));
    setup.materials.emplace_back();
    setup.materials[0].restitution = 0.5;
    setup.colliders.push_back({"floor", PlaneShape{}, 0});
    setup.colliders.push_back(
        {"block", MeshShape{std::make_shared<TriangleMesh>(test::example_mesh()), {}, "", {}}, 0});
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

TEST(RunWriter, RunLeavesFramesCollidersInfoAndSummary) {
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

TEST(RunWriter, RunThatJustBeganCanBeOpened) {
    const TemporaryFolder folder;
    Simulation simulation(falling_particles());
    RunWriter writer(folder.path(""), {}, simulation, {});
    EXPECT_EQ(hits_of(read_vtp(folder.path(collider_file_name(1, "block")))), 0);
    EXPECT_TRUE(std::filesystem::exists(folder.path(kColliderSeriesFile)));
    EXPECT_TRUE(std::filesystem::exists(folder.path(kRunInfoFile)));
    EXPECT_FALSE(std::filesystem::exists(folder.path(kSummaryFile)));
}

TEST(RunWriter, FinalStateIsOneFrameEvenIfItWasJustWritten) {
    const TemporaryFolder folder;
    Simulation simulation(falling_particles());
    RunWriter writer(folder.path(""), {}, simulation, {});
    writer.write_frame(simulation);
    writer.write_frame(simulation);
    EXPECT_EQ(writer.finish(simulation).frames, 1U);
}

TEST(RunWriter, CollidersHaveNoTotalsIfTheSimulationKeepsNone) {
    const TemporaryFolder folder;
    Simulation simulation(falling_particles(false));
    RunWriter writer(folder.path(""), {}, simulation, {});
    while (!simulation.finished()) simulation.step();
    (void)writer.finish(simulation);
    for (const auto& file : open_run_folder(folder.path("")).colliders) {
        const VtkPolyData collider = read_vtp(file);
        for (const char* totals : {"hits", "impulse", "lasting_impulse"}) {
            EXPECT_EQ(find_array(collider.cell_arrays, totals), nullptr) << totals;
        }
    }
}

// Returns the contents of all files of a folder by name.
std::map<std::string, std::string> files_of(const TemporaryFolder& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path(""))) {
        const std::string name = entry.path().filename().string();
        files[name] = folder.read(name);
    }
    return files;
}

TEST(RunWriter, BackgroundAndSynchronousModesWriteTheSameBytes) {
    std::map<std::string, std::string> files[2];
    for (const auto mode : {WriterThread::Mode::background, WriterThread::Mode::synchronous}) {
        const TemporaryFolder folder;
        SimulationSetup setup = falling_particles();
        setup.options.record_contacts = true;
        Simulation simulation(std::move(setup));
        RunWriter writer(folder.path(""), {}, simulation, {}, std::nullopt, mode);
        for (writer.write_frame(simulation); !simulation.finished(); writer.write_frame(simulation)) {
            simulation.step();
            writer.add_step(simulation);
        }
        RunSummary summary = writer.finish(simulation);
        EXPECT_GT(summary.output_seconds, 0.0);
        EXPECT_EQ(summary.output_seconds, writer.output_seconds());
        summary.output_seconds = 0.0;
        writer.write_summary(summary);
        files[mode == WriterThread::Mode::background ? 0 : 1] = files_of(folder);
    }
    EXPECT_EQ(files[0].size(), 29U);  // 2 x 11 frames, 3 series, 2 colliders, run.json, summary.json
    ASSERT_EQ(files[0].size(), files[1].size());
    for (const auto& [name, bytes] : files[0]) EXPECT_EQ(bytes, files[1][name]) << name;
}

TEST(RunWriter, FailedFrameEndsTheRunWithOneLineEvenWithoutLaterFrames) {
    for (const auto mode : {WriterThread::Mode::background, WriterThread::Mode::synchronous}) {
        const TemporaryFolder folder;
        Simulation simulation(falling_particles());
        RunWriter writer(folder.path(""), {}, simulation, {}, std::nullopt, mode);
        std::filesystem::remove_all(folder.path(""));
        std::string message;
        try {
            writer.write_frame(simulation);
            // The thread may write the frame late, but some step reports the error.
            for (;;) writer.add_step(simulation);
        } catch (const RunError& error) {
            message = error.what();
        }
        EXPECT_NE(message.find(frame_file_name(0)), std::string::npos) << message;
        EXPECT_NE(message.find("cannot create the file"), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_THROW((void)writer.finish(simulation), RunError);
    }
}

TEST(RunWriter, CheckpointNamesOnlyFramesThatAreCompleteOnDisk) {
    const TemporaryFolder folder;
    SimulationSetup setup = falling_particles();
    setup.options.record_contacts = true;
    Simulation simulation(std::move(setup));
    RunWriter writer(folder.path(""), {}, simulation, {});
    for (std::size_t frames = 1; !simulation.finished(); ++frames) {
        simulation.step();
        writer.add_step(simulation);
        writer.write_frame(simulation);
        writer.write_checkpoint(simulation, 7, 1.5);
        SimulationSetup again = falling_particles();
        again.options.record_contacts = true;
        Simulation resumed(std::move(again));
        const Checkpoint checkpoint = read_checkpoint(folder.path(kCheckpointFile), 7, resumed);
        EXPECT_EQ(resumed.step_index(), simulation.step_index());
        EXPECT_EQ(checkpoint.frames.size(), frames);
        EXPECT_EQ(checkpoint.contacts.size(), frames);
        EXPECT_GT(checkpoint.output_seconds, 0.0);
        EXPECT_LE(checkpoint.output_seconds, writer.output_seconds());
        for (const PvdEntry& entry : checkpoint.frames) EXPECT_EQ(read_vtp(folder.path(entry.file)).points.size(), 50U);
        for (const PvdEntry& entry : checkpoint.contacts) EXPECT_NO_THROW((void)read_vtp(folder.path(entry.file)));
        EXPECT_EQ(folder.read(kParticleSeriesFile), pvd_text(checkpoint.frames));
    }
}

TEST(RunWriter, ResumedRunCountsTheEarlierOutput) {
    const TemporaryFolder folder;
    Simulation simulation(falling_particles());
    Checkpoint earlier;
    earlier.output_seconds = 1000.0;
    const RunWriter writer(folder.path(""), {}, simulation, {}, earlier);
    EXPECT_GT(writer.output_seconds(), 1000.0);
}

// One particle has a force that fails, one is born with an invalid velocity, and one is extremely fast.
TEST(RunWriter, FrozenParticleIsCountedMarkedAndLeftOutOfTheEnergy) {
    const TemporaryFolder folder;
    SimulationSetup setup = falling_particles();
    setup.particles.resize(4);
    for (Particle& particle : setup.particles) particle.velocity = {0, 0, 2};
    setup.forces.clear();
    setup.forces.push_back(make_force([](const ForceInput& input) {
        const bool broken = input.id == 1 || (input.id == 2 && input.time > 0.25);
        return Vec3(0, input.id == 3 ? 1e300 : 0.0, broken ? 1e300 : 0.0);
    }));
    Simulation simulation(std::move(setup));
    EXPECT_EQ(simulation.statistics().frozen, 0U);
    RunWriter writer(folder.path(""), {}, simulation, {});
    while (!simulation.finished()) {
        simulation.step();
        writer.write_frame(simulation);
    }
    const RunSummary summary = writer.finish(simulation);
    writer.write_summary(summary);
    EXPECT_EQ(summary.statistics.frozen, 3U);
    EXPECT_EQ(summary.kinetic_energy, 2.0);  // energy of the only flying particle
    const auto json = nlohmann::json::parse(folder.read(kSummaryFile));
    EXPECT_EQ(json["frozen"], 3);
    EXPECT_EQ(json["kinetic_energy"], 2.0);
    const auto frozen_in = [&](std::uint64_t step) {
        const VtkPolyData frame = read_vtp(folder.path(frame_file_name(step)));
        return std::get<std::vector<std::uint8_t>>(find_array(frame.point_arrays, "frozen")->values);
    };
    EXPECT_EQ(frozen_in(2), (std::vector<std::uint8_t>{0, 1, 0, 1}));
    EXPECT_EQ(frozen_in(10), (std::vector<std::uint8_t>{0, 1, 1, 1}));
}

TEST(RunWriter, FramesOfASceneWithSpheresAlwaysHaveTheirSpin) {
    for (const double radius : {0.0, 0.05}) {
        const TemporaryFolder folder;
        SimulationSetup setup = falling_particles();
        setup.particles.clear();
        EmitterDescription emitter;
        emitter.shape = PointShape{{0, 0, 2}};
        emitter.rate = {20.0, 0.0};
        emitter.start = 0.5;
        emitter.radius = {radius, 0.0};
        setup.emitters.push_back(emitter);
        Simulation simulation(std::move(setup));
        EXPECT_EQ(simulation.has_spheres(), radius > 0.0);
        RunWriter writer(folder.path(""), {}, simulation, {});
        for (writer.write_frame(simulation); !simulation.finished(); writer.write_frame(simulation)) simulation.step();
        (void)writer.finish(simulation);
        for (const FrameFile& file : open_run_folder(folder.path("")).frames) {
            const VtkPolyData frame = read_vtp(file.path);
            EXPECT_EQ(find_array(frame.point_arrays, "spin") != nullptr, radius > 0.0) << file.step;
            EXPECT_NE(find_array(frame.point_arrays, "unsimulated_time"), nullptr);
            EXPECT_NE(find_array(frame.point_arrays, "resting"), nullptr);
        }
    }
}

TEST(ParticleRegion, RegionContainsParticlesEmittersAndBounds) {
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
    scene.camera.emplace();
    scene.camera->position = {1, 2, 3};
    scene.camera->target = {0, 0, 0};
    scene.camera->up = Vec3{0, 0, 4};
    scene.camera->field_of_view_degrees = 40.0;
    EXPECT_EQ(run_info_of(scene).up, Vec3(0, 0, 1));
    EXPECT_EQ(run_info_of(scene).camera->field_of_view_degrees, 40.0);
}

// Returns a falling plate and an infinite floor. The floor is drawn as large as the scene is at the start.
SimulationSetup falling_plate() {
    SimulationSetup setup = falling_particles();
    FrameDescription frame;
    frame.name = "plate";
    frame.translation = {20, 0, 40};
    frame.is_driven = true;
    setup.frames = std::make_shared<const FrameTree>(std::vector<FrameDescription>{frame});
    BodyDescription body;
    body.frame = "plate";
    body.inertia = {1, 1, 1, 0, 0, 0};
    setup.bodies.push_back(body);
    setup.colliders.push_back({"plate", CuboidShape{{1, 1, 0.1}, {}}, 0, "plate"});
    return setup;
}

TEST(RunWriter, ResumedRunDrawsPlanesAsLargeAsAnUninterruptedOne) {
    const TemporaryFolder whole;
    const TemporaryFolder resumed;
    SimulationSetup setup = falling_plate();
    Box3 region = particle_region(setup);
    Simulation simulation(std::move(setup));
    {
        RunWriter writer(whole.path(""), {}, simulation, region);
        writer.write_frame(simulation);
        simulation.advance(8);
        writer.write_checkpoint(simulation, 7, 0.0);
        std::filesystem::copy_file(whole.path(kCheckpointFile), resumed.path(kCheckpointFile));
        while (!simulation.finished()) simulation.step();
        (void)writer.finish(simulation);
    }
    Simulation again(falling_plate());
    region.include(collider_region(again));
    const std::optional<Checkpoint> checkpoint = read_checkpoint(resumed.path(kCheckpointFile), 7, again);
    RunWriter writer(resumed.path(""), {}, again, region, checkpoint);
    while (!again.finished()) again.step();
    (void)writer.finish(again);
    const std::string floor = collider_file_name(0, "floor");
    EXPECT_EQ(read_vtp(resumed.path(floor)).points, read_vtp(whole.path(floor)).points);
}

// A run that is killed right after removing the files after a checkpoint must leave lists without them.
TEST(RunWriter, KeptFilesAreListedBeforeOthersAreRemoved) {
    const TemporaryFolder folder;
    (void)folder.write(kParticleSeriesFile, pvd_text({{0.0, 0, frame_file_name(0)}, {1.0, 0, frame_file_name(10)}}));
    Checkpoint checkpoint;
    checkpoint.frames = {{0.0, 0, frame_file_name(0)}};
    list_kept_files(folder.path(""), checkpoint);
    EXPECT_EQ(folder.read(kParticleSeriesFile), pvd_text(checkpoint.frames));
    EXPECT_FALSE(std::filesystem::exists(folder.path(kContactSeriesFile)));
}

TEST(Checkpoint, PipeInPlaceOfAPartDoesNotBlock) {
    const TemporaryFolder folder;
    Simulation simulation(falling_particles());
    Checkpoint checkpoint;
    checkpoint.scene = 7;
    checkpoint.parts = {{checkpoint_part_name(0, 0), 1}};
    write_checkpoint(folder.path(kCheckpointFile), checkpoint, simulation);
    ASSERT_EQ(::mkfifo(folder.path(checkpoint_part_name(0, 0)).c_str(), 0600), 0);
    try {
        (void)read_checkpoint(folder.path(kCheckpointFile), 7, simulation);
        ADD_FAILURE() << "it was read";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("is not a regular file"), std::string::npos) << error.what();
    }
}

TEST(Checkpoint, OnlyFilesOfARunAreListed) {
    const TemporaryFolder folder;
    Simulation simulation(falling_particles());
    for (const char* name : {"../particles_000001.vtp", "/etc/passwd", "contacts_000001.vtp"}) {
        Checkpoint checkpoint;
        checkpoint.scene = 7;
        checkpoint.frames = {{0.0, 0, name}};
        write_checkpoint(folder.path(kCheckpointFile), checkpoint, simulation);
        EXPECT_THROW((void)read_checkpoint(folder.path(kCheckpointFile), 7, simulation), InputError) << name;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
