// Statistics of emitted particles. Every quantity is uniform between mean - spread and mean + spread, and independent
// of the others. Births do not depend on time steps, threads or output.
// Seeds are fixed. Each chi-square value is below the limit that random data exceed once in a million cases. Each mean
// is within five standard errors of its expected value.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "dynamics/chi_square.h"
#include "ricochet/dynamics/emitter.h"
#include "ricochet/simulation.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr std::uint64_t kSamples = test::kSanitized ? 4000 : 40000;

std::vector<AttributeDescription> columns() {
    return {{"heat", 1, {}}, *looks_attribute("color"), *looks_attribute("opacity"), *looks_attribute("size")};
}

EmitterDescription everything() {
    EmitterDescription emitter;
    emitter.name = "all";
    emitter.burst = kSamples;
    emitter.direction = {0, 0, 1};
    emitter.speed = {5.0, 2.0};
    emitter.mass = {2.0, 0.5};
    emitter.radius = {0.3, 0.1};
    emitter.lifetime = {4.0, 1.5};
    emitter.attributes = {{"heat", {900, 0, 0}, {100, 0, 0}},
                          {"color", {0.5, 0.4, 0.6}, {0.3, 0.2, 0.1}},
                          {"opacity", {0.5, 0, 0}, {0.25, 0, 0}},
                          {"size", {0.2, 0, 0}, {0.1, 0, 0}}};
    return emitter;
}

std::vector<Particle> births_of(EmitterDescription emitter, double duration = 1.0) {
    const auto all = columns();
    return Emitter(std::move(emitter), 42, 0, {24.0, std::nullopt, all}).births(0.0, duration);
}

struct Quantity {
    std::string name;
    double mean;
    double spread;
    std::function<double(const Particle&)> of;
};

const std::vector<Quantity>& quantities() {
    static const std::vector<Quantity> list = {
        {"speed", 5.0, 2.0, [](const Particle& p) { return length(p.velocity); }},
        {"mass", 2.0, 0.5, [](const Particle& p) { return p.mass; }},
        {"radius", 0.3, 0.1, [](const Particle& p) { return p.radius; }},
        {"lifetime", 4.0, 1.5, [](const Particle& p) { return p.lifetime; }},
        {"heat", 900.0, 100.0, [](const Particle& p) { return p.attributes[0].x; }},
        {"red", 0.5, 0.3, [](const Particle& p) { return p.attributes[1].x; }},
        {"green", 0.4, 0.2, [](const Particle& p) { return p.attributes[1].y; }},
        {"blue", 0.6, 0.1, [](const Particle& p) { return p.attributes[1].z; }},
        {"opacity", 0.5, 0.25, [](const Particle& p) { return p.attributes[2].x; }},
        {"size", 0.2, 0.1, [](const Particle& p) { return p.attributes[3].x; }},
    };
    return list;
}

TEST(EmitterStatistics, EveryQuantityIsUniformAroundItsMean) {
    const auto births = births_of(everything());
    ASSERT_EQ(births.size(), kSamples);
    const auto n = static_cast<double>(births.size());
    for (const Quantity& quantity : quantities()) {
        SCOPED_TRACE(quantity.name);
        std::vector<double> observed(40, 0.0);
        double sum = 0.0;
        for (const Particle& particle : births) {
            const double part = (quantity.of(particle) - quantity.mean) / quantity.spread;  // -1..1
            ASSERT_GE(part, -1.0 - 1e-12);
            ASSERT_LE(part, 1.0 + 1e-12);
            observed[std::min<std::size_t>(39, static_cast<std::size_t>(20.0 * std::max(0.0, part + 1.0)))] += 1.0;
            sum += part;
        }
        EXPECT_LT(std::fabs(sum / n), 5.0 / std::sqrt(3.0 * n));
        EXPECT_LT(test::chi_square(observed, std::vector<double>(40, n / 40.0)), test::chi_square_limit(39));
    }
}

TEST(EmitterStatistics, QuantitiesAreUncorrelated) {
    const auto births = births_of(everything());
    const auto n = static_cast<double>(births.size());
    for (std::size_t a = 0; a < quantities().size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            double sum = 0.0;
            for (const Particle& p : births) {
                sum += (quantities()[a].of(p) - quantities()[a].mean) / quantities()[a].spread *
                       (quantities()[b].of(p) - quantities()[b].mean) / quantities()[b].spread;
            }
            // The product of two independent quantities has the standard deviation 1/3.
            EXPECT_LT(std::fabs(sum / n), 5.0 / (3.0 * std::sqrt(n)))
                << quantities()[a].name << " " << quantities()[b].name;
        }
    }
}

TEST(EmitterStatistics, AttributesOfParticlesChangeNothingElse) {
    EmitterDescription plain = everything();
    plain.attributes.clear();
    EmitterDescription one = everything();
    one.attributes = {one.attributes[2]};
    const auto all = births_of(everything());
    const auto none = births_of(plain);
    const auto some = births_of(one);
    for (std::size_t i = 0; i < all.size(); ++i) {
        ASSERT_EQ(all[i].velocity, none[i].velocity);
        ASSERT_EQ(all[i].lifetime, none[i].lifetime);
        ASSERT_EQ(all[i].mass, none[i].mass);
        ASSERT_EQ(all[i].attributes[2], some[i].attributes[2]);  // drawing one attribute does not change another
    }
}

TEST(EmitterStatistics, ColoursAndOpacitiesAreClamped) {
    EmitterDescription wide = everything();
    wide.attributes[1].spread = {3, 3, 3};
    wide.attributes[2].spread = {3, 0, 0};
    for (const Particle& p : births_of(wide)) {
        for (int c = 0; c < 3; ++c) {
            ASSERT_GE(p.attributes[1][c], 0.0);
            ASSERT_LE(p.attributes[1][c], 1.0);
        }
        ASSERT_GE(p.attributes[2].x, 0.0);
        ASSERT_LE(p.attributes[2].x, 1.0);
    }
}

TEST(EmitterStatistics, ARatePerFrameIsDrawnForEveryFrameAndSpreadEvenlyInsideIt) {
    EmitterDescription emitter;
    emitter.rate_per_frame = {50.0, 20.0};
    const std::size_t frames = 2400;
    std::vector<double> counts(frames, 0.0);
    std::vector<double> places(20, 0.0);
    const auto births = births_of(emitter, 100.0);
    for (const Particle& p : births) {
        const double frame = p.birth_time * 24.0;
        counts[static_cast<std::size_t>(frame)] += 1.0;
        places[static_cast<std::size_t>(20.0 * (frame - std::floor(frame)))] += 1.0;
    }
    double sum = 0.0;
    double squares = 0.0;
    for (const double count : counts) {
        EXPECT_GE(count, 29.0);
        EXPECT_LE(count, 71.0);
        sum += count;
        squares += (count - 50.0) * (count - 50.0);
    }
    // The number of births per frame is uniform with half width 20 and variance 133.3. The mean over 2400 frames has a
    // standard deviation of 0.236. The limit is five standard deviations.
    EXPECT_NEAR(sum / frames, 50.0, 1.2);
    EXPECT_NEAR(squares / frames, 400.0 / 3.0, 5 * std::sqrt(0.8 / frames) * 133.3);
    for (const double place : places) EXPECT_NEAR(place, sum / 20.0, 0.02 * sum / 20.0);
}

TEST(EmitterStatistics, ARatePerAreaEqualsTheRatePerFrameTimesTheScreenArea) {
    EmitterDescription emitter;
    emitter.shape = BoxShape{{}, {3, 2, 0}};  // the box covers 600 pixels, see ScreenArea
    emitter.rate_per_area = {0.01, 0.0};
    const EmitterSurroundings surroundings{30.0, ReferenceCamera{{0, 0, 10}, {}, 90.0, 200.0}, {}};
    EXPECT_EQ(Emitter(emitter, 1, 0, surroundings).births(0.0, 10.0).size(), 1800U);
    emitter.shape = BoxShape{{0, 0, -10}, {3, 2, 0}};  // twice as far from the camera
    EXPECT_EQ(Emitter(emitter, 1, 0, surroundings).births(0.0, 10.0).size(), 450U);
}

TEST(EmitterStatistics, ParticlesOfAnEmitterWithASeedDependOnNothingElse) {
    EmitterDescription emitter = everything();
    emitter.burst = 3;
    emitter.seed = 99;
    const auto all = columns();
    const auto a = Emitter(emitter, 1, 0, {24.0, std::nullopt, all}).births(0.0, 1.0);
    const auto b = Emitter(emitter, 2, 5, {24.0, std::nullopt, all}).births(0.0, 1.0);
    emitter.seed = 98;
    const auto c = Emitter(emitter, 1, 0, {24.0, std::nullopt, all}).births(0.0, 1.0);
    EXPECT_EQ(a[2].velocity, b[2].velocity);
    EXPECT_EQ(a[2].attributes, b[2].attributes);
    EXPECT_NE(a[2].velocity, c[2].velocity);
}

TEST(EmitterStatistics, BirthsPerFrameDoNotDependOnTheTimeStep) {
    std::vector<double> times;
    for (const double step : {1.0 / 24.0, 0.013, 0.2, 1.0}) {
        SimulationSetup setup;
        setup.options.time_step = step;
        setup.options.duration = 2.0;
        EmitterDescription emitter;
        emitter.rate_per_frame = {7.3, 4.0};
        setup.emitters = {emitter};
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        if (times.empty()) times = simulation.particles().birth_time;
        EXPECT_EQ(simulation.particles().birth_time, times);
        EXPECT_GT(times.size(), 250U);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
