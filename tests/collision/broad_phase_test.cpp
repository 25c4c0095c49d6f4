// Compares the clear time of paths with sampled points along them.
#include "ricochet/collision/broad_phase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/collision/contact_query.h"
#include "ricochet/core/random.h"
#include "ricochet/geometry/sweep/closest_point.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

/// Returns the distance of a point from the nearest surface, in m.
double distance_of(const CollisionWorld& world, const Vec3& p) {
    double nearest = std::numeric_limits<double>::infinity();
    for (SurfaceId surface = 0; surface < world.surface_count(); ++surface) {
        nearest = std::min(nearest, world.nearest(surface, p).distance);
    }
    return nearest;
}

Path random_path(RandomSequence& random, int degree) {
    const Vec3 from = 2.5 * random.uniform() * random.unit_vector();
    const Vec3 velocity = 3.0 * random.uniform() * random.unit_vector();
    if (degree == 1) return line_path(from, velocity, 1.0);
    if (degree == 2) return parabola_path(from, velocity, 4.0 * random.unit_vector(), 1.0);
    return hermite_path(from, velocity, 2.5 * random.unit_vector(), 3.0 * random.unit_vector(), 1.0);
}

/// Returns the triangles that a query of the path finds, without repetitions.
std::vector<std::uint32_t> found_near(const CollisionWorld& world, const Path& path, double radius) {
    ContactScratch scratch;
    const QueryMargins margins(world, path, radius);
    const SurfaceGeometry geometry(world, scratch.plane_cache);
    scratch.clear();
    NarrowPhase narrow_phase(geometry, path, margins, {}, scratch);
    (void)test_triangles_near(world, margins, path, narrow_phase);
    std::sort(scratch.triangles.begin(), scratch.triangles.end());
    scratch.triangles.erase(std::unique(scratch.triangles.begin(), scratch.triangles.end()), scratch.triangles.end());
    return scratch.triangles;
}

TEST(TrianglesNear, IncludeThoseThatAPathWithoutDurationTouches) {
    CollisionWorld world = world_of(mesh_collider(floor_mesh(1.0, 8)));
    world.prepare_radius(0.05);
    const Vec3 above{0.1, 0.12, 0.05};
    for (const Path& path : {line_path(above, {0, 0, -1}, 0.0), parabola_path(above, {0, 0, -1}, {0, 0, -9}, 0.0)}) {
        EXPECT_FALSE(found_near(world, path, 0.05).empty()) << path.degree;
    }
}

// Triangles that a query leaves out are not touched before the first contact.
TEST(TrianglesNear, IncludeAllThatThePathTouches) {
    CollisionWorld world = world_of(mesh_collider(floor_mesh(1.0, 8, 0.3)));
    world.prepare_radius(0.05);
    const SurfaceId count = static_cast<SurfaceId>(world.surface_count());
    int contacts = 0;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE(seed);
        RandomSequence random(seed, 1, 0);
        const double radius = seed % 2 == 0 ? 0.0 : 0.05;
        const Path path = random_path(random, static_cast<int>(1 + seed % 3));
        const std::vector<std::uint32_t> found = found_near(world, path, radius);
        ContactScratch scratch;
        const SurfaceGeometry geometry(world, scratch.plane_cache);
        const auto contact = find_first_contact(geometry, {path, radius}, scratch).contact;
        const double until = contact ? contact->time * (1.0 - 1e-9) : path.duration;
        contacts += contact ? 1 : 0;
        for (std::uint32_t triangle = 0; triangle < count; ++triangle) {
            if (std::binary_search(found.begin(), found.end(), triangle)) continue;
            const auto [a, b, c] = world.corners_of_triangle(triangle);
            for (int k = 0; k <= 100; ++k) {
                const Vec3 p = path.position(k / 100.0 * until);
                ASSERT_GT(closest_point_on_triangle(p, a, b, c).distance_squared, radius * radius);
            }
        }
    }
    EXPECT_GT(contacts, 50);
}

TEST(TimeClear, EndsBeforeAnythingComesNear) {
    CollisionWorld world = world_of(mesh_collider(floor_mesh(1.0, 8, 0.3)), plane_collider({0, 0, -1.5}, {0, 0.1, 1}),
                                    ColliderDescription{"ball", BallShape{0.3, {{0.5, 0.4, 1.2}}}, 0});
    world.prepare_radius(0.05);
    std::size_t whole = 0;
    std::size_t ended = 0;
    for (std::uint64_t seed = 0; seed < 120; ++seed) {
        SCOPED_TRACE(seed);
        RandomSequence random(seed, 0, 0);
        const double radius = seed % 2 == 0 ? 0.0 : 0.05;
        const Path path = random_path(random, static_cast<int>(1 + seed % 3));
        const double beside = seed % 5 == 0 ? 1e-3 : 0.0;
        const QueryMargins margins(world, path, radius, beside);
        const double clear = time_clear_of(world, margins, path, 1e-3);
        constexpr int kPoints = 100;
        double near = 1.0;  // first time, in s, at which a sample counts as near
        for (int k = kPoints; k-- > 0;) {
            const double time = static_cast<double>(k) / kPoints;
            if (distance_of(world, path.position(time)) <= radius + margins.slack) near = time;
        }
        EXPECT_LE(clear, near);
        if (clear > 0.0 && clear < 1.0) ++ended;
        if (clear == 1.0) ++whole;
    }
    EXPECT_GT(whole, 12U);
    EXPECT_GT(ended, 40U);
}

TEST(TimeClear, IsTheWholePathIfItStaysAwayAndZeroIfItBeginsNear) {
    CollisionWorld world = world_of(mesh_collider(floor_mesh(1.0, 8)));
    world.prepare_radius(0.0);
    const auto clear = [&](const Path& path) {
        return time_clear_of(world, QueryMargins(world, path, 0.0), path, 1e-6);
    };
    EXPECT_EQ(clear(line_path({0.1, 0.1, 0.5}, {1, 1, 0.1}, 2.0)), 2.0);
    EXPECT_EQ(clear(line_path({0.1, 0.2, 0.0}, {1, 0, 1}, 1.0)), 0.0);
    const double until = clear(line_path({0.1, 0.15, 1.0}, {0, 0, -1}, 2.0));
    EXPECT_LT(until, 1.0);
    EXPECT_GT(until, 0.97);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
