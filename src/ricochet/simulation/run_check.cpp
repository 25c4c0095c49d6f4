#include "ricochet/simulation/run_check.h"

#include <utility>
#include <variant>

#include "ricochet/core/parallel.h"

namespace ricochet {
namespace {

/// Particles per unit of parallel work.
constexpr std::size_t kBlock = 64;

/// The colliders as they collide; planes and shapes own one surface each.
std::vector<VerifiedSurface> surfaces_of(const CollisionWorld& world) {
    std::vector<VerifiedSurface> surfaces(world.colliders().size());
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const ColliderShape& shape = world.colliders()[i].shape;
        if (const auto* ball = std::get_if<BallShape>(&shape)) {
            surfaces[i] = VerifiedShape{world_from_unit(*ball), false};
        } else if (const auto* cylinder = std::get_if<CylinderShape>(&shape)) {
            surfaces[i] = VerifiedShape{world_from_unit(*cylinder), true};
        } else if (auto mesh = world.mesh_of(i)) {
            surfaces[i] = std::move(*mesh);
        }
    }
    for (const auto& [plane, surface] : world.planes()) {
        surfaces[world.name_of(surface).collider] = VerifiedPlane{plane.point, plane.normal};
    }
    return surfaces;
}

}  // namespace

RunCheck::RunCheck(const CollisionWorld& world) : verifier_(surfaces_of(world)) {}

void RunCheck::watch_spawned(const Particles& particles) {
    const std::size_t first = watched_.size();
    watched_.resize(particles.size());
    parallel_for_blocks(particles.size() - first, kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = first + begin; i < first + end; ++i) {
            watched_[i] = verifier_.watch(particles.position[i], particles.radius[i]);
        }
    });
}

void RunCheck::check(std::size_t i, const Particles& particles, const ForceInput& moved, double time,
                     std::span<const Segment> segments, std::vector<Violation>& violations) {
    const VerifiedStep step{particles.id[i], particles.position[i], moved.position, particles.radius[i], time,
                            segments};
    verifier_.check(step, watched_[i], violations);
}

void RunCheck::restart(const Particles& particles) {
    watched_.clear();
    watch_spawned(particles);
}

void RunCheck::compact(const std::vector<std::uint8_t>& keep) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < watched_.size(); ++i) {
        if (keep[i] == 0) continue;
        if (kept != i) watched_[kept] = std::move(watched_[i]);
        ++kept;
    }
    watched_.resize(kept);
}

}  // namespace ricochet
