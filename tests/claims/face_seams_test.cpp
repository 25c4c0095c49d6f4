// The seam between two coplanar triangles is not an edge. Particles on the seam, or sliding over it, behave as on a
// single plane. This holds for any position of the face and any rounding of its triangles.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "claims/contact_scene.h"
#include "ricochet/core/random.h"
#include "ricochet/core/transform.h"
#include "support/counts.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

/// A particle on a face of a rotated box. The contact point is on the seam between the face's triangles, at the world's
/// origin.
struct OnSeam {
    ContactScene scene;
    Vec3 heading;
    std::string text;
};

/// Speed of the belt or of the particle at the start, in m/s, and gravity, in m/s^2, for a box of size 1.
constexpr double kSpeed = 0.2;
constexpr double kPull = 10.0;

Vec3 unit_along(std::size_t axis, double sign) {
    return {axis == 0 ? sign : 0.0, axis == 1 ? sign : 0.0, axis == 2 ? sign : 0.0};
}

/// Returns a particle on a random face of a box of random size and rotation. The heading is along an edge of the face,
/// across the face, or along its seam.
OnSeam on_seam(std::uint64_t k, bool has_belt) {
    RandomSequence random(91, 0, k);
    const double scale = std::exp(4.0 * random.uniform() - 2.0);
    Vec3 size{8.0 * scale, 8.0 * scale, scale};
    if (random.uniform() < 0.5) {
        size = scale * Vec3{3.0 + random.uniform(), 4.0 + random.uniform(), 5.0 + random.uniform()};
    }
    Placement placement;
    placement.rotation_axis = random.unit_vector();
    placement.rotation_degrees =
        random.uniform() < 0.5 ? 10.0 * std::floor(18.0 * random.uniform()) : 180.0 * random.uniform();
    const auto face = static_cast<std::size_t>(3.0 * random.uniform());
    const Vec3 up = unit_along(face, random.uniform() < 0.5 ? -1.0 : 1.0);
    const Vec3 first = unit_along((face + 1) % 3, 1.0);
    const Vec3 second = unit_along((face + 2) % 3, 1.0);
    const Vec3 half = 0.5 * Vec3{dot(abs(first), size), dot(abs(second), size), dot(abs(up), size)};
    const double sign = random.uniform() < 0.5 ? -1.0 : 1.0;
    const double part = random.uniform() < 0.5 ? 0.0 : random.uniform() - 0.5;
    const Vec3 foot = half.z * up + part * (half.x * first + sign * half.y * second);
    const double kind = random.uniform();
    const Vec3 seam = normalized(half.x * first + sign * half.y * second);
    const Vec3 along = kind < 0.4 ? seam : (kind < 0.7 ? first : normalized(first + 2.0 * second));

    const AffineMap turn = world_from_local(placement);
    const Vec3 normal = turn.direction(up);
    placement.position = -turn.direction(foot);
    OnSeam result;
    result.heading = turn.direction(along);
    Material material{"face", 0.0, has_belt ? 0.5 : 0.0};
    if (has_belt) material.motion.velocity = kSpeed * scale * result.heading;
    const double radius = random.uniform() < 0.6 ? 0.0 : (random.uniform() < 0.5 ? 0.1 : 0.001) * scale;
    result.scene.materials = {material};
    result.scene.colliders = {{"box", CuboidShape{size, placement}, 0}};
    result.scene.gravity = -(kPull * scale) * normal;
    result.scene.particle.radius = radius;
    result.scene.particle.position = (radius + 1e-12 * scale) * normal;
    if (!has_belt) result.scene.particle.velocity = kSpeed * scale * result.heading;
    result.scene.time_step = 0.1;
    result.text =
        "case " + std::to_string(k) + ", scale " + std::to_string(scale) + ", radius " + std::to_string(radius);
    return result;
}

TEST(SeamOfAFace, HasNoEffectOnFrictionlessSliding) {
    for (int k = 0; k < test::scaled(200) * test::case_factor(20); ++k) {
        const OnSeam on = on_seam(static_cast<std::uint64_t>(k), false);
        const double speed = length(on.scene.particle.velocity);
        const Particle end = end_of(on.scene);
        ASSERT_NEAR(dot(end.velocity, on.heading), speed, 1e-9 * speed) << on.text;
        ASSERT_NEAR(dot(end.position, on.heading), speed, 1e-9 * speed) << on.text;
    }
}

TEST(SeamOfAFace, LetsABeltCarryAParticleOnIt) {
    for (int k = 0; k < test::scaled(200) * test::case_factor(20); ++k) {
        const OnSeam on = on_seam(static_cast<std::uint64_t>(k), true);
        const double belt = length(on.scene.materials[0].motion.velocity);
        const double carried = on.scene.particle.radius > 0.0 ? 2.0 / 7.0 * belt : belt;
        const Particle end = end_of(on.scene);
        // The friction force is half of the weight until the slip on the belt ends.
        const double gripping = carried / (0.5 * length(on.scene.gravity));
        ASSERT_NEAR(dot(end.velocity, on.heading), carried, 1e-6 * belt) << on.text;
        ASSERT_NEAR(dot(end.position, on.heading), carried * (1.0 - 0.5 * gripping), 1e-5 * belt) << on.text;
    }
}

// All triangles of the flat fan meet at the particle's position.
TEST(HubOfAFlatFan, HasNoEffectOnAParticleThatABeltCarriesAway) {
    for (int k = 0; k < test::scaled(100) * test::case_factor(20); ++k) {
        RandomSequence random(95, 0, static_cast<std::uint64_t>(k));
        const Vec3 normal = random.unit_vector();
        const auto [first, second] = tangent_frame(normal);
        const auto count = static_cast<std::uint32_t>(3.0 + 9.0 * random.uniform());
        TriangleMesh fan;
        fan.vertices.push_back({});
        for (std::uint32_t j = 0; j < count; ++j) {
            const double angle = 2.0 * kPiNumber * j / count;
            fan.vertices.push_back(4.0 * (std::cos(angle) * first + std::sin(angle) * second));
            fan.triangles.push_back({0, 1 + j, 1 + (j + 1) % count});
        }
        const Vec3 heading = random.uniform() < 0.5 ? first : normalized(first + (random.uniform() - 0.5) * second);
        ContactScene scene;
        scene.materials = {{"belt", 0.0, 0.5}};
        scene.materials[0].motion.velocity = kSpeed * heading;
        scene.colliders = {mesh_collider(fan)};
        scene.gravity = -kPull * normal;
        scene.particle.radius = random.uniform() < 0.5 ? 0.0 : 0.05;
        scene.particle.position = (scene.particle.radius + 1e-12) * normal;
        scene.time_step = 0.1;
        const double carried = scene.particle.radius > 0.0 ? 2.0 / 7.0 * kSpeed : kSpeed;
        const Particle end = end_of(scene);
        ASSERT_NEAR(dot(end.velocity, heading), carried, 1e-6 * kSpeed) << "case " << k;
        ASSERT_NEAR(dot(end.position, heading), carried * (1.0 - carried / kPull), 1e-5 * kSpeed) << "case " << k;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
