// Impacts on more surfaces at once than one contact problem can include.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "collision/worlds.h"
#include "response/course.h"
#include "ricochet/response/impact_problem.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr int kSides = 5 * static_cast<int>(ImpactResult::kMostSurfaces);

/// Returns the normals of a funnel about the z axis. All sides pass through the origin.
std::vector<Vec3> funnel_normals() {
    std::vector<Vec3> normals;
    for (int k = 0; k < kSides; ++k) {
        const double turn = 6.283185307179586 * k / kSides;
        normals.push_back(normalized(Vec3{std::cos(turn), std::sin(turn), 1.0}));
    }
    return normals;
}

class ManySurfaces : public ::testing::TestWithParam<ResponseKind> {};

INSTANTIATE_TEST_SUITE_P(Responses, ManySurfaces,
                         ::testing::Values(ResponseKind::exact, ResponseKind::rollback, ResponseKind::project),
                         [](const auto& test) { return std::string(name_of(test.param)); });

TEST_P(ManySurfaces, BallInAFunnelReboundsFromAllSides) {
    const std::vector<Vec3> normals = funnel_normals();
    for (const double radius : {0.0, 0.2}) {
        for (const double restitution : {0.0, 0.5, 1.0}) {
            SCOPED_TRACE(::testing::Message() << "radius " << radius << ", restitution " << restitution);
            std::vector<ColliderDescription> sides;
            for (const Vec3& normal : normals) sides.push_back(testing::plane_collider({}, normal));
            testing::Course course(std::move(sides), {"", restitution, 0.2}, {}, GetParam(), {});
            const Vec3 before{0, 0, -3};
            MovingParticle ball{{{0, 0, 0.6}, before, 1.0, radius, 0.0}, {}, 0, 0};
            for (int step = 0; step < 4; ++step) (void)course.move(ball, 0.1);
            EXPECT_LE(length_squared(ball.state.velocity), length_squared(before) * (1.0 + 1e-12));
            for (const Vec3& normal : normals) {
                EXPECT_GE(dot(ball.state.velocity, normal), -1e-12);
                EXPECT_GE(dot(ball.state.position, normal), radius - 1e-6);
            }
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
