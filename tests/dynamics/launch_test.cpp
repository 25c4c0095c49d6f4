#include "ricochet/dynamics/launch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "dynamics/chi_square.h"
#include "ricochet/core/error.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kMolecule = 4.65e-26;  // kg, nitrogen

EmitterDescription disk_emitter() {
    EmitterDescription emitter;
    emitter.name = "test";
    emitter.shape = DiskShape{{1, 2, 3}, {2, -1, 2}, 0.5};
    emitter.burst = static_cast<std::uint64_t>(test::scaled(40000));
    return emitter;
}

const Vec3 kNormal = Vec3{2, -1, 2} / 3.0;

std::vector<Particle> births_of(const EmitterDescription& emitter) { return Emitter(emitter, 21, 0).births(0.0, 1.0); }

void expect_uniform(const std::vector<Particle>& particles, const std::function<double(const Particle&)>& fraction) {
    constexpr std::size_t kBins = 40;
    std::vector<double> observed(kBins, 0.0);
    for (const Particle& particle : particles) {
        observed[std::min(kBins - 1, static_cast<std::size_t>(fraction(particle) * kBins))] += 1.0;
    }
    const std::vector<double> expected(kBins, static_cast<double>(particles.size()) / kBins);
    EXPECT_LT(test::chi_square(observed, expected), test::chi_square_limit(kBins - 1));
}

double mean_of(const std::vector<Particle>& particles, const std::function<double(const Particle&)>& value) {
    double sum = 0.0;
    for (const Particle& particle : particles) sum += value(particle);
    return sum / static_cast<double>(particles.size());
}

// Returns the angle about the normal as a fraction of a turn.
double turn_of(const Particle& particle) {
    const auto [first, second] = tangent_frame(kNormal);
    return std::atan2(dot(particle.velocity, second), dot(particle.velocity, first)) / (2.0 * std::numbers::pi) + 0.5;
}

// Under the cosine law, the squared sine of the angle to the normal is uniform.
TEST(Launch, CosineLawMakesTheSquaredSineUniform) {
    for (const double cone : {90.0, 30.0}) {
        SCOPED_TRACE(cone);
        EmitterDescription emitter = disk_emitter();
        emitter.direction_law = DirectionLaw::cosine;
        emitter.cone_degrees = cone;
        emitter.speed = {2.0, 0.0};
        const std::vector<Particle> particles = births_of(emitter);
        const double most = std::pow(std::sin(cone * std::numbers::pi / 180.0), 2.0);
        for (const Particle& particle : particles) ASSERT_NEAR(length(particle.velocity), 2.0, 1e-14);
        for (const Particle& particle : particles) ASSERT_GE(dot(particle.velocity, kNormal), 0.0);
        expect_uniform(particles, [&](const Particle& p) {
            const double cosine = dot(p.velocity, kNormal) / 2.0;
            return std::clamp((1.0 - cosine * cosine) / most, 0.0, 1.0);
        });
        expect_uniform(particles, turn_of);
    }
}

// Bird 1994, section 4.2: the normal speed of effusing molecules has the cumulative distribution
// 1 - exp(-v^2 / (2 s^2)), the components along the opening are normal.
TEST(Launch, EffusionIsAFluxWeightedMaxwellDistribution) {
    EmitterDescription emitter = disk_emitter();
    emitter.thermal = ThermalLaunch{ThermalLaw::effusion, 300.0, kMolecule, 0.0};
    const double s = std::sqrt(1.380649e-23 * 300.0 / kMolecule);
    EXPECT_NEAR(thermal_speed(*emitter.thermal), s, 1e-12 * s);
    const std::vector<Particle> particles = births_of(emitter);
    const auto [first, second] = tangent_frame(kNormal);
    const auto normal_below = [&](double v) { return 0.5 * std::erfc(-v / (s * std::sqrt(2.0))); };
    expect_uniform(particles,
                   [&](const Particle& p) { return -std::expm1(-0.5 * std::pow(dot(p.velocity, kNormal) / s, 2.0)); });
    for (const Vec3& along : {first, second}) {
        expect_uniform(particles, [&](const Particle& p) { return normal_below(dot(p.velocity, along)); });
    }
    // The mean kinetic energy of effusing molecules is 2 k T, not 3/2 k T.
    const double count = static_cast<double>(particles.size());
    const double energy =
        mean_of(particles, [&](const Particle& p) { return 0.5 * length_squared(p.velocity) / (s * s); });
    EXPECT_NEAR(energy, 2.0, 5.0 * std::sqrt(2.0 / count));
}

// With the drift d, in standard deviations, the density x exp(-(x - d)^2 / 2) has a cumulative distribution in closed
// form: exp(-d^2 / 2) - exp(-(x - d)^2 / 2) plus d times the integral of the normal density.
TEST(Launch, EffusionWithADriftHasItsClosedForm) {
    for (const double drift : {-2.0, 0.5, 3.0, 20.0}) {
        SCOPED_TRACE(drift);
        EmitterDescription emitter = disk_emitter();
        emitter.thermal = ThermalLaunch{ThermalLaw::effusion, 300.0, kMolecule, 0.0};
        const double s = thermal_speed(*emitter.thermal);
        emitter.thermal->drift = drift * s;
        const double root = std::sqrt(2.0 * std::numbers::pi);
        const auto sum = [&](double x) {
            const double normal = 0.5 * (std::erfc(-(x - drift) / std::sqrt(2.0)) - std::erfc(drift / std::sqrt(2.0)));
            return std::exp(-0.5 * drift * drift) - std::exp(-0.5 * (x - drift) * (x - drift)) + drift * root * normal;
        };
        expect_uniform(births_of(emitter),
                       [&](const Particle& p) { return sum(dot(p.velocity, kNormal) / s) / sum(drift + 60.0); });
    }
}

TEST(Launch, VolumeIsAMaxwellDistributionAboutTheVelocity) {
    EmitterDescription emitter = disk_emitter();
    emitter.thermal = ThermalLaunch{ThermalLaw::volume, 500.0, kMolecule, 0.0};
    emitter.velocity = {100, -200, 50};
    const double s = thermal_speed(*emitter.thermal);
    const std::vector<Particle> particles = births_of(emitter);
    for (int axis = 0; axis < 3; ++axis) {
        expect_uniform(particles, [&](const Particle& p) {
            return 0.5 * std::erfc(-(p.velocity[axis] - emitter.velocity[axis]) / (s * std::sqrt(2.0)));
        });
    }
}

TEST(Launch, DensityGivesTheMassOfTheDrawnRadiusAndChangesNothingElse) {
    EmitterDescription emitter = disk_emitter();
    emitter.burst = 500;
    emitter.radius = {0.02, 0.01};
    emitter.lifetime = {2.0, 1.0};
    emitter.speed = {1.0, 0.5};
    const std::vector<Particle> before = births_of(emitter);
    emitter.density = 2500.0;
    const std::vector<Particle> after = births_of(emitter);
    for (std::size_t k = 0; k < before.size(); ++k) {
        const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(after[k].radius, 3.0);
        EXPECT_NEAR(after[k].mass / (2500.0 * volume), 1.0, 1e-14);
        EXPECT_EQ(after[k].radius, before[k].radius);
        EXPECT_EQ(after[k].lifetime, before[k].lifetime);
        EXPECT_EQ(after[k].velocity, before[k].velocity);
    }
    EXPECT_EQ(least_mass(emitter), sphere_mass(2500.0, 0.01));
    EXPECT_EQ(most_mass(emitter), sphere_mass(2500.0, 0.03));
}

// The distribution of one value changes no other value, as a spread does not.
TEST(Launch, DistributionsChangeOnlyTheirOwnValue) {
    EmitterDescription emitter = disk_emitter();
    emitter.burst = 200;
    emitter.speed = {3.0, 0.0};
    const std::vector<Particle> before = births_of(emitter);
    Distribution normal;
    normal.law = DistributionLaw::normal;
    normal.center = 3.0;
    normal.width = 0.2;
    emitter.speed = normal;
    const std::vector<Particle> after = births_of(emitter);
    for (std::size_t k = 0; k < before.size(); ++k) {
        EXPECT_EQ(after[k].position, before[k].position);
        EXPECT_EQ(after[k].mass, before[k].mass);
        EXPECT_EQ(after[k].lifetime, before[k].lifetime);
        EXPECT_NE(length(after[k].velocity), 3.0);
    }
}

TEST(Launch, SettingsOutOfRangeAreRefused) {
    const auto fault_of = [](const std::function<void(EmitterDescription&)>& change) -> std::string {
        EmitterDescription emitter = disk_emitter();
        change(emitter);
        try {
            const Emitter made(emitter, 1, 0);
            return "";
        } catch (const InputError& error) {
            return error.what();
        }
    };
    EXPECT_EQ(fault_of([](auto& e) { e.direction_law = DirectionLaw::cosine; }),
              "emitter 'test': the cosine law needs a cone above 0 and of at most 90 degrees");
    EXPECT_EQ(fault_of([](auto& e) { e.density = 1.0; }),
              "emitter 'test': the density and the radii must give masses of at least 1e-300 kg and below 1e308 kg");
    EXPECT_EQ(fault_of([](auto& e) {
                  e.thermal = ThermalLaunch{ThermalLaw::volume, 0.0, kMolecule, 0.0};
              }),
              "emitter 'test': temperature and molecule mass must be > 0, with a thermal speed of at most 1e75 m/s");
    EXPECT_EQ(fault_of([](auto& e) {
                  e.thermal = ThermalLaunch{ThermalLaw::volume, 300.0, 1e-300, 0.0};
              }),
              "emitter 'test': temperature and molecule mass must be > 0, with a thermal speed of at most 1e75 m/s");
    EXPECT_EQ(fault_of([](auto& e) {
                  e.thermal = ThermalLaunch{ThermalLaw::volume, 300.0, kMolecule, 5.0};
              }),
              "emitter 'test': only an effusing gas has a drift; set the velocity instead");
    EXPECT_EQ(fault_of([](auto& e) {
                  e.rate_curve = {{1.0, 2.0}, {1.0, 3.0}};
              }),
              "emitter 'test': the times of the rate curve must increase from point to point");
    EXPECT_EQ(fault_of([](auto& e) {
                  e.radius = Distribution{DistributionLaw::exponential, -1.0, 1.0};
              }),
              "emitter 'test': radius: the mean, median or scale must be > 0");
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
