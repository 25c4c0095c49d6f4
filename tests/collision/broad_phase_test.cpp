// Compares the clear time of paths with sampled points along them.
#include "ricochet/collision/broad_phase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "collision/worlds.h"
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
