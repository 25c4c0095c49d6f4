#include "ricochet/dynamics/emitter.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include "dynamics/chi_square.h"
#include "ricochet/core/error.h"
#include "ricochet/core/random.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::chi_square;
using test::chi_square_limit;

constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr double kPi = 3.14159265358979323846;
constexpr std::uint64_t kSamples = test::kSanitized ? 4000 : 40000;

EmitterDescription burst_of(EmitterShape shape, std::uint64_t count = kSamples) {
    EmitterDescription description;
    description.name = "test";
    description.shape = std::move(shape);
    description.burst = count;
    return description;
}

std::vector<Particle> all_births(const EmitterDescription& description, double duration = 1.0, std::uint64_t seed = 1) {
    return Emitter(description, seed, 0).births(0.0, duration);
}

std::vector<Particle> all_births_of(const EmitterDescription& description, std::uint64_t seed, std::uint32_t number) {
    return Emitter(description, seed, number).births(0.0, 1.0);
}

// Compares chi-square over equally likely bins with the value exceeded with probability 1e-6.
void expect_uniform(const std::vector<Particle>& samples, std::size_t bins,
                    const std::function<double(const Particle&)>& fraction) {
    std::vector<double> observed(bins, 0.0);
    for (const Particle& particle : samples) {
        const double f = fraction(particle);
        ASSERT_GE(f, 0.0);
        ASSERT_LE(f, 1.0);
        observed[std::min(bins - 1, static_cast<std::size_t>(f * static_cast<double>(bins)))] += 1.0;
    }
    const std::vector<double> expected(bins, static_cast<double>(samples.size()) / static_cast<double>(bins));
    EXPECT_LT(chi_square(observed, expected), chi_square_limit(bins - 1));
}

double turn_fraction(double x, double y) { return (std::atan2(y, x) + kPi) / (2.0 * kPi); }

void expect_same_bits(const std::vector<Particle>& a, const std::vector<Particle>& b) {
    ASSERT_EQ(a.size(), b.size());
    const auto same = [](double x, double y) {
        return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
    };
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_TRUE(same(a[i].birth_time, b[i].birth_time)) << i;
        ASSERT_TRUE(same(a[i].mass, b[i].mass) && same(a[i].lifetime, b[i].lifetime)) << i;
        for (int axis = 0; axis < 3; ++axis) {
            ASSERT_TRUE(same(a[i].position[axis], b[i].position[axis])) << i;
            ASSERT_TRUE(same(a[i].velocity[axis], b[i].velocity[axis])) << i;
        }
    }
}

TEST(Emitter, ASteadyRateSpawnsWhenItsIntegralPassesHalfCounts) {
    EmitterDescription description = burst_of(PointShape{}, 0);
    description.rate = {10.0, 0.0};
    description.start = 2.0;
    const auto births = all_births(description, 4.0);
    ASSERT_EQ(births.size(), 20U);
    for (std::size_t k = 0; k < births.size(); ++k) {
        EXPECT_DOUBLE_EQ(births[k].birth_time, 2.0 + (static_cast<double>(k) + 0.5) / 10.0);
    }
}

TEST(Emitter, ASpreadTooSmallToMatterGivesTheSteadySchedule) {
    EmitterDescription steady = burst_of(PointShape{}, 0);
    steady.rate = {10.0, 0.0};
    EmitterDescription redrawn = steady;
    redrawn.rate.spread = 1e-12;
    const auto a = all_births(steady, 10.0);
    const auto b = all_births(redrawn, 10.0);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i].birth_time, b[i].birth_time, 1e-11);
}

TEST(Emitter, TheRateIsDrawnAnewForEverySecondWithinItsSpread) {
    EmitterDescription description = burst_of(PointShape{}, 0);
    description.rate = {2000.0, 200.0};
    const std::size_t seconds = 400;
    std::vector<double> counts(seconds, 0.0);
    for (const Particle& p : all_births(description, static_cast<double>(seconds))) {
        counts[static_cast<std::size_t>(p.birth_time)] += 1.0;
    }
    double mean = 0.0;
    double variance = 0.0;
    for (const double c : counts) {
        EXPECT_GE(c, 1799.0);
        EXPECT_LE(c, 2201.0);
        mean += c / static_cast<double>(seconds);
    }
    for (const double c : counts) variance += (c - mean) * (c - mean) / static_cast<double>(seconds - 1);
    // The distribution is uniform with half width 200 and standard deviation 115.5. The mean of 400 has 5.77. The
    // relative standard error of the variance is sqrt(0.8 / 400) = 0.045. The limits are five sigma.
    EXPECT_NEAR(mean, 2000.0, 29.0);
    EXPECT_NEAR(variance, 200.0 * 200.0 / 3.0, 5 * 0.045 * 13333.0);
}

TEST(Emitter, NegativeDrawsOfTheRateCountAsZero) {
    EmitterDescription description = burst_of(PointShape{}, 0);
    description.rate = {0.0, 300.0};
    const std::size_t seconds = 400;
    std::vector<double> counts(seconds, 0.0);
    const auto births = all_births(description, static_cast<double>(seconds));
    for (const Particle& p : births) counts[static_cast<std::size_t>(p.birth_time)] += 1.0;
    const auto idle = std::count(counts.begin(), counts.end(), 0.0);
    // Half of the seconds draw a negative rate: 200 +- 10 (one sigma). The mean rate is 300 / 4, with a standard
    // deviation of 96.8 per second. Five sigma of the total are 9680.
    EXPECT_NEAR(static_cast<double>(idle), 200.0, 50.0);
    EXPECT_NEAR(static_cast<double>(births.size()), 400 * 75.0, 9700.0);
}

TEST(Emitter, BirthsDoNotDependOnTheTimeSteps) {
    EmitterDescription description = burst_of(DiskShape{{1, 2, 3}, {1, 1, 0}, 0.5}, 100);
    description.start = 0.3;
    description.stop = 6.5;
    description.cone_degrees = 30.0;
    description.speed = {3.0, 0.5};
    description.mass = {2.0, 1.0};
    description.lifetime = {4.0, 1.0};
    for (const double spread : {0.0, 5.0, 400.0}) {
        description.rate = {150.0, spread};
        const auto whole = Emitter(description, 9, 4).births(0.0, 8.0);
        ASSERT_GT(whole.size(), 200U);
        for (const double step : {1.0 / 60.0, 0.1, 0.5, 1.0, 3.7}) {
            SCOPED_TRACE(::testing::Message() << "spread " << spread << ", step " << step);
            Emitter emitter(description, 9, 4);
            std::vector<Particle> parts;
            for (double from = 0.0; from < 8.0; from = std::min(8.0, from + step)) {
                const double to = std::min(8.0, from + step);
                for (const Particle& p : emitter.births(from, to)) {
                    ASSERT_GE(p.birth_time, from);
                    ASSERT_LT(p.birth_time, to);
                    parts.push_back(p);
                }
            }
            expect_same_bits(parts, whole);
        }
    }
}

TEST(Emitter, BirthsComeInTheOrderOfTheirTimes) {
    EmitterDescription description = burst_of(PointShape{}, 10);
    description.start = 0.25;
    description.rate = {5.0, 5.0};
    const auto births = all_births(description, 200.0);
    EXPECT_TRUE(std::is_sorted(births.begin(), births.end(),
                               [](const Particle& a, const Particle& b) { return a.birth_time < b.birth_time; }));
    EXPECT_EQ(births[9].birth_time, 0.25);
    EXPECT_GT(births[10].birth_time, 0.25);
}

TEST(Emitter, TheEndOfTheIntervalBelongsToTheNextOne) {
    EmitterDescription description = burst_of(PointShape{}, 3);
    description.start = 1.0;
    Emitter emitter(description, 1, 0);
    EXPECT_TRUE(emitter.births(0.0, 1.0).empty());
    EXPECT_EQ(emitter.births(1.0, 2.0).size(), 3U);
    EXPECT_TRUE(emitter.births(2.0, 3.0).empty());
}

TEST(Emitter, StopEndsTheRateAndLimitEndsAllBirths) {
    EmitterDescription description = burst_of(PointShape{}, 7);
    description.rate = {10.0, 0.0};
    description.stop = 2.0;
    EXPECT_EQ(all_births(description, 100.0).size(), 27U);
    description.limit = 12;
    EXPECT_EQ(all_births(description, 100.0).size(), 12U);
    description.limit = 5;
    EXPECT_EQ(all_births(description, 100.0).size(), 5U);
    description.rate.spread = 3.0;
    description.limit = 12;
    EXPECT_EQ(all_births(description, 100.0).size(), 12U);
}

TEST(Emitter, SeedsAndEmittersDrawDifferently) {
    const EmitterDescription description = burst_of(BoxShape{}, 1);
    const Vec3 base = Emitter(description, 1, 0).births(0, 1)[0].position;
    EXPECT_EQ(base, Emitter(description, 1, 0).births(0, 1)[0].position);
    EXPECT_NE(base, Emitter(description, 2, 0).births(0, 1)[0].position);
    EXPECT_NE(base, Emitter(description, 1, 1).births(0, 1)[0].position);
}

TEST(Emitter, ADiskIsFilledUniformlyAndLaunchesAlongItsNormal) {
    EmitterDescription description = burst_of(DiskShape{{1, 2, 3}, {0, 0, -4}, 0.5});
    description.speed = {3.0, 0.0};
    const auto births = all_births(description);
    for (const Particle& p : births) {
        ASSERT_EQ(p.position.z, 3.0);
        ASSERT_EQ(p.velocity, (Vec3{0, 0, -3}));
    }
    expect_uniform(births, 50, [](const Particle& p) {
        const Vec3 r = p.position - Vec3{1, 2, 3};
        return length_squared(r) / 0.25;
    });
    expect_uniform(births, 50, [](const Particle& p) { return turn_fraction(p.position.x - 1, p.position.y - 2); });
}

TEST(Emitter, ATiltedDiskLiesInItsPlane) {
    const Vec3 normal = normalized({1, -2, 0.5});
    for (const Particle& p : all_births(burst_of(DiskShape{{1, 2, 3}, {1, -2, 0.5}, 2.0}, 1000))) {
        ASSERT_NEAR(dot(p.position - Vec3{1, 2, 3}, normal), 0.0, 4e-15);
        ASSERT_LE(length(p.position - Vec3{1, 2, 3}), 2.0 * (1 + 1e-15));
    }
}

TEST(Emitter, ABoxIsFilledUniformly) {
    const auto births = all_births(burst_of(BoxShape{{1, 2, 3}, {2, 4, 0}}));
    expect_uniform(births, 50, [](const Particle& p) { return (p.position.x - 0.0) / 2.0; });
    expect_uniform(births, 50, [](const Particle& p) { return (p.position.y - 0.0) / 4.0; });
    for (const Particle& p : births) ASSERT_EQ(p.position.z, 3.0);
}

TEST(Emitter, ABallIsFilledUniformly) {
    const auto births = all_births(burst_of(SphereShape{{1, 2, 3}, 2.0, false}));
    expect_uniform(births, 50, [](const Particle& p) {
        const double r = length(p.position - Vec3{1, 2, 3}) / 2.0;
        return r * r * r;
    });
}

TEST(Emitter, ASphereIsCoveredUniformlyAndLaunchesOutward) {
    EmitterDescription description = burst_of(SphereShape{{1, 2, 3}, 2.0, true});
    description.speed = {1.0, 0.0};
    const auto births = all_births(description);
    for (const Particle& p : births) {
        ASSERT_NEAR(length(p.position - Vec3{1, 2, 3}), 2.0, 1e-14);
        ASSERT_NEAR(dot(p.velocity, p.position - Vec3{1, 2, 3}), 2.0, 1e-14);
    }
    expect_uniform(births, 50, [](const Particle& p) { return (p.position.z - 1.0) / 4.0; });
}

TEST(Emitter, APointLaunchesEquallyInAllDirections) {
    EmitterDescription description = burst_of(PointShape{{1, 2, 3}});
    description.speed = {1.0, 0.0};
    const auto births = all_births(description);
    for (const Particle& p : births) ASSERT_EQ(p.position, (Vec3{1, 2, 3}));
    expect_uniform(births, 50, [](const Particle& p) { return (p.velocity.x + 1.0) / 2.0; });
    expect_uniform(births, 50, [](const Particle& p) { return turn_fraction(p.velocity.y, p.velocity.z); });
}

TEST(Emitter, AConeIsUniformInSolidAngle) {
    for (const double degrees : {0.001, 20.0, 90.0, 140.0, 180.0}) {
        SCOPED_TRACE(degrees);
        EmitterDescription description = burst_of(PointShape{});
        description.direction = {0, 3, 0};
        description.cone_degrees = degrees;
        description.speed = {1.0, 0.0};
        const auto births = all_births(description);
        // Computes the height below the apex relative to the cap's height. For narrow cones it uses the distance from
        // the axis.
        const double cap = 2.0 * std::pow(std::sin(degrees * kPi / 360.0), 2.0);
        expect_uniform(births, 50, [&](const Particle& p) {
            const double ring = p.velocity.x * p.velocity.x + p.velocity.z * p.velocity.z;
            const double height = p.velocity.y > 0 ? ring / (1.0 + p.velocity.y) : 1.0 - p.velocity.y;
            return std::min(1.0, height / cap);
        });
        expect_uniform(births, 50, [](const Particle& p) { return turn_fraction(p.velocity.x, p.velocity.z); });
        for (const Particle& p : births) ASSERT_NEAR(length(p.velocity), 1.0, 1e-15 * 4);
    }
}

TEST(Emitter, WithoutAConeAllLaunchExactlyAlongTheDirection) {
    EmitterDescription description = burst_of(BoxShape{}, 100);
    description.direction = {0, -2, 0};
    description.speed = {3.0, 0.0};
    description.velocity = {1, 0, 0};
    for (const Particle& p : all_births(description)) ASSERT_EQ(p.velocity, (Vec3{1, -3, 0}));
}

TEST(Emitter, AttributesAreUniformAroundTheirMeans) {
    EmitterDescription description = burst_of(PointShape{});
    description.direction = {1, 0, 0};
    description.speed = {3.0, 0.5};
    description.mass = {2.0, 0.25};
    description.lifetime = {4.0, 1.0};
    const auto births = all_births(description);
    expect_uniform(births, 50, [](const Particle& p) { return (p.velocity.x - 2.5) / 1.0; });
    expect_uniform(births, 50, [](const Particle& p) { return (p.mass - 1.75) / 0.5; });
    expect_uniform(births, 50, [](const Particle& p) { return (p.lifetime - 3.0) / 2.0; });
    // The attributes are independent of each other. The correlation of n pairs has a standard deviation of 1 / sqrt(n).
    double correlation = 0.0;
    for (const Particle& p : births) {
        correlation += (p.velocity.x - 3.0) * (p.mass - 2.0) / (0.5 * 0.25 / 3.0) / static_cast<double>(kSamples);
    }
    EXPECT_NEAR(correlation, 0.0, 5.0 / std::sqrt(static_cast<double>(kSamples)));
}

TEST(Emitter, DefaultsAreOneKilogramForever) {
    const Particle p = all_births(burst_of(PointShape{}, 1))[0];
    EXPECT_EQ(p.mass, 1.0);
    EXPECT_EQ(p.lifetime, kForever);
    EXPECT_EQ(p.radius, 0.0);
    EXPECT_EQ(p.velocity, Vec3{});
}

// Returns a unit square of two triangles, one of them split into a small and a large part, and a degenerate triangle.
std::shared_ptr<const TriangleMesh> unequal_square() {
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->vertices = {{0, 0, 5}, {1, 0, 5}, {1, 1, 5}, {0, 1, 5}, {0.1, 0.1, 5}};
    mesh->triangles = {{0, 1, 4}, {1, 2, 4}, {0, 0, 1}, {2, 3, 4}, {3, 0, 4}};
    return mesh;
}

TEST(Emitter, AMeshIsCoveredUniformlyByArea) {
    const auto births = all_births(burst_of(MeshSurfaceShape{unequal_square()}));
    std::vector<double> cells(100, 0.0);
    for (const Particle& p : births) {
        const auto column = std::min<std::size_t>(9, static_cast<std::size_t>(p.position.x * 10));
        const auto row = std::min<std::size_t>(9, static_cast<std::size_t>(p.position.y * 10));
        cells[10 * row + column] += 1.0;
    }
    const std::vector<double> expected(100, static_cast<double>(kSamples) / 100.0);
    EXPECT_LT(chi_square(cells, expected), chi_square_limit(99));
}

TEST(Emitter, MeshBirthsAreJustOffTheSurfaceOnTheOutwardSide) {
    EmitterDescription description = burst_of(MeshSurfaceShape{unequal_square()}, 1000);
    description.speed = {2.0, 0.0};
    for (const Particle& p : all_births(description)) {
        ASSERT_GT(p.position.z, 5.0);
        ASSERT_LE(p.position.z, 5.0 + 20 * ulp(5.0));
        ASSERT_EQ(p.velocity, (Vec3{0, 0, 2}));
    }
}

TEST(Emitter, MeshBirthsAreOutsideTheirTriangleByTheExactSignForAnyShape) {
    RandomSequence random(3, 0, 0);
    for (int round = 0; round < 300; ++round) {
        SCOPED_TRACE(round);
        // Slender, tilted triangles near the origin and far from it.
        const double size = std::ldexp(1.0, round % 40 - 20);
        const Vec3 a = 1000.0 * (round % 3) * random.unit_vector();
        const Vec3 b = a + size * random.unit_vector();
        const Vec3 off = std::ldexp(size, -(round % 25)) * random.unit_vector();
        const Vec3 c = a + random.uniform() * (b - a) + off;
        auto mesh = std::make_shared<TriangleMesh>();
        mesh->vertices = {a, b, c};
        mesh->triangles = {{0, 1, 2}};
        if (are_collinear(a, b, c)) continue;
        for (const Particle& p : all_births(burst_of(MeshSurfaceShape{mesh}, 50))) {
            ASSERT_EQ(orient3d(a, b, c, p.position), 1);
        }
    }
}

TEST(Emitter, RefusesInvalidSettingsAndNamesThem) {
    const auto refused = [](const std::function<void(EmitterDescription&)>& spoil, const char* word) {
        EmitterDescription description = burst_of(PointShape{}, 1);
        spoil(description);
        try {
            const Emitter emitter(description, 1, 0);
            ADD_FAILURE() << "accepted: " << word;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find("emitter 'test'"), std::string::npos) << error.what();
            EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
        }
    };
    refused([](auto& d) { d.cone_degrees = 181; }, "cone");
    refused([](auto& d) { d.mass = {1.0, 1.0}; }, "mass");
    refused([](auto& d) { d.rate = {kForever, 0}; }, "rate");
    refused([](auto& d) { d.rate = {1, -1}; }, "rate");
    refused([](auto& d) { d.speed = {1, kForever}; }, "speed");
    refused([](auto& d) { d.lifetime = {-1, 0}; }, "lifetime");
    refused([](auto& d) { d.start = -1; }, "start");
    refused([](auto& d) { d.direction = {kForever, 0, 0}; }, "direction");
    refused([](auto& d) { d.shape = DiskShape{{}, {}, 1}; }, "normal");
    refused([](auto& d) { d.shape = DiskShape{{}, {0, 0, 1}, 0}; }, "radius");
    refused([](auto& d) { d.shape = BoxShape{{}, {1, -1, 1}}; }, "size");
    refused([](auto& d) { d.shape = SphereShape{{}, -1, false}; }, "radius");
    refused([](auto& d) { d.shape = MeshSurfaceShape{}; }, "mesh");
    refused([](auto& d) { d.shape = MeshSurfaceShape{std::make_shared<TriangleMesh>()}; }, "area");
}

TEST(EmitterBirthTest, ChangesNoBitIfItAcceptsAll) {
    EmitterDescription description = burst_of(BoxShape{{}, {1, 1, 1}}, 200);
    description.speed = {2.0, 1.0};
    description.mass = {1.0, 0.5};
    description.radius = {0.2, 0.1};
    const auto all = [](const Particle&) { return true; };
    expect_same_bits(Emitter(description, 7, 3).births(0.0, 1.0, 1000, all), all_births_of(description, 7, 3));
}

TEST(EmitterBirthTest, MovesOnlyRefusedBirths) {
    EmitterDescription description = burst_of(BoxShape{{}, {1, 1, 1}}, 2000);
    description.direction = {0, 0, 1};
    description.speed = {2.0, 1.0};
    description.mass = {1.0, 0.5};
    description.radius = {0.2, 0.1};
    const auto is_left = [](const Particle& p) { return p.position.x < 0.0; };
    const auto before = all_births_of(description, 7, 3);
    Emitter emitter(description, 7, 3);
    const auto after = emitter.births(0.0, 1.0, 5000, is_left);
    EXPECT_EQ(emitter.refused(), 0U);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < after.size(); ++i) {
        ASSERT_TRUE(is_left(after[i]));
        if (is_left(before[i])) {
            ASSERT_EQ(after[i].position, before[i].position);
        }
        ASSERT_EQ(after[i].velocity, before[i].velocity);
        ASSERT_EQ(after[i].mass, before[i].mass);
        ASSERT_EQ(after[i].radius, before[i].radius);
        ASSERT_EQ(after[i].origin.lineage, before[i].origin.lineage);
    }
    expect_uniform(after, 10, [](const Particle& p) { return 2.0 * (p.position.x + 0.5); });
}

TEST(EmitterBirthTest, SkipsABirthAfterABoundedNumberOfPositions) {
    EmitterDescription description = burst_of(SphereShape{{}, 1.0, false}, 5);
    description.rate = {10.0, 0.0};
    int asked = 0;
    const BirthTest none = [&](const Particle&) { return ++asked == 0; };
    Emitter emitter(description, 1, 0);
    EXPECT_TRUE(emitter.births(0.0, 1.0, 100, none).empty());
    EXPECT_EQ(emitter.born(), 15U);
    EXPECT_EQ(emitter.refused(), 15U);
    EXPECT_EQ(asked, 15 * (1 + Emitter::kMostRedraws));
    EXPECT_EQ(emitter.births(1.0, 2.0).size(), 10U);
}

TEST(EmitterBirthTest, TestsEachBirthOfAPointOnce) {
    int asked = 0;
    const BirthTest none = [&](const Particle&) { return ++asked == 0; };
    Emitter emitter(burst_of(PointShape{}, 8), 1, 0);
    EXPECT_TRUE(emitter.births(0.0, 1.0, 100, none).empty());
    EXPECT_EQ(emitter.refused(), 8U);
    EXPECT_EQ(asked, 8);
}

TEST(EmitterBirthTest, DoesNotTestBirthsBeyondTheLimit) {
    int asked = 0;
    const BirthTest all = [&](const Particle&) { return ++asked > 0; };
    Emitter emitter(burst_of(PointShape{}, 8), 1, 0);
    EXPECT_EQ(emitter.births(0.0, 1.0, 3, all).size(), 3U);
    EXPECT_EQ(asked, 3);
    EXPECT_EQ(emitter.refused(), 0U);
    EXPECT_EQ(emitter.born(), 8U);
}

TEST(EmitterBirthTest, ReceivesThePositionInTheWorld) {
    EmitterDescription description = burst_of(BoxShape{{}, {1, 1, 1}}, 100);
    FrameDescription frame;
    frame.name = "cart";
    frame.translation = {100, 0, 0};
    description.frames = std::make_shared<const FrameTree>(std::vector{frame});
    description.frame = 0;
    const BirthTest right = [](const Particle& p) { return p.position.x > 100.0; };
    const auto born = Emitter(description, 1, 0).births(0.0, 1.0, 1000, right);
    EXPECT_EQ(born.size(), 100U);
    for (const Particle& p : born) ASSERT_TRUE(p.position.x > 100.0 && p.position.x < 100.5);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
