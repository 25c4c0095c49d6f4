/// \file
/// Heat: changes of the temperature of particles by the medium, by radiation, and by energy that they lose at surfaces.
#pragma once

#include <optional>
#include <string_view>

#include "ricochet/dynamics/flows.h"

namespace ricochet {

/// Name of the attribute that heat changes. It has one component, in K.
inline constexpr std::string_view kTemperatureAttribute = "temperature";

/// Heat exchange of a sphere of radius r with the medium, with the coefficient h in W/(m^2 K). The coefficient is
/// given, or follows from the correlation of Ranz and Marshall: h = Nu conductivity / (2 r) with Nu = 2 + 0.6 Re^(1/2)
/// Pr^(1/3) and Re = density w 2 r / viscosity, where w is the speed relative to the flow. The defaults describe air at
/// 20 degrees C. Source: W. E. Ranz, W. R. Marshall, "Evaporation from drops", Chemical Engineering Progress 48, 1952.
struct Convection {
    /// Given coefficient h, in W/(m^2 K), >= 0; if it is set, the members below are unused.
    std::optional<double> coefficient = std::nullopt;
    double conductivity = 0.0257;  ///< in W/(m K), > 0
    double density = 1.204;        ///< in kg/m^3, >= 0
    double viscosity = 1.82e-5;    ///< in Pa s, > 0
    double prandtl = 0.713;        ///< viscosity times heat capacity over conductivity, > 0
    FlowPointer flow = nullptr;    ///< motion of the medium; null: at rest
};

/// Processes that change the attribute `temperature` of all particles. A particle has one uniform temperature.
struct HeatSettings {
    double specific_heat = 0.0;           ///< specific heat of the particles, in J/(kg K), 1e-3..1e12
    double ambient_temperature = 293.15;  ///< temperature of the medium and of the radiating surroundings, in K, >= 0
    std::optional<Convection> convection = std::nullopt;  ///< if empty, there is no exchange with the medium
    /// Emissivity relative to a black body, 0..1; it is also the absorbed fraction of radiation.
    double emissivity = 0.0;
    /// Fractions, 0..1, of lost energy that heat the particle. impact_fraction applies to losses by restitution,
    /// friction_fraction to losses by friction in impacts and contact. The rest of the energy heats the surface, whose
    /// temperature is not simulated.
    double impact_fraction = 0.0;
    double friction_fraction = 0.0;

    /// Returns true if the particle exchanges heat through its surface.
    [[nodiscard]] bool exchanges() const { return convection.has_value() || emissivity > 0.0; }
    /// Returns true if energy lost at surfaces heats the particle.
    [[nodiscard]] bool is_heated_by_surfaces() const { return impact_fraction > 0.0 || friction_fraction > 0.0; }
};

/// Rates of the cooling law dT/dt = -convection (T - Ta) - radiation (T^4 - Ta^4) of a sphere, with the ambient
/// temperature Ta.
struct CoolingRates {
    double convection = 0.0;  ///< in 1/s
    double radiation = 0.0;   ///< in 1/(s K^3)
};

/// Returns Convection::coefficient if it is set, otherwise the value of the correlation, in W/(m^2 K). speed: relative
/// to the flow, in m/s. radius in m, > 0.
[[nodiscard]] double heat_transfer_coefficient(const Convection& convection, double radius, double speed);

/// Returns the rates of a sphere: convection = h A / (m c) and radiation = emissivity sigma A / (m c) with A = 4 pi
/// r^2. mass m in kg, radius r in m, heat transfer coefficient h in W/(m^2 K).
[[nodiscard]] CoolingRates cooling_rates(const HeatSettings& heat, double mass, double radius, double coefficient);

/// Returns the temperature, in K, after `duration` seconds. It never passes the ambient temperature. It is exact up to
/// rounding if radiation is 0, or if convection and the ambient temperature are both 0. Otherwise the logarithm of T -
/// Ta is integrated in adaptive steps with a tolerance of 1e-11.
[[nodiscard]] double cooled(double temperature, double ambient, const CoolingRates& rates, double duration);

}  // namespace ricochet
