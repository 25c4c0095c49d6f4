// Counting rules: an impact is one contact, and one row and one hit for every surface involved, with all responses.
#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string>
#include <utility>

#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

struct Counts {
    std::uint64_t contacts = 0;
    std::uint64_t impacts = 0;  ///< distinct pairs of time and particle in the rows
    std::uint64_t rows = 0;
    std::uint64_t hits = 0;
    double impulse = 0.0;  ///< N s, sum over all rows, upwards
    double given = 0.0;    ///< the same sum over all triangles
    double lasting = 0.0;  ///< the part of it that belongs to no hit
};

/// Returns points or spheres that bounce in a box, in a fine ball of triangles, or on a plane.
SimulationSetup bouncing(ResponseKind kind, int shape, double radius) {
    SimulationSetup setup;
    setup.options.response = kind;
    setup.options.time_step = 0.01;
    setup.options.duration = 1.0;
    setup.options.record_contacts = true;
    setup.materials = {{.name = "stone", .restitution = 1.0, .friction = 0.2}};
    if (shape == 0) setup.colliders = {{"box", CuboidShape{{1, 1, 1}, {}}, 0}};
    if (shape == 1) {
        auto mesh = std::make_shared<const TriangleMesh>(testing::sphere_mesh({}, 0.6, 2));
        setup.colliders = {{"ball", MeshShape{std::move(mesh), {}, ""}, 0}};
    }
    if (shape == 2) setup.colliders = {{"floor", PlaneShape{{0, 0, -0.5}, {0, 0, 1}}, 0}};
    setup.forces.push_back(make_gravity({0, 0, -9.81}));
    RandomSequence random(8, 0, 0);
    for (int k = 0; k < 40; ++k) {
        Particle particle;
        for (int axis = 0; axis < 3; ++axis) particle.position[axis] = random.uniform_around(0, 0.3);
        particle.velocity = 2.0 * random.unit_vector();
        particle.radius = radius;
        setup.particles.push_back(particle);
    }
    return setup;
}

Counts counts_of(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    Counts counts;
    while (!simulation.finished()) {
        simulation.step();
        std::set<std::pair<double, std::uint64_t>> impacts;
        for (const ContactRecord& record : simulation.contact_records()) {
            impacts.insert({record.time, record.particle});
            counts.impulse += record.mass * (record.velocity_before.z - record.velocity_after.z);
        }
        counts.impacts += impacts.size();
        counts.rows += simulation.contact_records().size();
    }
    const TriangleTotals totals = simulation.triangle_totals(0);
    for (const std::uint64_t hits : totals.hits) counts.hits += hits;
    for (const Vec3& impulse : totals.impulse) counts.given += impulse.z;
    for (const Vec3& impulse : totals.lasting_impulse) counts.lasting += impulse.z;
    counts.contacts = simulation.statistics().contacts;
    return counts;
}

TEST(ContactCounts, ImpactIsOneContactAndARowAndAHitOfEverySurface) {
    for (const ResponseKind kind : response_kinds()) {
        for (int shape = 0; shape < 3; ++shape) {
            for (const double radius : {0.0, 0.04}) {
                SCOPED_TRACE(std::string(name_of(kind)) + " shape " + std::to_string(shape) + " radius " +
                             std::to_string(radius));
                const Counts counts = counts_of(bouncing(kind, shape, radius));
                EXPECT_GT(counts.rows, 20U);
                EXPECT_EQ(counts.hits, counts.rows);
                EXPECT_EQ(counts.impacts, counts.contacts);
                EXPECT_TRUE(shape != 2 || counts.rows == counts.contacts);  // there is only one surface
            }
        }
    }
}

// With restitution 1 nothing rests or slides, so the rows contain all impulses on the surfaces.
TEST(ContactCounts, RowsContainTheImpulsesOfTheTotalsExceptForPenalty) {
    for (const ResponseKind kind : response_kinds()) {
        for (int shape = 0; shape < 3; ++shape) {
            SCOPED_TRACE(std::string(name_of(kind)) + " shape " + std::to_string(shape));
            const Counts counts = counts_of(bouncing(kind, shape, 0.0));
            EXPECT_LT(counts.given, -10.0);
            EXPECT_NEAR(counts.impulse, kind == ResponseKind::penalty ? 0.0 : counts.given, 1e-9);
        }
    }
}

/// Returns a point 1e-10 m above the common vertex of a slope's triangles. The point can rest there.
SimulationSetup lying_on_a_slope(std::uint64_t number) {
    RandomSequence random(137, 0, number);
    const Vec3 up = random.unit_vector();
    const Vec3 east = normalized(cross(up, random.unit_vector()));
    const Vec3 north = cross(up, east);
    TriangleMesh mesh;
    for (int k = 0; k < 9; ++k) mesh.vertices.push_back(3000.0 * ((k % 3 - 1) * east + (k / 3 - 1) * north));
    for (const std::uint32_t corner : {0U, 1U, 3U, 4U}) {
        mesh.triangles.push_back({corner, corner + 1, corner + 4});
        mesh.triangles.push_back({corner, corner + 4, corner + 3});
    }
    SimulationSetup setup;
    setup.options.time_step = 0.2 * (1.0 + random.uniform());
    setup.options.duration = 3.0 * setup.options.time_step;
    setup.options.resting_speed = 0.05;
    setup.options.record_contacts = true;
    setup.materials = {{.name = "stone", .restitution = 0.6, .friction = 0.5}};
    setup.colliders = {{"slope", MeshShape{std::make_shared<const TriangleMesh>(std::move(mesh)), {}, ""}, 0}};
    setup.forces.push_back(make_gravity(100.0 * ((0.2 + 0.29 * random.uniform()) * east - up)));
    Particle particle;
    particle.position = 1e-10 * up + 1e-11 * random.unit_vector();
    setup.particles.push_back(particle);
    return setup;
}

// The slide after the landing stops within microseconds of a long step. If its duration were rounded up, a speed of
// 1e-19 m/s in a random direction would remain. It would lift the point off the slope for another landing.
TEST(ContactCounts, ParticleThatLandsAndStaysHasLandedOnce) {
    for (std::uint64_t k = 0; k < 300; ++k) {
        SCOPED_TRACE(k);
        EXPECT_EQ(counts_of(lying_on_a_slope(k)).contacts, 1U);
    }
}

// Spheres slide, roll and come to rest. The rows contain one part of the totals, lasting contact the other.
TEST(ContactCounts, RowsAndLastingContactAddUpToTheTotals) {
    for (const ResponseKind kind : response_kinds()) {
        for (int shape = 0; shape < 3; ++shape) {
            for (const double radius : {0.0, 0.04}) {
                SCOPED_TRACE(std::string(name_of(kind)) + " shape " + std::to_string(shape) + " radius " +
                             std::to_string(radius));
                SimulationSetup setup = bouncing(kind, shape, radius);
                setup.materials[0].restitution = 0.3;
                setup.options.duration = 2.0;
                const Counts counts = counts_of(std::move(setup));
                // Each step of `project` that meets a wall is an impact.
                EXPECT_TRUE(kind == ResponseKind::project ? counts.lasting == 0.0 : counts.lasting < -1.0);
                EXPECT_NEAR(counts.impulse + counts.lasting, counts.given, 1e-9);
            }
        }
    }
}

// The floor supports the weight of both spheres all the time, in planned contact or asleep. None of this is a hit.
TEST(ContactCounts, WeightOfAStackAtRestIsLastingContact) {
    for (const bool sleeping : {true, false}) {
        SimulationSetup setup;
        setup.options.time_step = 0.01;
        setup.options.duration = 1.0;
        setup.acceleration.sleeping = sleeping;
        setup.options.particle_contacts.emplace();
        setup.materials.emplace_back();
        setup.materials[0].restitution = 0.0;
        setup.colliders = {{"floor", PlaneShape{}, 0}};
        setup.forces.push_back(make_gravity({0, 0, -10}));
        for (const double height : {0.5, 1.5}) {
            Particle particle;
            particle.position = {0, 0, height};
            particle.radius = 0.5;
            particle.mass = 3.0;
            setup.particles.push_back(particle);
        }
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        const TriangleTotals totals = simulation.triangle_totals(0);
        EXPECT_NEAR(totals.impulse[0].z, -2 * 3.0 * 10.0, 0.02 * 60.0) << sleeping;
        EXPECT_EQ(totals.lasting_impulse[0], totals.impulse[0]) << sleeping;
        EXPECT_EQ(totals.hits[0], 0U) << sleeping;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
