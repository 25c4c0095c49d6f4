#include "ricochet/verify/triangle_tests.h"

#include <gtest/gtest.h>

#include "ricochet/core/random.h"
#include "support/counts.h"
#include "support/exact_oracle.h"
#include "support/segment_triangle_cases.h"

namespace ricochet::verify {
namespace RICOCHET_FILE {

using testing::exact;
using testing::Rational;
using testing::sign_of;

constexpr std::uint64_t kSeed = 77;

// The cases include flat, slender, collinear, tiny, huge and far-away triangles.
TEST(Signs, SignsMatchRationalNumbers) {
    for (int i = 0; i < test::scaled(20000); ++i) {
        const auto [p, q, a, b, c] = testing::segment_triangle_case(kSeed, static_cast<std::uint64_t>(i));
        SCOPED_TRACE(testing::description({p, q, a, b, c}));
        ASSERT_EQ(spatial_sign(a, b, c, p), sign_of(testing::exact_orient3d(a, b, c, p)));
        ASSERT_EQ(spatial_sign(p, q, a, b), sign_of(testing::exact_orient3d(p, q, a, b)));
        const auto area = testing::exact_area_vector(a, b, c);
        ASSERT_EQ(planar_sign(0, 1, a, b, c), sign_of(area[2]));
        ASSERT_EQ(planar_sign(1, 2, a, b, c), sign_of(area[0]));
        ASSERT_EQ(planar_sign(2, 0, a, b, c), sign_of(area[1]));
        ASSERT_EQ(on_one_line(a, b, c), area[0] == 0 && area[1] == 0 && area[2] == 0);
        Rational height = 0;
        for (int axis = 0; axis < 3; ++axis) height += exact(a[axis]) * (exact(p[axis]) - exact(q[axis]));
        ASSERT_EQ(height_sign(a, q, p), sign_of(height));
    }
}

// Coordinates of very different sizes need more digits than the fixed-size integers have.
TEST(Signs, SignsAreRightForCoordinatesOfExtremeSizes) {
    const Vec3 a{1e75, 0, 0}, b{0, 1e75, 0}, c{0, 0, 1e75};
    EXPECT_EQ(spatial_sign(a, b, c, {1e75, 0x1p-280, 0}), 1);
    EXPECT_EQ(spatial_sign(a, b, c, {1e75, -0x1p-280, 0}), -1);
    EXPECT_EQ(spatial_sign(a, b, c, {1e75, 0x1p-280, -0x1p-280}), 0);
    EXPECT_EQ(planar_sign(0, 1, a, b, {1e75, 0x1p-280, 0}), -1);
    const Vec3 d{0x1p-280, 0, 0}, e{0, 0x1p-280, 0}, f{0, 0, 0x1p-280};
    EXPECT_EQ(spatial_sign(d, e, f, {0x1p-280, 0x1p-320, 0}), 1);
    EXPECT_EQ(height_sign({1, 0x1p-200, 0}, {1, 1, 1}, {1, 1 + 0x1p-52, 1}), 1);
    EXPECT_EQ(height_sign({1, 0x1p-200, 0}, {1, 1, 1}, {1, 1, 2}), 0);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::verify
