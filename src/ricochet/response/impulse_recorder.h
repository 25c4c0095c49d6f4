/// \file
/// Private to the responses: what one particle does in one move to colliders that move, or whose material does.
///
/// The moment about any point is what the particle's own angular momentum, with that of its spin, loses: so the sums
/// close, whatever the law of an impact. What changes the spin is booked with the impulse that comes next to it.
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

    /// Enters an impulse on a surface, and the change of the spin that is made with it, rad/s; without it all that has
    /// changed since the last entry.
    void add(const SurfaceHit& hit, const std::optional<Vec3>& spin_change);
    /// The entries between these two belong to one impact. approach: its largest speed, m/s.
    void begin_impact(double approach);
    void end_impact();
    /// Enters a couple on a surface, N m s: what its impulses in contact that lasts lack of the moment they have had.
    void add_couple(SurfaceId surface, const Vec3& couple);
    /// Enters what has changed the spin since, with the last surface.
    void close();

private:
    struct Moment {
        double time = 0.0;     // s
        Vec3 particle_center;  // m, in the world, of the particle's centre
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
    [[nodiscard]] Vec3 normal_at(SurfaceId surface, BodyId body, const Vec3& seen, double time) const;
    void enter(const SurfaceHit& hit, const Vec3& couple);

    const ResponseRules& rules_;
    const MovingParticle& particle_;
    MoveScratch& scratch_;
    const ReferenceFrame& reference_;
    Moment since_;       // the interval of contact in which entries are made: its begin
    Moment until_;       // and its end
    Vec3 spin_;          // rad/s, in the world, as the entries leave it
    std::size_t first_;  // entry of this move
    std::size_t first_of_impact_ = 0;
    double energy_before_ = 0.0;  // J, the impact
    double approach_ = 0.0;       // m/s, of it
};

}  // namespace ricochet
