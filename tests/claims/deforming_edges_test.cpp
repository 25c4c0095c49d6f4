// Particles that rest or slide on the edge between two faces of a deforming mesh behave like particles beside the edge.
//
// A long run tests more turning planes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "claims/deforming_scene.h"
#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/simulations.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kG = 9.81;

SimulationSetup setup_on(const TriangleMesh& mesh, const Deform& deform, std::vector<double> times,
                         const Material& material) {
    SimulationSetup setup;
    setup.options.time_step = 0.02;
    setup.options.duration = 1.0;
    setup.options.verify = true;
    setup.materials = {material};
    setup.forces.push_back(make_gravity({0, 0, -kG}));
    setup.colliders = {{"sheet", deforming(mesh, deform, std::move(times)), 0}};
    return setup;
}

void expect_sound_and_whole(const Simulation& simulation) {
    expect_sound(simulation);
    EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
    EXPECT_EQ(simulation.statistics().budget_exhausted, 0U);
}

double number(std::uint64_t seed, std::uint32_t index, double low, double high) {
    return low + (high - low) * RandomSequence(seed, 0, index).uniform();
}

// A particle slides from rest down the plane z = 0.3 x without friction. After 1 s its speed is g sin(a) with the slope
// angle a, on a grid line of the mesh and beside it.
TEST(AStillSlopeWithKeys, LetsParticlesSlideEquallyOnGridLinesAndBesideThem) {
    const double slope = 0.3;
    const double along = std::sqrt(1.0 + slope * slope);
    const double speed = kG * slope / along;
    TriangleMesh incline = sheet(4.0, 4);
    for (Vec3& v : incline.vertices) v.z = slope * v.x;
    const auto still = [](const Vec3& v, double /*time*/) { return v; };
    for (const double radius : {0.0, 0.05}) {
        for (const double y : {-2.0, 0.0, 2.0}) {
            SCOPED_TRACE(std::to_string(radius) + " " + std::to_string(y));
            SimulationSetup setup = setup_on(incline, still, {0.0, 5.0}, {"", 0.0, 0.0});
            setup.options.time_step = 0.05;
            for (std::uint32_t k = 0; k < 20; ++k) {
                const double x = number(17, k, -1.0, 3.0);
                setup.particles.push_back(particle_of({x, y, slope * x + radius * along + 1e-12}, {}, radius));
            }
            Simulation simulation(std::move(setup));
            while (!simulation.finished()) simulation.step();
            for (const Vec3& v : simulation.particles().velocity) {
                EXPECT_NEAR(length(v), speed, 1e-5);
                EXPECT_NEAR(v.y, 0.0, 1e-9);
            }
            EXPECT_LT(simulation.statistics().contacts, 200U);
            expect_sound_and_whole(simulation);
        }
    }
}

// The two faces stay in one plane, which turns about the y axis at 1/10 rad/s. The plane is too steep for friction only
// at the end.
TEST(ATiltingQuad, KeepsAPointAtRestOnItsDiagonal) {
    const auto tilting = [](const Vec3& v, double time) { return Vec3{v.x, v.y, 0.1 * time * v.x}; };
    for (const double time_step : {0.005, 0.02}) {
        SCOPED_TRACE(time_step);
        SimulationSetup setup = setup_on(sheet(3.0, 1), tilting, {0.0, 10.0}, {"", 0.0, 0.9});
        setup.options.time_step = time_step;
        setup.options.duration = 2.0;
        setup.particles = {particle_of({0, 0, 1e-10}, {}, 0.0), particle_of({0.7, 0.7, 1e-10}, {}, 0.0)};
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        for (const double x : {0.0, 0.7}) {
            const std::size_t k = x == 0.0 ? 0 : 1;
            EXPECT_LT(length(simulation.particles().position[k] - Vec3{x, x, 0.2 * x}), 1e-5);
            EXPECT_LT(length(simulation.particles().velocity[k] - Vec3{0, 0, 0.1 * x}), 1e-5);
        }
        EXPECT_LT(simulation.statistics().contacts, 20U);
        expect_sound_and_whole(simulation);
    }
}

// Two faces stay in one plane. The plane rises, and its slope changes from key to key. The ball lies on the common edge
// of the faces.
TEST(ARisingSheet, CarriesABallOnItsDiagonal) {
    const auto rising = [](const Vec3& v, double time) {
        return Vec3{v.x, v.y, 0.23 * time + 0.04 * std::sin(6.0 * time) * v.x};
    };
    for (const double x : {-0.9, 0.0, 0.5}) {
        SCOPED_TRACE(x);
        SimulationSetup setup = setup_on(sheet(2.0, 1), rising, evenly(0.0, 2.0, 6), {"", 0.0, 1.5});
        setup.options.duration = 1.2;
        setup.particles = {particle_of({x, x, 0.4}, {}, 0.05)};
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) {
            simulation.step();
            EXPECT_LT(length(simulation.particles().velocity[0]), 3.0);
        }
        const Vec3 p = simulation.particles().position[0];
        EXPECT_NEAR(p.y, x, 1e-9);
        EXPECT_GT(p.z, height_of(*simulation.collider_mesh(0), p.x, p.y) + 0.05 - 1e-9);
        EXPECT_LT(simulation.statistics().contacts, 20U);
        expect_sound_and_whole(simulation);
    }
}

// The plane of a mesh grid turns and rises at random rates. The speed of points and spheres on grid lines stays below
// the speed that gravity and the moving plane can cause.
TEST(APlaneThatTurns, ThrowsNoParticleFromItsGridLines) {
    for (std::uint64_t seed = 1; seed <= (test::is_long_run() ? 40U : 2U); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Vec3 from{number(seed, 0, -0.3, 0.3), number(seed, 1, -0.3, 0.3), 0.0};
        const Vec3 rate{number(seed, 2, -0.2, 0.2), number(seed, 3, -0.2, 0.2), number(seed, 4, 0.0, 0.3)};
        const auto turning = [&](const Vec3& v, double time) {
            return Vec3{v.x, v.y, (from.x + rate.x * time) * v.x + (from.y + rate.y * time) * v.y + rate.z * time};
        };
        SimulationSetup setup =
            setup_on(sheet(8.0, 8), turning, {0.0, 2.0}, {"", 0.0, 0.2 * static_cast<double>(seed % 3)});
        for (std::uint32_t k = 0; k < 4; ++k) {
            const double x = number(seed, 10 + k, -2.0, 2.0);
            const double y = k % 2 == 0 ? x : std::round(x);
            const double radius = k < 2 ? 0.0 : 0.05;
            const double up = radius * std::sqrt(1.0 + from.x * from.x + from.y * from.y) + 1e-10;
            setup.particles.push_back(particle_of({x, y, from.x * x + from.y * y + up}, {}, radius));
        }
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        // The bound is the speed of a fall along the slope plus the speed of the rising plane within the grid.
        const double most = kG * 0.6 + 4.0 * (std::fabs(rate.x) + std::fabs(rate.y)) + rate.z;
        for (const Vec3& v : simulation.particles().velocity) EXPECT_LT(length(v), most);
        expect_sound_and_whole(simulation);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
