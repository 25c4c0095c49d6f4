/// \file
/// Every tolerance that decides the motion of particles and bodies, with its unit, its reason, and the effect of a
/// change. "Smaller" and "Larger" name the effect of a smaller and of a larger value.
///
/// No tolerance decides whether a particle crosses a surface, because exact predicates decide that.
///
/// A constant elsewhere that resembles a tolerance has a comment that says why it is local. Most of these are error
/// bounds beside the arithmetic that they bound, limits of a search whose result is checked, and limits of input
/// values. The settings of a run are in response/settings.h, and the settings of the contact solvers in
/// response/contact_solver/contact_network.h.
#pragma once

#include "ricochet/core/tolerances/broad_phase.h"
#include "ricochet/core/tolerances/contact.h"
#include "ricochet/core/tolerances/contact_arcs.h"
#include "ricochet/core/tolerances/contact_forces.h"
#include "ricochet/core/tolerances/contact_network.h"
#include "ricochet/core/tolerances/driven_bodies.h"
#include "ricochet/core/tolerances/dynamics.h"
#include "ricochet/core/tolerances/moving_colliders.h"
#include "ricochet/core/tolerances/narrow_phase.h"
#include "ricochet/core/tolerances/safe_positions.h"
#include "ricochet/core/tolerances/sleep.h"
#include "ricochet/core/tolerances/sphere_impacts.h"
