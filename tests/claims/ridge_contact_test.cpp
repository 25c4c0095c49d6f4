// A sphere rolls along a ridge and temporarily over one of its faces. The sphere does not overlap this face, even if an
// obstacle stops it there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "claims/contact_scene.h"
#include "ricochet/collision_queries.h"
#include "ricochet/core/random.h"
#include "support/counts.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kSlope = 20.0;  // in degrees, of both faces
constexpr double kRadius = 1.0;

/// Returns two faces that descend to both sides of the ridge y = z = 0.
ColliderDescription ridge() {
    const double drop = -20.0 * std::tan(radians(kSlope));
    TriangleMesh mesh;
    mesh.vertices = {{-20, 0, 0}, {20, 0, 0}, {0, -20, drop}, {0, 20, drop}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}};
    return mesh_collider(mesh);
}

/// Returns a sphere on the ridge that moves over the face with y > 0. The sphere is close to the limit at which the
/// edge supports it. Gravity pulls it back at 1.3 m/s^2, so it is over the face until the time 2 `speed` / 1.3, in s.
ContactScene over_and_back(double speed) {
    const double s = std::sin(radians(kSlope) - 1e-4);
    const double c = std::cos(radians(kSlope) - 1e-4);
    ContactScene scene;
    scene.colliders = {ridge()};
    scene.materials = {{"", 0.0, 0.0}};
    scene.gravity = {0, -5, -10};
    const double height = kRadius * (1.0 + 1e-13);
    scene.particle = particle_of({0, height * s, height * c}, {2, speed * c, -speed * s}, kRadius);
    return scene;
}

/// Expects that the sphere does not overlap the ridge at the end of the scene, up to rounding.
void expect_free_at_end(const ContactScene& scene) {
    const Particle end = end_of(scene);
    const auto nearest = CollisionQueries({ridge()}).closest_point(end.position, 2.0 * kRadius);
    ASSERT_TRUE(nearest);
    EXPECT_GE(nearest->distance, kRadius * (1.0 - 1e-12)) << "at " << end.position.x;
    EXPECT_LE(nearest->distance, kRadius * (1.0 + 1e-9)) << "at " << end.position.x;
}

TEST(ARidge, IsNotOverlappedByASphereThatLeavesForAFaceAndReturns) {
    for (const double speed : {0.0, 0.03, 0.1, 0.3}) {
        for (const double time : {0.001, 0.01, 0.03, 0.06, 0.1, 0.15, 0.2}) {
            ContactScene scene = over_and_back(speed);
            scene.time_step = scene.duration = time;
            SCOPED_TRACE(::testing::Message() << speed << " m/s, " << time << " s");
            expect_free_at_end(scene);
        }
    }
}

TEST(ARidge, IsNotOverlappedIfAWallStopsASphereOverAFace) {
    for (const double speed : {0.03, 0.1, 0.2, 0.3}) {
        for (const double part : {0.1, 0.3, 0.5, 0.7, 0.9}) {
            ContactScene scene = over_and_back(speed);
            const double wall = part * 2.0 * speed / 1.3;  // time of impact on the wall, in s
            scene.colliders.push_back(plane_collider({2.0 * wall + kRadius, 0, 0}, {-1, 0, 0}));
            scene.materials.push_back(scene.materials[0]);
            scene.time_step = scene.duration = 4.0 * speed / 1.3;
            // The state shortly after the impact is checked too, because the path along the wall starts there.
            for (const double until : {1.001 * wall, scene.duration}) {
                scene.duration = until;
                SCOPED_TRACE(::testing::Message() << speed << " m/s, wall at " << part << ", until " << until << " s");
                expect_free_at_end(scene);
            }
        }
    }
}

/// Returns a sphere on a ridge with two different slopes. The sphere is pushed along and across the ridge, towards a
/// wall. Half of the spheres start almost over a face.
SimulationSetup random_ridge(std::uint64_t seed) {
    RandomSequence random(77, 1, seed);
    const auto around = [&](double half) { return random.uniform_around(0, half); };
    const double left = 0.05 + 0.8 * random.uniform();
    const double right = 0.05 + 0.8 * random.uniform();
    TriangleMesh mesh;
    const double aside = around(10);
    mesh.vertices = {
        {-20, 0, 0}, {20, 0, 0}, {aside, -20, -20 * std::tan(left)}, {around(10), 20, -20 * std::tan(right)}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}};
    SimulationSetup setup;
    setup.options.verify = true;
    setup.materials = {{"", 0.0, random.uniform() < 0.5 ? 0.0 : 0.3 * random.uniform()}};
    double angle = (2.0 * random.uniform() - 1.0) * 0.98 * std::min(left, right);
    if (random.uniform() < 0.5) angle = right * (1.0 - std::pow(10.0, -4.0 * random.uniform() - 1.0));
    const Vec3 place = (1.0 + 1e-13) * Vec3{0, std::sin(angle), std::cos(angle)};
    const double over = 0.3 * around(1);
    const double along = 2.0 * around(1);
    setup.particles = {particle_of(place, {along, over * std::cos(angle), -over * std::sin(angle)}, kRadius)};
    const double pull = 2.0 * around(1);
    setup.forces.push_back(make_gravity({pull, 6.0 * around(1), -10}));
    Vec3 n;
    for (const double half : {1.0, 1.0, 0.3}) n = {n.y, n.z, around(half)};
    n = normalized(n);
    setup.colliders = {mesh_collider(std::move(mesh)),
                       plane_collider(place - (kRadius + 0.3 * random.uniform()) * n, n)};
    setup.options.time_step = std::pow(10.0, -2.0 * random.uniform());
    setup.options.duration = 3.0 * setup.options.time_step;
    return setup;
}

TEST(ARidge, IsNeverOverlappedInRandomScenes) {
    const int scenes = test::scaled(1000) * test::case_factor(100);
    for (int seed = 0; seed < scenes; ++seed) {
        Simulation simulation(random_ridge(static_cast<std::uint64_t>(seed)));
        while (!simulation.finished()) simulation.step();
        EXPECT_EQ(simulation.statistics().violations, 0U) << "seed " << seed;
        expect_no_time_lost(simulation);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
