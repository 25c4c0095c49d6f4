/// \file
/// Private to the responses: records the impulses and moments that one particle gives in one move to moving colliders,
/// or to colliders with moving material.
///
/// The recorded moment about any point equals the loss of the particle's angular momentum, including its spin. The sums
/// therefore balance under any law of impact. A change of spin is recorded with the next impulse.
#pragma once

#include <cstddef>
#include <optional>

#include "ricochet/response/reference_frame.h"
#include "ricochet/response/response.h"

namespace ricochet {

class ImpulseRecorder {
public:
    ImpulseRecorder(const ResponseRules& rules, const MovingParticle& particle, MoveScratch& scratch,
                    const ReferenceFrame& reference)
        : rules_(rules),
          particle_(particle),
          scratch_(scratch),
          reference_(reference),
          spin_(particle.spin),
          first_(scratch.loads.size()) {
        if (scratch.record_loads) since_ = until_ = moment_of_time();
    }

    /// Records an impulse on a surface, and the change of spin that it causes, in rad/s. Without spin_change, the whole
    /// change of spin since the last record is used.
    void add(const SurfaceHit& hit, const std::optional<Vec3>& spin_change);
    /// Impulses recorded between these two calls belong to one impact. approach: its largest approach speed, in m/s.
    void begin_impact(double approach);
    void end_impact();
    /// Records a couple on a surface, in N m s: the part of its moment in lasting contact that its impulses do not
    /// contain.
    void add_couple(SurfaceId surface, const Vec3& couple);
    /// Records the change of spin since the last record, on the last surface.
    void close();

private:
    struct Moment {
        double time = 0.0;     // s
        Vec3 particle_center;  // m, in the world
    };

    [[nodiscard]] bool is_entered(SurfaceId surface) const;
    [[nodiscard]] Moment moment_of_time() const { return {particle_.state.time, motion_in_world().position}; }
    [[nodiscard]] double work_at(const ColliderLoad& load, BodyId body, const Moment& at) const;
    void enter_lasting(ColliderLoad& load, BodyId body) const;
    [[nodiscard]] RecordedMotion motion_in_world() const;
    [[nodiscard]] double kinetic_energy() const;
    [[nodiscard]] Vec3 couple_of(const Vec3& spin_change) const;
    [[nodiscard]] double time_of_push(BodyId body, double time, bool impact) const;
    [[nodiscard]] double work_on_material(const ColliderLoad& load, BodyId body, const Moment& at) const;
    void enter(const SurfaceHit& hit, const Vec3& couple);

    const ResponseRules& rules_;
    const MovingParticle& particle_;
    MoveScratch& scratch_;
    const ReferenceFrame& reference_;
    Moment since_;       // start of the contact interval of the records
    Moment until_;       // end of this interval
    Vec3 spin_;          // rad/s, in the world, after the last record
    std::size_t first_;  // first record of this move
    std::size_t first_of_impact_ = 0;
    double energy_before_ = 0.0;  // J, kinetic energy before the impact
    double approach_ = 0.0;       // m/s, approach speed of the impact
};

}  // namespace ricochet
