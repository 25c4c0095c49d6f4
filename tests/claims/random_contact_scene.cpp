#include "claims/random_contact_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "support/simple_meshes.h"

namespace ricochet::testing {
namespace {

/// Purposes of random draws. Each purpose has a separate stream, so that a change of one purpose does not affect the
/// others.
enum Stream : std::uint32_t { kOptions = 1, kForces, kMaterials, kRoom, kBodies, kParticles };

/// Random draws of one seed and one stream.
class Draws {
public:
    Draws(std::uint64_t seed, Stream stream) : random_(seed, stream, 0) {}

    double between(double low, double high) { return low + (high - low) * random_.uniform(); }
    bool chance(double p) { return random_.uniform() < p; }
    std::size_t index(std::size_t count) {
        return std::min(count - 1, static_cast<std::size_t>(random_.uniform() * static_cast<double>(count)));
    }
    Vec3 direction() { return random_.unit_vector(); }

private:
    RandomSequence random_;
};

/// Returns a mesh shipped with the project. Each mesh is read only once.
std::shared_ptr<const TriangleMesh> shipped_mesh(const std::string& name) {
    static std::map<std::string, std::shared_ptr<const TriangleMesh>> meshes;
    auto& mesh = meshes[name];
    if (!mesh) {
        const std::filesystem::path root = RICOCHET_SOURCE_DIR;
        mesh = std::make_shared<const TriangleMesh>(read_mesh(root / "meshes" / (name + ".obj")).mesh);
    }
    return mesh;
}

Placement random_placement(Draws& draws, double offset, double scale) {
    Placement placement;
    if (draws.chance(0.3)) {  // aligned with the axes
        placement.scale = {scale, scale, scale};
        return placement;
    }
    placement.position = offset * draws.between(0.0, 1.0) * draws.direction();
    placement.rotation_axis = draws.direction();
    placement.rotation_degrees = draws.between(-180.0, 180.0);
    placement.scale = {scale, scale, scale};
    if (draws.chance(0.4)) placement.scale = scale * Vec3{draws.between(0.6, 1.4), draws.between(0.6, 1.4), 1.0};
    if (draws.chance(0.1)) placement.scale.x *= -1.0;
    return placement;
}

/// Returns a closed shape with a size of half a metre to a metre, times the scale. The shape is a shipped mesh, a ball,
/// a cylinder, a box or a sphere mesh.
ColliderShape random_shape(Draws& draws, double offset, double scale) {
    constexpr std::array kMeshes{"cavity", "drum",       "rock_1", "rock_2", "rock_3", "rock_4",
                                 "rock_5", "torus_knot", "gear",   "bowl",   "funnel", "box"};
    const std::size_t kind = draws.index(8);
    const Placement placement = random_placement(draws, offset, scale);
    switch (kind) {
        case 0:
            return BallShape{draws.between(0.5, 1.0), placement};
        case 1:
            return CylinderShape{draws.between(0.4, 0.9), draws.between(0.3, 1.5), placement};
        case 2:
            return CuboidShape{{draws.between(0.5, 1.6), draws.between(0.5, 1.6), draws.between(0.5, 1.6)}, placement};
        case 3: {
            const int levels = static_cast<int>(draws.index(4));
            return MeshShape{std::make_shared<const TriangleMesh>(sphere_mesh({}, 0.8, levels)), placement, ""};
        }
        default:
            return MeshShape{shipped_mesh(kMeshes[draws.index(kMeshes.size())]), placement, ""};
    }
}

/// Returns a closed shape with enough space inside to be a room.
ColliderShape random_room(Draws& draws) {
    constexpr std::array kMeshes{"cavity", "drum", "torus_knot", "rock_2", "rock_4", "bowl"};
    const std::size_t kind = draws.index(8);
    const Placement placement = random_placement(draws, 2.0, 1.2);
    switch (kind) {
        case 0:
        case 1:
            return BallShape{1.0, placement};
        case 2:
        case 3:
            return CylinderShape{0.9, 1.6, placement};
        case 4:
            return CuboidShape{{1.6, 1.8, 1.4}, placement};
        case 5: {
            const int levels = static_cast<int>(draws.index(4));
            return MeshShape{std::make_shared<const TriangleMesh>(sphere_mesh({}, 1.0, levels)), placement, ""};
        }
        default:
            return MeshShape{shipped_mesh(kMeshes[draws.index(kMeshes.size())]), placement, ""};
    }
}

Material random_material(Draws& draws) {
    Material material;
    material.restitution = draws.chance(0.3) ? 0.0 : draws.chance(0.15) ? 1.0 : draws.between(0.0, 1.0);
    material.friction = draws.chance(0.25) ? 0.0 : draws.between(0.0, 2.0);
    if (draws.chance(0.3)) material.friction *= 0.1;
    if (draws.chance(0.2)) material.rolling_friction = draws.between(0.0, 0.3);
    if (draws.chance(0.15)) material.restitution_threshold = draws.between(0.01, 1.0);
    return material;
}

Vec3 center_of(const ColliderShape& shape) {
    return std::visit(
        [](const auto& s) {
            if constexpr (requires { s.placement; }) {
                return s.placement.position;
            } else {
                return s.point;
            }
        },
        shape);
}

void add_colliders(std::uint64_t seed, SimulationSetup& setup) {
    Draws room(seed, kRoom);
    setup.colliders.push_back({"room", random_room(room), 0});
    const Vec3 center = center_of(setup.colliders[0].shape);
    Draws draws(seed, kBodies);
    const std::size_t bodies = draws.index(4);
    for (std::size_t k = 0; k < bodies; ++k) {
        const auto material = static_cast<std::uint32_t>(draws.index(setup.materials.size()));
        ColliderShape shape = random_shape(draws, 0.8, draws.between(0.1, 0.5));
        if (draws.chance(0.2)) shape = PlaneShape{0.5 * draws.direction(), draws.direction()};
        std::visit(
            [&](auto& s) {
                if constexpr (requires { s.placement; }) {
                    s.placement.position += center;
                } else {
                    s.point += center;
                }
            },
            shape);
        setup.colliders.push_back({"body " + std::to_string(k), std::move(shape), material});
    }
}

/// Free space for particles: inside the room, outside the bodies, and at least a radius away from all surfaces.
class FreeSpace {
public:
    explicit FreeSpace(const std::vector<ColliderDescription>& colliders)
        : room_({colliders[0]}), bodies_({colliders.begin() + 1, colliders.end()}) {}

    [[nodiscard]] bool is_free(const Vec3& p, double distance) const {
        return room_.is_inside(p) && !bodies_.is_inside(p) && !room_.closest_point(p, distance) &&
               !bodies_.closest_point(p, distance);
    }
    /// Returns the last free position from `from` along `direction`, up to rounding.
    [[nodiscard]] Vec3 touching(const Vec3& from, const Vec3& direction, double distance) const {
        constexpr double kStride = 0.01;
        double low = 0.0;
        while (low < 10.0 && is_free(from + (low + kStride) * direction, distance)) low += kStride;
        double high = low + kStride;
        for (int k = 0; k < 60; ++k) {
            const double middle = 0.5 * (low + high);
            (is_free(from + middle * direction, distance) ? low : high) = middle;
        }
        return from + low * direction;
    }

private:
    CollisionQueries room_;
    CollisionQueries bodies_;
};

/// Returns true if bounces on one of the colliders never end. A point that starts at rest 1e-12 m above such a surface
/// correctly hits it every microsecond, and exhausts the bounce budget of every step.
bool bounces_for_ever(const SimulationSetup& setup) {
    return std::any_of(setup.colliders.begin(), setup.colliders.end(), [&](const ColliderDescription& collider) {
        return !setup.materials[collider.material].can_hold(setup.options.resting_speed);
    });
}

void add_particles(std::uint64_t seed, SimulationSetup& setup) {
    const FreeSpace space(setup.colliders);
    const Vec3 center = center_of(setup.colliders[0].shape);
    Draws draws(seed, kParticles);
    const double largest = draws.between(0.01, 0.15);
    for (int tries = 0; tries < 400 && setup.particles.size() < 12; ++tries) {
        Particle particle;
        particle.radius = draws.chance(0.3) ? 0.0 : largest * draws.between(0.05, 1.0);
        particle.mass = draws.between(0.1, 3.0);
        const Vec3 offset{draws.between(-1.5, 1.5), draws.between(-1.5, 1.5), draws.between(-1.5, 1.5)};
        particle.position = center + offset;
        particle.velocity = (draws.chance(0.2) ? 0.0 : draws.between(0.0, 4.0)) * draws.direction();
        const Vec3 spin = draws.between(0.0, 20.0) * draws.direction();
        if (particle.radius > 0.0 && draws.chance(0.5)) particle.spin = spin;
        const bool touches = draws.chance(0.3);
        const Vec3 direction = draws.direction();
        const double distance = std::max(particle.radius, 1e-12);
        if (!space.is_free(particle.position, distance)) continue;
        const bool falls_from_nearby = particle.radius == 0.0 && particle.velocity == Vec3{} && bounces_for_ever(setup);
        if (touches && !falls_from_nearby) particle.position = space.touching(particle.position, direction, distance);
        setup.particles.push_back(particle);
    }
}

}  // namespace

Vec3 random_contact_gravity(std::uint64_t seed) {
    Draws draws(seed, kForces);
    const double size = draws.chance(0.1) ? 0.0 : draws.chance(0.5) ? 9.81 : draws.between(0.1, 30.0);
    return size * (draws.chance(0.5) ? Vec3{0, 0, -1} : draws.direction());
}

SimulationSetup random_contact_scene(std::uint64_t seed) {
    constexpr std::array kIntegrators{IntegratorKind::ballistic,        IntegratorKind::midpoint,
                                      IntegratorKind::velocity_verlet,  IntegratorKind::rk4,
                                      IntegratorKind::dormand_prince,   IntegratorKind::forward_euler,
                                      IntegratorKind::symplectic_euler, IntegratorKind::implicit_euler};
    SimulationSetup setup;
    Draws draws(seed, kOptions);
    setup.options.seed = seed;
    setup.options.integrator = kIntegrators[draws.index(kIntegrators.size())];
    setup.options.time_step = std::exp(draws.between(std::log(1e-3), std::log(0.05)));
    setup.options.duration = std::min(2.0, 100.0 * setup.options.time_step);
    if (draws.chance(0.2)) setup.options.resting_speed = draws.between(0.0, 0.05);
    setup.options.verify = true;
    const Vec3 gravity = random_contact_gravity(seed);
    if (gravity != Vec3{}) setup.forces.push_back(make_gravity(gravity));
    Draws materials(seed, kMaterials);
    for (int k = 0; k < 3; ++k) setup.materials.push_back(random_material(materials));
    add_colliders(seed, setup);
    add_particles(seed, setup);
    return setup;
}

}  // namespace ricochet::testing
