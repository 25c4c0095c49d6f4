#include "ricochet/simulation/run_check.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "ricochet/core/algorithms.h"
#include "ricochet/core/parallel.h"
#include "ricochet/simulation/particle_store.h"
#include "ricochet/verify/rebound.h"

namespace ricochet {
namespace {

/// Particles per unit of parallel work.
constexpr std::size_t kBlock = 64;

VerifiedDeformation verified_deformation(const std::vector<Triangle>& triangles, const MeshMotion& motion) {
    VerifiedDeformation surface{triangles, {motion.times().begin(), motion.times().end()}, {}, false};
    surface.repeats = motion.ends() == MeshEnds::repeat;
    for (std::size_t key = 0; key < motion.key_count(); ++key) {
        surface.vertices.emplace_back(motion.positions(key).begin(), motion.positions(key).end());
    }
    return surface;
}

/// Returns the surfaces of all colliders for the verifier, each in its frame. A plane or a shape is one surface.
std::vector<VerifiedSurface> surfaces_of(const CollisionWorld& world, const MovingColliders& bodies) {
    std::vector<VerifiedSurface> surfaces(world.colliders().size());
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        if (bodies.deforming().is_mesh(i)) {
            const DeformingMesh& mesh = bodies.deforming().mesh(i);
            surfaces[i] = verified_deformation(mesh.triangles(), *mesh.motion());
            continue;
        }
        const CollisionWorld& own = bodies.world(bodies.body_of_collider(i));
        const ColliderShape& shape = own.colliders()[i].shape;
        if (const auto* ball = std::get_if<BallShape>(&shape)) {
            surfaces[i] = VerifiedShape{world_from_unit(*ball), false};
        } else if (const auto* cylinder = std::get_if<CylinderShape>(&shape)) {
            surfaces[i] = VerifiedShape{world_from_unit(*cylinder), true};
        } else if (auto mesh = own.mesh_of(i)) {
            surfaces[i] = std::move(*mesh);
        }
        for (const auto& [plane, surface] : own.planes()) {
            if (own.name_of(surface).collider == i) surfaces[i] = VerifiedPlane{plane.point, plane.normal};
        }
    }
    return surfaces;
}

VerifiedMotion motion_of(const CollisionWorld& world, const MovingColliders& bodies) {
    VerifiedMotion motion;
    if (bodies.empty()) return motion;
    motion.frames = bodies.frames();
    for (const ColliderDescription& collider : world.colliders()) {
        motion.frame_of.push_back(collider.frame.empty() ? std::nullopt : motion.frames->find(collider.frame));
    }
    return motion;
}

}  // namespace

RunCheck::RunCheck(const CollisionWorld& world, const MovingColliders& bodies)
    : verifier_(surfaces_of(world, bodies), motion_of(world, bodies)) {}

void RunCheck::add_spawned(std::size_t particles) { watched_.resize(particles); }

void RunCheck::check(const MoveReport& move, std::vector<Violation>& violations) {
    const std::size_t i = move.index;
    const Particles& particles = move.particles;
    const VerifiedStep step{particles.id[i],
                            particles.position[i],
                            move.moved.position,
                            particles.radius[i],
                            move.end,
                            move.segments,
                            {move.before, move.after, move.motions},
                            move.stored_time};
    std::optional<VerifiedParticle>& watched = watched_[i];
    if (!watched) {
        watched = verifier_.watch(particles.position[i], particles.radius[i], std::max(0.0, particles.birth_time[i]));
    }
    verifier_.check(step, *watched, violations);
    check_rebounds(particles.id[i], move.impacts, violations);
}

void RunCheck::check_rebounds(std::uint64_t particle, std::span<const RecordedImpact> impacts,
                              std::vector<Violation>& violations) {
    for (const RecordedImpact& impact : impacts) {
        if (!verify::has_wrong_rebound(impact)) continue;
        violations.push_back({ViolationKind::rebound, particle, impact.before.position, impact.time, {}, {}});
    }
}

std::vector<Violation> RunCheck::check_end(const Particles& particles, double time) const {
    std::vector<Violation> found;
    for (std::size_t i = 0; i < watched_.size(); ++i) {
        if (watched_[i]) verifier_.check_end(particles.id[i], time, *watched_[i], found);
    }
    return found;
}

std::vector<Violation> RunCheck::check_meetings(const std::vector<PairMeeting>& meetings,
                                                const verify::ImpactAudit& books) {
    std::vector<Violation> found;
    for (const PairMeeting& meeting : meetings) {
        if (!verify::is_wrong(meeting, books)) continue;
        const MetSphere& sphere = meeting.spheres.front();
        found.push_back({ViolationKind::pair_impact, sphere.particle, sphere.before.position, meeting.time, {}, {}});
    }
    return found;
}

std::vector<Violation> RunCheck::check_spheres(const Particles& particles, const TimeSpan& step, double most) {
    std::vector<StandingSphere> spheres;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        if (particles.radius[i] == 0.0 || particles.frozen[i] != 0) continue;
        const bool is_new = !has_looked_ || particles.birth_time[i] >= step.begin;
        spheres.push_back({particles.id[i], particles.position[i], particles.radius[i], is_new});
    }
    has_looked_ = true;
    std::vector<Violation> violations;
    for (const SphereOverlaps::Found& found : overlaps_.check(spheres, most)) {
        violations.push_back({ViolationKind::pair_overlap, found.first, found.position, step.end, {}, {}});
    }
    return violations;
}

void RunCheck::restart(const ParticleStore& store, double now) {
    const Particles& particles = store.particles();
    watched_.assign(particles.size(), std::nullopt);
    parallel_for(particles.size(), kBlock, [&](std::size_t i) {
        watched_[i] = verifier_.watch(particles.position[i], particles.radius[i], store.stored_time(i, now));
        watched_[i]->checked_until = now;
    });
}

void RunCheck::compact(const std::vector<std::uint8_t>& keep) { keep_marked(watched_, keep); }

}  // namespace ricochet
