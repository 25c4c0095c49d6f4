/// \file
/// Private to the library: tables of settings of heat and bodies, see core/setting.h.
#pragma once

#include "ricochet/core/setting.h"
#include "ricochet/dynamics/driven_body.h"
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

/// Initial motion of a body.
inline constexpr Setting<BodyDescription> kBodyMotionTable[] = {
    {"velocity", &BodyDescription::velocity, kSpeed, "m/s", "Velocity of the centre of mass of a free body at 0 s."},
    {"angular_velocity", &BodyDescription::angular_velocity, kSpeed, "rad/s",
     "Angular velocity of a free body at 0 s."},
    {"rate", &BodyDescription::rate, kSpeed, "rad/s or m/s",
     "Speed at 0 s: of the rotation on a hinge, by the right-hand rule, or of the motion along a slider."},
};

/// In the order of the fingerprint.
inline constexpr Setting<JointSettings> kJointTable[] = {
    {"spring", &JointSettings::spring, kNotNegative, "N m/rad or N/m",
     "Spring constant of a hinge or slider: moment or force towards `spring_rest`, per angle or distance from it."},
    {"spring_rest", &JointSettings::spring_rest, kAnyNumber, "rad or m",
     "Angle or offset at which the spring exerts no force. 0 is the pose at 0 s."},
    {"damping", &JointSettings::damping, kNotNegative, "N m s/rad or N s/m",
     "Damping of a hinge or slider: moment or force against the motion, per speed."},
    {"drive", &JointSettings::drive, kAnyNumber, "N m or N",
     "Constant moment about the axis of a hinge, or force along the axis of a slider."},
    {"friction", &JointSettings::friction, kNotNegative, "N m or N",
     "Dry friction of a hinge or slider: largest moment or force against the motion."},
    {"motor_rate", &JointSettings::motor_rate, kSpeed, "rad/s or m/s",
     "Target speed of a motor on the hinge or slider.", "", false, "motor_most"},
    {"motor_most", &JointSettings::motor_most, kNotNegative, "N m or N",
     "Largest moment or force of the motor. 0 means no motor."},
};

}  // namespace ricochet
