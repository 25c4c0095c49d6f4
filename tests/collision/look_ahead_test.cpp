#include "ricochet/collision/look_ahead.h"
#include "collision/worlds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/collision/contact_query.h"
#include "ricochet/core/random.h"
#include "support/counts.h"
#include "support/mesh_distance.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::query;

using testing::distance_from;

double height(const Plane& plane, const Vec3& p) { return dot(plane.normal, p - plane.point); }

Path random_path(RandomSequence& random, const Vec3& acceleration) {
    const Vec3 velocity = 2.0 * random.in_unit_ball();
    return parabola_path(3.0 * random.in_unit_ball(), velocity, acceleration, 3.0);
}

TEST(TimeFreeOfPlane, EndsShortlyBeforeThePathReachesTheMargin) {
    RandomSequence random(1, 0, 0);
    for (int i = 0; i < test::scaled(5000); ++i) {
        SCOPED_TRACE("case " + std::to_string(i));
        const Plane plane{random.in_unit_ball(), random.unit_vector()};
        const Vec3 acceleration = i % 3 == 0 ? Vec3{} : 10.0 * random.in_unit_ball();
        const Path path = random_path(random, acceleration);
        const double margin = 0.1 * random.uniform();
        const double time = time_free_of_plane(path, plane, margin);
        ASSERT_GE(time, 0.0);
        ASSERT_LE(time, path.duration);
        const double side = height(plane, path.c[0]) < 0.0 ? -1.0 : 1.0;
        for (int k = 0; k <= 50 && time > 0.0; ++k) {
            ASSERT_GT(side * height(plane, path.position(0.02 * k * time)), margin - 1e-12);
        }
        if (time < path.duration) {
            ASSERT_LT(side * height(plane, path.position(time)), margin + 1e-6);
        }
    }
}

// The plane's point is far away along the plane, so the height of the start rounds to the wrong side.
TEST(TimeFreeOfPlane, IsZeroIfRoundingHidesTheSide) {
    const Plane plane{{8e8, -6e8, 0}, {0.6, 0.8, 0}};
    EXPECT_EQ(time_free_of_plane(line_path({-7e-8, 0, 0}, {0, -1e-9, 0}, 100.0), plane, 0.0), 0.0);
    EXPECT_EQ(time_free_of_plane(line_path({1, 0, 0}, {0, 1e-9, 0}, 100.0), plane, 0.0), 100.0);
}

TEST(TimeOutside, IsFreeOfTheBoxAndLongIfTheBoxIsFarAway) {
    RandomSequence random(2, 0, 0);
    int outside = 0;
    for (int i = 0; i < test::scaled(5000); ++i) {
        SCOPED_TRACE("case " + std::to_string(i));
        Box3 box;
        box.include(random.in_unit_ball());
        box.include(random.in_unit_ball());
        const Vec3 acceleration = i % 3 == 0 ? Vec3{} : 10.0 * random.in_unit_ball();
        const Path path = random_path(random, acceleration);
        const double time = time_outside(path, box);
        ASSERT_LE(time, path.duration);
        EXPECT_EQ(time > 0.0, !box.contains(path.c[0]));
        for (int k = 0; k < 50 && time > 0.0; ++k) ASSERT_FALSE(box.contains(path.position(0.02 * k * time)));
        outside += time > 0.0 ? 1 : 0;
    }
    EXPECT_GT(outside, test::scaled(5000) / 2);
    const Path thrown = parabola_path({0, 0, 1}, {3, 0, 5}, {0, 0, -10}, 3.0);
    EXPECT_NEAR(time_outside(thrown, {{-100, -100, -1}, {100, 100, 0.5}}), 0.5 + std::sqrt(0.35), 1e-9);
}

TEST(Shortened, IsTheSamePathWithAnEarlierEnd) {
    const Path path = parabola_path({1, 2, 3}, {4, 5, 6}, {0, 0, -9.81}, 2.0);
    const Path part = shortened(path, 0.5);
    EXPECT_EQ(part.duration, 0.5);
    EXPECT_EQ(part.end, path.position(0.5));
    EXPECT_EQ(part.position(0.25), path.position(0.25));
    EXPECT_EQ(shortened(path, 5.0).duration, 2.0);
    EXPECT_EQ(shortened(path, 5.0).end, path.end);
}

CollisionWorld rough_world(const TriangleMesh& mesh) {
    std::vector<ColliderDescription> colliders;
    colliders.push_back({"mesh", MeshShape{std::make_shared<const TriangleMesh>(mesh), {}, "", {}}, 0});
    return CollisionWorld(std::move(colliders));
}

TEST(LookAhead, NoTriangleEntersTheMarginBeforeTheFreeTimeEnds) {
    TriangleMesh mesh = testing::sphere_mesh({}, 1.0, 3);
    RandomSequence random(2, 0, 0);
    for (Vec3& v : mesh.vertices) v *= 1.0 + 0.1 * random.uniform();
    CollisionWorld world = rough_world(mesh);
    world.prepare_radius(0.03);
    ContactScratch scratch;
    struct Sum {
        double told = 0.0;
        double possible = 0.0;
    };
    Sum points, curved_points, spheres, curved_spheres;
    for (int i = 0; i < test::scaled(600); ++i) {
        SCOPED_TRACE("case " + std::to_string(i));
        const double radius = i % 3 == 0 ? 0.03 : 0.0;
        const bool is_straight = i % 2 == 0;
        const Vec3 acceleration = is_straight ? Vec3{} : 0.5 * random.in_unit_ball();
        const Vec3 start = (i % 5 == 0 ? 3.0 : 0.8) * random.in_unit_ball();
        const Vec3 velocity = 2.0 * random.unit_vector();
        const double h = 0.01;
        const Path path = parabola_path(start, velocity, acceleration, h);
        const LookAhead look_ahead{parabola_path(start, velocity, acceleration, 1.0), 1e-9, 2.0 * h};
        const auto found = query(world, scratch, path, radius, &look_ahead);
        const auto& contact = found.contact;
        const double until = found.ahead.free_until;
        ASSERT_EQ(contact.has_value(), query(world, scratch, path, radius).contact.has_value());
        if (contact) {
            ASSERT_EQ(until, 0.0);
            continue;
        }
        ASSERT_LE(until, 1.0);
        for (int k = 0; k < 40; ++k) {
            const double time = h + (until - h) * k / 40.0;
            if (until <= h) break;
            ASSERT_GE(distance_from(mesh, look_ahead.path.position(time)), radius + 1e-9) << time;
        }
        const auto found_hit = query(world, scratch, look_ahead.path, radius);
        const auto& hit = found_hit.contact;
        Sum& sum = radius == 0.0 ? (is_straight ? points : curved_points) : (is_straight ? spheres : curved_spheres);
        sum.told += until;
        sum.possible += hit ? hit->time : 1.0;
    }
    EXPECT_GT(points.told, 0.95 * points.possible);
    EXPECT_GT(curved_points.told, 0.9 * curved_points.possible);
    EXPECT_GT(spheres.told, 0.995 * spheres.possible) << spheres.told / spheres.possible;
    EXPECT_GT(curved_spheres.told, 0.8 * curved_spheres.possible) << curved_spheres.told / curved_spheres.possible;
}

/// Rough ball of fine triangles with several meshes inside.
TriangleMesh furnished_ball(RandomSequence& random) {
    TriangleMesh mesh = testing::sphere_mesh({}, 1.0, 4);
    for (Vec3& v : mesh.vertices) v *= 1.0 + 0.02 * random.uniform();
    return testing::merged(std::move(mesh), testing::sphere_mesh({0.2, 0.1, 0.3}, 0.15, 3));
}

TEST(TimeClearOfField, EndsBeforeAnyTriangleIsNearAndCoversMostOfTheTimeToTheFirst) {
    RandomSequence random(3, 0, 0);
    const TriangleMesh mesh = furnished_ball(random);
    const CollisionWorld world = rough_world(mesh);
    double told = 0.0;
    double possible = 0.0;
    for (int i = 0; i < test::scaled(300); ++i) {
        SCOPED_TRACE("case " + std::to_string(i));
        const Vec3 acceleration = i % 3 == 0 ? Vec3{} : 10.0 * random.in_unit_ball();
        const Vec3 velocity = i % 7 == 0 ? Vec3{} : 2.0 * random.in_unit_ball();
        const Path path = parabola_path(0.5 * random.in_unit_ball(), velocity, acceleration, 1.0);
        const double margin = 0.05 * random.uniform();
        const double from = 0.1 * random.uniform();
        const double until = time_clear_of_field(path, world.distance_field(), margin, from);
        ASSERT_GE(until, from);
        ASSERT_LE(until, path.duration);
        for (int k = 0; k < 20 && until > from; ++k) {
            ASSERT_GT(distance_from(mesh, path.position(from + (until - from) * k / 20.0)), margin) << k;
        }
        ContactScratch scratch;
        const auto hit = query(world, scratch, path, 0.0).contact;
        told += until;
        possible += hit ? hit->time : 1.0;
    }
    EXPECT_GT(told, 0.5 * possible);
    EXPECT_EQ(time_clear_of_field(line_path({}, {1, 0, 0}, 1.0), DistanceField(), 0.0, 0.25), 0.25);
}

/// Tests several steps of one particle. The contact candidates from a look-ahead must lead a later query to the contact
/// that the broad phase finds.
TEST(LookAhead, CandidatesLeadALaterQueryToTheContactOfTheBroadPhase) {
    RandomSequence random(4, 0, 0);
    const TriangleMesh mesh = furnished_ball(random);
    CollisionWorld world = rough_world(mesh);
    world.prepare_radius(0.01);
    ContactScratch scratch;
    ContactScratch other;
    int candidates = 0;
    int contacts = 0;
    for (int i = 0; i < test::scaled(1500); ++i) {
        SCOPED_TRACE("case " + std::to_string(i));
        const double radius = i % 4 == 0 ? 0.01 : 0.0;
        const Vec3 acceleration = i % 2 == 0 ? Vec3{} : 2.0 * random.unit_vector();
        const Vec3 start = 0.9 * random.in_unit_ball();
        const Vec3 velocity = 3.0 * random.unit_vector();
        const double h = 0.005 + 0.01 * random.uniform();
        const double margin = 1e-9 + 0.125 * h * h * length(acceleration);
        const Path path = parabola_path(start, velocity, acceleration, h);
        const LookAhead look_ahead{parabola_path(start, velocity, acceleration, 1.0), margin, 2.0 * h, h};
        const auto found = query(world, scratch, path, radius, &look_ahead);
        if (found.contact) continue;
        // Selects the last step that begins before a surface is near.
        const double free = std::max(found.ahead.free_until, h);
        const double from = h * std::max(1.0, std::floor(free / h));
        if (!found.ahead.candidates.is_known() || found.ahead.candidates_until < from + h) continue;
        const Vec3 p = look_ahead.path.position(from);
        const Vec3 v = look_ahead.path.velocity(from);
        const Path step = parabola_path(p, v, acceleration, h);
        const auto by_candidates = query(world, scratch, step, radius, nullptr, found.ahead.candidates).contact;
        const auto by_broad_phase = query(world, other, step, radius).contact;
        ASSERT_EQ(by_candidates.has_value(), by_broad_phase.has_value());
        ++candidates;
        if (!by_broad_phase) continue;
        ++contacts;
        ASSERT_EQ(by_candidates->time, by_broad_phase->time);
        ASSERT_EQ(by_candidates->count, by_broad_phase->count);
        for (int k = 0; k < by_broad_phase->count; ++k) {
            ASSERT_EQ(by_candidates->all()[static_cast<std::size_t>(k)].surface,
                      by_broad_phase->all()[static_cast<std::size_t>(k)].surface);
            ASSERT_EQ(by_candidates->all()[static_cast<std::size_t>(k)].normal,
                      by_broad_phase->all()[static_cast<std::size_t>(k)].normal);
        }
    }
    EXPECT_GT(candidates, test::scaled(1500) / 3);
    EXPECT_GT(contacts, test::scaled(1500) / 6);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
