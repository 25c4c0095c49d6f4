// Long runs of moving colliders and dynamic bodies, compared with closed forms and references. They are a turntable for
// ten turns, a tumbling mesh, and a thousand impacts on a body.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "claims/moving_scene.h"
#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kPi = 3.14159265358979323846;
constexpr long double kPiLong = 3.14159265358979323846L;

/// Relative errors of the orbit's radius and of the angle that the particle has travelled.
struct OrbitError {
    double radius;
    double angle;
};

OrbitError orbit_error(double step) {
    const double w = 3.0;  // in rad/s
    const double radius = 0.05;
    const double turns = 10.0;
    const Vec3 at{0.4, 0.1, radius};
    const Vec3 v{0.1, 0.25, 0};
    auto setup =
        setup_of({frame_of("table", {Spin{{0, 0, 1}, w * 180.0 / kPi}})},
                 {{"table", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0, "table"}}, step, std::round(turns * 2.0 * kPi / w));
    setup.options.record_contacts = false;
    setup.materials = {{"", 0.0, 0.8}};
    setup.forces.push_back(make_gravity({0, 0, -9.81}));
    const Vec3 slip = cross(Vec3{0, 0, w}, at) - v;
    setup.particles = {particle_of(at, v, radius, -1.0 / radius * cross(Vec3{0, 0, 1}, slip))};
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_EQ(simulation.statistics().violations, 0U);
    const double rate = 2.0 / 7.0 * w;
    const double angle = rate * simulation.time();
    const Vec3 arm = cross(v, Vec3{0, 0, 1}) / rate;  // position relative to the orbit's centre
    const Vec3 now = simulation.particles().position[0] - (at - arm);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const Vec3 expected{c * arm.x - s * arm.y, s * arm.x + c * arm.y, 0.0};
    const Vec3 flat{now.x, now.y, 0.0};
    const double ahead = std::atan2(cross(expected, flat).z, dot(expected, flat));
    return {std::fabs(length(flat) / length(arm) - 1.0), std::fabs(ahead) / angle};
}

// The run has ten turns of the table. Source: J. A. Burns, "Ball rolling on a turntable", American Journal of Physics
// 49, 1981.
TEST(ASphereOnATurntable, KeepsTheRadiusAndTheRateOfItsOrbitForTenTurns) {
    const OrbitError fine = orbit_error(1e-3);
    EXPECT_LT(fine.radius, 1e-6);
    EXPECT_LT(fine.angle, 1e-6);
    const OrbitError coarse = orbit_error(8e-3);
    const OrbitError middle = orbit_error(4e-3);
    EXPECT_LT(middle.radius, std::max(0.3 * coarse.radius, 1e-9));
    EXPECT_LT(middle.angle, std::max(0.3 * coarse.angle, 1e-9));
}

using Long = long double;
using LongVec = std::array<Long, 3>;

/// Converts a point from world coordinates to the coordinates of a body that turns about an axis and is shaken, in long
/// double.
LongVec seen_by_tumbler(const LongVec& x, const Vec3& axis, Long degrees_per_s, const Vec3& shake, Long frequency,
                        Long t) {
    const Long sine = std::sin(2.0L * kPiLong * frequency * t);
    const LongVec d{x[0] - shake.x * sine, x[1] - shake.y * sine, x[2] - shake.z * sine};
    const Long n = std::sqrt(Long(axis.x) * axis.x + Long(axis.y) * axis.y + Long(axis.z) * axis.z);
    const LongVec u{axis.x / n, axis.y / n, axis.z / n};
    const Long angle = -degrees_per_s * kPiLong / 180.0L * t;
    const Long c = std::cos(angle);
    const Long s = std::sin(angle);
    const Long along = u[0] * d[0] + u[1] * d[1] + u[2] * d[2];
    return {c * d[0] + s * (u[1] * d[2] - u[2] * d[1]) + (1 - c) * along * u[0],
            c * d[1] + s * (u[2] * d[0] - u[0] * d[2]) + (1 - c) * along * u[1],
            c * d[2] + s * (u[0] * d[1] - u[1] * d[0]) + (1 - c) * along * u[2]};
}

/// Returns the largest height of a point above the planes of the faces. The point is outside a convex mesh if this
/// height is positive.
Long height_above(const TriangleMesh& mesh, const LongVec& y) {
    Long most = -1e30L;
    for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.vertices[t[0]];
        const Vec3& b = mesh.vertices[t[1]];
        const Vec3& c = mesh.vertices[t[2]];
        const LongVec u{Long(b.x) - a.x, Long(b.y) - a.y, Long(b.z) - a.z};
        const LongVec v{Long(c.x) - a.x, Long(c.y) - a.y, Long(c.z) - a.z};
        const LongVec n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
        most = std::max(most, n[0] * (y[0] - a.x) + n[1] * (y[1] - a.y) + n[2] * (y[2] - a.z));
    }
    return most;
}

TEST(APoint, HitsATumblingMeshAtTheExactTime) {
    const TriangleMesh mesh = sphere_mesh({}, 1.0, 1);  // convex
    const Vec3 axis{2, -1, 0.5};
    const double rate = 300.0;  // in degrees/s
    const Vec3 shake{0.1, -0.05, 0.2};
    const double frequency = 1.5;
    auto setup = setup_of({frame_of("tumbler", {Oscillation{shake, frequency}, Spin{axis, rate}})},
                          {{"ball", MeshShape{std::make_shared<const TriangleMesh>(mesh), {}, "", {}}, 0, "tumbler"}},
                          0.05, 0.6);
    RandomSequence random(6, 1, 0);
    for (int k = 0; k < std::max(20, test::scaled(100)); ++k) {
        setup.particles.push_back(
            particle_of(0.5 * random.uniform() * random.unit_vector(), 3.0 * random.unit_vector()));
    }
    const std::vector<Particle> start = setup.particles;
    Simulation simulation(std::move(setup));
    std::vector<bool> hit(start.size(), false);
    for (const ContactRecord& record : all_contacts(simulation)) {
        if (hit[record.particle]) continue;
        hit[record.particle] = true;
        const Particle& p = start[record.particle];
        const auto outside = [&](Long t) {
            const LongVec x{p.position.x + p.velocity.x * t, p.position.y + p.velocity.y * t,
                            p.position.z + p.velocity.z * t};
            return height_above(mesh, seen_by_tumbler(x, axis, rate, shake, frequency, t)) > 0.0L;
        };
        Long high = 0.0L;
        while (!outside(high)) high += 1e-3L;
        Long low = high - 1e-3L;
        for (int k = 0; k < 60; ++k) {
            const Long middle = 0.5L * (low + high);
            (outside(middle) ? high : low) = middle;
        }
        EXPECT_NEAR(record.time, static_cast<double>(high), 1e-10) << record.particle;
    }
    EXPECT_GT(static_cast<std::size_t>(std::count(hit.begin(), hit.end(), true)), start.size() * 3 / 4);
}

struct Budget {
    Vec3 momentum;
    Vec3 angular_momentum;
    double energy = 0.0;
};

Budget budget_of(const Simulation& simulation) {
    Budget sum;
    const Particles& p = simulation.particles();
    for (std::size_t i = 0; i < p.size(); ++i) {
        sum.momentum += p.mass[i] * p.velocity[i];
        sum.angular_momentum += p.mass[i] * cross(p.position[i], p.velocity[i]);
        sum.energy += 0.5 * p.mass[i] * dot(p.velocity[i], p.velocity[i]);
    }
    const BodyState body = simulation.bodies()[0];
    sum.momentum += body.mass * body.velocity;
    sum.angular_momentum += body.mass * cross(body.center, body.velocity) + body.angular_momentum;
    sum.energy += body.kinetic_energy;
    return sum;
}

/// Returns a hollow box that moves freely in space, with elastic points in it. The mass of the box is `ratio` times the
/// mass of one point.
Simulation rattle(double ratio, std::uint64_t seed, double step, const SymmetricMatrix& shape) {
    FrameDescription frame = frame_of("box", {});
    frame.is_driven = true;
    SimulationSetup setup = setup_of({frame}, {{"box", CuboidShape{{1, 1, 1}, {}}, 0, "box"}}, step, 6.0);
    BodyDescription body;
    body.frame = "box";
    body.mass = 0.1 * ratio;
    body.inertia = body.mass * shape;
    body.angular_velocity = {0.4, 0.8, -0.3};
    setup.bodies = {body};
    RandomSequence random(seed, 1, 0);
    for (int k = 0; k < 20; ++k) {
        Particle particle = particle_of(0.4 * random.uniform() * random.unit_vector(), 8.0 * random.unit_vector());
        particle.mass = 0.1;
        setup.particles.push_back(particle);
    }
    return Simulation(std::move(setup));
}

// After an elastic impact, a short substep updates the body. It lasts a billionth of the time to the next impact, but
// at least a millionth of the step. This length limits the energy error of an impact.
TEST(AThousandElasticHits, OnAFreeCubeConserveEnergyMomentumAndAngularMomentum) {
    for (const auto& [ratio, seed] : {std::pair(1.0, 12), {1.0, 4}, {0.3, 2}, {10.0, 12}, {1000.0, 12}}) {
        SCOPED_TRACE(std::to_string(ratio) + " " + std::to_string(seed));
        Simulation simulation = rattle(ratio, static_cast<std::uint64_t>(seed), 0.02, {0.2, 0.2, 0.2, 0.0, 0.0, 0.0});
        const Budget first = budget_of(simulation);
        const double scale = 20.0 * 0.1 * 8.0;  // in kg m/s
        Budget before = first;
        double most = 0.0;
        while (!simulation.finished()) {
            simulation.step();
            const Budget now = budget_of(simulation);
            ASSERT_LT(length(now.momentum - before.momentum), 1e-12 * scale) << simulation.time();
            ASSERT_LT(length(now.angular_momentum - before.angular_momentum), 1e-12 * scale) << simulation.time();
            most = std::max(most, std::fabs(now.energy - first.energy));
            before = now;
        }
        EXPECT_GE(simulation.statistics().contacts, 500U);
        EXPECT_LT(most, 1e-8 * first.energy);
        EXPECT_EQ(simulation.statistics().violations, 0U);
        EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
    }
}

/// Returns a door on a spring that elastic points hit.
Simulation pelted_door(double step) {
    FrameDescription frame = frame_of("door", {});
    frame.is_driven = true;
    SimulationSetup setup =
        setup_of({frame}, {{"door", CuboidShape{{0.1, 2, 1}, {}}, 0, "door"}, {"room", CuboidShape{{6, 6, 6}, {}}, 0}},
                 step, 4.0);
    BodyDescription door;
    door.frame = "door";
    door.mass = 12.0;
    door.inertia = {5.0, 1.0, 4.01, 0.0, 0.0, 0.0};
    door.joint = JointKind::hinge;
    door.axis = {0, 0, 1};
    door.rate = 0.5;
    door.settings.spring = 150.0;
    door.settings.spring_rest = 0.1;
    setup.bodies = {door};
    RandomSequence random(31, 1, 0);
    for (int k = 0; k < 30; ++k) {
        Particle particle = particle_of({1.0 + random.uniform(), 1.6 * random.uniform() - 0.8, 0.2 * random.uniform()},
                                        {-4.0 - random.uniform(), 0.2 * random.uniform(), 0.0});
        particle.mass = 0.2;
        setup.particles.push_back(particle);
    }
    return Simulation(std::move(setup));
}

// The motion on the spring follows its closed form for any length of the substeps. One error remains. An impact uses
// the body's velocity at the time of impact, but the body receives the impulse at the end of the substep.
TEST(ADoorOnASpring, ConservesTheEnergyTogetherWithTheParticlesThatHitIt) {
    for (const double step : {0.002, 0.02}) {
        SCOPED_TRACE(step);
        Simulation simulation = pelted_door(step);
        const auto energy = [&] {
            const double stretch = simulation.bodies()[0].coordinate - 0.1;
            return budget_of(simulation).energy + 0.5 * 150.0 * stretch * stretch;
        };
        const double first = energy();
        double most = 0.0;
        while (!simulation.finished()) {
            simulation.step();
            most = std::max(most, std::fabs(energy() - first));
        }
        EXPECT_LT(most, 1e-6 * first);
        EXPECT_GT(simulation.collider_totals()[0].hits, 30U);
        EXPECT_EQ(simulation.statistics().violations, 0U);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
