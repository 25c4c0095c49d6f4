#include "ricochet/dynamics/springs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>

#include "ricochet/core/error.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Random particles and springs. Particle i has the id 10 + 3 i.
struct RandomNetwork {
    explicit RandomNetwork(unsigned seed, std::size_t particles = 40, std::size_t spring_count = 120) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(-1.0, 1.0);
        for (std::size_t i = 0; i < particles; ++i) {
            ids.push_back(10 + 3 * i);
            position.push_back({unit(random), unit(random), unit(random)});
            velocity.push_back({unit(random), unit(random), unit(random)});
        }
        std::uniform_int_distribution<std::size_t> pick(0, particles - 1);
        while (springs.size() < spring_count) {
            const std::size_t a = pick(random);
            const std::size_t b = pick(random);
            if (a == b) continue;
            springs.push_back({ids[a], ids[b], 1.0 + unit(random), 50.0 * (1.5 + unit(random)), 1.0 + unit(random)});
        }
    }

    std::vector<std::uint64_t> ids;
    std::vector<Vec3> position;
    std::vector<Vec3> velocity;
    std::vector<Spring> springs;
};

template <typename T>
std::vector<T> reordered(const std::vector<T>& values, const std::vector<std::size_t>& order) {
    std::vector<T> result;
    for (const std::size_t i : order) result.push_back(values[i]);
    return result;
}

std::string refusal(std::vector<Spring> springs) {
    try {
        (void)SpringNetwork(std::move(springs));
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

TEST(SpringForce, PullsByStretchAndDampsAlongTheSpringOnly) {
    const Spring spring{0, 1, 2.0, 10.0, 0.5};
    // Stretched by 1 m. The far end recedes at 4 m/s and moves across at 7 m/s.
    EXPECT_EQ(spring_force(spring, {1, 0, 0}, {}, {4, 0, 0}, {4, 7, 0}), (Vec3{12, 0, 0}));
    // Compressed by 1 m.
    EXPECT_EQ(spring_force(spring, {1, 0, 0}, {}, {1, 0, 1}, {}), (Vec3{0, 0, -10}));
    // Both ends move with the same velocity.
    EXPECT_EQ(spring_force(spring, {1, 0, 0}, {5, 6, 7}, {3, 0, 0}, {5, 6, 7}), Vec3{});
}

TEST(SpringForce, IsZeroIfTheEndsCoincide) {
    EXPECT_EQ(spring_force({0, 1, 2.0, 10.0, 0.5}, {1, 2, 3}, {}, {1, 2, 3}, {4, 5, 6}), Vec3{});
}

TEST(SpringForce, IsExactlyOppositeOnTheOtherEnd) {
    const unsigned seed = 20231;
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const auto vector = [&] { return Vec3{unit(random), unit(random), unit(random)}; };
    for (int i = 0; i < test::scaled(10000); ++i) {
        const Spring spring{0, 1, 1.0 + unit(random), 100.0, 3.0};
        const Vec3 x1 = vector();
        const Vec3 v1 = vector();
        const Vec3 x2 = vector();
        const Vec3 v2 = vector();
        ASSERT_EQ(spring_force(spring, x1, v1, x2, v2), -spring_force(spring, x2, v2, x1, v1));
    }
}

TEST(SpringNetwork, GathersTheForcesOfAllSpringsOfAParticle) {
    RandomNetwork made(7);
    SpringNetwork network(made.springs);
    network.bind(made.ids);
    for (std::uint32_t i = 0; i < made.ids.size(); ++i) {
        Vec3 expected;
        for (const Spring& spring : made.springs) {
            const std::size_t a = (spring.first - 10) / 3;
            const std::size_t b = (spring.second - 10) / 3;
            const Vec3 force =
                spring_force(spring, made.position[a], made.velocity[a], made.position[b], made.velocity[b]);
            if (a == i) expected += force;
            if (b == i) expected -= force;
        }
        EXPECT_EQ(network.force_on(i, made.position, made.velocity), expected) << i;
    }
}

TEST(SpringNetwork, GivesTheSameBitsInAnyOrderOfTheParticles) {
    const unsigned seed = 991;
    SCOPED_TRACE(seed);
    RandomNetwork made(seed);
    SpringNetwork network(made.springs);
    network.bind(made.ids);
    std::vector<Vec3> expected;
    for (std::uint32_t i = 0; i < made.ids.size(); ++i) {
        expected.push_back(network.force_on(i, made.position, made.velocity));
    }
    std::mt19937 random(seed);
    std::vector<std::size_t> order(made.ids.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (int repetition = 0; repetition < test::scaled(50); ++repetition) {
        std::shuffle(order.begin(), order.end(), random);
        network.bind(reordered(made.ids, order));
        const auto position = reordered(made.position, order);
        const auto velocity = reordered(made.velocity, order);
        for (std::uint32_t i = 0; i < order.size(); ++i) {
            ASSERT_EQ(network.force_on(i, position, velocity), expected[order[i]]);
        }
    }
    EXPECT_EQ(network.lost(), 0U);
}

TEST(SpringNetwork, KeepsMomentumAndAngularMomentumToRounding) {
    RandomNetwork made(3);
    SpringNetwork network(made.springs);
    network.bind(made.ids);
    Vec3 force;
    Vec3 torque;
    double magnitude = 0.0;
    for (const std::uint32_t i : network.coupled()) {
        const Vec3 on_i = network.force_on(i, made.position, made.velocity);
        force += on_i;
        torque += cross(made.position[i], on_i);
        magnitude += length(on_i);
    }
    EXPECT_GT(magnitude, 100.0);
    EXPECT_LT(length(force), 1e-13 * magnitude);
    EXPECT_LT(length(torque), 1e-13 * magnitude);
}

TEST(SpringNetwork, ForceIsTheNegativeSlopeOfTheEnergy) {
    RandomNetwork made(12);
    for (Spring& spring : made.springs) spring.damping = 0.0;
    SpringNetwork network(made.springs);
    network.bind(made.ids);
    const double h = 1e-5;
    for (std::uint32_t i = 0; i < made.ids.size(); ++i) {
        const Vec3 force = network.force_on(i, made.position, made.velocity);
        for (int axis = 0; axis < 3; ++axis) {
            auto moved = made.position;
            moved[i][axis] += h;
            const double after = network.potential_energy(moved);
            moved[i][axis] -= 2.0 * h;
            const double before = network.potential_energy(moved);
            EXPECT_NEAR(force[axis], (before - after) / (2.0 * h), 1e-5 * (1.0 + length(force))) << i;
        }
    }
}

TEST(SpringNetwork, LinksAndBondsAreInTheOrderOfSpringNumbers) {
    RandomNetwork made(4);
    SpringNetwork network(made.springs);
    std::reverse(made.ids.begin(), made.ids.end());
    network.bind(made.ids);
    std::size_t ends = 0;
    for (std::uint32_t i = 0; i < made.ids.size(); ++i) {
        const auto links = network.links(i);
        ends += links.size();
        EXPECT_EQ(std::binary_search(network.coupled().begin(), network.coupled().end(), i), !links.empty());
        for (std::size_t k = 0; k < links.size(); ++k) {
            const Spring& spring = made.springs[links[k].spring];
            EXPECT_TRUE((spring.first == made.ids[i] && spring.second == made.ids[links[k].other]) ||
                        (spring.second == made.ids[i] && spring.first == made.ids[links[k].other]));
            EXPECT_TRUE(k == 0 || links[k - 1].spring < links[k].spring);
        }
    }
    EXPECT_EQ(ends, 2 * made.springs.size());
    ASSERT_EQ(network.bonds().size(), made.springs.size());
    for (std::uint32_t k = 0; k < network.bonds().size(); ++k) {
        EXPECT_EQ(network.bonds()[k].spring, k);
        EXPECT_EQ(made.ids[network.bonds()[k].a], made.springs[k].first);
        EXPECT_EQ(made.ids[network.bonds()[k].b], made.springs[k].second);
    }
}

TEST(SpringNetwork, CoupledListsOnlyParticlesWithASpring) {
    SpringNetwork network({{4, 9, 1.0, 1.0, 0.0}});
    network.bind(std::vector<std::uint64_t>{1, 4, 6, 9});
    EXPECT_EQ(network.coupled(), (std::vector<std::uint32_t>{1, 3}));
    EXPECT_TRUE(network.links(0).empty());
    const std::vector<Vec3> places(4);
    EXPECT_EQ(network.force_on(2, places, places), Vec3{});
}

TEST(SpringNetwork, BreaksOverstretchedSpringsPermanently) {
    SpringNetwork network({{0, 1, 1.0, 1.0, 0.0, 0.5}, {1, 2, 1.0, 1.0, 0.0}, {2, 3, 1.0, 1.0, 0.0, 0.25}});
    const std::vector<std::uint64_t> ids{0, 1, 2, 3};
    network.bind(ids);
    const std::vector<Vec3> at_the_limit{{0, 0, 0}, {1.5, 0, 0}, {10, 0, 0}, {10, 1.25, 0}};
    EXPECT_EQ(network.break_overstretched(at_the_limit), 0U);
    const std::vector<Vec3> beyond{{0, 0, 0}, {1.5, 0, 0}, {10, 0, 0}, {10, 1.26, 0}};
    EXPECT_EQ(network.break_overstretched(beyond), 1U);
    EXPECT_FALSE(network.is_intact(2));
    EXPECT_TRUE(network.is_intact(0));
    EXPECT_EQ(network.broken(), 1U);
    EXPECT_EQ(network.coupled(), (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(network.links(2).size(), 1U);
    EXPECT_EQ(network.force_on(3, beyond, beyond), Vec3{});
    const std::vector<Vec3> together(4);
    EXPECT_EQ(network.break_overstretched(together), 0U);
    network.bind(ids);
    EXPECT_FALSE(network.is_intact(2));
    EXPECT_EQ(network.bonds().size(), 2U);
    EXPECT_EQ(network.lost(), 0U);
}

TEST(SpringNetwork, RemovesTheSpringsOfRemovedParticlesPermanently) {
    SpringNetwork network({{0, 1, 1.0, 1.0, 0.0}, {1, 2, 1.0, 1.0, 0.0}, {2, 3, 1.0, 1.0, 0.0}});
    network.bind(std::vector<std::uint64_t>{0, 2, 3});
    EXPECT_EQ(network.lost(), 2U);
    EXPECT_EQ(network.broken(), 0U);
    ASSERT_EQ(network.bonds().size(), 1U);
    EXPECT_EQ(network.bonds()[0].spring, 2U);
    EXPECT_EQ(network.bonds()[0].a, 1U);
    network.bind(std::vector<std::uint64_t>{0, 1, 2, 3});
    EXPECT_EQ(network.bonds().size(), 1U);
    EXPECT_EQ(network.lost(), 2U);
}

TEST(SpringNetwork, WithoutSpringsIsEmptyAndBindsToAnything) {
    SpringNetwork network;
    EXPECT_TRUE(network.empty());
    network.bind(std::vector<std::uint64_t>{5, 6});
    EXPECT_TRUE(network.coupled().empty());
    const std::vector<Vec3> places(2);
    EXPECT_EQ(network.force_on(1, places, places), Vec3{});
    EXPECT_EQ(network.potential_energy(places), 0.0);
    EXPECT_EQ(network.break_overstretched(places), 0U);
}

TEST(SpringNetwork, RefusesImpossibleSpringsByTheirNumber) {
    const Spring good{0, 1, 1.0, 1.0, 0.0};
    EXPECT_EQ(refusal({good, {3, 3, 1.0, 1.0, 0.0}}), "spring 1: both ends are particle 3, expected two particles");
    EXPECT_EQ(refusal({{0, 1, 1.0, -2.0, 0.0}}),
              "spring 0: stiffness: found -2, expected a finite number of at least 0 (N/m)");
    EXPECT_NE(refusal({{0, 1, -1.0, 1.0, 0.0}}).find("rest_length"), std::string::npos);
    EXPECT_NE(refusal({{0, 1, 1.0, 1.0, kInfinity}}).find("damping"), std::string::npos);
    EXPECT_NE(refusal({{0, 1, 1.0, 1.0, 0.0, 0.0}}).find("breaking_stretch"), std::string::npos);
    EXPECT_NE(refusal({{0, 1, 0.0, 1.0, 0.0, 0.5}}).find("without a rest length"), std::string::npos);
    EXPECT_EQ(refusal({good, {0, 1, 0.0, 1.0, 0.0}}), "");
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
