/// \file
/// Private to the exact response: slip on one flat surface under constant forces. Friction has a constant size, and its
/// direction turns with the slip. Pure functions.
#pragma once

#include "ricochet/core/vec3.h"
#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/contact_motion.h"

namespace ricochet {

/// The motion of a point or a sphere from the start of its slip, relative to its position there. Source: the equations
/// of a sphere on a plane with Coulomb friction, e.g. D. E. Stewart, "Rigid-body dynamics with friction and impact",
/// SIAM Review 42 (2000). They are integrated by the classical Runge-Kutta method.
class TurningSlip {
public:
    struct State {
        Vec3 displacement;  ///< m
        Vec3 velocity;      ///< m/s
        Vec3 acceleration;  ///< mean since the start, m/s^2
        Vec3 friction;      ///< mean since the start, force per unit mass, m/s^2
    };

    /// motion: motion along the surface, which does not rotate. forces: per unit mass, in m/s^2. pressure: factor on
    /// friction.
    TurningSlip(const Motion& motion, double radius, const SupportSurface& surface, const Vec3& forces,
                double pressure);

    /// Returns a time, in s, of at most `duration`, for which the method is suitable. In this time it is stable, and
    /// the slip changes by at most kMaxArcAngle of its size or hardly turns. Returns 0 if no friction acts or the slip
    /// does not turn. Also returns 0 if the slip soon ends without a turn, or is only a rounding error.
    [[nodiscard]] double longest(double duration) const;
    /// Returns the state after t, in s.
    [[nodiscard]] State at(double t) const;
    /// Returns the change of a sphere's spin by a friction force per unit mass, in rad/s^2.
    [[nodiscard]] Vec3 spin_acceleration(const Vec3& friction) const {
        return spin_change_by(friction, normal_, radius_);
    }
    /// Returns the motion at the start.
    [[nodiscard]] const Motion& start() const { return start_; }
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

}  // namespace ricochet
