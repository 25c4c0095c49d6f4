/// \file
/// Private to the responses: how several surfaces at once hold what is pressed onto them.
#pragma once

#include <array>
#include <span>

#include "ricochet/response/contact_motion.h"

namespace ricochet {

/// True when a velocity leaves a surface of unit normal n, by more than rounding: it does not hold then.
[[nodiscard]] bool leaves(const Vec3& velocity, const Vec3& n);

/// plan_interval() for two surfaces or more: one contact problem for the forces, and the time until slip or rolling at
/// one of them comes to an end, or friction has turned. At most kMostHolding surfaces count. stuck: where slip and
/// turning are an error of the motion that is given, and count as none.
[[nodiscard]] ContactInterval plan_held_interval(const Motion& motion, double radius, const Vec3& a,
                                                 std::span<const HoldingSurface> surfaces, const Grip& grip,
                                                 double duration, const std::array<Stuck, kMostHolding>& stuck = {});

/// The vector nearest to v that is at right angles to all normals.
[[nodiscard]] Vec3 along_all(const Vec3& v, std::span<const Vec3> normals);

/// The shortest vector d with d . n = distance for every normal and its distance; normals that depend on those before
/// them do not count.
[[nodiscard]] Vec3 shift_by(std::span<const Vec3> normals, std::span<const double> distances);

/// The motion nearest to the given one (in energy) that is along all surfaces, and slips and turns on none where
/// `stuck` says so.
[[nodiscard]] Motion along_surfaces(const Motion& motion, double radius, std::span<const HoldingSurface> surfaces,
                                    const std::array<Stuck, kMostHolding>& stuck);

}  // namespace ricochet
