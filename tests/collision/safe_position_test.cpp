#include "ricochet/collision/safe_position.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/core/random.h"
#include "ricochet/core/tolerances.h"
#include "support/counts.h"
#include "support/exact_oracle.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::query;

using testing::mesh_collider;
using testing::plane_collider;
using testing::world_of;

bool intersects_any(const CollisionWorld& world, const Vec3& p, const Vec3& q) {
    for (std::uint32_t t = 0; t < world.triangles().size(); ++t) {
        const auto [a, b, c] = world.corners_of_triangle(t);
        if (testing::exact_segment_intersects_triangle(p, q, a, b, c)) return true;
    }
    return false;
}

/// Returns true if segments along the path reach the position without intersecting a surface, by the exact test.
bool can_be_walked(const CollisionWorld& world, const Path& path, double from, const Vec3& p, double to, const Vec3& q,
                   int depth) {
    if (!intersects_any(world, p, q)) return true;
    if (depth == 0) return false;
    const double middle = 0.5 * (from + to);
    const Vec3 m = path.position(middle);
    return can_be_walked(world, path, from, p, middle, m, depth - 1) &&
           can_be_walked(world, path, middle, m, to, q, depth - 1);
}

class SafePositionFarOut : public ::testing::TestWithParam<double> {
protected:
    /// A rotated box, displaced by a multiple of (1, 2, -3) m.
    CollisionWorld world_{{mesh_collider(testing::box_mesh({-1, -1, -1}, {1, 1, 1}),
                                         {GetParam() * Vec3{1, 2, -3}, {1, 2, 3}, 25.0, {1, 1, 1}})}};
    Vec3 center_ = GetParam() * Vec3{1, 2, -3};
};

INSTANTIATE_TEST_SUITE_P(Offsets, SafePositionFarOut, ::testing::Values(0.0, 1e3, 1e6));

TEST_P(SafePositionFarOut, IsOneContactOffsetBeforeTheSurfaceAlongCertifiedSegments) {
    RandomSequence random(1, 0, 0);
    ContactScratch scratch;
    for (int i = 0; i < test::scaled(400); ++i) {
        SCOPED_TRACE(i);
        const Vec3 start = center_ + 0.9 * random.in_unit_ball();
        const Vec3 v = 4.0 * random.unit_vector();
        const Path path =
            i % 2 == 0 ? line_path(start, v, 1.0) : parabola_path(start, v, 8.0 * random.unit_vector(), 2.0);
        const auto found = query(world_, scratch, path, 0.0);
        const auto& contact = found.contact;
        ASSERT_TRUE(contact);
        const SafePosition safe_position = find_safe_position(found.near, path, *contact, scratch.chain);
        ASSERT_FALSE(safe_position.stayed);
        ASSERT_TRUE(can_be_walked(world_, path, 0.0, start, contact->time, safe_position.reached.position, 12));
        const double height =
            std::fabs(world_.signed_distance_from(contact->first().surface, safe_position.reached.position));
        const double offset = contact_offset(safe_position.reached.position);
        EXPECT_GE(height, 0.5 * offset);
        EXPECT_LE(height, 64.0 * offset);
        // The distance from the true contact is at most the contact offset plus the rounding of the path.
        const double rounding = 64.0 * ulp(max_abs(center_) + 8.0);
        EXPECT_LE(length(safe_position.reached.position - path.position(contact->time)), 256.0 * offset + rounding);
    }
}

TEST_P(SafePositionFarOut, LeavingInAnyDirectionDoesNotHitTheSameSurfaceAgain) {
    RandomSequence random(2, 0, 0);
    ContactScratch scratch;
    for (int i = 0; i < test::scaled(4000); ++i) {
        SCOPED_TRACE(i);
        const Vec3 start = center_ + 0.9 * random.in_unit_ball();
        const Path path = line_path(start, 4.0 * random.unit_vector(), 1.0);
        const auto found = query(world_, scratch, path, 0.0);
        const auto& contact = found.contact;
        ASSERT_TRUE(contact);
        const SafePosition safe_position = find_safe_position(found.near, path, *contact, scratch.chain);
        ASSERT_FALSE(safe_position.stayed);
        const ContactSurface& hit = contact->first();
        Vec3 away = random.unit_vector();
        // The direction ranges from straight away to grazing.
        const double lift = std::pow(10.0, -12.0 * random.uniform());
        away += (lift - dot(away, hit.normal)) * hit.normal;
        const auto found_next = query(world_, scratch, line_path(safe_position.reached.position, 3.0 * away, 1.0), 0.0);
        const auto& next = found_next.contact;
        if (!next) continue;
        for (const ContactSurface& surface : next->all()) EXPECT_NE(surface.surface, hit.surface);
    }
}

TEST(SafePosition, KeepsAContactOffsetFromAllWallsOfACorner) {
    const auto world = world_of(plane_collider({0, 0, 0}, {1, 0, 0}), plane_collider({0, 0, 0}, {0, 1, 0}),
                                plane_collider({0, 0, 0}, {0, 0, 1}));
    ContactScratch scratch;
    const Path path = line_path({1, 1, 1}, {-1, -1, -1}, 2.0);
    const auto found = query(world, scratch, path, 0.0);
    const auto& contact = found.contact;
    ASSERT_TRUE(contact);
    const SafePosition safe_position = find_safe_position(found.near, path, *contact, scratch.chain);
    EXPECT_FALSE(safe_position.stayed);
    for (int axis = 0; axis < 3; ++axis) EXPECT_GT(safe_position.reached.position[axis], 0.0);
}

// Near the edge of a wedge of 0.001 rad, an offset from one wall would cross the other wall.
TEST(SafePosition, StaysBetweenTheWallsOfASharpWedge) {
    const double angle = 1e-3;
    const auto world = world_of(plane_collider({0, 0, 0}, {0, 1, 0}),
                                plane_collider({0, 0, 0}, {std::sin(angle), -std::cos(angle), 0}));
    RandomSequence random(3, 0, 0);
    ContactScratch scratch;
    int moved = 0;
    const int count = test::scaled(2000);
    for (int i = 0; i < count; ++i) {
        const double x = std::pow(10.0, -12.0 * random.uniform());
        const Vec3 start{x, x * std::tan(angle * random.uniform()), 1.0};
        if (!(start.y > 0.0) || side_of(world.planes()[1].plane, start) <= 0) continue;
        const Vec3 aim{-1.0, 0.3 * (random.uniform() - 0.5), random.uniform() - 0.5};
        const Path path = line_path(start, aim, 2.0);
        const auto found = query(world, scratch, path, 0.0);
        const auto& contact = found.contact;
        ASSERT_TRUE(contact) << i;
        const SafePosition safe_position = find_safe_position(found.near, path, *contact, scratch.chain);
        EXPECT_EQ(side_of(world.planes()[0].plane, safe_position.reached.position), 1) << i;
        EXPECT_EQ(side_of(world.planes()[1].plane, safe_position.reached.position), 1) << i;
        moved += safe_position.stayed ? 0 : 1;
    }
    EXPECT_GT(moved, count / 2);
}

TEST(FollowPath, CertifiesAnArcOverARidgeWhoseChordIsBlocked) {
    // The ridge of height 1 runs along y. The arc passes 0.25 above it, and the chord of the arc crosses it.
    TriangleMesh ridge{{{-0.5, -5, 0}, {0, -5, 1}, {0.5, -5, 0}, {-0.5, 5, 0}, {0, 5, 1}, {0.5, 5, 0}},
                       {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}}};
    const auto world = world_of(mesh_collider(ridge));
    ContactScratch scratch;
    const Path over = parabola_path({-1, 0, 0.25}, {1, 0, 2}, {0, 0, -2}, 2.0);
    const auto found = query(world, scratch, over, 0.0);
    ASSERT_FALSE(found.contact);
    EXPECT_TRUE(intersects_any(world, over.c[0], over.end));
    const CertifiedPath followed = certify_path(found.near, over, over.duration, over.end, scratch.chain);
    EXPECT_FALSE(followed.blocker);
    EXPECT_EQ(followed.reached.position, over.end);
}

// The triangles of the ridge are tiny. The middle of the chord lies far from every piece that the broad phase was
// queried for.
TEST(FollowPath, DoesNotTrustAChordThatTheBroadPhaseHasNotCovered) {
    const auto world = world_of(mesh_collider(testing::sphere_mesh({0, 0, 0.5}, 0.05, 3)));
    ContactScratch scratch;
    const Path over = parabola_path({-1, 0, 0.5}, {1, 0, 2}, {0, 0, -2}, 2.0);
    const auto found = query(world, scratch, over, 0.0);
    ASSERT_FALSE(found.contact);
    EXPECT_TRUE(intersects_any(world, over.c[0], over.end));
    EXPECT_FALSE(found.near.covers_chord(over, 0.0, over.duration));
    const CertifiedPath followed = certify_path(found.near, over, over.duration, over.end, scratch.chain);
    EXPECT_EQ(followed.reached.position, over.end);
    EXPECT_FALSE(followed.blocker);
}

// For triangles without extent, no path is close enough to its chord without an explicit limit.
TEST(FollowPath, EndsNextToTinyAndDegenerateTriangles) {
    for (const double size : {0.0, 1e-30, 1e-9}) {
        const TriangleMesh specks{{{-1, 0, 0}, {-1 + size, 0, 0}, {-1, size, 0}, {1, 0, 0.5}, {1, size, 0.5}},
                                  {{0, 1, 2}, {3, 4, 3}, {0, 0, 0}}};
        for (const double radius : {0.0, 0.25}) {
            SCOPED_TRACE(::testing::Message() << "size " << size << ", radius " << radius);
            CollisionWorld world = world_of(mesh_collider(specks));
            world.prepare_radius(radius);
            ContactScratch scratch;
            const Path beside = parabola_path({-1, 0.3, 0.1}, {1, 0, 1}, {0, 0, -1}, 2.0);
            const auto found = query(world, scratch, beside, radius);
            ASSERT_FALSE(found.contact);
            const CertifiedPath followed = certify_path(found.near, beside, 2.0, beside.end, scratch.chain);
            EXPECT_EQ(followed.reached.position, beside.end);
            EXPECT_LT(scratch.chain.size(), 100'000U);
        }
    }
}

TEST(FollowPath, StopsAtABlockedChord) {
    const auto world = world_of(plane_collider({0, 0, 0}, {0, 0, 1}));
    ContactScratch scratch;
    const Path down = parabola_path({0, 0, 1}, {}, {0, 0, -2}, 2.0);
    const auto found = query(world, scratch, down, 0.0);
    ASSERT_TRUE(found.contact);
    const CertifiedPath followed = certify_path(found.near, down, down.duration, down.end, scratch.chain);
    ASSERT_TRUE(followed.blocker);
    EXPECT_EQ(*followed.blocker, 0U);
    EXPECT_NEAR(followed.reached.time, 1.0, 1e-12);
    EXPECT_GT(followed.reached.position.z, 0.0);
    const Contact contact = contact_with_blocker(found.near, down, followed);
    EXPECT_EQ(contact.first().normal, (Vec3{0, 0, 1}));
}

TEST(StepOff, MovesAlongTheNormalOfTheTouchedSurface) {
    const auto world = world_of(mesh_collider(testing::box_mesh({0, 0, 0}, {1, 1, 1})));
    ContactScratch scratch;
    for (const Vec3& position : {Vec3{0.25, 0.5, 1}, Vec3{1, 0.5, 1}, Vec3{1, 1, 1}, Vec3{0, 0.5, 0.5}}) {
        const auto found = query(world, scratch, line_path(position, {0, 0, 0}, 1.0), 0.0);
        const auto off = step_off(found.near, position);
        ASSERT_TRUE(off);
        EXPECT_FALSE(world.bounds().contains(*off));
        EXPECT_LE(length(*off - position), 64.0 * contact_offset(position));
        EXPECT_FALSE(intersects_any(world, *off, *off));
    }
    const Vec3 beside{0.5, 0.5, 1.5};
    const auto found = query(world, scratch, line_path(beside, {0, 0, 0}, 1.0), 0.0);
    EXPECT_FALSE(step_off(found.near, beside));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
