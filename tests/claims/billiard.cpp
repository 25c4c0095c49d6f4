#include "claims/billiard.h"

#include <algorithm>
#include <cmath>

#include "ricochet/collision/contact_query.h"
#include "ricochet/collision/safe_position.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/response/exact.h"
#include "support/exact_oracle.h"

namespace ricochet::testing {
namespace {

constexpr std::size_t kBlock = 16;

std::vector<ColliderDescription> as_collider(const NamedMesh& mesh, const Placement& placement) {
    return {{mesh.name, MeshShape{std::make_shared<const TriangleMesh>(mesh.mesh), placement, "", {}}, 0}};
}

/// Returns the distance of a point from a segment.
double distance(const Vec3& x, const Vec3& p, const Vec3& q) {
    const Vec3 d = q - p;
    const double size = length_squared(d);
    const double s = size > 0.0 ? std::clamp(dot(x - p, d) / size, 0.0, 1.0) : 0.0;
    return length(x - (p + s * d));
}

/// Returns a vertex of a triangle, or a point on an edge.
Vec3 rim_point(const CollisionWorld::Corners& t, RandomSequence& random) {
    const Vec3* const corners[3] = {&t.a, &t.b, &t.c};
    const auto k = static_cast<std::size_t>(3.0 * random.uniform());
    const double s = random.uniform() < 0.5 ? 0.0 : random.uniform();
    return *corners[k] + s * (*corners[(k + 1) % 3] - *corners[k]);
}

std::uint32_t random_triangle(const CollisionWorld& world, RandomSequence& random) {
    return static_cast<std::uint32_t>(random.uniform() * static_cast<double>(world.triangles().size()));
}

/// A particle that repeatedly flies towards vertices and edges.
struct Aimed {
    const CollisionWorld& world;
    ContactScratch& scratch;
    RandomSequence random;
    Vec3 position;
    std::uint32_t triangle;

    /// Flies to the next impact, or to the target if it hits nothing before.
    void fly(BilliardTally& tally) {
        const bool near = random.uniform() < 2.0 / 3.0;
        if (!near) triangle = random_triangle(world, random);
        const Vec3 target = rim_point(world.corners_of_triangle(triangle), random);
        const double past = random.uniform() < 0.25 ? 1.0 : 2.0 * random.uniform();
        const Path path = line_path(position, target - position, past);
        const auto found = find_first_contact({world, scratch.plane_cache}, {path, 0.0}, scratch);
        const auto& contact = found.contact;
        if (!contact) {
            position = certify_path(found.near, path, path.duration, path.end, scratch.chain).reached.position;
            return;
        }
        const SafePosition safe_position = find_safe_position(found.near, path, *contact, scratch.chain);
        position = safe_position.reached.position;
        triangle = world.name_of(contact->first().surface).triangle;
        ++tally.contacts;
        tally.stayed += safe_position.stayed ? 1 : 0;
    }
};

BilliardTally sum_of(const std::vector<BilliardTally>& parts) {
    BilliardTally sum;
    for (const BilliardTally& part : parts) {
        sum.contacts += part.contacts;
        sum.stayed += part.stayed;
        sum.not_inside += part.not_inside;
        sum.checked_segments += part.checked_segments;
        sum.crossing_segments += part.crossing_segments;
        sum.budget_exhausted += part.budget_exhausted;
    }
    return sum;
}

}  // namespace

bool oracle_meets(const TriangleMesh& mesh, const Vec3& p, const Vec3& q) {
    const double rounding = 1e-9 * std::max(max_abs(p), max_abs(q));
    return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
        const Vec3& a = mesh.vertices[t[0]];
        const Vec3& b = mesh.vertices[t[1]];
        const Vec3& c = mesh.vertices[t[2]];
        // The distance of any point of the triangle from the corner a is at most the longer of the two edges at a. The
        // factor adds a margin for rounding.
        const double reach = 1.001 * std::max(length(b - a), length(c - a)) + rounding;
        return distance(a, p, q) <= reach && exact_segment_intersects_triangle(p, q, a, b, c);
    });
}

Billiard::Billiard(const NamedMesh& mesh, const Placement& placement) : world_(as_collider(mesh, placement)) {
    mesh_ = *world_.mesh_of(0);
    if (count_open_edges(mesh_) == 0) oracle_ = std::make_unique<ParityOracle>(mesh_);
    // The mean free path is 4 V / S in a closed body. For an open mesh, V is the volume of the bounding box.
    const Vec3 size = bounds(mesh_).size();
    const double volume = oracle_ ? std::fabs(signed_volume(mesh_)) : size.x * size.y * size.z;
    mean_free_path_ = 4.0 * volume / surface_area(mesh_);
}

std::vector<Vec3> Billiard::start_points(int count, std::uint64_t seed) const {
    const Box3 box = bounds(mesh_);
    RandomSequence random(seed, 1, 0);
    std::vector<Vec3> points;
    while (points.size() < static_cast<std::size_t>(count)) {
        const double x = random.uniform();
        const double y = random.uniform();
        const Vec3 size = box.size();
        const Vec3 point = flush_tiny(box.lower + Vec3{x * size.x, y * size.y, random.uniform() * size.z});
        if (may_be_at(point)) points.push_back(point);
    }
    return points;
}

BilliardTally Billiard::fly(int particles, int steps, double impacts, double gravity, IntegratorKind kind,
                            std::uint64_t seed) const {
    const std::vector<Vec3> start = start_points(particles, seed);
    std::vector<std::unique_ptr<Force>> list;
    if (gravity != 0.0) list.push_back(make_gravity(gravity * mean_free_path_ * normalized(Vec3{0.1, 0.2, -1.0})));
    const ForceField forces(std::move(list));
    const std::vector<Material> materials{{"elastic", 1.0, 0.0}};
    ResponseSettings settings;
    settings.integrator = kind;
    const MovingColliders bodies(world_);
    const ExactResponse response({world_, bodies, forces, materials, settings});
    std::vector<BilliardTally> parts((start.size() + kBlock - 1) / kBlock);
    parallel_for_blocks(start.size(), kBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        MoveScratch scratch;
        BilliardTally& tally = parts[block];
        for (std::size_t i = begin; i < end; ++i) {
            RandomSequence random(seed, 2, i);
            const double speed = (0.5 + random.uniform()) * impacts * mean_free_path_;
            MovingParticle particle{{start[i], speed * random.unit_vector(), 1.0, 0.0, 0.0}, {}, i, 0};
            bool inside = true;
            for (int step = 0; step < steps; ++step) {
                scratch.hits.clear();
                const MoveOutcome outcome = response.move(particle, 1.0, scratch);
                tally.contacts += outcome.bounces;
                tally.stayed += outcome.stayed;
                tally.budget_exhausted += outcome.unsimulated_time > 0.0 ? 1 : 0;
                if (step % 8 == 7 || step + 1 == steps) inside = inside && may_be_at(particle.state.position);
            }
            tally.not_inside += inside ? 0 : 1;
        }
    });
    return sum_of(parts);
}

/// Checks every segment of the chain that the particle has followed. If the chain does not start at `from` and end at
/// `to`, that counts as a crossing.
void Billiard::check_legs(const std::vector<PathPoint>& chain, const Vec3& from, const Vec3& to,
                          BilliardTally& tally) const {
    tally.crossing_segments += chain.front().position == from && chain.back().position == to ? 0 : 1;
    for (std::size_t k = 1; k < chain.size(); ++k) {
        ++tally.checked_segments;
        tally.crossing_segments += oracle_meets(mesh_, chain[k - 1].position, chain[k].position) ? 1 : 0;
    }
}

BilliardTally Billiard::aim(int particles, int impacts, int check_every, std::uint64_t seed) const {
    const std::vector<Vec3> start = start_points(particles, seed);
    std::vector<BilliardTally> parts((start.size() + kBlock - 1) / kBlock);
    parallel_for_blocks(start.size(), kBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        ContactScratch scratch;
        BilliardTally& tally = parts[block];
        for (std::size_t i = begin; i < end; ++i) {
            Aimed particle{world_, scratch, RandomSequence(seed, 3, i), start[i], 0};
            particle.triangle = random_triangle(world_, particle.random);
            bool inside = true;
            for (int k = 0; k < impacts; ++k) {
                const Vec3 before = particle.position;
                particle.fly(tally);
                if (static_cast<int>(particle.random.uniform() * check_every) == 0) {
                    check_legs(scratch.chain, before, particle.position, tally);
                }
                if (k % 8 == 7 || k + 1 == impacts) inside = inside && may_be_at(particle.position);
            }
            tally.not_inside += inside ? 0 : 1;
        }
    });
    return sum_of(parts);
}

}  // namespace ricochet::testing
