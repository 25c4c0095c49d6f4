// A particle that comes to rest in one orientation must do so in every one. Rounding of rotated normals and forces must
// decide nothing.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/core/vec3.h"
#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/contact_interval.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Axes of a rotated world. The first set is unrotated.
struct Axes {
    Vec3 x{1, 0, 0};
    Vec3 y{0, 1, 0};
    Vec3 z{0, 0, 1};
    [[nodiscard]] Vec3 of(const Vec3& v) const { return v.x * x + v.y * y + v.z * z; }
};

Axes turned(int number) {
    if (number == 0) return {};
    RandomSequence random(77, 0, static_cast<std::uint64_t>(number));
    Axes axes;
    axes.z = random.unit_vector();
    const Vec3 other = random.unit_vector();
    axes.x = normalized(other - dot(other, axes.z) * axes.z);
    axes.y = cross(axes.z, axes.x);
    return axes;
}

/// A particle above or on planes through the origin, in a world that is rotated afterwards.
struct RestCase {
    std::string name;
    Material material;
    std::vector<Vec3> normals;
    Particle particle;
};

Vec3 tilted(double degrees, double aside = 0.0) {
    const double angle = degrees * 3.14159265358979323846 / 180.0;
    return {std::sin(angle) * std::cos(aside), std::sin(aside), std::cos(angle) * std::cos(aside)};
}

Material material_of(double friction, double rolling, double spinning) {
    Material material{"floor", 0.3, friction};
    material.rolling_friction = rolling;
    material.spinning_friction = spinning;
    return material;
}

/// Returns a sphere that touches planes whose normals have the same angle to the given direction.
Particle touching(const Vec3& along, double angle, double radius, const Vec3& velocity, double spin) {
    return testing::particle_of((radius / std::cos(angle)) * along, velocity, radius, spin * along);
}

std::vector<RestCase> cases() {
    const Vec3 up{0, 0, 1};
    const Vec3 slope = tilted(25);
    const Vec3 down = normalized(cross(cross(slope, up), slope));
    std::vector<RestCase> all;
    const auto add = [&](const std::string& name, const Material& material, const std::vector<Vec3>& normals,
                         const Particle& particle) {
        all.push_back({name, material, normals, particle});
    };
    for (const double spin : {0.0, 5.0}) {
        const std::string kind = spin == 0.0 ? " without spin" : " with spin";
        add("placed on a floor" + kind, material_of(1.2, 0, 0), {up}, touching(up, 0, 0.5, {}, spin));
        add("placed on a rough slope" + kind, material_of(1.2, 1, 0), {slope}, touching(slope, 0, 0.5, {}, spin));
        add("stopped on a slope" + kind, material_of(1.2, 1, 0), {slope}, touching(slope, 0, 0.5, 0.9 * down, spin));
        add("stopped on a floor" + kind, material_of(1.2, 0.1, 0), {up}, touching(up, 0, 0.5, {0.9, 0.4, 0}, spin));
        add("dropped on a floor" + kind, material_of(0.5, 0, 0), {up}, touching(up, 0, 0.1, {0, 0, 1}, spin));
        add("dropped on a smooth floor" + kind, material_of(0, 0, 0), {up}, touching(up, 0, 0.1, {0, 0, 1}, spin));
        add("dropped on a slope" + kind, material_of(0.9, 0.6, 0), {slope}, touching(slope, 0, 0.1, slope, spin));
    }
    add("spinning to a stop", material_of(1.2, 0, 0.02), {up}, touching(up, 0, 0.5, {}, 5.0));
    add("spinning to a stop in a groove", material_of(0.9, 0, 0), {tilted(0, 0.7), tilted(0, -0.7)},
        touching(up, 0.7, 0.1, {}, 3.0));
    add("a point stopped on a slope", material_of(0.6, 0, 0), {tilted(20)}, testing::particle_of({}, 1.3 * down));
    add("a point stopped in a groove", material_of(0.6, 0, 0), {tilted(20, 0.7), tilted(20, -0.7)},
        testing::particle_of({}, {0.5, 0, -0.2}));
    return all;
}

SimulationSetup setup_of(const RestCase& one, const Axes& axes, IntegratorKind integrator) {
    SimulationSetup setup = testing::setup_of(0.02, 7.0, one.material, axes.of({0, 0, -9.81}));
    setup.options.integrator = integrator;
    for (const Vec3& normal : one.normals) setup.colliders.push_back({"", PlaneShape{{}, axes.of(normal)}});
    Particle particle = one.particle;
    for (Vec3* const v : {&particle.position, &particle.velocity, &particle.spin}) *v = axes.of(*v);
    particle.mass = 100.0;
    setup.particles = {particle};
    return setup;
}

TEST(TurnedRest, RestIsTheSameInEveryOrientation) {
    const int orientations = test::scaled(12) + 1;
    for (const IntegratorKind integrator : {IntegratorKind::ballistic, IntegratorKind::symplectic_euler}) {
        for (const RestCase& one : cases()) {
            for (int k = 0; k < orientations; ++k) {
                SCOPED_TRACE(one.name + ", orientation " + std::to_string(k));
                Simulation simulation(setup_of(one, turned(k), integrator));
                simulation.advance(simulation.step_count());
                EXPECT_EQ(simulation.statistics().resting, 1U);
                EXPECT_EQ(simulation.statistics().asleep, 1U);
                EXPECT_EQ(simulation.particles().velocity[0], Vec3{});
            }
        }
    }
}

TEST(TurnedRest, SpinAboutTheNormalIsKeptToTheLastBit) {
    for (int k = 0; k < test::scaled(100); ++k) {
        const Axes axes = turned(k);
        const std::array<SupportSurface, 1> floor{SupportSurface{axes.z, 0.5}};
        const Motion spinning{{}, 3.7 * axes.z};
        const ContactInterval interval = plan_interval(spinning, 0.3, -9.81 * axes.z, floor, {}, 1.0);
        EXPECT_TRUE(interval.at_rest) << k;
        EXPECT_EQ(interval.motion.spin, spinning.spin) << k;
    }
}

TEST(TurnedRest, SlowSlideAfterAnImpactIsNotRest) {
    // A speed of a billionth of the force's change in the interval counts as motion. A hundred-billionth is rounding
    // from impacts.
    for (int k = 0; k < test::scaled(100); ++k) {
        const Axes axes = turned(k);
        const std::array<SupportSurface, 1> floor{SupportSurface{axes.z, 0.0}};
        const auto rest_of = [&](double speed) {
            return rest_beside_rounding({speed * axes.x, 3.7 * axes.z}, 0.3, -9.81 * axes.z, floor, {}, 1.0);
        };
        EXPECT_FALSE(rest_of(9.81e-9)) << k;
        const std::optional<Motion> still = rest_of(9.81e-11);
        ASSERT_TRUE(still) << k;
        EXPECT_EQ(still->velocity, Vec3{}) << k;
        EXPECT_EQ(still->spin, 3.7 * axes.z) << k;
    }
}

TEST(AlongSurfaces, RollingSphereWithoutSlipKeepsNoSpeed) {
    // There is neither slip nor rotation about tangents: the centre rests, however fast the sphere spins.
    for (int k = 0; k < test::scaled(200); ++k) {
        const Axes axes = turned(k);
        const std::array<SupportSurface, 1> floor{SupportSurface{axes.z, 0.5, 0.1}};
        StuckSurfaces stuck{};
        stuck[0].to_slip = stuck[0].to_turning = true;
        RandomSequence random(5, 0, static_cast<std::uint64_t>(k));
        const Motion motion{1e-15 * random.unit_vector(), 20.0 * axes.z + 1e-15 * random.unit_vector()};
        const Motion along = along_surfaces(motion, 0.3, floor, stuck);
        EXPECT_EQ(along.velocity, Vec3{}) << k;
        EXPECT_NEAR(dot(along.spin, axes.z), 20.0, 1e-13) << k;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
