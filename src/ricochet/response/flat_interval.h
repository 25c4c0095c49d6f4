/// \file
/// A contact interval on flat surfaces, under forces that may vary in it.
#pragma once

#include <optional>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/sweep/path.h"
#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/contact_interval.h"
#include "ricochet/response/contact_motion.h"

namespace ricochet {

/// Slip of a point or a sphere on one flat surface under constant forces, relative to its position at the start.
/// Friction has a constant size, and its direction turns with the slip. Source: the equations of a sphere on a plane
/// with Coulomb friction, e.g. D. E. Stewart, "Rigid-body dynamics with friction and impact", SIAM Review 42 (2000).
/// They are integrated by the classical Runge-Kutta method.
class TurningSlip {
public:
    struct State {
        Vec3 displacement;  ///< m
        Vec3 velocity;      ///< m/s
        Vec3 acceleration;  ///< mean since the start, m/s^2
        Vec3 friction;      ///< mean since the start, force per unit mass, m/s^2
    };

    /// motion: along the surface, which does not rotate. forces: per unit mass, in m/s^2. pressure: factor on friction.
    TurningSlip(const Motion& motion, double radius, const SupportSurface& surface, const Vec3& forces,
                double pressure);

    /// Returns a time, in s, of at most `duration`, for which the method is suitable. In this time it is stable, and
    /// the slip changes by at most kMaxArcAngle of its size or hardly turns. Returns 0 if no friction acts, or the slip
    /// does not turn, soon ends without a turn, or is rounding.
    [[nodiscard]] double longest(double duration) const;
    /// Returns the state after t, in s.
    [[nodiscard]] State at(double t) const;
    /// Returns the change of a sphere's spin by a friction force per unit mass, in rad/s^2.
    [[nodiscard]] Vec3 spin_acceleration(const Vec3& friction) const {
        return spin_change_by(friction, normal_, radius_);
    }
    /// Returns the force of the surface per unit mass at the start, in m/s^2.
    [[nodiscard]] Vec3 reaction() const { return pressing_ * normal_ + friction_on(slip_); }

private:
    [[nodiscard]] Vec3 friction_on(const Vec3& slip) const;

    Motion start_;
    double radius_;
    Vec3 normal_;
    double pressing_;   // m/s^2
    double friction_;   // m/s^2, size
    Vec3 along_;        // m/s^2, acceleration without friction
    Vec3 slip_;         // m/s, at the start
    double slip_rate_;  // change of the slip divided by the friction that causes it
    double rounding_;   // m/s, rounding error of the slip
};

/// A contact interval, and the forces per unit mass, in m/s^2, with which it was planned.
struct PlannedInterval {
    ContactInterval interval;
    Vec3 forces;
};

/// A contact interval along flat surfaces, planned with the forces at its start and in its middle. Accelerations are
/// linear in time through both values. This is the midpoint rule if the interval is completed, and still of second
/// order if it ends earlier. If the friction on a single surface changes its direction, the interval integrates the
/// slip equations instead, under constant forces.
class FlatInterval {
public:
    /// Creates an interval under constant forces.
    explicit FlatInterval(const PlannedInterval& plan) : begin_(plan), middle_(plan) {}
    FlatInterval(const PlannedInterval& begin, const PlannedInterval& middle)
        : begin_(begin), middle_(middle), varies_(true) {}
    FlatInterval(const PlannedInterval& plan, const TurningSlip& slip) : begin_(plan), middle_(plan), slip_(slip) {}

    [[nodiscard]] double duration() const { return middle_.interval.duration; }
    [[nodiscard]] const Motion& motion() const { return middle_.interval.motion; }
    /// Returns true if surface k presses on the particle in the middle of the interval.
    [[nodiscard]] bool is_held_by(std::size_t k) const { return middle_.interval.reaction[k] != Vec3{}; }
    /// Returns true if the path only approximates the motion between its ends, to fourth order.
    [[nodiscard]] bool turns() const { return slip_.has_value(); }
    /// Returns the path from x in the first `time` seconds.
    [[nodiscard]] Path path(const Vec3& x, double time) const;
    /// Returns an interval with constant accelerations and forces that gives the same motion after `time` seconds.
    [[nodiscard]] PlannedInterval mean_until(double time) const;
    /// Returns the work of the forces per unit mass, in m^2/s^2, in `time` seconds with a displacement, in m.
    [[nodiscard]] double work_until(double time, const Vec3& displacement) const;

private:
    PlannedInterval begin_;
    PlannedInterval middle_;
    bool varies_ = false;
    std::optional<TurningSlip> slip_{};
};

}  // namespace ricochet
