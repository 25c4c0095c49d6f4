// Where walls hold what a flow carries, and where they let go.
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
#include "support/shared_meshes.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace {

using testing::at;
using testing::carried;
using testing::cloud;
using testing::mesh_collider;
using testing::plane_collider;
using testing::run;

/// Two triangles, one after the other in the list.
TriangleMesh quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return {{a, b, c, d}, {{0, 1, 2}, {0, 2, 3}}};
}

/// The flow turns about a line at height 1 above the floor z = 0 and presses onto it where x > 0.
struct Roller {
    static constexpr double kRate = 1.3;   // rad/s
    static constexpr double kStart = 0.7;  // m
    FlowPointer flow = make_rotation({0, 0, 1}, {0, kRate, 0});
    /// Along the floor at the speed of the rim to x = 0, and from there round on a circle.
    [[nodiscard]] static Vec3 place(double time) {
        const double released = kStart / kRate;
        if (time < released) return {kStart - kRate * time, 0, 0};
        const double angle = kRate * (time - released);
        return {-std::sin(angle), 0, 1.0 - std::cos(angle)};
    }
};

TEST(ConstrainedFlow, LetsGoOfAFloorWhereTheFlowTurnsAwayToTheMethodsOrder) {
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

// The walls' normals differ by twice the slope; each presses the particle onto the other.
TEST(ConstrainedFlow, GoesAlongABluntValleyWithBothItsFaces) {
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

// The wall y = 0 ends at x = 0.75, in the middle of a step; the floor goes on.
TEST(ConstrainedFlow, LeavesTheWallOfAGrooveWhereItEnds) {
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

// At the wall x = 0 the flow turns away where the particle is, and would press it on a little further along: it creeps.
TEST(ConstrainedFlow, HopsWhereAWallStopsWhatTheFlowWouldBringBack) {
    const FlowPointer flow = make_flow([](const Vec3& p, double t) {
        return Vec3{0.3 * (t - 0.2) - 2.0 * p.y, 1.0, 0.0};
    });
    SimulationSetup setup =
        carried(flow, {plane_collider({}, {1, 0, 0})}, {at({0.0, 0, 0})}, WallRule::stop, IntegratorKind::rk4);
    Simulation simulation(std::move(setup));
    run(simulation);
    const Vec3& p = simulation.particles().position[0];
    EXPECT_GE(p.x, 0.0);
    // Where it is, the flow has just turned away: y = 0.15 (t - 0.2), but for a hop of a 64th of a step.
    EXPECT_NEAR(p.y, 0.15 * 0.8, 0.05 / 16.0);
    EXPECT_LE(simulation.statistics().bounces_per_step_max, 66U);
}

/// Turbulence in a closed mesh that is some `size` wide.
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

TEST(TurbulenceInAMesh, SpendsNoBudgetAndFreezesNothing) {
    const int seeds = test::scaled(4) * test::case_factor(20);
    for (int seed = 1; seed <= seeds; ++seed) {
        const auto s = static_cast<std::uint64_t>(seed);
        expect_all_goes_on(testing::box_mesh({-1, -1, -1}, {1, 1, 1}), 2.0, {}, 20, s);
        expect_all_goes_on(testing::sphere_mesh({}, 1.0, 2), 2.0, {}, 20, s);
    }
}

TEST(TurbulenceInAMeshLong, SpendsNoBudgetInRealMeshesEither) {
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

}  // namespace
}  // namespace ricochet
