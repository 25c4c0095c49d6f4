#include "ricochet/geometry/mesh/winding_number.h"

#include <gtest/gtest.h>

#include "ricochet/core/random.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

TEST(WindingNumber, IsOneInsideAndZeroOutsideAClosedMesh) {
    constexpr std::uint64_t kSeed = 3;
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
    const TriangleMesh ball = testing::sphere_mesh({1, 2, 3}, 1.0, 2);
    RandomSequence random(kSeed, 1, 0);
    for (int k = 0; k < static_cast<int>(test::scaled(200)); ++k) {
        const Vec3 direction = random.unit_vector();
        EXPECT_NEAR(winding_number(ball, Vec3{1, 2, 3} + 0.9 * random.uniform() * direction), 1.0, 1e-12);
        EXPECT_NEAR(winding_number(ball, Vec3{1, 2, 3} + (1.1 + random.uniform()) * direction), 0.0, 1e-12);
    }
    EXPECT_NEAR(winding_number(testing::flipped(ball), {1, 2, 3}), -1.0, 1e-12);
}

// From its centre, a cube without one face covers five sixths of all directions.
TEST(WindingNumber, IsTheFractionOfDirectionsCoveredByAnOpenMesh) {
    TriangleMesh cube = testing::box_mesh({-1, -1, -1}, {1, 1, 1});
    std::erase_if(cube.triangles, [&](const Triangle& t) {
        return cube.vertices[t[0]].z + cube.vertices[t[1]].z + cube.vertices[t[2]].z == 3.0;
    });
    EXPECT_NEAR(winding_number(cube, {}), 5.0 / 6.0, 1e-12);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
