/// \file
/// Private to the responses: records the impulses that one particle gives to surfaces in one move.
#pragma once

#include <optional>

#include "ricochet/response/impulse_recorder.h"
#include "ricochet/response/surface_kinematics.h"

namespace ricochet {

/// Records velocity changes of the particle as impulses in the totals of surfaces, the loads on colliders and the
/// contact log. See MoveScratch.
class ImpulseLedger {
public:
    /// All arguments must outlive the object.
    ImpulseLedger(const ResponseRules& rules, const MovingParticle& particle, MoveScratch& scratch,
                  const ReferenceFrame& reference, const SurfaceKinematics& surfaces)
        : particle_(particle),
          scratch_(scratch),
          reference_(reference),
          surfaces_(surfaces),
          recorder_(rules, particle, scratch, reference),
          moment_center_(particle.state.position) {}

    /// Records a change of velocity by a surface, in m/s, and the change of spin that it causes, in rad/s. Without
    /// spin_change, the whole change of spin since the last record is used. impact: false for lasting contact.
    void record_impulse(SurfaceId surface, const Vec3& velocity_change, bool impact,
                        const std::optional<Vec3>& spin_change = std::nullopt);
    /// Marks the last impulse as a further pass of an impact that has already been counted.
    void mark_as_repeated() { scratch_.hits.back().again = are_hits_; }
    /// Records an impact in the contact log. The particle must already have its velocity after the impact.
    void log_contact(const ContactSurface& surface, const Vec3& velocity_before);
    /// The impulses between these two calls belong to one impact. approach: its largest approach speed, in m/s, or 0
    /// for an impact that begins contact.
    void begin_impact(double approach) { recorder_.begin_impact(approach); }
    void end_impact() { recorder_.end_impact(); }
    /// Records a moment on a surface in addition to the moments of all impulses. change: change of the particle's
    /// angular momentum per unit mass, in m^2/s.
    void record_moment(SurfaceId surface, const Vec3& change) {
        recorder_.add_couple(surface, -particle_.state.mass * change);
    }
    /// Ends the records of the move.
    void close() { recorder_.close(); }
    /// Records that moving surfaces take part in the next record.
    void note_driven() { scratch_.driven = true; }
    /// Sets whether the next impacts count as hits. Impacts that only resume a contact are omitted from the contact log
    /// and the counts of hits. Their impulses are still recorded.
    void set_hits(bool are_hits) { are_hits_ = are_hits; }

    /// Returns the sum of all recorded changes of velocity in the world, m/s.
    [[nodiscard]] const Vec3& velocity_change() const { return velocity_change_; }
    /// Returns the sum of the moments of these changes about moment_center(), in m^2/s. Each one acts at the particle's
    /// centre.
    [[nodiscard]] const Vec3& angular_impulse() const { return angular_impulse_; }
    /// Returns the position in the world, in m, at which the move began.
    [[nodiscard]] const Vec3& moment_center() const { return moment_center_; }

private:
    const MovingParticle& particle_;
    MoveScratch& scratch_;
    const ReferenceFrame& reference_;
    const SurfaceKinematics& surfaces_;
    ImpulseRecorder recorder_;
    Vec3 moment_center_;
    Vec3 velocity_change_;
    Vec3 angular_impulse_;
    bool are_hits_ = true;
};

}  // namespace ricochet
