// Spheres that tumble in a torus of triangles lose no simulated time, for any friction, restitution and size. They have
// nearly as few impacts as points, so their cost is similar.
//
// A long run has three thousand spheres for three seconds.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "claims/contact_scene.h"
#include "ricochet/core/random.h"
#include "support/counts.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kMajor = 1.0;  // radius of the tube's centre line, in m
constexpr double kMinor = 0.25;

/// Returns a closed torus about z, 96 x 32 cells of two triangles, wound outward.
TriangleMesh torus_mesh() {
    constexpr std::uint32_t kAround = 96;
    constexpr std::uint32_t kAcross = 32;
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < kAround; ++i) {
        for (std::uint32_t j = 0; j < kAcross; ++j) {
            const double u = 2.0 * kPiNumber * i / kAround;
            const double v = 2.0 * kPiNumber * j / kAcross;
            const double distance = kMajor + kMinor * std::cos(v);
            mesh.vertices.push_back({distance * std::cos(u), distance * std::sin(u), kMinor * std::sin(v)});
            const std::uint32_t a = i * kAcross + j;
            const std::uint32_t b = (i + 1) % kAround * kAcross + j;
            const std::uint32_t up = (j + 1) % kAcross;
            mesh.triangles.push_back({a, b, i * kAcross + up});
            mesh.triangles.push_back({b, (i + 1) % kAround * kAcross + up, i * kAcross + up});
        }
    }
    return mesh;
}

struct Filling {
    int particles = 100;
    double duration = 1.5;
    double friction = 0.0;
    double restitution = 0.7;
    double largest = 0.0;  ///< largest radius, in m; the smallest is a third of it; 0: points
};

SimulationStatistics run(const Filling& filling) {
    SimulationSetup setup;
    setup.options.time_step = 1.0 / 60.0;
    setup.options.duration = filling.duration;
    setup.options.triangle_totals = false;
    setup.options.verify = filling.particles < 1000;  // verification takes ten times as long
    setup.forces.push_back(make_gravity({0, -kStandardGravity, 0}));
    setup.materials = {{"", filling.restitution, filling.friction}};
    setup.colliders = {mesh_collider(torus_mesh())};
    for (int k = 0; k < filling.particles; ++k) {
        RandomSequence random(7, 1, static_cast<std::uint64_t>(k));
        const double around = 2.0 * kPiNumber * random.uniform();
        const Vec3 across = 0.8 * kMinor * random.in_unit_disk();
        const double distance = kMajor + across.x;
        const double radius = filling.largest * (1.0 + 2.0 * random.uniform()) / 3.0;
        setup.particles.push_back(particle_of({distance * std::cos(around), distance * std::sin(around), across.y},
                                              random.unit_vector(), radius));
    }
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_EQ(simulation.statistics().violations, 0U);
    return simulation.statistics();
}

Filling filling_of(double friction, double restitution, double largest) {
    Filling filling{test::scaled(300), 1.0, friction, restitution, largest};
    if (test::is_long_run()) filling.particles = test::scaled(3000);
    if (test::is_long_run()) filling.duration = 3.0;
    return filling;
}

TEST(SpheresInATorus, LoseNoTimeAndCostAtMostThreeTimesAsMuchAsPoints) {
    for (const double restitution : test::chosen_cases({0.0, 0.3, 0.7, 0.95}, 2)) {
        const SimulationStatistics points = run(filling_of(0.0, restitution, 0.0));
        EXPECT_EQ(points.unsimulated_time, 0.0) << "points, restitution " << restitution;
        for (const double friction : test::chosen_cases({0.3, 0.0, 1.0, 0.1}, 2)) {
            for (const double largest : {0.015, 0.05}) {
                SCOPED_TRACE("restitution " + std::to_string(restitution) + ", friction " + std::to_string(friction) +
                             ", radii up to " + std::to_string(largest));
                const SimulationStatistics spheres = run(filling_of(friction, restitution, largest));
                EXPECT_EQ(spheres.unsimulated_time, 0.0);
                EXPECT_EQ(spheres.budget_exhausted, 0U);
                // The factor 3 is a required bound.
                EXPECT_LE(spheres.contacts, 3 * points.contacts) << "of points";
                RecordProperty("contacts", std::to_string(spheres.contacts));
            }
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
