/// \file
/// What a surface does to what hits it.
#pragma once

#include <optional>
#include <string>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// How the material of a surface moves while its geometry stands still: the belt of a conveyor, the wall of a drum that
/// turns about its own axis. The velocity of a point p is velocity + angular_velocity x (p - center); of that only the
/// part along the surface counts.
struct SurfaceMotion {
    Vec3 velocity;          ///< m/s
    Vec3 angular_velocity;  ///< rad/s
    Vec3 center;            ///< m, of the turning

    [[nodiscard]] bool is_none() const { return velocity == Vec3{} && angular_velocity == Vec3{}; }
    /// m/s, of the material at p, along a surface of unit normal n.
    [[nodiscard]] Vec3 at(const Vec3& p, const Vec3& n) const {
        const Vec3 whole = velocity + cross(angular_velocity, p - center);
        return whole - dot(whole, n) * n;
    }
    /// m/s^2, by which that changes along the surface, for a contact that moves with velocity v while the normal turns
    /// by n_rate, 1/s.
    [[nodiscard]] Vec3 rate(const Vec3& p, const Vec3& n, const Vec3& v, const Vec3& n_rate) const {
        const Vec3 whole = velocity + cross(angular_velocity, p - center);
        return cross(angular_velocity, v) - dot(whole, n) * n_rate;
    }
};

/// Surface material; particles take the collider's.
struct Material {
    std::string name;
    double restitution = 1.0;            ///< rebound speed over approach speed along the normal, 0..1
    double friction = 0.0;               ///< Coulomb coefficient, >= 0, for impacts and for sliding
    double restitution_threshold = 0.0;  ///< m/s, >= 0; below this approach speed restitution falls linearly to 0
    double rolling_friction = 0.0;       ///< resisting moment over radius times normal force, >= 0; spheres that roll
    double diffuse = 0.0;                ///< accommodation: fraction of impacts reflected by the cosine law, 0..1
    /// Temperature of the wall, K, > 0: diffuse reflection then leaves with the wall's thermal speeds; without it with
    /// the speed of arrival.
    std::optional<double> wall_temperature = std::nullopt;
    double absorption = 0.0;  ///< fraction of impacts that remove the particle, 0..1
    /// Moment that resists spinning about the normal over the normal force, m, >= 0; spheres in contact that lasts.
    double spinning_friction = 0.0;
    /// How the material moves: what friction, resistance to turning and diffuse reflection are relative to.
    SurfaceMotion motion = {};

    /// Restitution at an approach speed, m/s.
    [[nodiscard]] double restitution_at(double approach) const {
        return approach < restitution_threshold ? restitution * (approach / restitution_threshold) : restitution;
    }
    /// True when bounces that start at this approach speed, m/s, die out on the surface.
    [[nodiscard]] bool can_hold(double approach) const {
        return restitution_at(approach) < 1.0 && diffuse < 1.0 && !(diffuse > 0.0 && wall_temperature);
    }
    /// True when impacts draw random numbers.
    [[nodiscard]] bool is_random() const { return diffuse > 0.0 || absorption > 0.0; }
    /// True when the surface can do work on what touches it: it moves and grips.
    [[nodiscard]] bool drives() const {
        const bool grips = friction > 0.0 || rolling_friction > 0.0 || spinning_friction > 0.0 || diffuse > 0.0;
        return grips && !motion.is_none();
    }
};

}  // namespace ricochet
