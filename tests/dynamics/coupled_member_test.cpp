// Tests members of a particle system that deviate from the planned step, and the interaction with the other members.
#include "ricochet/dynamics/coupled_member.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ricochet/dynamics/system_integrator.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kStep = 0.01;

/// Three particles on two springs, and their planned flights.
class PlannedSystem {
public:
    explicit PlannedSystem(IntegratorKind kind)
        : springs_({{0, 1, 0.4, 300.0, 2.0}, {1, 2, 0.5, 200.0, 0.0}}), system_(forces_, springs_) {
        add({0, 0, 0}, {1.0, 0.5, -0.2}, 1.0);
        add({0.5, 0.1, 0}, {-0.4, 0.2, 0.3}, 2.0);
        add({0.9, -0.1, 0.2}, {0.1, -0.6, 0.0}, 0.5);
        springs_.bind(particles_.id);
        system_.assign(particles_, springs_.coupled(), 0.0);
        const SystemStep step = step_system(kind, system_, kStep, kStep);
        for (std::size_t k = 0; k < 3; ++k) plans.push_back(planned_flight(kind, system_, step, k));
        deviations.reset(3, kind);
    }
    [[nodiscard]] const ParticleSystem& system() const { return system_; }
    [[nodiscard]] std::vector<Vec3> planned_velocities() const {
        std::vector<Vec3> velocities;
        for (const Flight& plan : plans) velocities.push_back(plan.end_velocity);
        return velocities;
    }
    [[nodiscard]] Vec3 momentum(const std::vector<Vec3>& velocities) const {
        Vec3 sum;
        for (std::size_t k = 0; k < 3; ++k) sum += system_.mass(k) * velocities[k];
        return sum;
    }
    /// Reverses member 0 in the middle of the step. It then flies on in a straight line. Returns its velocities.
    std::vector<FlownPiece> turn_back() {
        const double half = 0.5 * kStep;
        FlownPiece before = piece_of(plans[0]);
        before.duration = half;
        before.arrival = before.path.velocity(half);
        const Vec3 back = -1.0 * before.arrival;
        const FlownPiece after{line_path(before.path.position(half), back, half), half, half, back, back, true};
        return {before, after};
    }

    std::vector<Flight> plans;
    PlanDeviations deviations;

private:
    void add(const Vec3& position, const Vec3& velocity, double mass) {
        Particle particle;
        particle.id = particles_.size();
        particle.position = position;
        particle.velocity = velocity;
        particle.mass = mass;
        particles_.append(particle);
    }

    ForceField forces_;
    SpringNetwork springs_;
    Particles particles_;
    ParticleSystem system_;
};

TEST(FlownPiece, EndsWithTheVelocityOfTheMethod) {
    const PlannedSystem planned(IntegratorKind::velocity_verlet);
    const FlownPiece piece = piece_of(planned.plans[1]);
    EXPECT_EQ(piece.at(0.0).velocity, planned.plans[1].start.velocity);
    EXPECT_LT(length(piece.at(kStep).velocity - planned.plans[1].end_velocity), 1e-14);
    EXPECT_EQ(piece.at(kStep).position, planned.plans[1].path.end);
}

TEST(CoupledMember, HasTheForceOfTheSystemOnItsPlannedPath) {
    const PlannedSystem planned(IntegratorKind::rk4);
    const ParticleSystem& system = planned.system();
    for (std::size_t k = 0; k < 3; ++k) {
        const CoupledMember member(system, planned.plans, k);
        EXPECT_TRUE(member.varies());
        const ForceInput start = planned.plans[k].start;
        const Vec3 expected = system.spring_force_on(k, system.positions(), system.velocities()) / system.mass(k);
        EXPECT_LT(length(member.acceleration(start) - expected), 1e-12);
    }
}

TEST(CoupledMember, UsesThePositionsOfTheOthersAtTheSameTime) {
    const PlannedSystem planned(IntegratorKind::rk4);
    ForceInput input = planned.plans[2].start;
    input.time = 0.6 * kStep;
    const PhaseState other = piece_of(planned.plans[1]).at(input.time);
    const Vec3 force = spring_force({1, 2, 0.5, 200.0, 0.0}, other.position, other.velocity, input.position, {});
    EXPECT_LT(length(CoupledMember(planned.system(), planned.plans, 2).acceleration(input) + force / input.mass),
              1e-12);
}

TEST(CoupledMember, CanHaveAConstantAcceleration) {
    const CoupledMember held({1, 2, 3});
    EXPECT_FALSE(held.varies());
    EXPECT_EQ(held.acceleration({}), (Vec3{1, 2, 3}));
}

TEST(PlanDeviations, ChangeNothingIfAllMembersFlyAsPlanned) {
    PlannedSystem planned(IntegratorKind::rk4);
    std::vector<Vec3> velocities = planned.planned_velocities();
    planned.deviations.correct(planned.system(), planned.plans, {1, 1, 1}, velocities);
    EXPECT_EQ(velocities, planned.planned_velocities());
}

// A velocity change of 2 v in the middle of a step stretches the spring by 2 v h / 2 at the end of the step. The spring
// adds an impulse of k v h^2 / 4, and the damper adds 2 v c h / 2.
TEST(PlanDeviations, TransferTheImpulseOfTheDeviationToTheOthers) {
    for (const IntegratorKind kind : {IntegratorKind::velocity_verlet, IntegratorKind::rk4}) {
        PlannedSystem planned(kind);
        const std::vector<FlownPiece> flown = planned.turn_back();
        std::vector<Vec3> velocities = planned.planned_velocities();
        const Vec3 turned = flown[1].start_velocity - flown[0].arrival;
        velocities[0] = flown[1].arrival;
        planned.deviations.record(0, flown, turned);
        planned.deviations.correct(planned.system(), planned.plans, {1, 1, 1}, velocities);
        const Vec3 given = 2.0 * (velocities[1] - planned.plans[1].end_velocity);
        const Vec3 along = planned.plans[1].start.position / length(planned.plans[1].start.position);
        const double speed = dot(turned, along);
        const double expected = speed * (300.0 * kStep * kStep / 8.0 + 2.0 * kStep / 2.0);
        EXPECT_NEAR(dot(given, along), expected, 0.1 * std::fabs(expected)) << name_of(kind);
        EXPECT_EQ(velocities[2], planned.plans[2].end_velocity) << name_of(kind);
    }
}

TEST(PlanDeviations, ConserveMomentumExceptForTheImpactImpulse) {
    for (const IntegratorKind kind : {IntegratorKind::velocity_verlet, IntegratorKind::midpoint, IntegratorKind::rk4}) {
        PlannedSystem planned(kind);
        const std::vector<FlownPiece> flown = planned.turn_back();
        std::vector<Vec3> velocities = planned.planned_velocities();
        const Vec3 before = planned.momentum(velocities);
        const Vec3 turned = flown[1].start_velocity - flown[0].arrival;
        velocities[0] = flown[1].arrival;
        planned.deviations.record(0, flown, turned);
        planned.deviations.correct(planned.system(), planned.plans, {1, 1, 1}, velocities);
        EXPECT_LT(length(planned.momentum(velocities) - before - planned.system().mass(0) * turned), 1e-14);
    }
}

TEST(PlanDeviations, LeaveTheVelocitiesOfUnaffectedMembers) {
    PlannedSystem planned(IntegratorKind::rk4);
    std::vector<Vec3> velocities = planned.planned_velocities();
    planned.deviations.record(0, planned.turn_back(), {});
    planned.deviations.correct(planned.system(), planned.plans, {0, 0, 1}, velocities);
    EXPECT_EQ(velocities, planned.planned_velocities());
}

// This also holds in contact. The spring pulls on a particle that a surface has stopped, and applies the opposite
// impulse at its other end.
TEST(PlanDeviations, GiveOppositeImpulsesToBothEndsIfOneIsStopped) {
    for (const IntegratorKind kind : {IntegratorKind::velocity_verlet, IntegratorKind::midpoint, IntegratorKind::rk4}) {
        PlannedSystem planned(kind);
        const Flight& plan = planned.plans[0];
        std::vector<Vec3> velocities = planned.planned_velocities();
        const Vec3 before = planned.momentum(velocities);
        const Vec3 velocity_change{0.3, -0.2, 0.7};
        velocities[0] = {};
        const FlownPiece stay{line_path(plan.start.position, {}, kStep), plan.start.time, kStep, {}, {}, false};
        planned.deviations.record(0, {&stay, 1}, velocity_change);
        EXPECT_TRUE(planned.deviations.has_left(0));
        planned.deviations.correct(planned.system(), planned.plans, {1, 1, 1}, velocities);
        EXPECT_NE(velocities[1], planned.plans[1].end_velocity) << name_of(kind);
        EXPECT_LT(length(planned.momentum(velocities) - before - planned.system().mass(0) * velocity_change), 1e-14);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
