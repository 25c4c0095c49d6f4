/// \file
/// Materials of surfaces.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/response/impact_law.h"

namespace ricochet {

/// Motion of a surface's material while its geometry stands still: the belt of a conveyor, or the wall of a drum that
/// turns about its own axis. The velocity of a point p is velocity + angular_velocity x (p - center). Only its
/// component along the surface counts.
struct SurfaceMotion {
    Vec3 velocity;          ///< m/s
    Vec3 angular_velocity;  ///< rad/s
    Vec3 center;            ///< m, point on the axis of rotation

    [[nodiscard]] bool is_none() const { return velocity == Vec3{} && angular_velocity == Vec3{}; }
    /// Returns the velocity of the material at p along a surface of unit normal n, in m/s.
    [[nodiscard]] Vec3 at(const Vec3& p, const Vec3& n) const {
        const Vec3 whole = velocity + cross(angular_velocity, p - center);
        return whole - dot(whole, n) * n;
    }
    /// Returns the component along the surface of the time derivative of at(), in m/s^2, at a contact that moves with
    /// velocity v. n_rate: time derivative of the normal, in 1/s.
    [[nodiscard]] Vec3 rate(const Vec3& p, const Vec3& n, const Vec3& v, const Vec3& n_rate) const {
        const Vec3 whole = velocity + cross(angular_velocity, p - center);
        return cross(angular_velocity, v) - dot(whole, n) * n_rate;
    }
};

/// Material of a surface. Contacts of particles with the surface use it.
struct Material {
    std::string name;
    double restitution = 1.0;            ///< rebound speed over approach speed along the normal, 0..1
    double friction = 0.0;               ///< Coulomb coefficient, >= 0, for impacts and for sliding
    double restitution_threshold = 0.0;  ///< m/s, >= 0; below this approach speed restitution falls linearly to 0
    double rolling_friction = 0.0;       ///< resisting moment / (radius * normal force), >= 0; for rolling spheres
    double diffuse = 0.0;                ///< accommodation: fraction of impacts reflected by the cosine law, 0..1
    /// Temperature of the wall, in K, > 0. Diffusely reflected particles leave with thermal speeds of this temperature,
    /// or with their approach speed if it is not set.
    std::optional<double> wall_temperature = std::nullopt;
    double absorption = 0.0;  ///< fraction of impacts that remove the particle, 0..1
    /// Ratio of the moment that resists spinning about the normal to the normal force, in m, >= 0. For spheres in
    /// lasting contact.
    double spinning_friction = 0.0;
    /// Coulomb coefficient of a contact that sticks, >= friction; `friction` if it is not set.
    std::optional<double> static_friction = std::nullopt;
    /// Share of the slip velocity at the contact that a sticking impact reverses, 0..1 (Walton's third parameter).
    double tangential_restitution = 0.0;
    /// Factor on the tangential velocity of the centre at each impact, 0..1, for lumped masses (rockfall).
    double tangential_factor = 1.0;
    /// Approach speed, in m/s, > 0, above which the restitution falls as a power of the approach speed.
    std::optional<double> restitution_speed = std::nullopt;
    double restitution_exponent = kElasticPlasticExponent;  ///< exponent of this power, 0..1
    /// Coefficients by impact speed and angle. They replace the numbers above; empty if these apply.
    std::vector<ImpactTableRow> impact_table = {};
    /// Motion of the material. Friction, resistance to rolling and spinning, and diffuse reflection are relative to it.
    SurfaceMotion motion = {};

    /// Returns the restitution of an impact without the effect of the threshold. approach, along: speeds along the
    /// normal and along the surface, relative to the material, in m/s, >= 0.
    [[nodiscard]] double nominal_restitution(double approach, double along) const {
        if (!has_impact_law()) return restitution;
        if (impact_table.empty())
            return falling_restitution(restitution, restitution_speed, restitution_exponent, approach);
        return from_table(impact_table, {}, approach, along).restitution;
    }
    /// Returns the restitution of an impact at these speeds, in m/s.
    [[nodiscard]] double restitution_at(double approach, double along = 0.0) const {
        return below_threshold(nominal_restitution(approach, along), approach);
    }
    /// Returns the coefficients of an impact at these speeds, in m/s.
    [[nodiscard]] ImpactLaw at_impact(double approach, double along) const;
    /// Returns the Coulomb coefficient of a contact that sticks.
    [[nodiscard]] double sticking_friction() const { return static_friction.value_or(friction); }
    /// Returns true if a law applies that is defined only for impacts without duration.
    [[nodiscard]] bool needs_instant_impacts() const {
        return has_impact_law() || tangential_restitution > 0.0 || tangential_factor < 1.0 || static_friction;
    }
    /// Returns true if the coefficients depend on the speed of the impact beyond the threshold.
    [[nodiscard]] bool has_impact_law() const { return restitution_speed.has_value() || !impact_table.empty(); }
    /// Returns true if bounces that start at this approach speed, in m/s, die out on the surface.
    [[nodiscard]] bool can_hold(double approach) const {
        return restitution_at(approach) < 1.0 && diffuse < 1.0 && !(diffuse > 0.0 && wall_temperature);
    }
    /// Returns true if impacts draw random numbers.
    [[nodiscard]] bool is_random() const { return diffuse > 0.0 || absorption > 0.0; }
    /// Returns true if the surface can belong to a body that impulses move: its impacts have equal opposite impulses.
    [[nodiscard]] bool suits_bodies() const {
        const auto slows = [](const ImpactTableRow& row) { return row.tangential_factor.value_or(1.0) < 1.0; };
        return !is_random() && tangential_factor == 1.0 && std::ranges::none_of(impact_table, slows);
    }
    /// Returns true if the surface can do work on a particle that touches it: it moves and grips.
    [[nodiscard]] bool drives() const {
        const bool grips = friction > 0.0 || rolling_friction > 0.0 || spinning_friction > 0.0 || diffuse > 0.0 ||
                           tangential_factor < 1.0 || !impact_table.empty();
        return grips && !motion.is_none();
    }

private:
    [[nodiscard]] double below_threshold(double value, double approach) const {
        return approach < restitution_threshold ? value * (approach / restitution_threshold) : value;
    }
};

}  // namespace ricochet
