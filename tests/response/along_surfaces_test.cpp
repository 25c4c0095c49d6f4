#include "ricochet/response/along_surfaces.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "ricochet/core/random.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

TEST(ShortestShift, WithoutPlanesItIsZero) {
    const ShortestShift shift;
    EXPECT_TRUE(shift.is_empty());
    EXPECT_EQ(shift.vector(), Vec3{});
}

// The shortest vector is in the span of the normals: it has no component perpendicular to all of them.
TEST(ShortestShift, MovesByEachDistanceAndInNoOtherDirection) {
    RandomSequence random(3, 0, 0);
    for (int k = 0; k < test::scaled(1000); ++k) {
        SCOPED_TRACE("case " + std::to_string(k));
        ShortestShift shift;
        std::array<Vec3, 2> normals;
        std::array<double, 2> distances{};
        for (std::size_t i = 0; i < normals.size(); ++i) {
            normals[i] = random.unit_vector();
            distances[i] = 2.0 * random.uniform() - 1.0;
            shift.add(normals[i], distances[i]);
        }
        const Vec3 line = cross(normals[0], normals[1]);
        if (length(line) < 0.01) continue;
        for (std::size_t i = 0; i < normals.size(); ++i) {
            EXPECT_NEAR(dot(shift.vector(), normals[i]), distances[i], 1e-11);
        }
        EXPECT_NEAR(dot(shift.vector(), line), 0.0, 1e-11);
    }
}

TEST(ShortestShift, NormalThatDependsOnEarlierOnesIsIgnored) {
    ShortestShift shift;
    shift.add({1, 0, 0}, 2.0);
    shift.add({0, 1, 0}, 3.0);
    shift.add({-1, 0, 0}, 5.0);
    EXPECT_EQ(shift.vector(), (Vec3{2, 3, 0}));
    shift.add({0, 0, 1}, 4.0);
    shift.add({0.6, 0.8, 0}, 100.0);
    EXPECT_EQ(shift.vector(), (Vec3{2, 3, 4}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
