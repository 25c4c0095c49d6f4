#include "ricochet/response/rim_side.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "ricochet/collision/collision_world.h"
#include "ricochet/core/random.h"
#include "ricochet/core/tolerances.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

double slack_at(const Vec3& p) { return kEdgeOffsets * contact_offset(p); }

bool is_beyond(const TrianglePlane& plane, const Vec3& p) {
    const Vec3 foot = p - plane.signed_distance(p) * plane.unit_normal();
    return CollisionWorld::nearest(plane, foot).distance > slack_at(p);
}

TEST(RimSide, KnowsPointsAboveTheFaceAndFarBesideIt) {
    const TrianglePlane plane({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    EXPECT_EQ(is_foot_beyond(plane, {0.2, 0.2, 0.1}, slack_at({0.2, 0.2, 0.1})), false);
    EXPECT_EQ(is_foot_beyond(plane, {0.8, 0.8, 0.1}, slack_at({0.8, 0.8, 0.1})), true);
    EXPECT_EQ(is_foot_beyond(plane, {0.5, 0.5, 0.1}, slack_at({0.5, 0.5, 0.1})), std::nullopt);  // on the rim
}

// The foot of a point far above a sliver, or of one near the origin, can be rounded by more than the slack.
TEST(RimSide, LeavesRoundedFeetToTheFullComputation) {
    const TrianglePlane sliver({0.75373, 0.44104, 0.3007}, {0.35096, -0.38187, 0.70143}, {0.37461, -0.33355, 0.6779});
    const Vec3 above{-0.41995278412126574, 0.30043150795219126, 0.44706904461461699};
    EXPECT_EQ(is_foot_beyond(sliver, above, slack_at(above)), std::nullopt);
    const TrianglePlane around({-1.3965828858598583, -0.55582321885180164, -1.6554808341713207},
                               {-0.60611087405030861, 2.0857437593669967, 0.41509345769308092},
                               {-0.91645147428473261, -1.0363514839516965, 1.7251354430862684});
    EXPECT_EQ(is_foot_beyond(around, {}, slack_at({})), std::nullopt);
}

TEST(RimSide, AgreesWithTheFullComputationOnSliversAndBesideTheOrigin) {
    RandomSequence random(7, 1, 0);
    const int count = 40'000 * test::case_factor(25);
    int answered = 0;
    for (int k = 0; k < count; ++k) {
        const double thinness = std::ldexp(1.0, -static_cast<int>(48.0 * random.uniform() * random.uniform()));
        const double size = std::ldexp(1.0, static_cast<int>(40.0 * random.uniform()) - 20);
        const Vec3 offset = k % 3 == 0 ? Vec3{} : (size * std::ldexp(1.0, k % 13 - 3)) * random.unit_vector();
        const Vec3 along = size * random.unit_vector();
        const Vec3 across = (thinness * size) * random.unit_vector();
        const std::array<Vec3, 3> corners{offset, offset + along, offset + random.uniform() * along + across};
        const TrianglePlane plane(corners[0], corners[1], corners[2]);
        const double s = 1.4 * random.uniform() - 0.2;
        const double t = 1.4 * random.uniform() - 0.2;
        Vec3 foot = corners[0] + s * (corners[1] - corners[0]) + ((1.0 - s) * t) * (corners[2] - corners[0]);
        // In every fifth case the particle is beside the origin.
        const double radius = k % 7 == 0 ? 0.0 : size * std::ldexp(1.0, k % 11 - 8);
        Vec3 p = foot + radius * plane.unit_normal();
        const bool is_moved = k % 5 == 0;
        const Vec3 shift = is_moved ? -p : Vec3{};
        const TrianglePlane moved(corners[0] + shift, corners[1] + shift, corners[2] + shift);
        p += shift;
        const auto answer = is_foot_beyond(moved, p, slack_at(p));
        if (!answer) continue;
        ++answered;
        ASSERT_EQ(*answer, is_beyond(moved, p)) << "case " << k;
    }
    EXPECT_GT(answered, count / 2);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
