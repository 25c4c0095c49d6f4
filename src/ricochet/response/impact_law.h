/// \file
/// Coefficients of an impact, and how they depend on the speed and the angle of the impact.
#pragma once

#include <algorithm>
#include <optional>
#include <span>

namespace ricochet {

/// Exponent of the restitution of elastic-plastic spheres, e ~ v^(-1/4). Local: a default. Source: K. L. Johnson,
/// "Contact Mechanics", Cambridge 1985, section 11.5.
inline constexpr double kElasticPlasticExponent = 0.25;

/// Coefficients of one impact. The first three are Walton's parameters for the impact of a sphere: O. R. Walton,
/// "Numerical simulation of inelastic, frictional particle-particle interactions", in M. C. Roco (ed.), "Particulate
/// Two-Phase Flow", Butterworth-Heinemann 1993.
struct ImpactLaw {
    double restitution = 1.0;             ///< rebound speed over approach speed along the normal, 0..1
    double friction = 0.0;                ///< Coulomb coefficient, >= 0
    double tangential_restitution = 0.0;  ///< slip speed after a sticking impact over that before, reversed, 0..1
    double tangential_factor = 1.0;       ///< factor on the tangential velocity of the centre, 0..1
    double static_friction = 0.0;         ///< Coulomb coefficient of a contact that sticks; that of slip if it is less

    /// Returns the coefficient of a contact that sticks.
    [[nodiscard]] double sticking_friction() const { return std::max(friction, static_friction); }
};

/// One row of a table of coefficients. A table is a grid: the same angles at each speed, in ascending order, first by
/// speed, then by angle.
struct ImpactTableRow {
    double speed = 0.0;  ///< impact speed relative to the surface, m/s, >= 0
    double angle = 0.0;  ///< from the normal of the surface, degrees, 0..90
    double restitution = 1.0;
    /// Values of the material apply to all rows if a row has none of its own.
    std::optional<double> tangential_restitution = std::nullopt;
    std::optional<double> tangential_factor = std::nullopt;
};

/// Returns true if the rows form a grid as described above, with at least one row.
[[nodiscard]] bool is_grid(std::span<const ImpactTableRow> rows);

/// Returns the coefficients of an impact from a table that is a grid. Values are linear in the speed and in the sine of
/// the angle, and constant outside the table. otherwise: coefficients that rows do not contain. approach, along: speeds
/// along the normal and along the surface, m/s, >= 0.
[[nodiscard]] ImpactLaw from_table(std::span<const ImpactTableRow> rows, const ImpactLaw& otherwise, double approach,
                                   double along);

/// Returns the restitution e at speeds up to `from`, and e (approach / from)^-exponent at higher ones; e if `from` is
/// not set. Speeds in m/s, exponent 0..1.
[[nodiscard]] double falling_restitution(double restitution, std::optional<double> from, double exponent,
                                         double approach);

}  // namespace ricochet
