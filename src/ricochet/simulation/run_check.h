/// \file
/// Private to the simulation: the verifier at work on a run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/collision/collision_world.h"
#include "ricochet/core/segment.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/verify/verifier.h"

namespace ricochet {

/// The verifier with what it remembers of every living particle, in the order of Particles.
class RunCheck {
public:
    explicit RunCheck(const CollisionWorld& world);

    /// Begins to watch the particles that have been appended since the last call. Not while others check.
    void watch_spawned(const Particles& particles);
    /// Checks what particle i, which `particles` still has as it was, did until `time`. Different particles may be
    /// checked from several threads at once.
    void check(std::size_t i, const Particles& particles, const ForceInput& moved, double time,
               std::span<const Segment> segments, std::vector<Violation>& violations);
    /// Begins to watch all particles from where they are.
    void restart(const Particles& particles);
    /// Keeps what Particles::compact() keeps.
    void compact(const std::vector<std::uint8_t>& keep);

private:
    Verifier verifier_;
    std::vector<VerifiedParticle> watched_;
};

}  // namespace ricochet
