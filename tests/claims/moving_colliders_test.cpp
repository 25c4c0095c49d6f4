// Particles hit moving colliders at the exact time and with the exact speed, and no particle passes through.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "claims/moving_scene.h"
#include "collision/worlds.h"
#include "ricochet/core/frame_tree.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/simulation.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kG = 9.81;
constexpr double kPi = 3.14159265358979323846;
constexpr long double kPiLong = 3.14159265358979323846L;

// A ball flies between a wall at rest at 0 and a wall that approaches from 1 m at 0.1 m/s. Each expected time of impact
// follows from the previous impact.
TEST(ABallBetweenClosingWalls, GainsTwiceTheSpeedOfTheWallAtEachImpactOnIt) {
    for (const double radius : {0.0, 0.01}) {
        auto setup = setup_of(
            {frame_of("piston", {steady({-0.1, 0, 0})}, {1, 0, 0})},
            {{"wall", PlaneShape{{0, 0, 0}, {1, 0, 0}}, 0}, {"piston", PlaneShape{{0, 0, 0}, {1, 0, 0}}, 0, "piston"}},
            0.07, 5.0);
        setup.particles = {particle_of({0.5, 0.1, 0.2}, {1.0, 0.3, 0}, radius)};
        Simulation simulation(std::move(setup));
        double speed = 1.0;
        double x = 0.5;
        double t = 0.0;
        bool towards = true;
        int hits = 0;
        for (const ContactRecord& record : all_contacts(simulation)) {
            const double to_go = towards ? 1.0 - radius - 0.1 * t - x : x - radius;
            t += to_go / (towards ? speed + 0.1 : speed);
            x = towards ? 1.0 - radius - 0.1 * t : radius;
            if (towards) speed += 0.2;
            ++hits;
            EXPECT_NEAR(record.time, t, 1e-12 * hits);
            EXPECT_NEAR(record.velocity_after.x, towards ? -speed : speed, 1e-12 * hits);
            EXPECT_NEAR(record.surface_velocity.x, towards ? -0.1 : 0.0, 1e-15);
            towards = !towards;
        }
        EXPECT_GT(hits, 8);
    }
}

// A cloud of particles is in a cube that turns about a skew axis. No particle leaves the cube, and the verifier
// confirms this independently.
TEST(PointsAndSpheres, StayInsideACubeThatSpins) {
    for (const double radius : {0.0, 0.02}) {
        auto setup = setup_of({frame_of("spin", {Spin{{1, 2, 3}, 400.0}})},
                              {{"box", CuboidShape{{1, 1, 1}, {}}, 0, "spin"}}, 0.02, 4.0);
        RandomSequence random(7, 1, 0);
        for (int k = 0; k < 200; ++k) {
            const Vec3 p{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
            const Vec3 v{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
            setup.particles.push_back(particle_of(0.7 * p, 4.0 * v, radius));
        }
        Simulation simulation(std::move(setup));
        const auto contacts = all_contacts(simulation);
        EXPECT_GT(contacts.size(), 1000U);
        const MovingPose pose = simulation.collider_pose(0, simulation.time());
        for (const Vec3& p : simulation.particles().position) {
            EXPECT_LT(max_abs(pose.local_position(p)), 0.5 - radius + 1e-9);
        }
        EXPECT_EQ(simulation.statistics().squeezed, 0U);
    }
}

// The same cloud has the same impacts if it is described in a uniformly moving frame.
TEST(Impacts, AreTheSameInAUniformlyMovingFrame) {
    const Vec3 drift{1.5, -0.7, 0.4};
    for (const double radius : {0.0, 0.05}) {
        std::vector<std::vector<ContactRecord>> contacts;
        for (const bool moves : {false, true}) {
            const std::string frame = moves ? "train" : "";
            auto setup = setup_of({frame_of("train", {steady(drift)})},
                                  {{"room", CuboidShape{{3, 3, 3}, {}}, 0, frame},
                                   {"ball", BallShape{0.4, {{0.2, 0.1, 0}}}, 0, frame},
                                   {"post", CylinderShape{0.3, 1.0, {{-0.7, -0.8, 0.1}, {1, 1, 0}, 30.0}}, 0, frame}},
                                  0.05, 3.0);
            RandomSequence random(3, 1, 0);
            for (int k = 0; k < 40; ++k) {
                const Vec3 p{random.uniform(), random.uniform(), random.uniform()};
                const Vec3 v{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
                const Vec3 from = Vec3{0.7, 0.6, 0.55} + 0.6 * p;
                setup.particles.push_back(particle_of(from, 2.0 * v + (moves ? drift : Vec3{}), radius));
            }
            Simulation simulation(std::move(setup));
            contacts.push_back(all_contacts(simulation));
        }
        ASSERT_EQ(contacts[0].size(), contacts[1].size());
        EXPECT_GT(contacts[0].size(), 50U);
        for (std::size_t k = 0; k < contacts[0].size(); ++k) {
            const ContactRecord& a = contacts[0][k];
            const ContactRecord& b = contacts[1][k];
            ASSERT_EQ(a.particle, b.particle);
            EXPECT_NEAR(a.time, b.time, 1e-11);
            EXPECT_LT(length(b.position - a.time * drift - a.position), 1e-11);
            EXPECT_LT(length(b.velocity_after - drift - a.velocity_after), 1e-11);
            EXPECT_LT(length(b.normal - a.normal), 1e-10);
        }
    }
}

// The rotation of a ball or cylinder about its own axis has no effect without friction.
TEST(ABallAndACylinder, TurningAboutTheirOwnAxisActAsAtRest) {
    for (const double radius : {0.0, 0.05}) {
        std::vector<std::vector<ContactRecord>> contacts;
        for (const bool turns : {false, true}) {
            auto setup = setup_of({frame_of("ball", {Spin{{1, 2, -1}, 500.0}}, {0.5, 0, 0}),
                                   frame_of("roller", {Spin{{0, 0, 1}, -300.0}}, {-0.6, 0, 0})},
                                  {{"shell", BallShape{2.0, {}}, 0}}, 0.05, 4.0);
            setup.colliders.push_back(
                {"ball", BallShape{0.4, {turns ? Vec3{} : Vec3{0.5, 0, 0}}}, 0, turns ? "ball" : ""});
            setup.colliders.push_back(
                {"roller", CylinderShape{0.3, 1.0, {turns ? Vec3{} : Vec3{-0.6, 0, 0}}}, 0, turns ? "roller" : ""});
            setup.forces.push_back(make_gravity({0, 0, -1}));
            RandomSequence random(3, 1, 0);
            for (int k = 0; k < 40; ++k) {
                const Vec3 v{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
                setup.particles.push_back(particle_of({0, 0.5 + random.uniform(), random.uniform()}, 3.0 * v, radius));
            }
            Simulation simulation(std::move(setup));
            contacts.push_back(all_contacts(simulation));
        }
        EXPECT_GT(contacts[0].size(), 100U);
        // Chaos amplifies rounding at every impact on the convex walls, so only the first impacts of each particle are
        // compared.
        std::vector<int> seen(40, 0);
        std::size_t other = 0;
        for (const ContactRecord& a : contacts[0]) {
            if (++seen[a.particle] > 6) continue;
            while (other < contacts[1].size() && contacts[1][other].time < a.time - 1e-6) ++other;
            const auto same = std::find_if(
                contacts[1].begin() + static_cast<std::ptrdiff_t>(other), contacts[1].end(),
                [&](const ContactRecord& b) { return a.particle == b.particle && std::fabs(a.time - b.time) < 1e-6; });
            ASSERT_NE(same, contacts[1].end()) << a.particle << " " << a.time;
            const double bound = 1e-12 * std::pow(10.0, seen[a.particle] - 1);
            EXPECT_NEAR(a.time, same->time, bound) << seen[a.particle];
            EXPECT_LT(length(a.velocity_after - same->velocity_after), 10.0 * bound);
        }
    }
}

// In the rotating frame the walls are at rest, and Coriolis and centrifugal forces act.
TEST(Walls, ThatTurnActAsWallsAtRestWithTheForcesOfTheirFrame) {
    const Vec3 turning{0.3, -0.5, 1.2};  // in rad/s
    const double rate = length(turning);
    for (const double radius : {0.0, 0.04}) {
        std::vector<std::vector<ContactRecord>> contacts;
        for (const bool turns : {true, false}) {
            auto setup = setup_of({frame_of("turning", {Spin{turning, rate * 180.0 / kPi}})},
                                  {{"box", CuboidShape{{1.1, 0.9, 1.0}, {}}, 0, turns ? "turning" : ""}}, 0.05, 6.0);
            setup.options.integrator = {IntegratorKind::dormand_prince, {1e-14, 1e-14}};
            setup.options.verify = turns;
            if (!turns) {
                setup.forces.push_back(make_acceleration([turning](const ForceInput& input) {
                    return -2.0 * cross(turning, input.velocity) - cross(turning, cross(turning, input.position));
                }));
            }
            RandomSequence random(11, 1, 0);
            for (int k = 0; k < 10; ++k) {
                const Vec3 p{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
                const Vec3 v{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
                // At 0 s both frames coincide.
                setup.particles.push_back(
                    particle_of(0.6 * p, 3.0 * v - (turns ? Vec3{} : cross(turning, 0.6 * p)), radius));
            }
            Simulation simulation(std::move(setup));
            contacts.push_back(all_contacts(simulation));
        }
        std::vector<int> seen(10, 0);
        for (const ContactRecord& a : contacts[0]) {
            const int number = seen[a.particle]++;
            if (number >= 10) continue;
            int other = 0;
            for (const ContactRecord& b : contacts[1]) {
                if (b.particle != a.particle || other++ != number) continue;
                EXPECT_NEAR(a.time, b.time, 1e-9) << a.particle << " " << number;
                EXPECT_NEAR(dot(a.velocity_after - a.surface_velocity, a.normal), dot(b.velocity_after, b.normal),
                            1e-9);
                break;
            }
        }
        EXPECT_GT(*std::min_element(seen.begin(), seen.end()), 5);
    }
}

/// Returns the first time at which a point on a straight path leaves a cube that turns about an axis through the
/// origin. Samples the exact motion in small steps and brackets the root, in long double.
long double first_exit(const Vec3& from, const Vec3& velocity, const Vec3& axis, long double rate, double half) {
    using Long = long double;
    const auto outside = [&](Long t) {
        const Long x[3] = {from.x + velocity.x * t, from.y + velocity.y * t, from.z + velocity.z * t};
        const Long n = std::sqrt(Long(axis.x) * axis.x + Long(axis.y) * axis.y + Long(axis.z) * axis.z);
        const Long u[3] = {axis.x / n, axis.y / n, axis.z / n};
        const Long c = std::cos(-rate * t);
        const Long s = std::sin(-rate * t);
        const Long along = u[0] * x[0] + u[1] * x[1] + u[2] * x[2];
        const Long turned[3] = {c * x[0] + s * (u[1] * x[2] - u[2] * x[1]) + (1 - c) * along * u[0],
                                c * x[1] + s * (u[2] * x[0] - u[0] * x[2]) + (1 - c) * along * u[1],
                                c * x[2] + s * (u[0] * x[1] - u[1] * x[0]) + (1 - c) * along * u[2]};
        return std::max({std::fabs(turned[0]), std::fabs(turned[1]), std::fabs(turned[2])}) > half;
    };
    Long high = 0.0L;
    while (!outside(high)) high += 1e-4L;
    Long low = high - 1e-4L;
    for (int k = 0; k < 80; ++k) {
        const Long middle = 0.5L * (low + high);
        (outside(middle) ? high : low) = middle;
    }
    return high;
}

TEST(APoint, HitsATurningCubeAtTheExactTime) {
    const Vec3 axis{2, -1, 0.5};
    const double rate = 500.0;  // in degrees/s
    auto setup =
        setup_of({frame_of("spin", {Spin{axis, rate}})}, {{"box", CuboidShape{{1, 1, 1}, {}}, 0, "spin"}}, 0.05, 0.5);
    RandomSequence random(5, 1, 0);
    for (int k = 0; k < 300; ++k) {
        const Vec3 p{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
        const Vec3 v{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
        setup.particles.push_back(particle_of(0.8 * p, 6.0 * v));
    }
    const std::vector<Particle> start = setup.particles;
    Simulation simulation(std::move(setup));
    std::vector<bool> hit(start.size(), false);
    for (const ContactRecord& record : all_contacts(simulation)) {
        if (hit[record.particle]) continue;
        hit[record.particle] = true;
        const Particle& p = start[record.particle];
        const long double truth = first_exit(p.position, p.velocity, axis, rate * kPiLong / 180.0L, 0.5);
        EXPECT_NEAR(record.time, static_cast<double>(truth), 1e-10) << record.particle;
    }
    EXPECT_GT(std::count(hit.begin(), hit.end(), true), 250);
}

// A sphere that rolls on a table moves in a circle at 2/7 of the table's angular velocity w. Source: J. A. Burns, "Ball
// rolling on a turntable", American Journal of Physics 49, 1981.
TEST(ASphereOnATurntable, OrbitsAtTwoSeventhsOfItsRate) {
    const double w = 3.0;
    const double radius = 0.05;
    const Vec3 at{0.4, 0.1, radius};
    const Vec3 v{0.1, 0.25, 0};
    const auto error = [&](double step) {
        auto setup = setup_of({frame_of("table", {Spin{{0, 0, 1}, w * 180.0 / kPi}})},
                              {{"table", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0, "table"}}, step, 5.0);
        setup.options.integrator = IntegratorKind::rk4;
        setup.materials = {{"", 0.0, 0.8}};
        setup.forces.push_back(make_gravity({0, 0, -9.81}));
        const Vec3 slip = cross(Vec3{0, 0, w}, at) - v;
        setup.particles = {particle_of(at, v, radius, -1.0 / radius * cross(Vec3{0, 0, 1}, slip))};
        Simulation simulation(std::move(setup));
        EXPECT_LE(all_contacts(simulation).size(), 1U);
        const double angle = 2.0 / 7.0 * w * 5.0;
        const double c = std::cos(angle);
        const double s = std::sin(angle);
        const Vec3 turned{c * v.x - s * v.y, s * v.x + c * v.y, 0};
        EXPECT_LT(length(simulation.particles().velocity[0] - turned), 1.0 * step);
        return length(simulation.particles().velocity[0] - turned);
    };
    const double coarse = error(0.01);
    EXPECT_LT(error(0.005), std::max(0.3 * coarse, 1e-9)) << coarse;
    EXPECT_LT(error(0.001), 1e-6);
}

TEST(ASphere, KeepsItsPositionOnAUniformlyMovingBodyToTheLastBit) {
    for (const Vec3& axis : {Vec3{0, 0, 1}}) {
        auto setup = setup_of({frame_of("truck", {steady({2, 0.5, 0}), Spin{axis, 30.0}})},
                              {{"floor", CuboidShape{{3, 3, 0.2}, {{0, 0, -0.1}}}, 0, "truck"}}, 0.01, 4.0);
        setup.materials = {{"", 0.2, 0.6, 0.0, 0.1}};
        setup.forces.push_back(make_gravity({0, 0, -9.81}));
        setup.particles = {particle_of({0.3, 0.2, 0.05}, {2, 0.5, 0}, 0.05), particle_of({0.1, 0.4, 0.1}, {2, 0.5, 0})};
        Simulation simulation(std::move(setup));
        std::vector<Vec3> images(2);
        int still = 0;
        while (!simulation.finished()) {
            simulation.step();
            const MovingPose pose = simulation.collider_pose(0, simulation.time());
            for (std::size_t i = 0; i < 2; ++i) {
                const Vec3 image = pose.local_position(simulation.particles().position[i]);
                if (simulation.time() > 3.0) {
                    EXPECT_LT(length(image - images[i]), 4e-15 * (1.0 + max_abs(simulation.particles().position[i])));
                    ++still;
                    EXPECT_EQ(simulation.particles().resting[i], 1);
                } else {
                    images[i] = image;
                }
            }
        }
        EXPECT_GT(still, 100);
        EXPECT_EQ(simulation.statistics().violations, 0U);
    }
}

/// Returns the first time after `from` at which a freely flying ball reaches the table, whose height is A sin(omega t).
/// Finds the root by bracketing.
double next_landing(double from, double height, double speed, double amplitude, double omega) {
    const auto gap = [&](double t) {
        const double s = t - from;
        return height + speed * s - 0.5 * kG * s * s - amplitude * std::sin(omega * t);
    };
    double high = from + 1e-5;
    while (gap(high) > 0.0) high += 1e-5;
    double low = high - 1e-5;
    for (int k = 0; k < 100; ++k) {
        const double middle = 0.5 * (low + high);
        (gap(middle) > 0.0 ? low : high) = middle;
    }
    return low;
}

// The motion is chaotic, so two runs with different rounding soon diverge. Each landing is therefore predicted from the
// previous impact.
TEST(ABallOnAnOscillatingTable, LandsAtTheExactTimeEachTime) {
    const double frequency = 10.0;
    const double omega = 2.0 * kPi * frequency;
    const double amplitude = 1.2 * kG / (omega * omega);
    for (const double radius : {0.0, 0.01}) {
        auto setup = setup_of({frame_of("shaker", {Oscillation{{0, 0, amplitude}, frequency, 0.0}})},
                              {{"table", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0, "shaker"}}, 0.013, 4.0);
        setup.materials = {{"", 0.5, 0.0}};
        setup.forces.push_back(make_gravity({0, 0, -kG}));
        setup.options.resting_speed = 1e-3;
        setup.particles = {particle_of({0, 0, 0.02 + radius}, {}, radius)};
        Simulation simulation(std::move(setup));
        const std::vector<ContactRecord> contacts = all_contacts(simulation);
        EXPECT_GT(contacts.size(), 40U);
        int compared = 0;
        for (std::size_t k = 1; k < contacts.size(); ++k) {
            const ContactRecord& before = contacts[k - 1];
            const double after = before.velocity_after.z - before.surface_velocity.z;
            const double from_table = before.velocity_before.z - before.surface_velocity.z;
            if (from_table < -1e-9) {
                EXPECT_NEAR(after, -0.5 * from_table, 1e-12);
            }
            if (after < 2e-3) continue;  // persistent contact
            const double height = amplitude * std::sin(omega * before.time) + 1e-13;
            EXPECT_NEAR(contacts[k].time, next_landing(before.time, height, before.velocity_after.z, amplitude, omega),
                        1e-10)
                << k;
            ++compared;
        }
        EXPECT_GT(compared, 20);
    }
}

// A point lies on the table until the table accelerates downwards faster than gravity. This happens at sin(omega t) = g
// / (A omega^2). The point then has the speed of the table, for any time step.
TEST(APointOnATable, TakesOffWhenTheTableAcceleratesDownwardsAtG) {
    const double frequency = 5.0;
    const double omega = 2.0 * kPi * frequency;
    const double gamma = 1.7;
    const double amplitude = gamma * kG / (omega * omega);
    const double take_off = std::asin(1.0 / gamma) / omega;
    for (const double step : {0.003, 0.02}) {
        auto setup = setup_of({frame_of("shaker", {Oscillation{{0, 0, amplitude}, frequency, 0.0}})},
                              {{"table", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0, "shaker"}}, step, 0.06);
        setup.materials = {{"", 0.0, 0.5}};
        setup.forces.push_back(make_gravity({0, 0, -kG}));
        setup.particles = {particle_of({0, 0, 1e-15}, {0, 0, amplitude * omega})};
        Simulation simulation(std::move(setup));
        while (simulation.time() < take_off) simulation.step();
        const double s = simulation.time() - take_off;
        const double height = amplitude * std::sin(omega * take_off);
        const double speed = amplitude * omega * std::cos(omega * take_off);
        EXPECT_NEAR(simulation.particles().position[0].z, height + speed * s - 0.5 * kG * s * s, 1e-12) << step;
        EXPECT_NEAR(simulation.particles().velocity[0].z, speed - kG * s, 1e-10) << step;
    }
}

// On a slowly turning ramp the point starts to slip when the slope exceeds the angle of friction.
TEST(APointOnATurningRamp, SlipsWhenTheSlopeExceedsTheAngleOfFriction) {
    const double friction = 0.3;
    const double rate = 0.01;  // in degrees/s; accelerations due to the rotation change the result by less than 1e-9
    auto setup = setup_of({frame_of("ramp", {Spin{{0, 1, 0}, rate}})},
                          {{"ramp", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0, "ramp"}}, 0.5, 1800.0);
    setup.options.verify = false;
    setup.materials = {{"", 0.0, friction}};
    setup.forces.push_back(make_gravity({0, 0, -kG}));
    setup.particles = {particle_of({0.001, 0, 1e-15}, {})};
    Simulation simulation(std::move(setup));
    Vec3 last;
    while (!simulation.finished()) {
        simulation.step();
        const Vec3 image =
            simulation.collider_pose(0, simulation.time()).local_position(simulation.particles().position[0]);
        if (simulation.step_index() > 5 && std::fabs(image.x - last.x) > 1e-13) break;
        last = image;
    }
    const double slips_at = std::atan(friction) * 180.0 / kPi / rate;
    EXPECT_GE(simulation.time(), slips_at - 1e-3);
    EXPECT_LE(simulation.time() - 0.5, slips_at + 0.5 + 1e-3);
}

// The blade pushes a particle along a floor with friction. The particle moves with the blade. The impulse on the blade
// is the impulse of the start plus the impulse of the floor's friction.
TEST(APointBeforeABlade, IsPushedAlongTheFloorWithTheBladesSpeed) {
    const double u = 0.5;
    const double friction = 0.4;
    for (const double radius : {0.0, 0.05}) {
        auto setup = setup_of(
            {frame_of("blade", {steady({u, 0, 0})})},
            {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0}, {"blade", PlaneShape{{0, 0, 0}, {1, 0, 0}}, 1, "blade"}},
            0.01, 3.0);
        setup.materials = {{"floor", 0.0, friction}, {"blade", 0.3, 0.0}};
        setup.forces.push_back(make_gravity({0, 0, -kG}));
        setup.particles = {particle_of({radius + 0.1, 0, radius + 1e-15}, {}, radius)};
        Simulation simulation(std::move(setup));
        while (simulation.time() < 1.5) simulation.step();
        const double before = simulation.triangle_totals(1).impulse[0].x;
        const double start = simulation.time();
        while (!simulation.finished()) simulation.step();
        const Particles& p = simulation.particles();
        EXPECT_NEAR(p.position[0].x, u * 3.0 + radius, 1e-12);
        EXPECT_NEAR(p.velocity[0].x, u, 1e-12);
        EXPECT_NEAR(p.position[0].z, radius, 1e-13);
        // For a sliding point, the blade's force equals the floor's friction. A sphere rolls, so the frictionless blade
        // exerts no force.
        const double push = radius > 0.0 ? 0.0 : friction * kG * (3.0 - start);
        EXPECT_NEAR(before - simulation.triangle_totals(1).impulse[0].x, push, 1e-9);
        EXPECT_EQ(simulation.statistics().violations, 0U);
        EXPECT_EQ(simulation.statistics().energy_violations, 0U);
        EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
    }
}

// A plane turns about the origin and pushes the point along a wall one metre away. The point is at x = tan(omega t).
TEST(APointBeforeATurningArm, IsPushedAlongAWallAndNotThroughTheArm) {
    for (const double step : {0.01, 0.04}) {
        for (const double rate : {0.5, 1.0}) {
            const double until = 0.8 / rate;
            auto setup = setup_of(
                {frame_of("arm", {Spin{{0, 0, 1}, -rate * 180.0 / kPi}})},
                {{"wall", PlaneShape{{0, 1, 0}, {0, -1, 0}}, 0}, {"arm", PlaneShape{{0, 0, 0}, {1, 0, 0}}, 0, "arm"}},
                step, until);
            setup.materials = {{"", 0.0, 0.0}};
            setup.options.integrator = IntegratorKind::rk4;
            setup.forces.push_back(make_gravity({0, kG, 0}));
            setup.particles = {particle_of({0.03, 0.97, 0}, {})};
            Simulation simulation(std::move(setup));
            static_cast<void>(all_contacts(simulation));
            EXPECT_NEAR(simulation.particles().position[0].x, std::tan(0.8), 1e-12) << step << " " << rate;
            EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
        }
    }
}

// The blade sweeps a point over the inside of a ball. There is no frame in which both surfaces are at rest. The point
// spirals outward along the blade.
TEST(APointBeforeATurningBlade, IsSweptThroughABowl) {
    std::vector<Vec3> ends;
    for (const double step : {0.01, 0.005}) {
        auto setup = setup_of({frame_of("rotor", {Spin{{0, 0, 1}, 150.0}})},
                              {{"bowl", BallShape{6.0, {{0, 0, 6}}}, 0},
                               {"blade", CuboidShape{{1.6, 0.05, 0.4}, {{0, 0, 0.215}}}, 0, "rotor"}},
                              step, 1.0);
        setup.materials = {{"", 0.0, 0.3}};
        setup.forces.push_back(make_gravity({0, 0, -kG}));
        setup.particles = {particle_of({0.3, 0.3, 0.016018797}, {})};
        Simulation simulation(std::move(setup));
        static_cast<void>(all_contacts(simulation));
        EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
        ends.push_back(simulation.particles().position[0]);
    }
    EXPECT_LT(length(ends[0] - ends[1]), 1e-2);
    EXPECT_GT(length(ends[0]), 0.5);
}

// An open cup full of spheres is carried, tipped and shaken in steps of up to a tenth of a second.
TEST(ACup, LosesNoSphereThroughItsWalls) {
    for (const double step : {0.01, 0.1}) {
        std::vector<FrameMotion> motions{KeyedTranslation{KeyedCurve<Vec3>(
                                             {{0.0, {0, 0, 0}}, {1.0, {1, 0, 0.5}}, {2.0, {1, 1, 1}}, {3.0, {0, 0, 0}}},
                                             Interpolation::cubic_spline, CurveEnds::repeat)},
                                         Swing{{1, 0, 0}, 50.0, 0.7, 0.0}, Oscillation{{0.05, 0, 0.02}, 6.0, 0.0}};
        TriangleMesh cup = cuboid_mesh({0.6, 0.6, 0.6});
        std::erase_if(cup.triangles, [&](const Triangle& t) {  // removes the lid
            return cup.vertices[t[0]].z > 0.0 && cup.vertices[t[1]].z > 0.0 && cup.vertices[t[2]].z > 0.0;
        });
        auto setup =
            setup_of({frame_of("cup", motions)},
                     {{"cup", MeshShape{std::make_shared<const TriangleMesh>(cup), {}, "", {}}, 0, "cup"}}, step, 3.0);
        setup.materials = {{"", 0.4, 0.3}};
        setup.forces.push_back(make_gravity({0, 0, -kG}));
        RandomSequence random(2, 1, 0);
        for (int k = 0; k < 60; ++k) {
            const Vec3 p{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
            setup.particles.push_back(particle_of(0.5 * p, {}, k % 2 == 0 ? 0.0 : 0.03));
        }
        Simulation simulation(std::move(setup));
        static_cast<void>(all_contacts(simulation));
    }
}

/// Returns a frame that moves with the given velocity until 0.47 s and then stops.
FrameDescription stopping(const Vec3& velocity) {
    return frame_of("table", {KeyedTranslation{KeyedCurve<Vec3>({{0.0, {}}, {0.47, 0.47 * velocity}})}});
}

// If the velocity of a body jumps, a particle on the body keeps its own velocity.
TEST(APointOnATable, IsThrownOffOrSlidesOnIfTheTableStopsSuddenly) {
    for (const double step : {0.01, 0.03}) {
        for (const Vec3& velocity : {Vec3{0, 0, 1}, Vec3{1, 0, 0}}) {
            auto setup =
                setup_of({stopping(velocity)}, {{"table", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0, "table"}}, step, 0.57);
            setup.materials = {{"", 0.0, 0.2}};
            setup.forces.push_back(make_gravity({0, 0, -kG}));
            setup.particles = {particle_of({0, 0, 1e-9}, velocity)};
            Simulation simulation(std::move(setup));
            static_cast<void>(all_contacts(simulation));
            const Vec3 translation = simulation.particles().position[0] - 0.47 * velocity;
            const bool is_thrown = velocity.z > 0.0;
            const double force = is_thrown ? kG : 0.2 * kG;
            EXPECT_NEAR(is_thrown ? translation.z : translation.x, 0.1 - 0.5 * force * 0.01, 1e-8) << step;
            const Vec3& v = simulation.particles().velocity[0];
            EXPECT_NEAR(is_thrown ? v.z : v.x, 1.0 - force * 0.1, 1e-8) << step;
        }
    }
}

// The particle's coordinates are near zero in the frame, but not in the world. The contact offset must exceed the
// rounding of the world coordinates.
TEST(APointAtTheOriginOfItsFrame, IsCarriedDespiteRounding) {
    for (const double direction : {1.0, -0.1}) {
        for (const bool is_box : {false, true}) {
            ColliderShape shape = PlaneShape{{0, 0, 0}, {0, 0, 1}};
            if (is_box) shape = CuboidShape{{1, 1, 0.2}, {{0, 0, -0.1}}};
            auto setup =
                setup_of({frame_of("lift", {steady({0, 0, direction})})}, {{"table", shape, 0, "lift"}}, 0.01, 2.0);
            setup.materials = {{"", 0.0, 0.5}};
            setup.forces.push_back(make_gravity({0, 0, -kG}));
            setup.particles = {particle_of({0, 0, 1e-9}, {0, 0, direction})};
            Simulation simulation(std::move(setup));
            static_cast<void>(all_contacts(simulation));
            EXPECT_NEAR(simulation.particles().position[0].z, 2.0 * direction, 1e-12);
        }
    }
}

// A centre exactly on a surface has no side. The particle starts on the side of the normal.
TEST(AParticleThatIsBornOnAMovingSurface, LeavesIt) {
    for (const double radius : {0.0, 0.01}) {
        auto setup = setup_of({frame_of("floor", {steady({0.5, 0, 0.1})})},
                              {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0, "floor"}}, 0.01, 0.3);
        setup.forces.push_back(make_gravity({0, 0, -kG}));
        setup.particles = {particle_of({0.1, 0.2, 0}, {0, 0, 3}, radius)};
        Simulation simulation(std::move(setup));
        EXPECT_EQ(simulation.statistics().started_inside, 1U);
        static_cast<void>(all_contacts(simulation));
        EXPECT_NEAR(simulation.particles().position[0].z, 0.9 - 0.5 * kG * 0.09, 1e-9) << radius;
    }
}

// A frame at rest must give the same results as the world frame, with every integrator.
TEST(LastingContact, InAFrameAtRestIsThatOfTheWorldWithEveryIntegrator) {
    for (const IntegratorKind kind :
         {IntegratorKind::forward_euler, IntegratorKind::symplectic_euler, IntegratorKind::implicit_euler,
          IntegratorKind::ballistic, IntegratorKind::midpoint, IntegratorKind::velocity_verlet, IntegratorKind::rk4,
          IntegratorKind::dormand_prince}) {
        for (const double radius : {0.0, 0.05}) {
            auto setup =
                setup_of({frame_of("still", {})}, {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0, "still"}}, 0.01, 1.3);
            setup.materials = {{"", 0.5, 0.0}};
            setup.options.integrator = kind;
            setup.forces.push_back(make_gravity({0, 0, -kG}));
            setup.particles = {particle_of({0.3, 0, 0.05 + radius}, {1, 0, 0}, radius)};
            Simulation simulation(std::move(setup));
            static_cast<void>(all_contacts(simulation));
            const auto what = static_cast<int>(kind);
            EXPECT_NEAR(simulation.particles().position[0].x, 1.6, 1e-12) << what;
            // With forward Euler, flights within a step are straight and the velocity changes only at the end. The
            // particle therefore bounces by about g h^2.
            const double hop = kind == IntegratorKind::forward_euler ? 2e-3 : 1e-12;
            EXPECT_NEAR(simulation.particles().position[0].z, radius, hop) << what;
            EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0) << what;
        }
    }
}

/// Returns the distance, in m, between the upper ends of two springs after landing without friction. One spring lands
/// on a plane at rest. The other spring lands on a plane that moves along itself.
double apart_on_a_plane_that_moves(double step) {
    std::vector<Vec3> upper;
    for (const bool moves : {false, true}) {
        auto setup = setup_of({frame_of("slide", {steady({0.1, 0, 0})})},
                              {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0, moves ? "slide" : ""}}, step, 0.5);
        setup.materials = {{"", 0.1, 0.0}};
        setup.options.integrator = IntegratorKind::velocity_verlet;
        setup.forces.push_back(make_gravity({0, 0, -kG}));
        setup.particles = {particle_of({0, 0, 0.1}, {}, 0.02), particle_of({0, 0, 0.22}, {}, 0.02)};
        for (Particle& particle : setup.particles) particle.mass = 0.01;
        setup.springs.push_back({0, 1, 20.0, 0.02, 0.12});
        Simulation simulation(std::move(setup));
        static_cast<void>(all_contacts(simulation));
        upper.push_back(simulation.particles().position[1]);
        EXPECT_NEAR(simulation.particles().velocity[0].x, 0.0, 1e-12);
    }
    return length(upper[0] - upper[1]);
}

// The plan of the coupled particles includes the impulse of a plane at rest. It does not include the impulse of a
// moving plane, so a correction at the end of the step adds this impulse. Both results agree to second order.
TEST(ASpring, LandsEquallyOnAPlaneAtRestAndMovingAlongItselfToSecondOrder) {
    const double coarse = apart_on_a_plane_that_moves(0.002);
    const double fine = apart_on_a_plane_that_moves(0.001);
    EXPECT_LT(coarse, 1e-4);
    EXPECT_LT(fine, coarse / 3.8);
}

// The number of threads, the order of colliders, and a save and restore in the middle of the run change no bit.
TEST(AScene, WithMovingCollidersHasTheSameBitsInAnyKindOfRun) {
    const auto make = [](bool shuffled) {
        auto setup = setup_of({frame_of("rotor", {Spin{{0, 0, 1}, 200.0}}), frame_of("lift", {steady({0, 0, 0.1})})},
                              {{"pan", CylinderShape{1.0, 2.0, {{0, 0, 1}}}, 0},
                               {"blade", CuboidShape{{1.5, 0.05, 0.3}, {{0, 0, 0.2}}}, 1, "rotor"},
                               {"ball", BallShape{0.2, {{0.5, 0.5, 0.5}}}, 1, "lift"}},
                              0.01, 1.0);
        if (shuffled) std::swap(setup.colliders[0], setup.colliders[2]);
        setup.options.verify = false;
        setup.materials = {{"", 0.5, 0.3}, {"", 0.7, 0.2}};
        setup.forces.push_back(make_gravity({0, 0, -kG}));
        RandomSequence random(2, 1, 0);
        for (int k = 0; k < 100; ++k) {
            const Vec3 p{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform()};
            setup.particles.push_back(particle_of(p + Vec3{0, 0, 0.6}, {}, k % 2 == 0 ? 0.0 : 0.03));
        }
        return setup;
    };
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        Simulation simulation(make(false));
        while (!simulation.finished()) simulation.step();
        hashes.push_back(simulation.state_hash());
    }
    Simulation shuffled(make(true));
    while (!shuffled.finished()) shuffled.step();
    hashes.push_back(shuffled.state_hash());
    Simulation first(make(false));
    while (first.time() < 0.5) first.step();
    std::vector<std::byte> state;
    first.save([&](std::span<const std::byte> bytes) { state.insert(state.end(), bytes.begin(), bytes.end()); });
    Simulation resumed(make(false));
    std::size_t at = 0;
    resumed.restore([&](std::span<std::byte> bytes) {
        std::copy_n(state.begin() + static_cast<std::ptrdiff_t>(at), bytes.size(), bytes.begin());
        at += bytes.size();
    });
    while (!resumed.finished()) resumed.step();
    hashes.push_back(resumed.state_hash());
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
