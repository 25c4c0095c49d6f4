#include "ricochet/geometry/sweep/pair_sweep.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ricochet/core/random.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

Vec3 in_cube(RandomSequence& random) {
    return {random.uniform_around(0, 1), random.uniform_around(0, 1), random.uniform_around(0, 1)};
}

// After an impact without rebound, the remaining approach and the gap are only rounding errors. A graze has a
// discriminant of the size of rounding, whose sign plain doubles cannot determine.
TEST(PairSweep, SpheresThatSlipPastEachOtherCollideOnlyIfTheyTouch) {
    RandomSequence random(43, 0, 0);
    constexpr double kDistance = 0.06;
    const int count = test::scaled(20000);
    int meetings = 0;
    for (int k = 0; k < count; ++k) {
        SCOPED_TRACE(k);
        const Vec3 place = in_cube(random);
        const Vec3 normal = normalized(in_cube(random));
        const Vec3 velocity = in_cube(random);
        const Vec3 slip = in_cube(random);
        const Vec3 apart = (kDistance * (1.0 + 0x1p-50 * random.uniform())) * normal;
        const Path first = line_path(place, velocity, 1.0);
        const Path second = line_path(place + apart, velocity + (slip - dot(slip, normal) * normal), 1.0);
        const auto time = first_meeting(TimedPath{&first, 0.0, 1.0}, TimedPath{&second, 0.0, 1.0}, kDistance, 0x1p-47);
        if (!time) continue;
        ++meetings;
        EXPECT_NEAR(length(second.position(*time) - first.position(*time)), kDistance, 1e-15);
    }
    EXPECT_LT(meetings, count);
}

// Closed form: two spheres pass at the sum of their radii, or at one rounding unit less or more.
TEST(PairSweep, AGrazeIsDecidedToTheLastBit) {
    const Path first = line_path({0, 0, 0}, {0, 0, 0}, 4.0);
    for (const double beside : {1.0 - 0x1p-53, 1.0, 1.0 + 0x1p-52}) {
        const Path second = line_path({-1.0, beside, 0.0}, {1.0, 0.0, 0.0}, 4.0);
        const auto time = first_meeting(TimedPath{&first, 0.0, 4.0}, TimedPath{&second, 0.0, 4.0}, 1.0, 0.0);
        EXPECT_EQ(time.has_value(), beside <= 1.0) << beside;
        if (time) {
            EXPECT_NEAR(*time, 1.0 - std::sqrt((1.0 - beside) * (1.0 + beside)), 1e-15);
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
