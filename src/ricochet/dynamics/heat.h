/// \file
/// Heat: changes of the temperature of particles by the medium, by radiation, and by energy lost at surfaces.
#pragma once

#include <optional>
#include <string_view>

#include "ricochet/dynamics/flows.h"

namespace ricochet {

/// Attribute that heat changes: one component, in K.
inline constexpr std::string_view kTemperatureAttribute = "temperature";

/// Heat exchange of a sphere with the medium, with the coefficient h in W/(m^2 K). The coefficient is given, or follows
/// from the correlation of Ranz and Marshall: h = Nu conductivity / (2 r) with Nu = 2 + 0.6 Re^(1/2) Pr^(1/3) and Re =
/// density w 2 r / viscosity at the speed w relative to the flow. The defaults are the values of air at 20 degrees C.
/// Source: W. E. Ranz, W. R. Marshall, "Evaporation from drops", Chemical Engineering Progress 48, 1952.
struct Convection {
    std::optional<double> coefficient = std::nullopt;  ///< in W/(m^2 K), >= 0; the members below are then unused
    double conductivity = 0.0257;                      ///< in W/(m K), > 0
    double density = 1.204;                            ///< in kg/m^3, >= 0
    double viscosity = 1.82e-5;                        ///< in Pa s, > 0
    double prandtl = 0.713;                            ///< viscosity times heat capacity over conductivity, > 0
    FlowPointer flow = nullptr;                        ///< motion of the medium; null: at rest
};

/// Processes that change the attribute `temperature` of all particles. A particle has one uniform temperature.
struct HeatSettings {
    double specific_heat = 0.0;           ///< of the particles, in J/(kg K), 1e-3..1e12
    double ambient_temperature = 293.15;  ///< of the medium and of the radiating surroundings, in K, >= 0
    std::optional<Convection> convection = std::nullopt;  ///< nothing: no exchange with the medium
    double emissivity = 0.0;  ///< 0..1, relative to a black body; also the absorbed fraction of radiation
    /// Fractions, 0..1, of lost energy that heat the particle. impact_fraction applies to the normal loss of impacts
    /// (restitution), friction_fraction to friction in impacts and contact. The rest heats the surface, whose
    /// temperature is not tracked.
    double impact_fraction = 0.0;
    double friction_fraction = 0.0;

    /// Returns true if the particle exchanges heat through its surface.
    [[nodiscard]] bool exchanges() const { return convection.has_value() || emissivity > 0.0; }
    /// Returns true if energy lost at surfaces heats the particle.
    [[nodiscard]] bool is_heated_by_surfaces() const { return impact_fraction > 0.0 || friction_fraction > 0.0; }
};

/// Rates at which a sphere approaches the ambient temperature Ta: dT/dt = -convection (T - Ta) - radiation (T^4 -
/// Ta^4).
struct CoolingRates {
    double convection = 0.0;  ///< in 1/s
    double radiation = 0.0;   ///< in 1/(s K^3)
};

/// Returns Convection::coefficient, or the correlation's value at a speed relative to the flow, in m/s. radius in m, >
/// 0.
[[nodiscard]] double heat_transfer_coefficient(const Convection& convection, double radius, double speed);

/// Returns the rates of a sphere with this mass, in kg, radius, in m, and heat transfer coefficient, in W/(m^2 K): a =
/// h A / (m c) and b = emissivity sigma A / (m c) with A = 4 pi r^2.
[[nodiscard]] CoolingRates cooling_rates(const HeatSettings& heat, double mass, double radius, double coefficient);

/// Returns the temperature, in K, after `duration` seconds. It never passes the ambient temperature, for any duration.
/// The result is exact up to rounding if radiation is 0, or if convection and the ambient temperature are both 0.
/// Otherwise the logarithm of T - Ta is integrated by adaptive steps, each to 1e-11.
[[nodiscard]] double cooled(double temperature, double ambient, const CoolingRates& rates, double duration);

}  // namespace ricochet
