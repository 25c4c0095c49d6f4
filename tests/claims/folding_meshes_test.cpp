// Deforming meshes temporarily leave no space for particles. The particles stall, and continue when there is space
// again.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "claims/deforming_scene.h"
#include "claims/winding.h"
#include "ricochet/core/random.h"
#include "ricochet/core/transform.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/simple_meshes.h"
#include "support/simulations.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

/// Runs to the end. Returns the number of particle steps that were pinched later than `time`, in s.
std::uint64_t squeezed_after(double time, Simulation& simulation) {
    std::optional<std::uint64_t> before;
    while (!simulation.finished()) {
        if (!before && simulation.time() >= time) before = simulation.statistics().squeezed;
        simulation.step();
    }
    return simulation.statistics().squeezed - before.value_or(0);
}

/// Returns a plate beside the wall x = 0. The plate approaches the wall up to a distance of `gap` at 1 s and returns.
/// It is a deforming mesh or a moving body.
SimulationSetup pinching(double gap, bool deforms, double restitution, double time_step) {
    SimulationSetup setup = setup_of(time_step, 3.0, {"", restitution, 0.0}, {0, 0, -0.05});
    setup.options.verify = true;
    TriangleMesh plate = sheet(1.0, 2);
    for (Vec3& vertex : plate.vertices) vertex = {0.5, vertex.x, vertex.y};
    const auto translation = [&](double time) { return Vec3{(gap - 0.5) * (1.0 - std::fabs(time - 1.0)), 0, 0}; };
    const auto press = [&](const Vec3& v, double time) { return v + translation(time); };
    setup.colliders = {{"wall", PlaneShape{{0, 0, 0}, {1, 0, 0}}, 0}};
    if (deforms) {
        setup.colliders.push_back({"plate", deforming(plate, press, {0.0, 1.0, 2.0}), 0});
        return setup;
    }
    FrameDescription frame;
    frame.name = "plate";
    frame.motions = {
        KeyedTranslation{KeyedCurve<Vec3>({{0.0, translation(0)}, {1.0, translation(1)}, {2.0, translation(2)}})}};
    setup.frames = std::make_shared<const FrameTree>(std::vector<FrameDescription>{frame});
    setup.colliders.push_back(
        {"plate", MeshShape{std::make_shared<const TriangleMesh>(plate), {}, "", {}}, 0, "plate"});
    return setup;
}

TEST(ABallThatAPlatePinches, FallsOnAfterwardsBesideDeformingAndMovingPlates) {
    for (const double restitution : {0.0, 0.1, 0.3}) {
        for (const double time_step : {1.0 / 60.0, 1.0 / 120.0}) {
            SCOPED_TRACE(std::to_string(restitution) + " " + std::to_string(time_step));
            std::vector<double> heights;
            for (const bool deforms : {false, true}) {
                SimulationSetup setup = pinching(0.035, deforms, restitution, time_step);
                setup.particles = {particle_of({0.03, 0, 0.5}, {}, 0.02)};
                Simulation simulation(std::move(setup));
                EXPECT_EQ(squeezed_after(1.5, simulation), 0U);
                expect_sound(simulation);
                EXPECT_LT(simulation.particles().unsimulated_time[0], 0.1);
                heights.push_back(simulation.particles().position[0].z);
            }
            EXPECT_NEAR(heights[1], heights[0], 0.02);
            EXPECT_LT(heights[1], 0.3);
        }
    }
}

TEST(PointsThatADeformingPlateLeavesNoRoom, AreFreeAgainBesideIt) {
    for (const double gap : {0.0, -0.05}) {
        for (const double restitution : {0.0, 0.2, 1.0}) {
            SCOPED_TRACE(std::to_string(gap) + " " + std::to_string(restitution));
            SimulationSetup setup = pinching(gap, true, restitution, 1.0 / 60.0);
            for (int k = 0; k < 8; ++k) {
                setup.particles.push_back(particle_of({0.05 + 0.05 * k, 0.04 * k - 0.1, 0.2}, {0.1 * (k % 3 - 1), 0, 0},
                                                      k % 4 == 3 ? 0.02 : 0.0));
            }
            Simulation simulation(std::move(setup));
            EXPECT_EQ(squeezed_after(2.5, simulation), 0U);
            expect_sound(simulation);
            for (const Vec3& p : simulation.particles().position) {
                if (std::fabs(p.z) > 1.0 || std::fabs(p.y) > 1.0) continue;
                EXPECT_GT(p.x, 0.0);
                EXPECT_LT(p.x, 0.5);
            }
        }
    }
}

/// A box of 2 m whose lid moves through its floor and back between 0 and 2 s. Meanwhile the box moves and turns.
struct FoldingBox {
    Vec3 translation;
    Vec3 axis{0, 0, 1};
    double degrees = 0.0;
    double depth = 0.2;
    double scale = 1.0;

    [[nodiscard]] Vec3 operator()(const Vec3& v, double time) const {
        const double part = 1.0 - std::fabs(time - 1.0);
        const double gone = 0.5 * time;
        Vec3 p = v;
        if (v.z > 0.0) p.z -= (2.0 + depth) * part;
        return scale * world_from_local({gone * translation, axis, gone * degrees}).point(p);
    }
};

/// Expects that all particles are in the box at the end of the run and that none is stalled. Winding numbers determine
/// the side of each particle.
void expect_all_in_the_box(const FoldingBox& fold, double restitution, double time_step, std::uint64_t seed) {
    SimulationSetup setup = setup_of(time_step, 4.0, {"", restitution, 0.0});
    setup.options.verify = true;
    const TriangleMesh box = box_mesh({-1, -1, -1}, {1, 1, 1});
    setup.colliders = {{"box", deforming(box, fold, {0.0, 1.0, 2.0}), 0}};
    RandomSequence random(seed, 17, 0);
    for (int k = 0; k < 10; ++k) {
        setup.particles.push_back(particle_of(0.8 * fold.scale * random.in_unit_ball(),
                                              0.4 * fold.scale * random.in_unit_ball(),
                                              k % 4 == 3 ? 0.05 * fold.scale : 0.0));
    }
    Simulation simulation(std::move(setup));
    EXPECT_EQ(squeezed_after(2.5, simulation), 0U);
    expect_sound(simulation);
    TriangleMesh whole = box;
    for (Vec3& vertex : whole.vertices) vertex = fold(vertex, 2.0);
    for (const Vec3& p : simulation.particles().position) EXPECT_EQ(winding_number(whole, p), 1);
}

TEST(ABoxThatFoldsThroughItself, FreesItsParticlesWhenItIsUnfoldedAgain) {
    for (const double restitution : {0.0, 0.2, 1.0}) {
        for (const double time_step : {0.02, 0.01}) {
            SCOPED_TRACE(std::to_string(restitution) + " " + std::to_string(time_step));
            expect_all_in_the_box({}, restitution, time_step, 1);
        }
    }
}

TEST(ABoxThatFoldsThroughItself, FreesThemAfterAnyMotionAndRotation) {
    for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::scaled(12)); ++seed) {
        SCOPED_TRACE(seed);
        RandomSequence random(seed, 23, 0);
        FoldingBox fold;
        fold.translation = 5.0 * random.in_unit_ball();
        fold.axis = random.unit_vector();
        fold.degrees = 40.0 * random.uniform();
        fold.depth = 0.5 * random.uniform() + 0.01;
        fold.scale = seed % 3 == 0 ? 1.0 : (seed % 3 == 1 ? 0.01 : 100.0);
        expect_all_in_the_box(fold, seed % 2 == 0 ? 0.1 : 0.9, 0.02, seed);
    }
}

// The mesh passes through a particle and does not return. The particle stalls, and the verifier reports its final
// position.
TEST(AParticleThatAMeshHasPassed, StallsAndIsReportedAtTheEndOfTheRun) {
    SimulationSetup setup = setup_of(0.02, 1.5, {"", 0.2, 0.0});
    setup.options.verify = true;
    const auto fold = [](const Vec3& v, double time) {
        return v - Vec3{0, 0, v.z > 0.0 ? 2.2 * std::min(time, 1.0) : 0.0};
    };
    setup.colliders = {{"box", deforming(box_mesh({-1, -1, -1}, {1, 1, 1}), fold, {0.0, 1.0, 2.0}), 0}};
    setup.particles = {particle_of({0.1, 0.2, 0})};
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_GT(simulation.statistics().squeezed, 10U);
    ASSERT_EQ(simulation.violations().size(), 1U);
    EXPECT_EQ(simulation.violations()[0].kind, ViolationKind::wrong_side);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
