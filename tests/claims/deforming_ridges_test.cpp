// A particle on the ridge of a deforming mesh rests there or slides off, like a particle on a ridge at rest.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "claims/deforming_scene.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kG = 9.81;
constexpr double kPlace = 0.7;  // start position along the ridge, in m

/// Rotates a point about the z axis, so that the coordinates of vertices are not exact.
Vec3 turned(const Vec3& v, double angle) {
    return {v.x * std::cos(angle) - v.y * std::sin(angle), v.x * std::sin(angle) + v.y * std::cos(angle), v.z};
}

/// Two faces that descend with equal slope to both sides of the y axis. They are rotated and move.
struct Ridge {
    double slope = 0.1;
    double angle = 0.0;
    Vec3 velocity;  ///< in m/s
    double friction = 0.0;

    [[nodiscard]] SimulationSetup setup() const {
        TriangleMesh roof;
        for (const double y : {-3.0, 3.0}) {
            for (const double x : {-3.0, 0.0, 3.0}) roof.vertices.push_back({x, y, -slope * std::fabs(x)});
        }
        roof.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
        const auto moving = [&](const Vec3& v, double time) { return turned(v + time * velocity, angle); };
        SimulationSetup setup = setup_of(0.02, 1.0, {"", 0.0, friction}, {0, 0, -kG});
        setup.options.verify = true;
        setup.colliders = {{"ridge", deforming(roof, moving, {0.0, 2.0}), 0}};
        return setup;
    }
    /// Returns the final position, in the ridge's coordinates, of a particle that starts beside the middle of the
    /// ridge.
    [[nodiscard]] Vec3 end_of(const Vec3& from) const {
        SimulationSetup scene = setup();
        scene.particles = {particle_of(turned(from, angle), turned(velocity, angle))};
        Simulation simulation(std::move(scene));
        while (!simulation.finished()) simulation.step();
        expect_sound(simulation);
        EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
        EXPECT_EQ(simulation.statistics().budget_exhausted, 0U);
        EXPECT_LT(simulation.statistics().contacts, 10U);
        return turned(simulation.particles().position[0], -angle) - velocity;
    }
};

template <class Check>
void for_each_ridge(std::vector<double> slopes, const Check& check) {
    for (const double slope : slopes) {
        for (const double angle : {0.0, 0.37}) {
            for (const Vec3& velocity : {Vec3{}, Vec3{0, 0, 0.3}, Vec3{0, 0.2, 0}, Vec3{0.2, 0, -0.1}}) {
                SCOPED_TRACE(::testing::Message() << "slope " << slope << ", turned by " << angle << ", velocity "
                                                  << velocity.x << " " << velocity.y << " " << velocity.z);
                check(Ridge{slope, angle, velocity, 0.0});
            }
        }
    }
}

// The point starts on the ridge or within rounding of it. On a slope of 0.5, a friction coefficient of 0.5 is just
// enough.
TEST(ADeformingRidge, HoldsAPointByFriction) {
    for_each_ridge({0.1, 0.4, 0.5}, [](Ridge ridge) {
        ridge.friction = 0.5;
        for (const double height : {1e-12, 0.05}) {
            for (const double aside : {0.0, 1e-13, 1e-3}) {
                SCOPED_TRACE(::testing::Message() << "from " << height << ", aside " << aside);
                const Vec3 end = ridge.end_of({aside, kPlace, height - ridge.slope * aside});
                EXPECT_LT(length(end - Vec3{aside, kPlace, -ridge.slope * aside}), 1e-12);
            }
        }
    });
}

// The point starts from rest. After 1 s it has descended by g sin^2(a) / 2 with the slope angle a. A point exactly on
// the ridge may stay there, as on a ridge at rest.
TEST(ADeformingRidge, LetsAPointSlideOff) {
    for_each_ridge({0.1, 0.5, 1.5}, [](const Ridge& ridge) {
        const double translation = 0.5 * kG * ridge.slope / (1.0 + ridge.slope * ridge.slope);
        for (const double aside : {0.0, 1e-13, 1e-10, 1e-3}) {
            SCOPED_TRACE(aside);
            const Vec3 end = ridge.end_of({aside, kPlace, 1e-12 - ridge.slope * aside});
            EXPECT_NEAR(end.z, -ridge.slope * std::fabs(end.x), 1e-12);
            if (aside > 1e-12) {
                EXPECT_NEAR(end.x, aside + translation, 1e-5);
            } else {
                EXPECT_LT(std::fabs(end.x), translation + 1e-5);
            }
        }
    });
}

// The spheres roll around an edge that also turns. Each sphere leaves the edge permanently.
TEST(ADeformingRidge, ReleasesSpheresThatRollAroundIt) {
    for (const double turning : {-0.3, -0.1, 0.1, 0.3}) {
        for (const double along : {-1.0, 1.0}) {
            SCOPED_TRACE(::testing::Message() << turning << " /s, " << along << " m/s");
            TriangleMesh table = sheet(3.0, 1);
            for (Vec3& v : table.vertices) v.x -= 3.0;
            const auto tilting = [&](const Vec3& v, double time) { return v + Vec3{0, 0, turning * time * v.y}; };
            SimulationSetup setup = setup_of(0.02, 0.6, {"", 0.0, 0.0}, {0, 0, -kG});
            setup.options.verify = true;
            setup.colliders = {{"table", deforming(table, tilting, {0.0, 2.0}), 0}};
            for (const double x : {-0.05, -0.01, -1e-3}) {
                setup.particles.push_back(particle_of({x, 0, 0.1 + 1e-12}, {0.2, along, 0}, 0.1));
            }
            Simulation simulation(std::move(setup));
            while (!simulation.finished()) simulation.step();
            expect_sound(simulation);
            EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
            EXPECT_EQ(simulation.statistics().budget_exhausted, 0U);
            EXPECT_LT(simulation.statistics().contacts, 40U);
            for (const Vec3& p : simulation.particles().position) EXPECT_LT(p.z, 0.0);
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
