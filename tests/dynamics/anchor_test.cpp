#include "ricochet/dynamics/forces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "dynamics/trajectory.h"
#include "ricochet/core/error.h"

namespace ricochet {
namespace RICOCHET_FILE {

using std::numbers::pi;
using test::carried;
using test::field_of;

TEST(Anchor, PullsByStretchAndDampsAlongTheSpring) {
    const auto anchor = make_anchor({{1, 0, 0}, 10.0, 2.0, 0.5});
    // Stretched by 1 m. The particle moves outward at 4 m/s and across at 7 m/s.
    EXPECT_EQ(anchor->acceleration({{4, 0, 0}, {4, 7, 0}, 2.0, 0.0, 0.0}), (Vec3{-6, 0, 0}));
    EXPECT_EQ(anchor->acceleration({{2, 0, 0}, {}, 2.0, 0.0, 0.0}), (Vec3{5, 0, 0}));
    EXPECT_DOUBLE_EQ(*anchor->potential_energy({{4, 0, 0}, {}, 2.0, 0.0, 0.0}), 5.0);
    EXPECT_EQ(anchor->acceleration({{1, 0, 0}, {3, 0, 0}, 2.0, 0.0, 0.0}), Vec3{});
    EXPECT_TRUE(anchor->is_steady());
}

TEST(Anchor, SwingsWithTheOscillatorsFrequency) {
    const double period = 2.0 * pi * std::sqrt(0.5 / 8.0);
    const ForceField forces = field_of(make_anchor({{}, 8.0, 1.0, 0.0}));
    const ForceInput start{{1.25, 0, 0}, {}, 0.5, 0.0, 0.0};
    EXPECT_NEAR(carried(forces, start, period / 2.0, 500).position.x, 0.75, 1e-9);
    EXPECT_NEAR(carried(forces, start, period, 1000).position.x, 1.25, 1e-9);
}

TEST(Anchor, DecaysLikeADampedOscillator) {
    const double k = 8.0;
    const double m = 0.5;
    const double c = 0.4;
    const double decay = c / (2.0 * m);
    const double omega = std::sqrt(k / m - decay * decay);
    const ForceField forces = field_of(make_anchor({{}, k, 1.0, c}));
    const double t = 3.0;
    const ForceInput end = carried(forces, {{1.25, 0, 0}, {}, m, 0.0, 0.0}, t, 3000);
    const double swing = 0.25 * std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t));
    EXPECT_NEAR(end.position.x, 1.0 + swing, 1e-9);
}

TEST(Anchor, ActsOnItsParticlesOnly) {
    const auto anchor = make_anchor({{}, 1.0, 0.0, 0.0, {9, 2, 5}});
    for (const std::uint64_t id : {0U, 2U, 3U, 5U, 9U, 10U}) {
        const ForceInput state{{1, 0, 0}, {}, 1.0, 0.0, 0.0, id};
        const bool hangs = id == 2 || id == 5 || id == 9;
        EXPECT_EQ(anchor->acceleration(state).x, hangs ? -1.0 : 0.0) << id;
        EXPECT_EQ(*anchor->potential_energy(state), hangs ? 0.5 : 0.0) << id;
    }
}

TEST(Anchor, RefusesValuesOutOfRange) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW((void)make_anchor({{nan, 0, 0}, 1.0, 0.0, 0.0}), InputError);
    EXPECT_THROW((void)make_anchor({{}, -1.0, 0.0, 0.0}), InputError);
    EXPECT_THROW((void)make_anchor({{}, 1.0, -1.0, 0.0}), InputError);
    EXPECT_THROW((void)make_anchor({{}, 1.0, 0.0, nan}), InputError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
