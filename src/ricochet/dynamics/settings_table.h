/// \file
/// Tables of the settings of heat, bodies and springs, see core/setting.h. Private to the library.
#pragma once

#include "ricochet/core/setting.h"
#include "ricochet/dynamics/driven_body.h"
#include "ricochet/dynamics/heat.h"
#include "ricochet/dynamics/springs.h"

namespace ricochet {

/// Settings of Convection, without the flow.
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

/// Settings of the initial motion of a body.
inline constexpr Setting<BodyDescription> kBodyMotionTable[] = {
    {"velocity", &BodyDescription::velocity, kSpeed, "m/s", "Velocity of the centre of mass of a free body at 0 s."},
    {"angular_velocity", &BodyDescription::angular_velocity, kSpeed, "rad/s",
     "Angular velocity of a free body at 0 s."},
    {"rate", &BodyDescription::rate, kSpeed, "rad/s or m/s",
     "Speed at 0 s: of the rotation on a hinge, by the right-hand rule, or of the motion along a slider."},
};

/// Settings of a joint, in the order in which the fingerprint reads them.
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

/// Settings of a spring, without its ends.
inline constexpr Setting<Spring> kSpringTable[] = {
    {"rest_length", &Spring::rest_length, kLengthOrZero, "m", "Length at which it neither pulls nor pushes.",
     "the distance of its ends at the start"},
    {"stiffness", &Spring::stiffness, kLengthOrZero, "N/m", "Force divided by stretch.", "", kMustBeGiven},
};

/// Settings of damping and breaking, for Spring, RopeSettings and ClothSettings. These structures have the same members
/// for them.
template <class Struct>
inline constexpr Setting<Struct> kDampingTable[] = {
    {"damping", &Struct::damping, kLengthOrZero, "N s/m",
     "Damping force of a spring divided by the rate of change of its length."},
    {"breaking_stretch", &Struct::breaking_stretch, kPositiveOrInfinite, "",
     "Stretch, as a fraction of the rest length, beyond which a spring breaks permanently.", "it never breaks"},
};

inline constexpr Setting<RopeSettings> kRopeEndsTable[] = {
    {"from", &RopeSettings::from, kCoordinate, "m", "Position of its first particle.", "", kMustBeGiven},
    {"to", &RopeSettings::to, kCoordinate, "m", "Position of its last particle.", "", kMustBeGiven},
};

inline constexpr Setting<RopeSettings> kRopeLengthTable[] = {
    {"length", &RopeSettings::length, kLength, "m",
     "Rest length. A rope longer than the distance of its ends starts as a catenary. A shorter rope starts "
     "straight and under tension.",
     "the distance of its ends"},
};

/// Settings of a rope, without the direction `sag`.
inline constexpr Setting<RopeSettings> kRopeTable[] = {
    {"mass", &RopeSettings::mass, kMass, "kg", "Total mass.", "", kMustBeGiven},
    {"radius", &RopeSettings::radius, kLengthOrZero, "m", "Radius of its particles."},
    {"stiffness", &RopeSettings::stiffness, kLengthOrZero, "N/m", "Stiffness of every segment."},
    {"axial_stiffness", &RopeSettings::axial_stiffness, kLengthOrZero, "N",
     "Stiffness E A of the material. The stiffness of a segment is this value divided by its rest length."},
};

/// Settings of cloth, without the mass per area. A scene can give the total mass instead.
inline constexpr Setting<ClothSettings> kClothTable[] = {
    {"radius", &ClothSettings::radius, kLengthOrZero, "m", "Radius of its particles."},
    {"stiffness", &ClothSettings::stiffness, kLengthOrZero, "N/m", "Stiffness of the springs along the edges.", "",
     kMustBeGiven},
    {"bending_stiffness", &ClothSettings::bending_stiffness, kLengthOrZero, "N/m",
     "Stiffness of the springs that resist bending. They join the corners across every edge between two triangles."},
};

}  // namespace ricochet
