/// \file
/// Steps of particles that meet nothing: where begin_flight() would lead to, without its path.
#pragma once

#include "ricochet/dynamics/flight.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {

/// One step under an acceleration that depends on neither position, velocity nor time, prepared for many particles. The
/// state after it has the same bits as the end of begin_flight()'s flight.
class FreeFlight {
public:
    /// acceleration in m/s^2, duration in s.
    FreeFlight(const Integrator& integrator, const Vec3& acceleration, double duration)
        : duration_(duration), kick_(duration * acceleration) {
        if (kicks_first(integrator.kind)) {
            drift_kick_ = kick_;
        } else if (integrator.kind != IntegratorKind::forward_euler) {
            drift_kick_ = (0.5 * duration) * acceleration;
        }
    }

    /// The state at the end of the step. A kick of zero changes no bit: flush_tiny() knows but one zero.
    [[nodiscard]] PhaseState step(const Vec3& position, const Vec3& velocity) const {
        return {flush_tiny(position + duration_ * (velocity + drift_kick_)), velocity + kick_};
    }

    /// True when the velocity stays: only its zeros may change their sign, with the first step.
    [[nodiscard]] bool is_straight() const { return kick_ == Vec3{} && drift_kick_ == Vec3{}; }
    [[nodiscard]] double duration() const { return duration_; }

private:
    double duration_;
    Vec3 kick_;
    Vec3 drift_kick_;
};

}  // namespace ricochet
