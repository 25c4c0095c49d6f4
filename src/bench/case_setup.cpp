#include "bench/case_setup.h"

#include <utility>

#include "bench/case_setup.h"
#include "generators/build_near.h"
#include "generators/primitives.h"
#include "generators/rock.h"
#include "generators/terrain.h"
#include "generators/vessels.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/portable_math.h"
#include "ricochet/core/random.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/sweep/closest_point.h"

namespace ricochet::bench {

Insides::Insides(const TriangleMesh& mesh, const Vec3& heart)
    : mesh_(mesh), heart_(heart), bvh_(mesh.vertices, mesh.triangles, 0.0) {}

bool Insides::contains(const Vec3& p) const {
    bool is_seen = true;
    bvh_.query_segment(heart_, p, [&](std::uint32_t triangle) {
        const Triangle& t = mesh_.triangles[triangle];
        const auto& v = mesh_.vertices;
        if (!segment_intersects_triangle(heart_, p, v[t[0]], v[t[1]], v[t[2]])) return 1.0;
        is_seen = false;
        return 0.0;
    });
    return is_seen;
}

bool Insides::contains_ball(const Vec3& middle, double radius) const {
    if (!contains(middle)) return false;
    if (radius == 0.0) return true;
    bool is_clear = true;
    bvh_.query_point(middle, radius, [&](std::uint32_t triangle) {
        const Triangle& t = mesh_.triangles[triangle];
        const auto& v = mesh_.vertices;
        const auto nearest = closest_point_on_triangle(middle, v[t[0]], v[t[1]], v[t[2]]);
        if (nearest.distance_squared >= radius * radius) return radius;
        is_clear = false;
        return 0.0;
    });
    return is_clear;
}

namespace {

constexpr std::uint64_t kSeed = 1;

// Edge length that build_near starts from, m: coarse for every ground but the terrain, where it is coarser still.
constexpr double kCoarseEdge = 0.25;
constexpr double kCoarseTerrainEdge = 15.0;

TriangleMesh make_rough_bowl(double edge) {
    TriangleMesh mesh = meshes::make_cavity({}, edge);
    std::erase_if(mesh.triangles, [&](const Triangle& t) {
        return mesh.vertices[t[0]].z + mesh.vertices[t[1]].z + mesh.vertices[t[2]].z > 0.0;
    });
    return mesh;
}

TriangleMesh make_ground(Ground ground, double edge) {
    switch (ground) {
        case Ground::cavity:
            return meshes::make_cavity({}, edge);
        case Ground::bowl:
            return meshes::make_bowl({}, edge);
        case Ground::rough_bowl:
            return make_rough_bowl(edge);
        case Ground::terrain:
            return meshes::make_terrain({}, edge);
        case Ground::wedge:
            return meshes::make_wedge({.length = 1.0, .opening = 0.01, .width = 1.0}, edge);
    }
    throw InputError("a benchmark case names a ground that does not exist");
}

// Particles per unit of parallel work.
constexpr std::size_t kBlock = 4096;

// The radii's random numbers have a stream of their own: points and spheres start at the same places where these suit.
constexpr std::uint32_t kPlaceStream = 0;
constexpr std::uint32_t kRadiusStream = 1;

double radius_of(const Case& c, std::uint64_t index) {
    if (c.least_radius == c.largest_radius) return c.least_radius;
    RandomSequence random(kSeed, kRadiusStream, index);
    return c.least_radius * portable_pow(c.largest_radius / c.least_radius, random.uniform());
}

Vec3 place_in(const Case& c, RandomSequence& random) {
    const Vec3 size = c.box.size();
    Vec3 place = c.box.lower;
    for (int axis = 0; axis < 3; ++axis) place[axis] += random.uniform() * size[axis];
    if (c.start == Start::above_terrain) place.z += meshes::terrain_height({}, place.x, place.y);
    return place;
}

}  // namespace

std::optional<Vec3> heart_of(Ground ground) {
    if (ground == Ground::cavity) return Vec3{};
    if (ground == Ground::wedge) return Vec3{0.5, 0.0, 0.0};
    return std::nullopt;
}

std::shared_ptr<const TriangleMesh> make_mesh(const Case& c) {
    const double edge = c.ground == Ground::terrain ? kCoarseTerrainEdge : kCoarseEdge;
    return std::make_shared<const TriangleMesh>(
        meshes::build_near(c.triangles, edge, [&](double length) { return make_ground(c.ground, length); }));
}

std::vector<Particle> make_particles(const Case& c, const TriangleMesh& mesh) {
    std::optional<Insides> insides;
    if (c.start == Start::inside) insides.emplace(mesh, heart_of(c.ground).value());
    std::vector<Particle> particles(c.particles);
    parallel_for_blocks(particles.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Particle& particle = particles[i];
            particle.radius = radius_of(c, i);
            RandomSequence random(kSeed, kPlaceStream, i);
            particle.position = place_in(c, random);
            while (insides && !insides->contains_ball(particle.position, particle.radius)) {
                particle.position = place_in(c, random);
            }
            const double speed = random.uniform_around(c.speed, c.spread);
            particle.velocity = c.drift + speed * random.unit_vector();
        }
    });
    return particles;
}

SimulationSetup make_setup(const Case& c, const std::shared_ptr<const TriangleMesh>& mesh) {
    SimulationSetup setup;
    setup.options.time_step = c.time_step;
    setup.options.duration = static_cast<double>(c.warm_up + c.steps) * c.time_step;
    setup.options.seed = kSeed;
    setup.options.response = c.response;
    if (c.gravity != 0.0) setup.forces.push_back(make_gravity({0.0, 0.0, -c.gravity}));
    setup.materials.push_back({.name = "ground", .restitution = c.restitution, .friction = c.friction});
    setup.colliders.push_back({"ground", MeshShape{mesh, {}, ""}, 0});
    return setup;
}

}  // namespace ricochet::bench
