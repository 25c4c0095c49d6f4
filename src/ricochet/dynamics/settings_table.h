/// \file
/// Private to the library: tables of settings of heat, see core/setting.h.
#pragma once

#include "ricochet/core/setting.h"
#include "ricochet/dynamics/heat.h"

namespace ricochet {

/// Without the flow.
inline constexpr Setting<Convection> kConvectionTable[] = {
    {"coefficient", &Convection::coefficient, kNotNegative, "W/(m^2 K)",
     "Coefficient h in dT/dt = -h A (T - Ta) / (m c). It excludes all other keys.", "the correlation"},
    {"conductivity", &Convection::conductivity, kPositive, "W/(m K)", "Thermal conductivity of the medium."},
    {"fluid_density", &Convection::density, kNotNegative, "kg/m^3", "Density of the medium."},
    {"viscosity", &Convection::viscosity, kPositive, "Pa s", "Dynamic viscosity of the medium."},
    {"prandtl", &Convection::prandtl, kPositive, "", "Prandtl number of the medium."},
};

inline constexpr Setting<HeatSettings> kHeatTable[] = {
    // With a smaller specific heat, the temperature after a fast impact would overflow.
    {"specific_heat", &HeatSettings::specific_heat, between(1e-3, 1e12), "J/(kg K)", "Specific heat of the particles.",
     "", kMustBeGiven},
    {"ambient_temperature", &HeatSettings::ambient_temperature, kTemperature, "K",
     "Temperature of the medium, and of the surroundings that particles exchange radiation with."},
};

inline constexpr Setting<HeatSettings> kHeatFractionTable[] = {
    {"emissivity", &HeatSettings::emissivity, kFraction, "",
     "Heat that spheres radiate and absorb, divided by that of black bodies."},
    {"impact_fraction", &HeatSettings::impact_fraction, kFraction, "",
     "Fraction of the energy lost along the normal at impacts, by restitution, that heats the particle."},
    {"friction_fraction", &HeatSettings::friction_fraction, kFraction, "",
     "Fraction of the energy lost by friction, in impacts and in contact, that heats the particle."},
};

}  // namespace ricochet
