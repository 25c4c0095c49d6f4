/// \file
/// Private to the simulation: the verifier of a run.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/collision/moving_colliders.h"
#include "ricochet/core/recorded_impact.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/simulation/move_report.h"
#include "ricochet/simulation/query_schedule.h"
#include "ricochet/verify/impact_audit.h"
#include "ricochet/verify/sphere_overlaps.h"
#include "ricochet/verify/verifier.h"

namespace ricochet {

class ParticleStore;

/// The verifier, with its state of every living particle, in the order of Particles.
class RunCheck {
public:
    /// bodies: empty if no collider moves. Both arguments must outlive the object.
    RunCheck(const CollisionWorld& world, const MovingColliders& bodies);

    /// Adds entries for appended particles. particles: new number of all particles. Must not be called during checks. A
    /// new particle is watched from its first check on. Before, other impacts in the step can still change the path of
    /// a dynamic body at the time of the birth.
    void add_spawned(std::size_t particles);
    /// Checks a move and its impacts, on any thread. Needs segments and motions.
    void check(const MoveReport& move, std::vector<Violation>& violations);
    /// Appends violations for impacts of a particle whose rebound does not match the surfaces that were hit.
    static void check_rebounds(std::uint64_t particle, std::span<const RecordedImpact> impacts,
                               std::vector<Violation>& violations);
    /// Returns the violations of particles that are stalled at the end of the run. time: end of the run, in s.
    [[nodiscard]] std::vector<Violation> check_end(const Particles& particles, double time) const;
    /// Begins to watch all particles at their positions, from a time on, in s, or from their stored times if stalled.
    void restart(const ParticleStore& store, double now);
    /// Keeps the entries that Particles::compact() keeps.
    void compact(const std::vector<std::uint8_t>& keep);

    /// Returns the violations in impacts of spheres on each other.
    [[nodiscard]] static std::vector<Violation> check_meetings(const std::vector<PairMeeting>& meetings,
                                                               const verify::ImpactAudit& books);
    /// Returns violations for spheres whose overlap has grown in a step beyond `most` times the smaller radius.
    [[nodiscard]] std::vector<Violation> check_spheres(const Particles& particles, const TimeSpan& step, double most);
    /// Returns the largest overlap that the last call of check_spheres() found, divided by the smaller radius.
    [[nodiscard]] double largest_overlap() const { return overlaps_.largest(); }

private:
    Verifier verifier_;
    SphereOverlaps overlaps_;
    bool has_looked_ = false;                               // true if check_spheres() has been called
    std::vector<std::optional<VerifiedParticle>> watched_;  // per particle; empty before its first check
};

}  // namespace ricochet
