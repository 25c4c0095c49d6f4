/// \file
/// Heat: how the temperature that particles carry changes by the medium, by radiation and by what surfaces take of
/// their motion.
#pragma once

#include <optional>
#include <string_view>

#include "ricochet/dynamics/flows.h"

namespace ricochet {

/// The attribute that heat changes, of one component, in K.
inline constexpr std::string_view kTemperatureAttribute = "temperature";

/// Heat that a medium takes from a sphere, by the coefficient h in W/(m^2 K): given, or by the correlation of Ranz and
/// Marshall, h = Nu conductivity / (2 r) with Nu = 2 + 0.6 Re^(1/2) Pr^(1/3) and Re = density w 2 r / viscosity at the
/// speed w relative to the flow. Source: W. E. Ranz, W. R. Marshall, "Evaporation from drops", Chemical Engineering
/// Progress 48, 1952. The defaults are those of air at 20 degrees C.
struct Convection {
    std::optional<double> coefficient = std::nullopt;  ///< W/(m^2 K), >= 0; the numbers below have no part then
    double conductivity = 0.0257;                      ///< W/(m K), > 0
    double density = 1.204;                            ///< kg/m^3, >= 0
    double viscosity = 1.82e-5;                        ///< Pa s, > 0
    double prandtl = 0.713;                            ///< viscosity times heat capacity over conductivity, > 0
    FlowPointer flow = nullptr;                        ///< how the medium moves; null: it is at rest
};

/// What changes the attribute `temperature` of all particles. A particle has one temperature throughout.
struct HeatSettings {
    double specific_heat = 0.0;                           ///< J/(kg K), 1e-3..1e12, of the particles
    double ambient_temperature = 293.15;                  ///< K, >= 0, of the medium and of what they shine at
    std::optional<Convection> convection = std::nullopt;  ///< nothing: the medium takes no heat
    double emissivity = 0.0;  ///< 0..1, over that of a black body; also the part of radiation that is taken in
    /// 0..1: the parts of the energy that impacts lose along the normal (restitution), and that friction takes in
    /// impacts and contact, which heat the particle. What is left heats the surface, whose temperature nobody follows.
    double impact_fraction = 0.0;
    double friction_fraction = 0.0;

    /// True where it depends on the particle's surface.
    [[nodiscard]] bool exchanges() const { return convection.has_value() || emissivity > 0.0; }
    /// True where surfaces heat.
    [[nodiscard]] bool is_heated_by_surfaces() const { return impact_fraction > 0.0 || friction_fraction > 0.0; }
};

/// How fast a sphere goes towards the ambient temperature Ta: dT/dt = -convection (T - Ta) - radiation (T^4 - Ta^4).
struct CoolingRates {
    double convection = 0.0;  ///< 1/s
    double radiation = 0.0;   ///< 1/(s K^3)
};

/// Convection::coefficient, or what the correlation says at a speed relative to the flow, m/s; radius in m, > 0.
[[nodiscard]] double heat_transfer_coefficient(const Convection& convection, double radius, double speed);

/// Of a sphere of this mass, kg, and radius, m, with that heat transfer coefficient, W/(m^2 K): a = h A / (m c) and
/// b = emissivity sigma A / (m c) with A = 4 pi r^2.
[[nodiscard]] CoolingRates cooling_rates(const HeatSettings& heat, double mass, double radius, double coefficient);

/// The temperature, K, after `duration` seconds: never beyond the ambient one, however long that is. Exact but for
/// rounding where one of the rates is 0 and, for radiation, the ambient temperature is; else the logarithm of T - Ta is
/// integrated by steps that fit themselves, each to 1e-11.
[[nodiscard]] double cooled(double temperature, double ambient, const CoolingRates& rates, double duration);

}  // namespace ricochet
