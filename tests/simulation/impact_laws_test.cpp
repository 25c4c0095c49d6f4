// Laws of impacts and of static friction in whole runs: closed forms, energy, the verifier, and saved states.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/random.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/simulation.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kGravity = 9.81;

SimulationSetup on_a_floor(const Material& material, double time_step, double duration) {
    SimulationSetup setup;
    setup.options.time_step = time_step;
    setup.options.duration = duration;
    setup.options.verify = true;
    setup.materials = {material};
    setup.colliders = {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0}};
    return setup;
}

double energy_of(const Simulation& simulation) {
    return simulation.kinetic_energy() + simulation.potential_energy().value_or(0.0);
}

/// Returns the simulation after its last step. energy_before: gets the energy at the start, in J.
Simulation finished(SimulationSetup setup, double* energy_before = nullptr) {
    Simulation simulation(std::move(setup));
    if (energy_before != nullptr) *energy_before = energy_of(simulation);
    while (!simulation.finished()) simulation.step();
    EXPECT_TRUE(simulation.violations().empty());
    return simulation;
}

Particle sphere_at(const Vec3& position, const Vec3& velocity, double radius) {
    Particle particle;
    particle.position = position;
    particle.velocity = velocity;
    particle.radius = radius;
    return particle;
}

// A ball that reverses its slip without loss (R. L. Garwin, "Kinematics of an ultraelastic rough ball", American
// Journal of Physics 37, 1969) keeps its energy, and after two bounces between parallel walls it returns.
TEST(ImpactLaws, ASuperballKeepsItsEnergyInABox) {
    SimulationSetup setup =
        on_a_floor({.name = "rubber", .friction = 100.0, .tangential_restitution = 1.0}, 0.01, 20.0);
    setup.colliders = {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0}, {"top", PlaneShape{{0, 0, 1}, {0, 0, -1}}, 0},
                       {"a", PlaneShape{{0, 0, 0}, {1, 0, 0}}, 0},     {"b", PlaneShape{{1, 0, 0}, {-1, 0, 0}}, 0},
                       {"c", PlaneShape{{0, 0, 0}, {0, 1, 0}}, 0},     {"d", PlaneShape{{0, 1, 0}, {0, -1, 0}}, 0}};
    setup.forces.push_back(make_gravity({0, 0, -kGravity}));
    RandomSequence random(3, 0, 0);
    for (int k = 0; k < 20; ++k) {
        Particle ball = sphere_at({0.2 + 0.6 * random.uniform(), 0.5, 0.5}, 4.0 * random.unit_vector(), 0.05);
        ball.spin = 50.0 * random.unit_vector();
        setup.particles.push_back(ball);
    }
    double before = 0.0;
    const Simulation simulation = finished(std::move(setup), &before);
    EXPECT_GT(simulation.statistics().contacts, 1000U);
    EXPECT_NEAR(energy_of(simulation), before, 1e-9 * before);
}

TEST(ImpactLaws, HeightsOfBouncesFollowThePowerLaw) {
    const Material steel{.name = "steel", .restitution = 0.8, .restitution_speed = 1.0, .restitution_exponent = 0.25};
    for (const double speed : {0.5, 1.0, 4.0, 30.0}) {
        SimulationSetup setup = on_a_floor(steel, 0.01, 0.05);
        setup.particles = {sphere_at({0, 0, 0.01 * speed}, {0, 0, -speed}, 0.0)};
        const Simulation simulation = finished(std::move(setup));
        const double expected = speed * 0.8 * std::pow(std::max(1.0, speed), -0.25);
        EXPECT_NEAR(simulation.particles().velocity[0].z, expected, 1e-14 * speed) << speed;
    }
}

TEST(ImpactLaws, ATableAppliesByTheAngleOfTheImpactToAMovingBeltToo) {
    Material belt{.name = "belt"};
    belt.impact_table = {{.angle = 0.0, .restitution = 0.9, .tangential_factor = 1.0},
                         {.angle = 90.0, .restitution = 0.3, .tangential_factor = 0.4}};
    belt.motion.velocity = {2.0, 0.0, 0.0};
    for (const double degrees : {0.0, 30.0, 45.0, 80.0}) {
        const double angle = degrees * std::numbers::pi / 180.0;
        SimulationSetup setup = on_a_floor(belt, 0.01, 0.02);
        const Vec3 relative{std::sin(angle), 0.0, -std::cos(angle)};
        setup.particles = {sphere_at({0, 0, 0.005 * std::cos(angle)}, relative + belt.motion.velocity, 0.0)};
        const Simulation simulation = finished(std::move(setup));
        const Vec3 after = simulation.particles().velocity[0] - belt.motion.velocity;
        const double part = degrees / 90.0;
        EXPECT_NEAR(after.z, (0.9 - 0.6 * part) * std::cos(angle), 1e-14) << degrees;
        EXPECT_NEAR(after.x, (1.0 - 0.6 * part) * std::sin(angle), 1e-14) << degrees;
    }
}

TEST(ImpactLaws, RestoredStatesOfAnotherLawAreRefused) {
    const auto saved = [](const Material& material) {
        std::vector<std::byte> bytes;
        Simulation(on_a_floor(material, 0.01, 0.1)).save([&](std::span<const std::byte> more) {
            bytes.insert(bytes.end(), more.begin(), more.end());
        });
        return bytes;
    };
    const auto restore = [](Simulation& simulation, const std::vector<std::byte>& bytes) {
        std::size_t at = 0;
        simulation.restore([&](std::span<std::byte> wanted) {
            std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), wanted.size(), wanted.begin());
            at += wanted.size();
        });
    };
    const Material plain{.name = "glass", .restitution = 0.9, .friction = 0.2};
    std::vector<Material> others(5, plain);
    others[0].tangential_restitution = 0.3;
    others[1].tangential_factor = 0.9;
    others[2].restitution_speed = 2.0;
    others[3].static_friction = 0.3;
    others[4].impact_table = {{.restitution = 0.9}};
    for (const Material& other : others) {
        Simulation simulation(on_a_floor(other, 0.01, 0.1));
        EXPECT_THROW(restore(simulation, saved(plain)), InputError);
        EXPECT_NO_THROW(restore(simulation, saved(other)));
    }
}

TEST(ImpactLaws, PairsOfSpheresPassTheVerifier) {
    SimulationSetup setup = on_a_floor({.name = "wall", .friction = 0.3, .tangential_restitution = 0.5}, 0.002, 0.4);
    PairContactSettings pairs;
    pairs.restitution = 0.9;
    pairs.friction = 0.3;
    pairs.tangential_restitution = 0.5;
    pairs.restitution_speed = 0.5;
    setup.options.particle_contacts = pairs;
    RandomSequence random(5, 0, 0);
    for (int k = 0; k < 64; ++k) {
        const Vec3 place{0.1 * (k % 4), 0.1 * (k / 4 % 4), 0.1 + 0.1 * (k / 16)};
        setup.particles.push_back(sphere_at(place, 2.0 * random.unit_vector(), 0.04));
    }
    double before = 0.0;
    const Simulation simulation = finished(std::move(setup), &before);
    EXPECT_GT(simulation.statistics().pair_impacts, 50U);
    EXPECT_LT(energy_of(simulation), before);
}

TEST(ImpactLaws, ThePenaltyResponseAndBodiesRefuseThem) {
    SimulationSetup setup = on_a_floor({.name = "glass", .friction = 0.2, .tangential_restitution = 0.3}, 0.01, 0.1);
    setup.options.verify = false;
    setup.options.response = ResponseKind::penalty;
    EXPECT_THROW(Simulation{std::move(setup)}, InputError);
}

/// Returns the setup of a particle on a slope of an angle, in degrees.
SimulationSetup on_a_slope(const Material& material, double degrees, const Vec3& velocity, double radius) {
    SimulationSetup setup = on_a_floor(material, 0.01, 1.0);
    const double angle = degrees * std::numbers::pi / 180.0;
    setup.forces.push_back(make_gravity({kGravity * std::sin(angle), 0, -kGravity * std::cos(angle)}));
    setup.particles = {sphere_at({0, 0, radius}, velocity, radius)};
    return setup;
}

const Material kStickySlope{.name = "slope", .restitution = 0.0, .friction = 0.3, .static_friction = 0.6};

// tan 25 degrees = 0.466 lies between both coefficients.
TEST(StaticFriction, HoldsAPointThatRestsButNotOneThatSlides) {
    const Simulation rests = finished(on_a_slope(kStickySlope, 25.0, {}, 0.0));
    EXPECT_EQ(rests.particles().position[0].x, 0.0);
    EXPECT_EQ(rests.particles().velocity[0], Vec3{});
    const Simulation slides = finished(on_a_slope(kStickySlope, 25.0, {0.1, 0, 0}, 0.0));
    const double angle = 25.0 * std::numbers::pi / 180.0;
    const double rate = kGravity * (std::sin(angle) - 0.3 * std::cos(angle));
    EXPECT_NEAR(slides.particles().velocity[0].x, 0.1 + rate, 1e-9);
}

TEST(StaticFriction, LetsAPointSlipOnASteeperSlopeWithTheFrictionOfSlip) {
    const double angle = 35.0 * std::numbers::pi / 180.0;
    const Simulation slips = finished(on_a_slope(kStickySlope, 35.0, {}, 0.0));
    const double rate = kGravity * (std::sin(angle) - 0.3 * std::cos(angle));
    EXPECT_NEAR(slips.particles().velocity[0].x, rate, 1e-9);
}

TEST(StaticFriction, StopsAPointThatSlidesUphillAndHoldsItThere) {
    const Simulation stops = finished(on_a_slope(kStickySlope, 25.0, {-0.5, 0, 0}, 0.0));
    const double angle = 25.0 * std::numbers::pi / 180.0;
    const double rate = kGravity * (std::sin(angle) + 0.3 * std::cos(angle));
    EXPECT_NEAR(stops.particles().position[0].x, -0.5 * 0.25 / rate, 1e-9);
    EXPECT_EQ(stops.particles().velocity[0], Vec3{});
}

// A solid sphere rolls up to tan = 3.5 mu. It accelerates with 5/7 g sin, and slips with the friction of slip.
TEST(StaticFriction, LetsASphereRollOnSteeperSlopes) {
    constexpr double kRadius = 0.05;
    const Material rough{.name = "slope", .restitution = 0.0, .friction = 0.2, .static_friction = 0.4};
    const double angle = 45.0 * std::numbers::pi / 180.0;
    const Simulation rolls = finished(on_a_slope(rough, 45.0, {}, kRadius));
    EXPECT_NEAR(rolls.particles().velocity[0].x, 5.0 / 7.0 * kGravity * std::sin(angle), 1e-9);
    EXPECT_NEAR(rolls.particles().spin[0].y * kRadius, rolls.particles().velocity[0].x, 1e-9);
    const double steep = 60.0 * std::numbers::pi / 180.0;
    const Simulation slips = finished(on_a_slope(rough, 60.0, {}, kRadius));
    EXPECT_NEAR(slips.particles().velocity[0].x, kGravity * (std::sin(steep) - 0.2 * std::cos(steep)), 1e-9);
    EXPECT_NEAR(slips.particles().spin[0].y * kRadius, 2.5 * 0.2 * kGravity * std::cos(steep), 1e-9);
}

// Without rebound, an impact stops the slip if static friction suffices. Otherwise the friction of slip acts.
TEST(StaticFriction, DecidesWhetherALandingSticks) {
    for (const auto& [slip, expected] : {std::pair(0.5, 0.0), std::pair(0.7, 0.4)}) {
        SimulationSetup setup = on_a_floor(kStickySlope, 0.01, 0.01);
        setup.particles = {sphere_at({0, 0, 0.005}, {slip, 0, -1.0}, 0.0)};
        const Simulation simulation = finished(std::move(setup));
        EXPECT_NEAR(simulation.particles().velocity[0].x, expected, 1e-12) << slip;
    }
}

// The wedge turns with the scene: the answers stay.
TEST(StaticFriction, HoldsInAGrooveOfTwoWallsHoweverItIsTurned) {
    RandomSequence random(11, 0, 0);
    for (int k = 0; k < 10; ++k) {
        const Vec3 axis = random.unit_vector();
        const auto [side, up] = tangent_frame(axis);
        const double s = std::sqrt(0.5);
        SimulationSetup setup = on_a_floor(kStickySlope, 0.01, 0.3);
        setup.colliders = {{"left", PlaneShape{{}, normalized(s * up + s * side)}, 0},
                           {"right", PlaneShape{{}, normalized(s * up - s * side)}, 0}};
        // Each wall carries 1/sqrt(2) of the load, so friction holds up to sqrt(2) mu times the load.
        const double along = k % 2 == 0 ? 0.7 : 0.95;
        setup.forces.push_back(make_gravity(kGravity * (along * axis - up)));
        setup.particles = {sphere_at({}, {}, 0.0)};
        const Simulation simulation = finished(std::move(setup));
        const double speed = dot(simulation.particles().velocity[0], axis);
        const double expected = k % 2 == 0 ? 0.0 : 0.3 * kGravity * (along - 0.3 * std::sqrt(2.0));
        EXPECT_NEAR(speed, expected, 1e-8) << k;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
