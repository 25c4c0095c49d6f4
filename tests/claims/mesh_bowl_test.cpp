// The motion in a bowl of triangles converges to the motion in a smooth bowl as the mesh is refined. The angle at an
// edge between facets is h / R, with the edge length h. Each edge reduces the speed by the relative amount (h / R)^2.
// The paths therefore differ by at most first order in h.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "claims/contact_scene.h"
#include "support/simple_meshes.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kG = kStandardGravity;
constexpr double kAngle = 0.5;  // start angle from the lowest point

/// Returns the position on the ray from the centre along `direction` whose distance from the surface is `radius`.
Vec3 touching(const std::vector<ColliderDescription>& colliders, const Vec3& direction, double radius) {
    const CollisionQueries queries(colliders);
    double low = 0.0;
    double high = 1.0;
    for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        const bool is_free = queries.is_inside(middle * direction) &&
                             queries.closest_point(middle * direction)->distance >= std::max(radius, 1e-13);
        (is_free ? low : high) = middle;
    }
    return low * direction;
}

ContactScene swing(ColliderDescription bowl, const Vec3& direction, double radius, double friction) {
    ContactScene scene;
    scene.colliders = {std::move(bowl)};
    scene.materials = {{"", 0.0, friction}};
    scene.particle = particle_of(touching(scene.colliders, direction, radius), {}, radius);
    scene.time_step = 0.01;
    scene.duration = 1.5;  // three quarters of a swing
    return scene;
}

/// Compares the paths in an icosphere of 8 * 4^levels triangles and in the ball. Returns the largest distance between
/// them, in m, averaged over five start directions.
double distance_from_smooth(int levels, double radius, double friction) {
    double sum = 0.0;
    for (const double azimuth : {0.1, 0.4, 0.8, 1.3, 1.9}) {
        const Vec3 direction{std::sin(kAngle) * std::cos(azimuth), std::sin(kAngle) * std::sin(azimuth),
                             -std::cos(kAngle)};
        Simulation smooth = simulation_of(swing({"ball", BallShape{1.0, {}}, 0}, direction, radius, friction));
        Simulation faceted =
            simulation_of(swing(mesh_collider(sphere_mesh({}, 1.0, levels)), direction, radius, friction));
        double worst = 0.0;
        while (!faceted.finished()) {
            smooth.step();
            faceted.step();
            worst = std::max(worst, length(faceted.particles().position[0] - smooth.particles().position[0]));
        }
        expect_no_time_lost(faceted);
        sum += worst;
    }
    return sum / 5.0;
}

class MeshBowl : public ::testing::TestWithParam<std::pair<double, double>> {};

INSTANTIATE_TEST_SUITE_P(Of, MeshBowl,
                         ::testing::Values(std::pair{0.0, 0.0}, std::pair{0.0, 0.1}, std::pair{0.05, 0.0},
                                           std::pair{0.05, 0.1}),
                         [](const auto& test) {
                             return std::string(test.param.first > 0.0 ? "Spheres" : "Points") +
                                    (test.param.second > 0.0 ? "WithFriction" : "WithoutFriction");
                         });

TEST_P(MeshBowl, ConvergesToTheSmoothBowlAtFirstOrder) {
    const auto [radius, friction] = GetParam();
    const double coarse = distance_from_smooth(3, radius, friction);
    double last = coarse;
    for (const int factor : {2, 4, 8}) {
        const double error = distance_from_smooth(factor == 2 ? 4 : factor == 4 ? 5 : 6, radius, friction);
        // The convergence is of first order or better. The factor 1.5 allows for the small number of edges that a path
        // crosses.
        EXPECT_LT(error, 1.5 * coarse / factor) << "refined " << factor << " times, before " << last;
        last = error;
    }
    EXPECT_LT(coarse, 0.3);  // in m; the paths belong to the same swing
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
