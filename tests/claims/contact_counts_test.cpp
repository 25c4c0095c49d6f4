// The numbers of impacts of carried, sliding and rolling particles do not change if the time step is halved.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "claims/contact_scene.h"
#include "claims/moving_scene.h"
#include "ricochet/geometry/mesh/mass_moments.h"
#include "support/simple_meshes.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kG = kStandardGravity;
constexpr double kStep = 0.01;

/// Returns a plank of 2 x 1 x 0.2 m with 3 kg. Depending on the joint, it turns about y, or moves along z on a spring.
SimulationSetup plank_setup(JointKind joint, double spring, double damping, const Particle& particle) {
    SimulationSetup setup = ricochet::testing::setup_of(kStep, 1.0, Material{"wood", 0.5, 0.4}, {0, 0, -kG});
    setup.options.record_contacts = true;
    setup.options.verify = true;
    FrameDescription frame;
    frame.name = "plank";
    frame.is_driven = true;
    setup.frames = std::make_shared<const FrameTree>(std::vector<FrameDescription>{frame});
    const Vec3 size{2, 1, 0.2};
    setup.colliders = {{"plank", CuboidShape{size, {}}, 0, "plank"}};
    BodyDescription body;
    body.frame = "plank";
    body.mass = 3.0;
    const MassMoments moments = moments_of(cuboid_mesh(size));
    body.inertia = (body.mass / moments.volume) * moments.inertia();
    body.joint = joint;
    body.axis = joint == JointKind::hinge ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
    body.settings.spring = spring;
    body.settings.damping = damping;
    setup.bodies = {body};
    setup.particles = {particle};
    return setup;
}

Particle ball_at(const Vec3& position) {
    Particle ball = particle_of(position, {}, 0.05);
    ball.mass = 0.5;
    return ball;
}

struct Counts {
    std::uint64_t contacts = 0;
    std::uint64_t rows = 0;
    std::uint64_t hits = 0;  ///< impacts on all surfaces
    double slowest = 1e300;  ///< smallest approach speed of a record, in m/s
    Vec3 impulse;            ///< impulse on all surfaces, in N s
    Vec3 momentum;           ///< momentum of the particle at the end, in kg m/s
};

/// Runs a setup and counts its impacts. make() returns a new setup for each run.
template <class Make>
Counts counts_of(const Make& make, double time_step) {
    SimulationSetup setup = make();
    setup.options.time_step = time_step;
    Simulation simulation(std::move(setup));
    Counts counts;
    while (!simulation.finished()) {
        simulation.step();
        counts.rows += simulation.contact_records().size();
        for (const ContactRecord& record : simulation.contact_records()) {
            const double approach = -dot(record.velocity_before - record.surface_velocity, record.normal);
            counts.slowest = std::min(counts.slowest, approach);
        }
    }
    EXPECT_EQ(simulation.statistics().energy_violations, 0U);
    counts.contacts = simulation.statistics().contacts;
    for (const ColliderTotals& totals : simulation.collider_totals()) {
        counts.hits += totals.hits;
        counts.impulse += totals.impulse;
    }
    counts.momentum = simulation.particles().mass[0] * simulation.particles().velocity[0];
    return counts;
}

TEST(TheCountsOfAParticleThatIsCarried, AreZeroAtAnyTimeStepIfItIsCarriedFromTheStart) {
    const auto setup = [] { return plank_setup(JointKind::hinge, 0.0, 0.0, ball_at({0.3, 0.05, 0.15})); };
    for (const double part : {1.0, 0.5, 0.25}) {
        const Counts counts = counts_of(setup, part * kStep);
        EXPECT_EQ(counts.contacts, 0U) << part;
        EXPECT_EQ(counts.rows, 0U) << part;
        EXPECT_EQ(counts.hits, 0U) << part;
        // The impulse of lasting contact is complete. It equals gravity's impulse minus the ball's momentum.
        const Vec3 given = Vec3{0, 0, -0.5 * kG} - counts.momentum;
        EXPECT_LT(length(counts.impulse - given), 1e-9) << part;
    }
}

TEST(TheCountsOfAParticleThatIsCarried, AreTheNumberOfItsBouncesAtAnyTimeStep) {
    const auto setup = [] { return plank_setup(JointKind::hinge, 40.0, 1.0, ball_at({0.3, 0.05, 0.5})); };
    std::array<Counts, 3> counts;
    for (std::size_t k = 0; k < counts.size(); ++k) {
        counts[k] = counts_of(setup, kStep / static_cast<double>(1U << k));
        EXPECT_EQ(counts[k].contacts, counts[0].contacts);
        EXPECT_EQ(counts[k].rows, counts[k].contacts);
        EXPECT_EQ(counts[k].hits, counts[k].rows);
        EXPECT_GT(counts[k].slowest, 1e-3);
        const Vec3 given = Vec3{0, 0, -0.5 * kG} - counts[k].momentum;
        EXPECT_LT(length(counts[k].impulse - given), 1e-9);
    }
    EXPECT_GT(counts[0].contacts, 5U);
}

// A particle that the plank throws up has separated from it. The landing therefore counts as an impact.
TEST(TheCountsOfAParticleThatIsCarried, IncludeItsLandingAfterTheBodyHasThrownItUp) {
    const auto setup = [] {
        SimulationSetup thrown = plank_setup(JointKind::slider, 2000.0, 0.0, ball_at({0.1, 0.05, 0.15}));
        thrown.bodies[0].rate = 3.0;
        thrown.options.duration = 0.3;
        return thrown;
    };
    std::array<Counts, 3> counts;
    for (std::size_t k = 0; k < counts.size(); ++k) {
        counts[k] = counts_of(setup, kStep / static_cast<double>(1U << k));
        EXPECT_EQ(counts[k].rows, counts[0].rows);
        EXPECT_GT(counts[k].slowest, 1e-3);
    }
}

/// Returns a particle that slides down a frictionless slope and hits a wall with friction.
SimulationSetup slide_setup(double radius) {
    SimulationSetup setup =
        ricochet::testing::setup_of(kStep, 0.6, Material{"floor", 0.5, 0.0}, {0, -0.6 * kG, -0.8 * kG});
    setup.options.record_contacts = true;
    setup.materials.push_back({"wall", 0.5, 0.3});
    setup.colliders = {plane_collider({}, {0, 0.6, 0.8}), plane_collider({1, 0, 0}, {-1, 0, 0})};
    setup.colliders[1].material = 1;
    setup.particles = {particle_of((radius + 1e-9) * Vec3{0, 0.6, 0.8}, {4, 0, 0}, radius)};
    return setup;
}

// After the impact on the wall, the particle continues along the floor. A landing at a ten-millionth of its speed must
// not count.
TEST(TheCountsOfAParticleThatSlides, IncludeOneImpactAtAWallAtAnyTimeStep) {
    for (const double radius : {0.0, 0.05}) {
        for (const double part : {1.0, 0.5, 0.25}) {
            const Counts counts = counts_of([&] { return slide_setup(radius); }, part * kStep);
            EXPECT_EQ(counts.contacts, 2U) << radius << ' ' << part;  // the first landing and the impact on the wall
            EXPECT_EQ(counts.rows, 2U) << radius << ' ' << part;
        }
    }
}

/// Returns a sphere in a trough of facets.
SimulationSetup trough_setup() {
    TriangleMesh trough;
    constexpr std::uint32_t kFacets = 12;
    for (std::uint32_t k = 0; k <= kFacets; ++k) {
        const double angle = 2.0 * (static_cast<double>(k) / kFacets - 0.5);
        for (const double y : {-1.0, 1.0}) trough.vertices.push_back({std::sin(angle), y, 1.0 - std::cos(angle)});
    }
    for (std::uint32_t k = 0; k < kFacets; ++k) {
        trough.triangles.push_back({2 * k, 2 * k + 2, 2 * k + 1});
        trough.triangles.push_back({2 * k + 1, 2 * k + 2, 2 * k + 3});
    }
    SimulationSetup setup = ricochet::testing::setup_of(kStep, 1.0, Material{"", 0.0, 0.5}, {0, 0, -kG});
    setup.options.record_contacts = true;
    setup.colliders = {mesh_collider(trough, {}, "trough")};
    setup.particles = {particle_of({-0.5, 0.03, 0.3}, {}, 0.1)};
    return setup;
}

// The sphere rolls up and down over the edges between the facets.
TEST(TheCountsOfAParticleThatRolls, AreTheNumberOfCrossedFacetsAtAnyTimeStep) {
    const Counts whole = counts_of(trough_setup, kStep);
    for (const double part : {0.5, 0.25}) {
        const Counts counts = counts_of(trough_setup, part * kStep);
        EXPECT_EQ(counts.contacts, whole.contacts) << part;
        EXPECT_EQ(counts.rows, whole.rows) << part;
        EXPECT_GT(counts.slowest, 1e-4) << part;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
