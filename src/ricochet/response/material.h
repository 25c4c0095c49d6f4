/// \file
/// What a surface does to what hits it.
#pragma once

#include <optional>
#include <string>

namespace ricochet {

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
};

}  // namespace ricochet
