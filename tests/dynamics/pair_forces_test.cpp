// Tests forces of near pairs: closed forms, one evaluation per pair, consistent potentials, and refused settings.
#include "ricochet/dynamics/pair_forces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "support/random_points.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Particles with default values for everything that a test does not set.
struct Crowd {
    std::vector<Vec3> positions;
    std::vector<Vec3> velocities = std::vector<Vec3>(positions.size());
    std::vector<double> masses = std::vector<double>(positions.size(), 1.0);
    std::vector<double> radii = std::vector<double>(positions.size(), 0.0);
    std::vector<std::uint64_t> ids = std::vector<std::uint64_t>(positions.size(), 0);

    [[nodiscard]] ParticlesView view() const { return {0.0, ids, positions, velocities, masses, radii}; }
};

std::vector<Vec3> accelerations(const ParticlesForce& force, const Crowd& crowd) {
    std::vector<Vec3> result(crowd.positions.size());
    force.add_accelerations(crowd.view(), result);
    return result;
}

Crowd two(double distance, double radius = 0.0) {
    Crowd crowd{{{0, 0, 0}, {0, distance, 0}}};
    crowd.radii = {radius, radius};
    return crowd;
}

/// Returns the force on the first of two particles, along the line away from the second.
double push(const ParticlesForce& force, const Crowd& crowd) { return -accelerations(force, crowd)[0].y; }

TEST(LennardJones, IsTheDerivativeOfThePowersShiftedByTheForceAtTheCutoff) {
    const auto force = make_lennard_jones({2.0, 1.5, 2.5});
    const auto bare = [](double r) {
        return 24.0 * 2.0 / r * (2.0 * std::pow(1.5 / r, 12.0) - std::pow(1.5 / r, 6.0));
    };
    for (const double r : {1.4, 1.7, 2.5, 3.6}) {
        EXPECT_NEAR(push(*force, two(r)), bare(r) - bare(3.75), 1e-12 * std::fabs(bare(r))) << r;
    }
    EXPECT_EQ(push(*force, two(3.76)), 0.0);
    EXPECT_NEAR(push(*force, two(3.75 * (1.0 - 1e-9))), 0.0, 1e-8);
}

void expect_potential(const ParticlesForce& force, double distance, double radius) {
    constexpr double kStep = 1e-5;
    const auto potential = [&](double r) { return force.potential_energy(two(r, radius).view()).value(); };
    const double slope = (potential(distance - kStep) - potential(distance + kStep)) / (2.0 * kStep);
    EXPECT_NEAR(push(force, two(distance, radius)), slope, 1e-7 * (1.0 + std::fabs(slope))) << distance;
}

TEST(PairForces, HaveThePotentialsOfTheirForces) {
    for (const double r : {0.95, 1.1, 1.5, 2.4}) expect_potential(*make_lennard_jones({}), r, 0.0);
    for (const double r : {0.9, 1.05, 1.2, 1.35}) expect_potential(*make_cohesion({100.0, 0.4, 0.0}), r, 0.5);
}

TEST(Cohesion, MatchesItsFormula) {
    const auto force = make_cohesion({100.0, 0.3, 0.0});
    // the maximum, at a third of the range
    EXPECT_NEAR(push(*force, two(1.1, 0.5)), -100.0 * 0.1 * (4.0 / 9.0), 1e-12);
    EXPECT_NEAR(push(*force, two(0.9, 0.5)), 10.0, 1e-12);
    EXPECT_EQ(push(*force, two(1.31, 0.5)), 0.0);
    Crowd closing = two(1.0, 0.5);
    closing.velocities = {{0, 2, 0}, {0, 0, 5}};
    EXPECT_NEAR(push(*make_cohesion({100.0, 0.3, 4.0}), closing), 8.0, 1e-12);
}

Crowd crowd_of(std::size_t count, std::uint64_t seed) {
    Crowd crowd{test::charges_in_cube(count, seed).positions};
    for (std::size_t k = 0; k < count; ++k) {
        crowd.radii[k] = k % 50 == 0 ? 0.03 : 0.002;
        crowd.masses[k] = 1.0 + static_cast<double>(k % 7);
        crowd.velocities[k] = {crowd.positions[k].y, 0.3, -crowd.positions[k].x};
    }
    return crowd;
}

/// Sums over all pairs in the order of the particles.
std::vector<Vec3> by_brute_force(const Crowd& crowd, double cutoff, const std::function<Vec3(const PairState&)>& law) {
    std::vector<Vec3> sums(crowd.positions.size());
    for (std::size_t i = 0; i < sums.size(); ++i) {
        for (std::size_t j = i + 1; j < sums.size(); ++j) {
            const Vec3 d = crowd.positions[i] - crowd.positions[j];
            if (length(d) >= cutoff + crowd.radii[i] + crowd.radii[j]) continue;
            const Vec3 force = law({length(d),
                                    d / length(d),
                                    crowd.velocities[i] - crowd.velocities[j],
                                    {crowd.masses[i], crowd.masses[j]},
                                    {crowd.radii[i], crowd.radii[j]},
                                    {}});
            sums[i] += force;
            sums[j] -= force;
        }
    }
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = sums[i] / crowd.masses[i];
    return sums;
}

TEST(PairForces, IncludeEveryPairWithinTheCutoffOnce) {
    const auto law = [](const PairState& pair) {
        return (pair.masses[0] * pair.masses[1] / pair.distance) * pair.direction - 0.2 * pair.relative_velocity;
    };
    PairLaw settings;
    settings.cutoff = 0.05;
    settings.between_surfaces = true;
    settings.force = law;
    settings.depends_on_velocity = true;
    const auto force = make_pair_force(settings);
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const Crowd crowd = crowd_of(1500, seed);
        const std::vector<Vec3> found = accelerations(*force, crowd);
        const std::vector<Vec3> expected = by_brute_force(crowd, 0.05, law);
        for (std::size_t i = 0; i < found.size(); ++i) ASSERT_EQ(found[i], expected[i]) << "seed " << seed << ", " << i;
    }
    EXPECT_EQ(force->potential_energy(crowd_of(3, 1).view()), std::nullopt);
    EXPECT_TRUE(force->depends_on_velocity());
}

TEST(PairForces, GiveTheSameBitsForAnyThreadCount) {
    const Crowd crowd = crowd_of(20000, 4);
    const auto force = make_lennard_jones({1.0, 0.02, 2.5});
    std::vector<Vec3> first;
    for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        const std::vector<Vec3> found = accelerations(*force, crowd);
        if (threads == 1) first = found;
        EXPECT_EQ(found, first) << threads << " threads";
    }
}

TEST(PairForces, AreZeroForCoincidentPairsAndSkipNonFinitePositions) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    Crowd crowd{{{1, 1, 1}, {1, 1, 1}, {kNan, 0, 0}, {1, 1, 2.2}}};
    const std::vector<Vec3> found = accelerations(*make_lennard_jones({}), crowd);
    EXPECT_EQ(found[0], found[1]);
    EXPECT_GT(found[0].z, 0.0);
    EXPECT_EQ(found[2], (Vec3{}));
    EXPECT_NEAR(found[3].z, -2.0 * found[0].z, 1e-12);
}

TEST(PairForces, AreRefusedForInvalidSettings) {
    const auto expect_refused = [](const char* words, const std::function<void()>& call) {
        try {
            call();
            ADD_FAILURE() << "taken: " << words;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
        }
    };
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {0.0, -1.0, kNan}) {
        expect_refused("the depth", [&] { (void)make_lennard_jones({bad, 1.0, 2.5}); });
        expect_refused("the diameter", [&] { (void)make_lennard_jones({1.0, bad, 2.5}); });
        expect_refused("the cutoff", [&] { (void)make_lennard_jones({1.0, 1.0, bad}); });
        expect_refused("the range", [&] { (void)make_cohesion({1.0, bad, 0.0}); });
    }
    expect_refused("the stiffness", [] { (void)make_cohesion({-1.0, 1.0, 0.0}); });
    expect_refused("the cutoff", [] { (void)make_pair_force({}); });
    expect_refused("empty function", [] { (void)make_pair_force({.cutoff = 1.0, .force = {}}); });
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
