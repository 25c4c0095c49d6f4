/// \file
/// Tables of materials and of response settings, see core/setting.h.
#pragma once

#include "ricochet/core/setting.h"
#include "ricochet/response/material.h"
#include "ricochet/response/settings.h"

namespace ricochet {

inline constexpr Setting<SurfaceMotion> kSurfaceMotionTable[] = {
    {"velocity", &SurfaceMotion::velocity, kSpeed, "m/s", "Uniform velocity."},
    {"angular_velocity", &SurfaceMotion::angular_velocity, kSpeed, "rad/s",
     "Rotation by the right-hand rule about an axis through `center`, added to `velocity`."},
    {"center", &SurfaceMotion::center, kCoordinate, "m", "A point on the axis, in world coordinates."},
};

/// All members except the name, and those in tables of their own: the motion, and the laws of impacts.
inline constexpr Setting<Material> kMaterialTable[] = {
    {"restitution", &Material::restitution, kFraction, "",
     "Rebound speed divided by approach speed, along the normal."},
    {"restitution_threshold", &Material::restitution_threshold, kNotNegative, "m/s",
     "Approach speed below which the restitution falls linearly to 0."},
    {"friction", &Material::friction, kNotNegative, "", "Coulomb coefficient, for impacts and sliding."},
    {"rolling_friction", &Material::rolling_friction, kNotNegative, "",
     "Moment that resists rolling, divided by radius times normal force. For particles with a radius."},
    {"spinning_friction", &Material::spinning_friction, kLengthOrZero, "m",
     "Moment that resists spinning about the normal, divided by normal force. For particles with a radius."},
    {"diffuse", &Material::diffuse, kFraction, "",
     "Accommodation: fraction of the impacts that reflect by the cosine law."},
    {"wall_temperature", &Material::wall_temperature, kPositive, "K",
     "Temperature of the wall. Diffuse reflections leave with its thermal speeds.",
     "diffuse reflections keep their impact speed"},
    {"absorption", &Material::absorption, kFraction, "", "Fraction of the impacts that remove the particle."},
};

/// How the coefficients of impacts depend on the slip and the speed, for Material, PairMaterial and
/// PairContactSettings.
template <class Struct>
inline constexpr Setting<Struct> kImpactLawTable[] = {
    {"tangential_restitution", &Struct::tangential_restitution, kFraction, "",
     "Share of the slip velocity that a sticking impact reverses (Walton's third parameter). Needs friction."},
    {"restitution_speed", &Struct::restitution_speed, kPositive, "m/s",
     "Approach speed above which the restitution falls as a power of the approach speed.",
     "the restitution does not fall"},
    {"restitution_exponent", &Struct::restitution_exponent, kFraction, "",
     "The restitution is proportional to (approach speed)^-exponent above `restitution_speed`.", "", false,
     "restitution_speed"},
};

/// Laws of impacts that only surfaces have.
inline constexpr Setting<Material> kSurfaceLawTable[] = {
    {"static_friction", &Material::static_friction, kNotNegative, "",
     "Coulomb coefficient of a contact that sticks, at least `friction`. The contact then slips with `friction`.",
     "the same as `friction`"},
    {"tangential_factor", &Material::tangential_factor, kFraction, "",
     "Factor of each impact on the tangential velocity of the centre, for lumped masses (rockfall). The spin does not "
     "change."},
};

/// Contact between two spheres, for PairMaterial and PairContactSettings, which have the same members.
template <class Struct>
inline constexpr Setting<Struct> kSphereContactTable[] = {
    {"restitution", &Struct::restitution, kFraction, "",
     "Separation speed divided by approach speed, along the normal."},
    {"friction", &Struct::friction, kNotNegative, "", "Coulomb coefficient between spheres."},
    {"rolling_friction", &Struct::rolling_friction, kNotNegative, "",
     "Moment that resists relative rotation, divided by reduced radius times normal impulse."},
};

inline constexpr Setting<ImpactTableRow> kImpactTableRowTable[] = {
    {"speed", &ImpactTableRow::speed, kNotNegative, "m/s", "Impact speed, relative to the surface."},
    {"angle", &ImpactTableRow::angle, between(0.0, 90.0), "degrees", "Angle of impact, from the normal."},
    {"restitution", &ImpactTableRow::restitution, kFraction, "", "Restitution at this speed and angle.", "",
     kMustBeGiven},
    {"tangential_restitution", &ImpactTableRow::tangential_restitution, kFraction, "",
     "Tangential restitution at this speed and angle.", "the value of the material"},
    {"tangential_factor", &ImpactTableRow::tangential_factor, kFraction, "",
     "Tangential factor at this speed and angle.", "the value of the material"},
};

inline constexpr Setting<PairContactSettings> kPairBudgetTable[] = {
    {"impact_budget", &PairContactSettings::impact_budget, kCountFromOne, "",
     "Largest number of impacts of one sphere on others in one step. If a sphere spends the budget, all contacts of "
     "its island are resolved together for the rest of the step. With the method `events` the sphere stops instead, "
     "and the omitted time is counted."},
};

inline constexpr Setting<ErrorTolerance> kToleranceTable[] = {
    {"position", &ErrorTolerance::position, between(kSmallestTolerance, kLargestCoordinate), "m",
     "Error of the position, also between the ends of a sub-step."},
    {"velocity", &ErrorTolerance::velocity, between(kSmallestTolerance, kLargestCoordinate), "m/s",
     "Error of the velocity."},
};

inline constexpr Setting<RollbackSettings> kRollbackTable[] = {
    {"time_tolerance", &RollbackSettings::time_tolerance, kPositive, "s",
     "Largest error of the time of contact, which bisection brackets."},
    {"global", &RollbackSettings::global, kAnyNumber, "",
     "true: the whole system goes back to the earliest contact, as in textbooks. Costs grow with particles "
     "times contacts. false: each particle goes back by itself."},
};

inline constexpr Setting<ProjectSettings> kProjectTable[] = {
    {"offset", &ProjectSettings::offset, kLength, "m",
     "Thickness of the contact layer on surfaces. A particle in the layer is in contact and is moved to its "
     "top."},
};

inline constexpr Setting<PenaltySettings> kPenaltyTable[] = {
    {"stiffness", &PenaltySettings::stiffness, kPositive, "N/m", "Spring constant of contacts.",
     "a value for each particle: an undamped contact lasts `contact_steps` sub-steps"},
    {"contact_steps", &PenaltySettings::contact_steps, kPositive, "",
     "Duration of an undamped contact, in sub-steps, if no stiffness is given."},
    {"substeps", &PenaltySettings::substeps, between(1.0, 1e6), "", "Number of equal sub-steps in every step."},
    {"friction_speed", &PenaltySettings::friction_speed, kPositive, "m/s",
     "Slip speed up to which friction grows linearly."},
};

}  // namespace ricochet
