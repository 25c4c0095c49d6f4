// Tests the classical interface of dimension, state and derivative. Its results must not depend on the order of calls.
#include "ricochet/dynamics/particle_system.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "ricochet/core/error.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Two particles on a spring, a third one that is pinned, and gravity.
class PairOnASpring : public ::testing::Test {
protected:
    PairOnASpring() {
        std::vector<std::unique_ptr<Force>> list;
        list.push_back(make_gravity({0, 0, -9.81}));
        forces_ = ForceField(std::move(list));
        add({1, 0, 0}, {0, 1, 0}, 2.0, false);
        add({3, 0, 0}, {0, 0, 0}, 0.5, false);
        add({3, 4, 0}, {7, 7, 7}, 1.0, true);
        springs_ = SpringNetwork({{0, 1, 1.5, 40.0, 0.3}, {1, 2, 4.0, 10.0, 0.0}});
        springs_.bind(particles_.id);
        system_.assign(particles_, springs_.coupled(), 0.25);
    }
    void add(const Vec3& x, const Vec3& v, double mass, bool pinned) {
        Particle particle;
        particle.id = particles_.size();
        particle.position = x;
        particle.velocity = v;
        particle.mass = mass;
        particle.pinned = pinned;
        particles_.append(particle);
    }

    ForceField forces_;
    Particles particles_;
    SpringNetwork springs_;
    ParticleSystem system_{forces_, springs_};
};

TEST_F(PairOnASpring, HasSixDimensionsForEachMember) {
    EXPECT_EQ(system_.size(), 3U);
    EXPECT_EQ(system_.dimension(), 18U);
    EXPECT_EQ(system_.time(), 0.25);
}

TEST_F(PairOnASpring, ReturnsTheStateThatWasSet) {
    std::vector<double> state(18);
    for (std::size_t i = 0; i < 12; ++i) state[i] = 0.5 * static_cast<double>(i);
    state[12] = 3.0;
    state[13] = 4.0;
    system_.set_state(state);
    std::vector<double> found(18);
    system_.get_state(found);
    EXPECT_EQ(found, state);
}

TEST_F(PairOnASpring, DerivativeIsVelocityAndAccelerationOfTheClosedForm) {
    std::vector<double> d(18);
    system_.derivative(0.25, d);
    // Spring 0 is stretched by 0.5 m along x and its ends move across it, so its force is 20 N. Spring 1 is at rest
    // length.
    const std::vector<double> expected{0, 1, 0, 10.0, 0, -9.81, 0, 0, 0, -40.0, 0, -9.81, 0, 0, 0, 0, 0, 0};
    for (std::size_t i = 0; i < 18; ++i) EXPECT_NEAR(d[i], expected[i], 1e-13) << i;
}

TEST_F(PairOnASpring, DerivativeOfAGivenStateEqualsTheDerivativeInThatState) {
    std::vector<double> state(18);
    system_.get_state(state);
    for (std::size_t i = 0; i < 12; ++i) state[i] += 0.1 * std::sin(static_cast<double>(i));
    std::vector<double> from_outside(18);
    system_.derivative(0.5, state, from_outside);
    system_.set_state(state);
    std::vector<double> from_inside(18);
    system_.derivative(0.5, from_inside);
    EXPECT_EQ(from_outside, from_inside);
}

TEST_F(PairOnASpring, PinnedMembersKeepTheirPositionInAnyState) {
    std::vector<double> state(18, 5.0);
    system_.set_state(state);
    EXPECT_EQ(system_.positions()[2], (Vec3{3, 4, 0}));
    EXPECT_EQ(system_.velocities()[2], Vec3{});
}

TEST_F(PairOnASpring, RefusesVectorsOfAnotherLength) {
    std::vector<double> state(17);
    EXPECT_THROW(system_.get_state(state), InputError);
    EXPECT_THROW(system_.set_state(state), InputError);
    EXPECT_THROW(system_.derivative(0.0, state), InputError);
}

TEST_F(PairOnASpring, SpringsChangeNoMomentum) {
    const auto& x = system_.positions();
    const auto& v = system_.velocities();
    const Vec3 sum =
        system_.spring_force_on(0, x, v) + system_.spring_force_on(1, x, v) + system_.spring_force_on(2, x, v);
    EXPECT_EQ(sum, Vec3{});
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
