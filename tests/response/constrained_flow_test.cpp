// Walls that constrain a particle in a flow, and the release from them.
#include "ricochet/response/constrained_flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "response/flow_scene.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "support/counts.h"
#include "support/random_draws.h"
#include "support/shared_meshes.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::at;
using testing::carried;
using testing::cloud;
using testing::mesh_collider;
using testing::plane_collider;
using testing::run;

/// Returns two triangles, in the order of the corners.
TriangleMesh quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return {{a, b, c, d}, {{0, 1, 2}, {0, 2, 3}}};
}

/// A flow that rotates about a line at height 1 above the floor z = 0. It presses onto the floor where x > 0.
struct Roller {
    static constexpr double kRate = 1.3;   // rad/s
    static constexpr double kStart = 0.7;  // m
    FlowPointer flow = make_rotation({0, 0, 1}, {0, kRate, 0});
    /// Returns the position at a time: along the floor at the speed of the rim to x = 0, then on a circle.
    [[nodiscard]] static Vec3 place(double time) {
        const double released = kStart / kRate;
        if (time < released) return {kStart - kRate * time, 0, 0};
        const double angle = kRate * (time - released);
        return {-std::sin(angle), 0, 1.0 - std::cos(angle)};
    }
};

TEST(ConstrainedFlow, FloorReleasesAtTheTurnOfTheFlowToTheMethodsOrder) {
    for (const auto& [kind, order] : {std::pair{IntegratorKind::midpoint, 2.0}, std::pair{IntegratorKind::rk4, 4.0}}) {
        std::vector<double> errors;
        for (const double step : {0.1, 0.05}) {
            SimulationSetup setup = carried(Roller().flow, {plane_collider({}, {0, 0, 1})},
                                            {at({Roller::kStart, 0, 0})}, WallRule::slide, kind);
            setup.options.time_step = step;
            Simulation simulation(std::move(setup));
            run(simulation);
            errors.push_back(length(simulation.particles().position[0] - Roller::place(1.0)));
        }
        EXPECT_LT(errors[0], kind == IntegratorKind::rk4 ? 1e-5 : 1e-2);
        EXPECT_GT(std::log2(errors[0] / errors[1]), order - 0.6) << name_of(kind) << errors[0] << " " << errors[1];
    }
}

// The normals of the walls differ by twice the slope. Each wall presses the particle onto the other.
TEST(ConstrainedFlow, ParticleSlidesAlongABluntValleyOnBothFaces) {
    for (const double slope : {0.3, 1e-2, 5e-3, 1e-3, 1e-4, 1e-5, 2e-6}) {
        SCOPED_TRACE(slope);
        const TriangleMesh left = quad({-1, -1, slope}, {3, -1, slope}, {3, 0, 0}, {-1, 0, 0});
        const TriangleMesh right = quad({-1, 0, 0}, {3, 0, 0}, {3, 1, slope}, {-1, 1, slope});
        const double aside = 1e-3 * slope;
        SimulationSetup setup = carried(make_wind({1, 0, -1}), {mesh_collider(testing::merged(left, right))},
                                        {at({0, aside, slope * aside + 1e-6})});
        setup.options.time_step = 0.05;
        Simulation simulation(std::move(setup));
        run(simulation);
        EXPECT_LT(length(simulation.particles().position[0] - Vec3(1, 0, 0)), 2e-6);
        EXPECT_LT(simulation.statistics().bounces_per_step_max, 200U);
    }
}

// The wall y = 0 ends at x = 0.75, in the middle of a step. The floor continues.
TEST(ConstrainedFlow, ParticleLeavesTheWallOfAGrooveAtItsEnd) {
    const TriangleMesh wall = quad({-1, 0, 1}, {0.75, 0, 1}, {0.75, 0, -1}, {-1, 0, -1});
    for (const double radius : {0.0, 0.1}) {
        SimulationSetup setup = carried(make_wind({1, -0.5, -1}), {plane_collider({}, {0, 0, 1}), mesh_collider(wall)},
                                        {at({0, radius, radius}, radius)});
        setup.options.time_step = 0.5;
        Simulation simulation(std::move(setup));
        run(simulation);
        if (radius == 0.0) {
            EXPECT_LT(length(simulation.particles().position[0] - Vec3(1, -0.125, 0)), 1e-12);
        } else {
            EXPECT_LT(simulation.particles().position[0].y, radius);  // round the edge
        }
    }
}

// A steady flow presses a particle into a groove and along it. The groove has any orientation and any angle between 1
// and 179 degrees.
TEST(ConstrainedFlow, ParticleSlidesInAnyGrooveWithFewContactsAndNoLostTime) {
    RandomSequence random(26, 0, 0);
    for (int round = 0; round < test::scaled(120); ++round) {
        SCOPED_TRACE(round);
        const Vec3 along = random.unit_vector();
        const Vec3 up = normalized(cross(along, random.unit_vector()));
        const Vec3 aside = cross(up, along);
        const double tilt = (0.5 + 89.0 * random.uniform()) * 3.14159265358979 / 180.0;  // of a wall to the bottom
        const Vec3 foot = testing::random_vector(random, 3.0);
        const double radius = round % 2 == 0 ? 0.0 : 0.02;
        const Vec3 rise = std::cos(tilt) * aside + std::sin(tilt) * up;
        const Vec3 mirrored = -std::cos(tilt) * aside + std::sin(tilt) * up;
        std::vector<ColliderDescription> walls{plane_collider(foot, normalized(cross(along, rise))),
                                               plane_collider(foot, normalized(cross(mirrored, along)))};
        if (round % 4 >= 2) {
            const Vec3 back = foot - 4.0 * along;
            const Vec3 front = foot + 4.0 * along;
            walls = {mesh_collider(testing::merged(quad(back, front, front + 9.0 * rise, back + 9.0 * rise),
                                                   quad(front, back, back + 9.0 * mirrored, front + 9.0 * mirrored)))};
        }
        const Vec3 wind = along - (0.5 + random.uniform()) * up + random.uniform_around(0, 0.2) * aside;
        const double height = (radius + 0.05) / std::cos(tilt);
        SimulationSetup setup = carried(make_wind(wind), walls, {at(foot + height * up, radius)});
        setup.options.time_step = 0.02;
        Simulation simulation(std::move(setup));
        run(simulation);
        EXPECT_LT(simulation.statistics().contacts, 120U);
        const Vec3 moved = simulation.particles().position[0] - foot;
        EXPECT_NEAR(dot(moved, along), dot(wind, along), 1e-9);
    }
}

// At the wall x = 0 the flow turns away at the particle's position, but would press it on again slightly further along.
// The particle therefore creeps.
TEST(ConstrainedFlow, ParticleHopsAlongAWallIfTheFlowReturnsItAtOnce) {
    const FlowPointer flow = make_flow([](const Vec3& p, double t) {
        return Vec3{0.3 * (t - 0.2) - 2.0 * p.y, 1.0, 0.0};
    });
    SimulationSetup setup =
        carried(flow, {plane_collider({}, {1, 0, 0})}, {at({0.0, 0, 0})}, WallRule::stop, IntegratorKind::rk4);
    Simulation simulation(std::move(setup));
    run(simulation);
    const Vec3& p = simulation.particles().position[0];
    EXPECT_GE(p.x, 0.0);
    // At the particle's position the flow has just turned away: y = 0.15 (t - 0.2), up to a hop of a 64th of a step.
    EXPECT_NEAR(p.y, 0.15 * 0.8, 0.05 / 16.0);
    EXPECT_LE(simulation.statistics().bounces_per_step_max, 66U);
}

/// Returns the position, after `time`, of a particle on a ball of 1 m at the origin in a uniform flow of 1 m/s along x.
/// It starts at the angle `start` to the flow's axis, slides over the ball until it leaves at a right angle, and flies
/// on. reach: distance of its centre from the origin, in m.
Vec3 over_a_ball(double start, double time, double reach) {
    // The angle grows by sin(angle) / reach: tan(angle / 2) = tan(start / 2) exp(time / reach).
    const double leaving = -reach * std::log(std::tan(0.5 * start));
    const double angle = 2.0 * std::atan(std::tan(0.5 * start) * std::exp(std::min(time, leaving) / reach));
    return {-reach * std::cos(angle) + std::max(0.0, time - leaving), reach * std::sin(angle), 0};
}

double error_over_a_ball(double radius, double step, IntegratorKind kind) {
    const double start = 0.3;
    const double before = 0.125;  // s, of free flight
    const double reach = 1.0 + radius;
    ColliderDescription ball{"ball", BallShape{}, 0};
    const Vec3 from = over_a_ball(start, 0.0, reach) - Vec3{before, 0, 0};
    SimulationSetup setup = carried(make_wind({1, 0, 0}), {ball}, {at(from, radius)}, WallRule::slide, kind);
    setup.options.time_step = step;
    setup.options.duration = 3.0;
    Simulation simulation(std::move(setup));
    run(simulation);
    EXPECT_LE(simulation.statistics().contacts, 3U);
    return length(simulation.particles().position[0] - over_a_ball(start, 3.0 - before, reach));
}

TEST(ConstrainedFlow, ParticleSlidesOverABallToTheMethodsOrderForAnyRadius) {
    for (const double radius : {0.0, 1e-6, 1e-3, 0.3}) {
        SCOPED_TRACE(radius);
        const double coarse = error_over_a_ball(radius, 0.0625, IntegratorKind::rk4);
        const double fine = error_over_a_ball(radius, 0.03125, IntegratorKind::rk4);
        EXPECT_LT(coarse, 1e-6);
        EXPECT_LT(fine, std::max(coarse / 11.0, 1e-11));
        EXPECT_LT(error_over_a_ball(radius, 0.5, IntegratorKind::rk4), 2e-4) << "arcs keep long steps apart";
        const double first = error_over_a_ball(radius, 0.0625, IntegratorKind::midpoint);
        EXPECT_LT(error_over_a_ball(radius, 0.03125, IntegratorKind::midpoint), first / 3.0);
    }
}

/// A rotation about an axis beside the axis of a cylinder of 1 m presses particles onto the wall from inside.
TEST(ConstrainedFlow, ParticleSlidesInsideACylinderToTheMethodsOrder) {
    const double rate = 2.0;
    const double beside = 0.3;
    for (const double radius : {0.0, 1e-5, 0.01}) {
        std::vector<double> errors;
        for (const double step : {0.02, 0.01}) {
            ColliderDescription wall{"wall", CylinderShape{1.0, 4.0, {}}, 0};
            const double reach = 1.0 - radius;
            const FlowPointer flow = make_rotation({beside, 0, 0}, {0, 0, rate});
            SimulationSetup setup = carried(flow, {wall}, {at({0, -reach * (1.0 - 1e-15), 0}, radius)});
            setup.options.time_step = step;
            setup.options.duration = 0.5;
            Simulation simulation(std::move(setup));
            run(simulation);
            // The angle along the wall grows at the rate (1 - beside cos(angle) / reach) times the flow's, starting at
            // -pi / 2.
            double angle = -0.5 * std::acos(-1.0);
            const auto speed = [&](double a) { return rate * (1.0 - beside * std::cos(a) / reach); };
            constexpr int kParts = 4000;
            const double h = 0.5 / kParts;
            for (int k = 0; k < kParts; ++k) angle += h * speed(angle + 0.5 * h * speed(angle));
            const Vec3 expected{reach * std::cos(angle), reach * std::sin(angle), 0};
            errors.push_back(length(simulation.particles().position[0] - expected));
        }
        EXPECT_LT(errors[0], 1e-7) << radius;
        EXPECT_LT(errors[1], std::max(errors[0] / 8.0, 2e-8)) << radius;
    }
}

// In a wedge that ends at the origin, a particle comes to rest in a few contacts per step, for any opening angle.
TEST(ConstrainedFlow, ParticleRestsInAWedgeWithFewContacts) {
    for (const double degrees : {90.0, 60.0, 30.0, 10.0, 5.0, 1.0}) {
        const double a = degrees / 360.0 * std::acos(-1.0);
        for (const double z : {0.0, 0.01, 0.05}) {
            SimulationSetup setup = carried(
                make_wind({-1, 0, 0}),
                {plane_collider({}, {std::sin(a), 0, std::cos(a)}), plane_collider({}, {std::sin(a), 0, -std::cos(a)})},
                {at({20.0, 0, z})});
            setup.options.time_step = 0.1;
            setup.options.duration = 25.0;
            Simulation simulation(std::move(setup));
            run(simulation);
            EXPECT_LT(simulation.particles().position[0].x, 1e-6) << degrees;
            EXPECT_LT(simulation.statistics().contacts, 200U) << degrees;
        }
    }
}

/// Runs turbulence in a closed mesh of the given width.
void expect_all_goes_on(const TriangleMesh& mesh, double size, const Vec3& center, int count, std::uint64_t seed) {
    for (const WallRule walls : {WallRule::slide, WallRule::stop}) {
        for (const IntegratorKind kind : {IntegratorKind::rk4, IntegratorKind::forward_euler}) {
            for (const double rate : {0.0, 1.0}) {
                const FlowPointer flow = make_turbulence({seed, 2.0 * size, 0.4 * size, 3, 0.5, rate});
                std::vector<Particle> particles = cloud(count, 0.4 * size, 0.01 * size, seed);
                for (Particle& particle : particles) particle.position += center;
                SimulationSetup setup = carried(flow, {mesh_collider(mesh)}, std::move(particles), walls, kind);
                setup.options.time_step = seed % 2 == 0 ? 0.01 : 0.05;
                SCOPED_TRACE(std::string(walls == WallRule::stop ? "stop " : "slide ") + std::string(name_of(kind)) +
                             " rate " + std::to_string(rate) + " seed " + std::to_string(seed));
                Simulation simulation(std::move(setup));
                run(simulation);
            }
        }
    }
}

TEST(TurbulenceInAMesh, RunSpendsNoBudgetAndFreezesNothing) {
    const int seeds = test::scaled(4) * test::case_factor(20);
    for (int seed = 1; seed <= seeds; ++seed) {
        const auto s = static_cast<std::uint64_t>(seed);
        expect_all_goes_on(testing::box_mesh({-1, -1, -1}, {1, 1, 1}), 2.0, {}, 20, s);
        expect_all_goes_on(testing::sphere_mesh({}, 1.0, 2), 2.0, {}, 20, s);
    }
}

TEST(TurbulenceInAMeshLong, RunSpendsNoBudgetInRealMeshes) {
    for (const char* const name : {"spot.obj", "bunny-closed.off", "armadillo.obj", "quadknot.obj", "fandisk.obj"}) {
        SCOPED_TRACE(name);
        RICOCHET_SHARED_MESH_OR_SKIP(path, name);
        const TriangleMesh mesh = read_mesh(path).mesh;
        Box3 box;
        for (const Vec3& v : mesh.vertices) box.include(v);
        const Vec3 size = box.size();
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            expect_all_goes_on(mesh, std::min({size.x, size.y, size.z}), box.center(), 100, seed);
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
