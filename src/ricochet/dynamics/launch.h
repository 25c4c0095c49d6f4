/// \file
/// Random values of a particle at its birth: radius, speed, mass and lifetime, its direction in a cone, and its thermal
/// velocity. Each value takes a fixed number of random numbers, except a uniform direction in a cone.
/// Source of the velocity laws: G. A. Bird, "Molecular Gas Dynamics and the Direct Simulation of Gas Flows", 1994,
/// sections 4.2 and 12.1, and appendix C.
#pragma once

#include <optional>

#include "ricochet/core/random.h"
#include "ricochet/dynamics/emitter.h"

namespace ricochet {

/// Draws the values of an emitter's particles. Immutable.
class Launch {
public:
    /// Throws InputError for values outside the ranges of EmitterDescription.
    explicit Launch(const EmitterDescription& emitter);

    [[nodiscard]] double radius(RandomSequence& random) const { return radius_(random.uniform()); }
    [[nodiscard]] double speed(RandomSequence& random) const { return speed_(random.uniform()); }
    [[nodiscard]] double lifetime(RandomSequence& random) const { return lifetime_(random.uniform()); }
    /// Returns a number of children, before rounding. The emitter must have a parent rule.
    [[nodiscard]] double count(RandomSequence& random) const { return count_(random.uniform()); }
    /// Returns the mass, in kg, of a particle with the radius, in m.
    [[nodiscard]] double mass(double radius, RandomSequence& random) const;
    /// Returns a direction of unit length in the emitter's cone about an axis of unit length.
    [[nodiscard]] Vec3 direction(const Vec3& axis, RandomSequence& random) const;
    /// Returns true if thermal_velocity() replaces direction and speed.
    [[nodiscard]] bool is_thermal() const { return thermal_.has_value(); }
    /// Returns a thermal velocity, in m/s: z is the component along the direction of an effusing gas. It takes three
    /// random numbers.
    [[nodiscard]] Vec3 thermal_velocity(RandomSequence& random) const;
    /// Turns a thermal velocity of an effusing gas to the direction, of unit length. Returns other velocities
    /// unchanged.
    [[nodiscard]] Vec3 turned(const Vec3& thermal_velocity, const Vec3& direction) const;

private:
    Quantile radius_;
    Quantile speed_;
    Quantile mass_;
    Quantile lifetime_;
    Quantile count_;
    std::optional<double> density_;
    DirectionLaw law_;
    double cone_height_ = 0.0;        // 1 - cos(cone angle)
    double cone_sine_squared_ = 0.0;  // squared sine of the cone angle, for DirectionLaw::cosine
    std::optional<ThermalLaunch> thermal_;
    double thermal_speed_ = 0.0;  // standard deviation of a velocity component, in m/s
    Quantile normal_speed_;       // speed along the direction, in thermal_speed_, if a gas effuses
};

}  // namespace ricochet
