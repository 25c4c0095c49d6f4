// Particles that slide, roll or spin on the inside of a curved surface gain no energy. The tests cover every kind of
// curved surface, many values of friction and rolling resistance, and particles with and without spin.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "claims/contact_scene.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kG = kStandardGravity;

double energy_of(const Particle& p) {
    return 0.5 * length_squared(p.velocity) + 0.2 * p.radius * p.radius * length_squared(p.spin) + kG * p.position.z;
}

/// Returns the largest energy gain of a run in one step, in J/kg.
double largest_gain(const ContactScene& scene) {
    double last = energy_of(scene.particle);
    double worst = 0.0;
    watch(scene, [&](double, const Particle& p) {
        worst = std::max(worst, energy_of(p) - last);
        last = energy_of(p);
        return true;
    });
    return worst;
}

/// Bound on the rounding error of the energy in a step, in J/kg. A step has at most about a hundred contact intervals.
/// Each has a relative error of 4e-16 of the largest term, which is g times 1.2 m or v^2 / 2.
constexpr double kRounding = 100 * 4e-16 * 15.0;

struct Room {
    const char* name;
    ColliderShape shape;
};

std::vector<Room> rooms() {
    const Placement along_x{{}, {0, 1, 0}, 90.0};
    const Placement uneven{{}, {0, 0, 1}, 0.0, {0.77, 1.06, 1.2}};
    Placement uneven_along_x = along_x;
    uneven_along_x.scale = {0.77, 1.06, 1.2};
    return {{"ball", BallShape{1.0, {}}},
            {"ellipsoid", BallShape{1.0, uneven}},
            {"cylinder", CylinderShape{1.0, 3.0, along_x}},
            {"elliptic cylinder", CylinderShape{1.0, 3.0, uneven_along_x}}};
}

ContactScene tumbling(const Room& room, const Material& material, double radius, const Vec3& spin, double time_step) {
    ContactScene scene;
    scene.colliders = {{room.name, room.shape, 0}};
    scene.materials = {material};
    scene.particle = particle_of({0.1, 0.05, -0.3}, {2, 1, 0}, radius, spin);
    scene.time_step = time_step;
    scene.duration = 1.0;
    return scene;
}

/// Expects no energy gain in any room. Tests points, small spheres and large spheres, with and without spin.
void expect_no_gain(const Material& material) {
    for (const Room& room : rooms()) {
        for (const auto& [radius, spin] : {std::pair{0.0, Vec3{}}, std::pair{0.02, Vec3{}}, std::pair{0.2, Vec3{}},
                                           std::pair{0.02, Vec3{50, 50, -150}}, std::pair{0.2, Vec3{5, 5, -15}}}) {
            for (const double step : {0.025, 0.005}) {
                EXPECT_LE(largest_gain(tumbling(room, material, radius, spin, step)), kRounding)
                    << room.name << ", radius " << radius << ", spin " << spin.x << ", step " << step << ", friction "
                    << material.friction;
            }
        }
    }
}

TEST(ContactOnACurve, GainsNoEnergyWithFriction) {
    for (const double friction : {0.01, 0.1, 0.3, 1.4}) expect_no_gain({"", 0.3, friction});
}

TEST(ContactOnACurve, GainsNoEnergyWithoutFriction) { expect_no_gain({"", 0.3, 0.0}); }

TEST(ContactOnACurve, GainsNoEnergyFromResistanceToRolling) {
    for (const double rolling : {0.02, 0.15, 1.0}) {
        Material material{"", 0.3, 1.4};
        material.rolling_friction = rolling;
        expect_no_gain(material);
    }
}

// Gravity presses spheres into the edge between the side and a cap of a cylinder. Both surfaces support the spheres,
// which move along the edge at 1 m/s.
TEST(TheRimOfACylinder, SupportsSpheresWithoutEnergyGainOrLossOfTime) {
    for (const auto& [friction, spin] :
         {std::pair{0.0, Vec3{}}, std::pair{0.2, Vec3{}}, std::pair{1.4, Vec3{3, 4, 5}}}) {
        for (const double radius : {0.01, 0.1}) {
            for (const double step : {0.002, 0.02}) {
                ContactScene scene;
                scene.colliders = {{"drum", CylinderShape{1.0, 2.0, {{}, {1, 0, 0}, 30.0}}, 0}};
                scene.materials = {{"", 0.2, friction}};
                // Lowest point of the lower cap's rim, and the direction along it.
                const double a = radians(30.0);
                const Vec3 across{0, std::cos(a), std::sin(a)};
                const Vec3 axis{0, -std::sin(a), std::cos(a)};
                const double in = 1.0 - radius - 1e-9;
                scene.particle = particle_of(-in * across - in * axis, {1, 0, 0}, radius, spin);
                scene.time_step = step;
                scene.duration = 2.0;
                EXPECT_LE(largest_gain(scene), kRounding) << friction << ", " << radius << ", " << step;
                const Vec3 end = end_of(scene).position;
                EXPECT_LE(std::max(std::fabs(dot(end, axis)), std::hypot(end.x, dot(end, across))),
                          1.0 - radius + 1e-12 * (1.0 + radius));
            }
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
