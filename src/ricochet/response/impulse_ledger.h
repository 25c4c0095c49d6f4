/// \file
/// Records the impulses that one particle gives to surfaces in one move.
#pragma once

#include <cstddef>
#include <optional>

#include "ricochet/response/surface_kinematics.h"

namespace ricochet {

/// Records velocity changes of the particle as impulses in the totals of surfaces, the loads on colliders and the
/// contact log. See MoveScratch.
///
/// Loads are recorded for moving colliders, and for colliders with moving material. Their moment about any point equals
/// the loss of the particle's angular momentum, including its spin. The sums therefore balance under any law of impact.
/// A change of spin is recorded with the next impulse.
class ImpulseLedger {
public:
    /// All arguments must outlive the object.
    ImpulseLedger(const ResponseRules& rules, const MovingParticle& particle, MoveScratch& scratch,
                  const ReferenceFrame& reference, const SurfaceKinematics& surfaces)
        : rules_(rules),
          particle_(particle),
          scratch_(scratch),
          reference_(reference),
          surfaces_(surfaces),
          moment_center_(particle.state.position),
          spin_(particle.spin),
          first_(scratch.loads.size()) {
        if (scratch.record_loads) since_ = until_ = moment_of_time();
    }

    /// Records a change of velocity by a surface, in m/s, and the change of spin that it causes, in rad/s. Without
    /// spin_change, the whole change of spin since the last record is used. impact: false for lasting contact.
    void record_impulse(SurfaceId surface, const Vec3& velocity_change, bool impact,
                        const std::optional<Vec3>& spin_change = std::nullopt);
    /// Marks the last impulse as a further pass of an impact that has already been counted.
    void mark_as_repeated() { scratch_.hits.back().again = are_hits_; }
    /// Records an impact in the contact log. The particle must already have its velocity after the impact.
    void log_contact(const ContactSurface& surface, const Vec3& velocity_before);
    /// Impulses between these two calls belong to one impact. approach: its approach speed, in m/s; 0 if contact
    /// begins.
    void begin_impact(double approach);
    void end_impact();
    /// Records a further moment on a surface: a change of the particle's angular momentum per unit mass, in m^2/s.
    void record_moment(SurfaceId surface, const Vec3& change);
    /// Ends the records of the move: records the change of spin since the last record, on the last surface.
    void close();
    /// Records that moving surfaces take part in the next record.
    void note_driven() { scratch_.driven = true; }
    /// Sets whether the next impacts count as hits. Impacts that only resume a contact are omitted from the contact log
    /// and the counts of hits. Their impulses are still recorded.
    void set_hits(bool are_hits) { are_hits_ = are_hits; }

    /// Returns the sum of all recorded changes of velocity in the world, m/s.
    [[nodiscard]] const Vec3& velocity_change() const { return velocity_change_; }
    /// Returns the sum of their moments about moment_center(), in m^2/s. Each one acts at the particle's centre.
    [[nodiscard]] const Vec3& angular_impulse() const { return angular_impulse_; }
    /// Returns the position in the world, in m, at which the move began.
    [[nodiscard]] const Vec3& moment_center() const { return moment_center_; }

private:
    struct Moment {
        double time = 0.0;     // s
        Vec3 particle_center;  // m, in the world
    };

    [[nodiscard]] RecordedMotion motion_in_world() const {
        return reference_.in_world(particle_.recorded_motion(), particle_.state.time);
    }
    [[nodiscard]] Moment moment_of_time() const { return {particle_.state.time, motion_in_world().position}; }
    [[nodiscard]] double kinetic_energy() const;
    [[nodiscard]] Vec3 couple_of(const Vec3& spin_change) const;
    [[nodiscard]] double time_of_push(BodyId body, double time, bool impact) const;
    [[nodiscard]] double work_on_material(const ColliderLoad& load, BodyId body, const Moment& at) const;
    [[nodiscard]] double work_at(const ColliderLoad& load, BodyId body, const Moment& at) const;
    void add_load(const SurfaceHit& hit, const Vec3& couple);
    void make_lasting(ColliderLoad& load, BodyId body) const;

    const ResponseRules& rules_;
    const MovingParticle& particle_;
    MoveScratch& scratch_;
    const ReferenceFrame& reference_;
    const SurfaceKinematics& surfaces_;
    Vec3 moment_center_;
    Vec3 velocity_change_;
    Vec3 angular_impulse_;
    bool are_hits_ = true;
    Moment since_;       // start of the contact interval of the loads
    Moment until_;       // end of this interval
    Vec3 spin_;          // rad/s, in the world, after the last record
    std::size_t first_;  // first load of this move
    std::size_t first_of_impact_ = 0;
    double energy_before_ = 0.0;  // J, kinetic energy before the impact
    double approach_ = 0.0;       // m/s, approach speed of the impact
};

}  // namespace ricochet
