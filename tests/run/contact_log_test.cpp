#include "run/frame_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "ricochet/core/parallel.h"
#include "run/run_folder.h"
#include "run/run_writer.h"
#include "run/vtp_reader.h"
#include "support/counts.h"
#include "support/random_draws.h"
#include "support/simple_meshes.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::scaled;
using test::TemporaryFolder;

constexpr std::uint64_t kSeed = 4711;

SimulationSetup logged_setup(double time_step, double duration) {
    SimulationSetup setup;
    setup.options.time_step = time_step;
    setup.options.duration = duration;
    setup.options.record_contacts = true;
    setup.materials.emplace_back();
    return setup;
}

void add_particle(SimulationSetup& setup, const Vec3& position, const Vec3& velocity, double mass = 1.0,
                  double radius = 0.0) {
    Particle particle;
    particle.position = position;
    particle.velocity = velocity;
    particle.mass = mass;
    particle.radius = radius;
    setup.particles.push_back(particle);
}

ColliderDescription mesh_collider(const std::string& name, TriangleMesh mesh, const Placement& placement = {}) {
    MeshShape shape;
    shape.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
    shape.placement = placement;
    return {name, std::move(shape), 0};
}

// Points and small balls of different masses in a mirrored and rotated box. The box contains a rough ball, and a plane
// cuts its floor. There is no friction, and every rebound loses a little energy.
SimulationSetup gas(int count) {
    SimulationSetup setup = logged_setup(0.02, 0.5);
    setup.materials[0].restitution = 0.95;
    Placement placement;
    placement.position = {100, -50, 0.25};
    placement.rotation_axis = {1, 2, 3};
    placement.rotation_degrees = 40.0;
    placement.scale = {1, -1, 1.5};
    setup.colliders.push_back(mesh_collider("box", testing::box_mesh({-1, -1, -1}, {1, 1, 1}), placement));
    setup.colliders.push_back(mesh_collider("core", testing::sphere_mesh({100, -50, 0.25}, 0.3, 2)));
    setup.colliders.push_back({"floor", PlaneShape{{0, 0, -0.2}, {0, 0, 2}}, 0});
    RandomSequence random(kSeed, 0, 0);
    for (int i = 0; i < count; ++i) {
        const Vec3 start = Vec3(100, -50, 0.25) + testing::scaled({random.unit_vector(), 0.4 + 0.3 * random.uniform()});
        const double radius = i % 3 == 0 ? 0.02 : 0.0;
        const double mass = 0.5 + random.uniform();
        const Vec3 velocity = testing::scaled({random.unit_vector(), 1.0 + 5.0 * random.uniform()});
        add_particle(setup, start, velocity, mass, radius);
    }
    return setup;
}

// Runs to the end with a frame every `every` steps.
void run_into(const std::filesystem::path& folder, SimulationSetup setup, std::uint64_t every = 4) {
    Simulation simulation(std::move(setup));
    RunWriter writer(folder, {}, simulation, {});
    for (writer.write_frame(simulation); !simulation.finished();) {
        simulation.step();
        writer.add_step(simulation);
        if (simulation.step_index() % every == 0) writer.write_frame(simulation);
    }
    (void)writer.finish(simulation);
}

std::map<std::uint64_t, VtkPolyData> contact_files(const TemporaryFolder& folder) {
    std::map<std::uint64_t, VtkPolyData> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path(""))) {
        if (const auto step = step_of_contact_file(entry.path().filename().string())) {
            files.emplace(*step, read_vtp(entry.path()));
        }
    }
    return files;
}

template <typename T>
const std::vector<T>& column(const VtkPolyData& file, std::string_view name) {
    const VtkArray* array = find_array(file.point_arrays, name);
    if (array == nullptr) throw std::logic_error("no column " + std::string(name));
    return std::get<std::vector<T>>(array->values);
}

std::size_t count_of(const std::string& text, std::string_view word) {
    std::size_t count = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
    return count;
}

TEST(ContactLog, DropIsLoggedAsInItsClosedForm) {
    const TemporaryFolder folder;
    SimulationSetup setup = logged_setup(1.0, 1.0);
    setup.forces.push_back(make_gravity({0, 0, -10}));
    setup.materials[0].restitution = 0.5;
    setup.colliders.push_back({"floor", PlaneShape{{0, 0, 1}, {0, 0, 1}}, 0});
    add_particle(setup, {2, 3, 4.45}, {1, 0, 0}, 2.0, 0.25);  // falls 3.2 m in 0.8 s, to 8 m/s
    run_into(folder.path(""), std::move(setup));
    const auto files = contact_files(folder);
    ASSERT_EQ(files.size(), 2U);
    EXPECT_TRUE(files.at(0).points.empty());
    const VtkPolyData& file = files.at(1);
    ASSERT_EQ(file.points.size(), 1U);
    EXPECT_EQ(file.time, 1.0);
    const double tiny = 1e-13;
    EXPECT_LE(length(file.points[0] - Vec3(2.8, 3, 1)), tiny);
    EXPECT_NEAR(column<double>(file, "time")[0], 0.8, tiny);
    EXPECT_EQ(column<std::int64_t>(file, "particle")[0], 0);
    EXPECT_EQ(column<std::uint32_t>(file, "collider")[0], 0U);
    EXPECT_EQ(column<std::int64_t>(file, "triangle")[0], -1);
    EXPECT_EQ(column<Vec3>(file, "barycentric")[0], Vec3());
    EXPECT_EQ(column<Vec3>(file, "normal")[0], Vec3(0, 0, 1));
    EXPECT_LE(length(column<Vec3>(file, "velocity_before")[0] - Vec3(1, 0, -8)), tiny);
    EXPECT_LE(length(column<Vec3>(file, "velocity_after")[0] - Vec3(1, 0, 4)), tiny);
    EXPECT_LE(length(column<Vec3>(file, "impulse")[0] - Vec3(0, 0, -24)), 10 * tiny);
    EXPECT_EQ(column<double>(file, "radius")[0], 0.25);
}

// The second sphere is at rest. The gap of 0.3 m takes 0.15 s. Then it falls back to the wall.
TEST(ContactLog, CollisionNamesBothSpheres) {
    const TemporaryFolder folder;
    SimulationSetup setup = logged_setup(1.0, 1.0);
    setup.options.particle_contacts.emplace();
    setup.colliders.push_back({"wall", PlaneShape{{-0.1, 0, 0}, {1, 0, 0}}, 0});
    add_particle(setup, {0.5, 0, 0}, {}, 3.0, 0.1);
    add_particle(setup, {0, 0, 0}, {2, 0, 0}, 1.0, 0.1);
    run_into(folder.path(""), std::move(setup));
    const auto files = contact_files(folder);
    const VtkPolyData& file = files.at(1);
    ASSERT_EQ(file.points.size(), 2U);
    const double tiny = 1e-13;
    EXPECT_EQ(column<std::int64_t>(file, "particle"), (std::vector<std::int64_t>{0, 1}));
    EXPECT_EQ(column<std::int64_t>(file, "other"), (std::vector<std::int64_t>{1, -1}));
    EXPECT_EQ(column<std::uint32_t>(file, "collider"), (std::vector<std::uint32_t>{0xFFFFFFFFU, 0}));
    EXPECT_EQ(column<std::int64_t>(file, "triangle")[0], -1);
    EXPECT_NEAR(column<double>(file, "time")[0], 0.15, tiny);
    EXPECT_NEAR(column<double>(file, "time")[1], 0.45, tiny);  // back at 1 m/s
    EXPECT_LE(length(file.points[0] - Vec3(0.4, 0, 0)), tiny);
    EXPECT_LE(length(column<Vec3>(file, "normal")[0] - Vec3(1, 0, 0)), tiny);
    EXPECT_LE(length(column<Vec3>(file, "velocity_after")[0] - Vec3(1, 0, 0)), tiny);
    EXPECT_LE(length(column<Vec3>(file, "impulse")[0] - Vec3(-3, 0, 0)), tiny);
    EXPECT_EQ(column<double>(file, "radius")[0], 0.1);
    TemporaryFolder without;
    run_into(without.path(""), gas(20));
    EXPECT_EQ(find_array(contact_files(without).begin()->second.point_arrays, "other"), nullptr);
}

TEST(ContactLog, SurfaceVelocityIsLoggedForMovingMaterials) {
    const TemporaryFolder folder;
    SimulationSetup setup = logged_setup(0.5, 1.0);
    setup.materials[0].friction = 0.1;
    setup.materials[0].motion.velocity = {1, 2, 3};  // along the surface: (1, 2, 0)
    setup.materials[0].motion.angular_velocity = {0, 0, 2};
    setup.colliders.push_back({"belt", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0});
    add_particle(setup, {2, 3, 1}, {0, 0, -1}, 1.0, 0.25);
    run_into(folder.path(""), std::move(setup));
    const auto files = contact_files(folder);
    EXPECT_TRUE(column<Vec3>(files.at(0), "surface_velocity").empty());
    const auto& velocities = column<Vec3>(files.at(2), "surface_velocity");
    ASSERT_EQ(velocities.size(), 1U);
    EXPECT_LE(length(velocities[0] - Vec3(1 - 6, 2 + 4, 0)), 1e-13);
}

TEST(ContactLog, EveryFileHasAllColumnsEvenWithoutImpacts) {
    const TemporaryFolder folder;
    run_into(folder.path(""), gas(std::max(50, scaled(200))));
    const auto files = contact_files(folder);
    EXPECT_EQ(files.size(), 8U);  // steps 0, 4, ..., 24 and 25
    std::vector<std::string> names;
    for (const auto& [step, file] : files) {
        std::vector<std::string> here;
        for (const VtkArray& array : file.point_arrays) {
            here.push_back(array.name);
            EXPECT_EQ(array.size(), file.points.size()) << array.name;
        }
        if (names.empty()) names = here;
        EXPECT_EQ(here, names) << step;
        EXPECT_NEAR(file.time, 0.02 * static_cast<double>(step), 1e-12);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"time", "particle", "collider", "triangle", "barycentric", "normal",
                                               "velocity_before", "velocity_after", "impulse", "radius"}));
    EXPECT_TRUE(files.at(0).points.empty());
    EXPECT_FALSE(files.at(4).points.empty());
    EXPECT_EQ(count_of(folder.read(kContactSeriesFile), "<DataSet"), files.size());
}

TEST(ContactLog, RowsAreSortedByTimeThenParticleAndBelongToTheirFile) {
    const TemporaryFolder folder;
    run_into(folder.path(""), gas(scaled(2000)));
    double from = 0.0;
    for (const auto& [step, file] : contact_files(folder)) {
        const auto& times = column<double>(file, "time");
        const auto& ids = column<std::int64_t>(file, "particle");
        for (std::size_t i = 0; i < times.size(); ++i) {
            EXPECT_GE(times[i], from - 1e-12);
            EXPECT_LE(times[i], file.time + 1e-12);
            if (i == 0) continue;
            EXPECT_LE(std::tie(times[i - 1], ids[i - 1]), std::tie(times[i], ids[i])) << step << ' ' << i;
        }
        from = file.time;
    }
}

// There is no friction and nothing ever rests, so the totals per triangle contain impacts only.
TEST(ContactLog, ImpulsesAndHitsAddUpToTheTotalsOfEveryTriangle) {
    const TemporaryFolder folder;
    run_into(folder.path(""), gas(scaled(2000)));
    std::vector<std::vector<Vec3>> impulse(3);
    std::vector<std::vector<std::int64_t>> rows(3);
    std::vector<VtkPolyData> colliders;
    for (const auto& [index, name] : {std::pair{0, "box"}, {1, "core"}, {2, "floor"}}) {
        colliders.push_back(read_vtp(folder.path(collider_file_name(static_cast<std::size_t>(index), name))));
        impulse[static_cast<std::size_t>(index)].resize(colliders.back().triangles.size());
        rows[static_cast<std::size_t>(index)].resize(colliders.back().triangles.size());
    }
    for (const auto& [step, file] : contact_files(folder)) {
        for (std::size_t i = 0; i < file.points.size(); ++i) {
            const auto collider = column<std::uint32_t>(file, "collider")[i];
            const auto triangle = column<std::int64_t>(file, "triangle")[i];
            EXPECT_EQ(triangle == -1, collider == 2U);
            const auto at = static_cast<std::size_t>(std::max<std::int64_t>(triangle, 0));
            impulse[collider].at(at) += column<Vec3>(file, "impulse")[i];
            ++rows[collider].at(at);
        }
    }
    std::int64_t hits_of_all = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        const auto& hits = std::get<std::vector<std::int64_t>>(find_array(colliders[c].cell_arrays, "hits")->values);
        const auto& totals = std::get<std::vector<Vec3>>(find_array(colliders[c].cell_arrays, "impulse")->values);
        for (std::size_t t = 0; t < (c == 2 ? 1 : totals.size()); ++t) {
            EXPECT_LE(length(impulse[c][t] - totals[t]), 1e-11 * (1.0 + length(totals[t]))) << c << ' ' << t;
            EXPECT_GE(rows[c][t], hits[t]) << c << ' ' << t;
            hits_of_all += hits[t];
        }
        EXPECT_GT(std::accumulate(rows[c].begin(), rows[c].end(), std::int64_t{0}), scaled(100)) << c;
    }
    EXPECT_GE(hits_of_all, scaled(2000));
}

TEST(ContactLog, BarycentricCoordinatesGiveThePointInTheCollidersFile) {
    const TemporaryFolder folder;
    run_into(folder.path(""), gas(scaled(2000)));
    const std::vector<VtkPolyData> colliders = {read_vtp(folder.path(collider_file_name(0, "box"))),
                                                read_vtp(folder.path(collider_file_name(1, "core")))};
    std::size_t checked = 0;
    for (const auto& [step, file] : contact_files(folder)) {
        for (std::size_t i = 0; i < file.points.size(); ++i) {
            const auto collider = column<std::uint32_t>(file, "collider")[i];
            if (collider == 2U) {
                EXPECT_NEAR(file.points[i].z, -0.2, 1e-13);
                continue;
            }
            const VtkPolyData& mesh = colliders[collider];
            const Triangle& t = mesh.triangles.at(static_cast<std::size_t>(column<std::int64_t>(file, "triangle")[i]));
            const Vec3 w = column<Vec3>(file, "barycentric")[i];
            EXPECT_GE(std::min({w.x, w.y, w.z}), 0.0);
            EXPECT_NEAR(w.x + w.y + w.z, 1.0, 1e-15);
            const Vec3 point = w.x * mesh.points[t[0]] + w.y * mesh.points[t[1]] + w.z * mesh.points[t[2]];
            EXPECT_LE(length(point - file.points[i]), 1e-12) << step << ' ' << i;
            EXPECT_NEAR(length(column<Vec3>(file, "normal")[i]), 1.0, 1e-15);
            ++checked;
        }
    }
    EXPECT_GT(checked, static_cast<std::size_t>(scaled(1000)));
}

// The corner of a box reverses a particle: three reflections at one time, with consecutive velocities.
TEST(ContactLog, ImpactInACornerHasARowForEachReflection) {
    const TemporaryFolder folder;
    SimulationSetup setup = logged_setup(1.0, 1.0);
    for (int axis = 0; axis < 3; ++axis) {
        PlaneShape wall;
        wall.normal = {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
        setup.colliders.push_back({"wall" + std::to_string(axis), wall, 0});
    }
    add_particle(setup, {0.5, 0.5, 0.5}, {-1, -1, -1}, 3.0);
    run_into(folder.path(""), std::move(setup));
    const VtkPolyData file = contact_files(folder).at(1);
    ASSERT_EQ(file.points.size(), 3U);
    EXPECT_EQ(column<std::uint32_t>(file, "collider"), (std::vector<std::uint32_t>{0, 1, 2}));
    const auto& before = column<Vec3>(file, "velocity_before");
    const auto& after = column<Vec3>(file, "velocity_after");
    EXPECT_EQ(before[0], Vec3(-1, -1, -1));
    EXPECT_EQ(after[0], before[1]);
    EXPECT_EQ(after[1], before[2]);
    EXPECT_EQ(after[2], Vec3(1, 1, 1));
    const auto& impulse = column<Vec3>(file, "impulse");
    EXPECT_EQ(impulse[0] + impulse[1] + impulse[2], Vec3(-6, -6, -6));
    const auto& times = column<double>(file, "time");
    EXPECT_TRUE(times[0] == times[1] && times[1] == times[2]);
}

// Both walls give impulses at once, and none of them may be missing.
TEST(ContactLog, SharpWedgeLosesNoImpulse) {
    SimulationSetup setup = logged_setup(1.0, 1.0);
    setup.colliders.push_back({"low", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0});
    setup.colliders.push_back({"high", PlaneShape{{0, 0, 0}, {0.5, 0, -1}}, 0});  // 27 degrees above the low one
    add_particle(setup, {0.5, 0, 0.125}, {-4, 0.5, -1});                          // straight into the edge
    Simulation simulation(std::move(setup));
    simulation.step();
    Vec3 given;
    for (const ContactRecord& record : simulation.contact_records()) {
        given += record.mass * (record.velocity_before - record.velocity_after);
    }
    EXPECT_EQ(simulation.contact_records().size(), 2U);
    EXPECT_LE(length(given - (Vec3(-4, 0.5, -1) - simulation.particles().velocity[0])), 1e-14);
    const Vec3 totals = simulation.triangle_totals(0).impulse[0] + simulation.triangle_totals(1).impulse[0];
    EXPECT_LE(length(given - totals), 1e-14);
}

TEST(ContactLog, CurvedCollidersHaveNoTrianglesAndThePointIsOnTheirSurface) {
    const TemporaryFolder folder;
    SimulationSetup setup = logged_setup(1.0, 1.0);
    setup.colliders.push_back({"ball", BallShape{0.5, {{1, 0, 0}, {0, 0, 1}, 0.0, {1, 1, 1}}}, 0});
    setup.colliders.push_back({"cuboid", CuboidShape{{2, 2, 2}, {{-4, 0, 0}, {0, 0, 1}, 0.0, {1, 1, 1}}}, 0});
    add_particle(setup, {-1, 0.3, 0}, {2, 0, 0}, 1.0, 0.1);
    add_particle(setup, {-1, 0.25, 0.5}, {-3, 0, 0}, 1.0, 0.1);
    Simulation simulation(std::move(setup));
    ContactLog log(folder.path(""), simulation);
    simulation.step();
    log.write(simulation);
    log.finish();
    const VtkPolyData file = contact_files(folder).at(1);
    ASSERT_EQ(file.points.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        if (column<std::uint32_t>(file, "collider")[i] == 0U) {
            EXPECT_EQ(column<std::int64_t>(file, "triangle")[i], -1);
            EXPECT_NEAR(length(file.points[i] - Vec3(1, 0, 0)), 0.5, 1e-15);
            EXPECT_LE(length(file.points[i] - Vec3(1, 0, 0) - 0.5 * column<Vec3>(file, "normal")[i]), 1e-12);
        } else {
            EXPECT_GE(column<std::int64_t>(file, "triangle")[i], 0);
            EXPECT_LE(length(file.points[i] - Vec3(-3, 0.25, 0.5)), 1e-14);
        }
    }
}

std::map<std::string, std::string> contact_bytes(const TemporaryFolder& folder) {
    std::map<std::string, std::string> bytes;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path(""))) {
        const std::string name = entry.path().filename().string();
        if (step_of_contact_file(name) || name == kContactSeriesFile) bytes[name] = folder.read(name);
    }
    return bytes;
}

TEST(ContactLog, BytesDoNotDependOnTheNumberOfThreads) {
    std::map<std::string, std::string> reference;
    for (const int threads : {1, 2, 7}) {
        const TemporaryFolder folder;
        const ThreadLimit limit(threads);
        run_into(folder.path(""), gas(scaled(5000)));
        const auto bytes = contact_bytes(folder);
        EXPECT_EQ(bytes.size(), 9U);
        if (reference.empty()) reference = bytes;
        EXPECT_TRUE(bytes == reference) << threads << " threads";
    }
}

TEST(ContactLog, FullMemoryIsWrittenBetweenFramesWithoutLoss) {
    const TemporaryFolder small;
    const TemporaryFolder large;
    for (const TemporaryFolder* folder : {&small, &large}) {
        Simulation simulation(gas(scaled(1000)));
        ContactLog log(folder->path(""), simulation, folder == &small ? 1 : ContactLog::kMostRows);
        while (!simulation.finished()) {
            simulation.step();
            log.add_step(simulation);
        }
        log.write(simulation);
        log.write(simulation);
        log.finish();
    }
    const auto parts = contact_files(small);
    const auto whole = contact_files(large);
    ASSERT_EQ(whole.size(), 1U);
    EXPECT_GT(parts.size(), 5U);
    std::vector<double> times;
    for (const auto& [step, file] : parts) {
        const auto& here = column<double>(file, "time");
        times.insert(times.end(), here.begin(), here.end());
    }
    EXPECT_EQ(times, column<double>(whole.begin()->second, "time"));
    EXPECT_EQ(count_of(small.read(kContactSeriesFile), "<DataSet"), parts.size());
}

TEST(ContactLog, InterruptedRunLeavesCompleteListedFiles) {
    const TemporaryFolder folder;
    {
        Simulation simulation(gas(scaled(500)));
        RunWriter writer(folder.path(""), {}, simulation, {});
        for (writer.write_frame(simulation); !simulation.finished();) {
            simulation.step();
            writer.write_frame(simulation);
        }
    }
    const auto files = contact_files(folder);
    EXPECT_GE(files.size(), 20U);
    const std::string list = folder.read(kContactSeriesFile);
    for (const auto& [step, file] : files) EXPECT_NE(list.find(contact_file_name(step)), std::string::npos) << step;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path(""))) {
        EXPECT_EQ(entry.path().string().find("partial"), std::string::npos) << entry.path();
    }
}

TEST(ContactLog, LogIsWrittenOnRequestOnlyAndRefusesToSkipSteps) {
    const TemporaryFolder folder;
    SimulationSetup quiet = gas(10);
    quiet.options.record_contacts = false;
    run_into(folder.path(""), std::move(quiet));
    EXPECT_TRUE(contact_bytes(folder).empty());
    SimulationSetup again = gas(10);
    again.options.record_contacts = false;
    EXPECT_THROW(ContactLog(folder.path(""), Simulation(std::move(again))), std::logic_error);

    Simulation simulation(gas(10));
    ContactLog log(folder.path(""), simulation);
    simulation.step();
    simulation.step();
    EXPECT_THROW(log.add_step(simulation), std::logic_error);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
