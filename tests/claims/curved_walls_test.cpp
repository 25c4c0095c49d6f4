// Reflections in mirrors with known paths: the sphere, the ellipsoid, the paraboloid and the box.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "collision/worlds.h"
#include "response/course.h"
#include "ricochet/core/random.h"
#include "support/counts.h"
#include "support/simple_meshes.h"
#include "support/statistics.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::Course;
using testing::Sample;

const Material kMirror{"mirror", 1.0, 0.0};

ForceInput at(const Vec3& position, const Vec3& velocity) { return {position, velocity, 1.0, 0.0, 0.0}; }

double distance_of_line(const Vec3& through, const Vec3& direction, const Vec3& point) {
    return length(cross(point - through, direction)) / length(direction);
}

TEST(SphericalMirror, KeepsTheAngleOfIncidenceAndTheChordForever) {
    Course course({{"ball", BallShape{1.0, {}}, 0}}, kMirror, {}, IntegratorKind::ballistic, 1000000);
    ForceInput state = at({0.3, 0.1, -0.5}, {0.7, 0.4, 0.2});
    (void)course.move(state, 5000.0);
    const std::vector<ContactRecord>& hits = course.scratch.records;
    ASSERT_GT(hits.size(), 2000U);
    const double chord = length(hits[1].position - hits[0].position);
    const double cosine = -dot(hits[0].velocity_before, hits[0].normal) / length(hits[0].velocity_before);
    for (std::size_t k = 1; k < hits.size(); ++k) {
        ASSERT_NEAR(length(hits[k].position - hits[k - 1].position), chord, 1e-11) << k;
        const double now = -dot(hits[k].velocity_before, hits[k].normal) / length(hits[k].velocity_before);
        ASSERT_NEAR(now, cosine, 1e-11) << k;
    }
}

// With half axes 5, 3, 3 the foci are at +-4 on the x axis.
TEST(EllipsoidalMirror, SendsRaysFromOneFocusThroughTheOtherAtEveryBounce) {
    Placement placement;
    placement.scale = {5, 3, 3};
    Course course({{"egg", BallShape{1.0, placement}, 0}}, kMirror, {});
    RandomSequence random(1, 0, 0);
    for (int i = 0; i < test::scaled(300); ++i) {
        ForceInput state = at({4, 0, 0}, random.unit_vector());
        (void)course.move(state, 45.0);  // a path from focus to wall to focus has 10 m
        const std::vector<ContactRecord>& hits = course.scratch.records;
        ASSERT_GE(hits.size(), 4U);
        for (std::size_t k = 0; k < 4; ++k) {
            const Vec3 focus{k % 2 == 0 ? -4.0 : 4.0, 0, 0};
            // The path through the foci is unstable. Every bounce amplifies an error by at most the factor (a + c) / (a
            // - c) = 9.
            ASSERT_LT(distance_of_line(hits[k].position, hits[k].velocity_after, focus),
                      1e-13 * std::pow(9.0, 1.0 + static_cast<double>(k)))
                << "ray " << i << ", bounce " << k;
        }
    }
}

/// Returns the root mean square distance at which rays from one focus pass the other focus, after one bounce in a
/// faceted ellipsoid.
double focal_blur(int levels, int rays) {
    Placement placement;
    placement.scale = {5, 3, 3};
    ColliderDescription egg = testing::mesh_collider(testing::sphere_mesh({}, 1.0, levels));
    std::get<MeshShape>(egg.shape).placement = placement;
    Course course({egg}, kMirror, {});
    RandomSequence random(2, 0, 0);
    Sample squares;
    for (int i = 0; i < rays; ++i) {
        ForceInput state = at({4, 0, 0}, random.unit_vector());
        (void)course.move(state, 10.5);
        const ContactRecord& hit = course.scratch.records.front();
        const double miss = distance_of_line(hit.position, hit.velocity_after, {-4, 0, 0});
        squares.add(miss * miss);
    }
    return std::sqrt(squares.mean());
}

// The error of a facet's normal is proportional to the facet's size. The blur therefore halves if the facets are half
// as large.
TEST(EllipsoidalMirror, FocusesBetterAsAFinerSphereMesh) {
    const int rays = test::scaled(2000);
    const double coarse = focal_blur(5, rays);
    const double fine = focal_blur(7, rays);
    EXPECT_LT(coarse, 0.4);
    EXPECT_NEAR(fine / coarse, 0.25, test::kSanitized ? 0.1 : 0.03);
}

/// Returns the mesh of the paraboloid z = (x^2 + y^2) / 4, whose focus is (0, 0, 1).
TriangleMesh paraboloid(int cells) {
    TriangleMesh mesh = testing::floor_mesh(1.0, cells);
    for (Vec3& v : mesh.vertices) v.z = 0.25 * (v.x * v.x + v.y * v.y);
    return mesh;
}

double blur_at_focus(int cells, int rays) {
    Course course({testing::mesh_collider(paraboloid(cells))}, kMirror, {});
    RandomSequence random(3, 0, 0);
    Sample squares;
    for (int i = 0; i < rays; ++i) {
        ForceInput state = at({1.8 * random.uniform() - 0.9, 1.8 * random.uniform() - 0.9, 2.0}, {0, 0, -1});
        (void)course.move(state, 2.0);
        const ContactRecord& hit = course.scratch.records.front();
        const double miss = distance_of_line(hit.position, hit.velocity_after, {0, 0, 1});
        squares.add(miss * miss);
    }
    return std::sqrt(squares.mean());
}

TEST(ParabolicMirror, CollectsABeamAlongItsAxisInTheFocus) {
    const int rays = test::scaled(4000);
    const double coarse = blur_at_focus(32, rays);
    EXPECT_LT(coarse, 0.05);
    EXPECT_NEAR(blur_at_focus(128, rays) / coarse, 0.25, test::kSanitized ? 0.1 : 0.03);
}

/// Returns the coordinate of a point that bounces between -1/2 and 1/2. x is the coordinate without walls.
double folded(double x) {
    const double u = std::fmod(x + 0.5, 2.0);
    const double positive = u < 0.0 ? u + 2.0 : u;
    return (positive < 1.0 ? positive : 2.0 - positive) - 0.5;
}

TEST(BoxOfMirrors, MatchesTheUnfoldedPositionAfterAMillionBounces) {
    Course course({{"box", CuboidShape{{1, 1, 1}, {}}, 0}}, kMirror, {});
    const Vec3 start{0.1, -0.2, 0.3};
    const Vec3 v{1.0, 0.71, 0.33};
    ForceInput state = at(start, v);
    const int steps = test::scaled(50000);
    std::uint64_t bounces = 0;
    for (int k = 0; k < steps; ++k) bounces += course.move(state, 10.0).bounces;
    const double time = 10.0 * steps;
    EXPECT_NEAR(static_cast<double>(bounces), 2.04 * time, 3.0);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(state.position[axis], folded(start[axis] + v[axis] * time), 1e-8) << axis;
        EXPECT_NEAR(std::fabs(state.velocity[axis]), v[axis], 1e-12) << axis;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
