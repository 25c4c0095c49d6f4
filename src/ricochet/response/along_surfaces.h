/// \file
/// Private to the responses: the surfaces that hold a particle, and what they leave of its motion. Pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "ricochet/core/vec3.h"
#include "ricochet/response/contact_motion.h"

namespace ricochet {

/// Surfaces that hold a particle at one time, at most.
inline constexpr std::size_t kMostSupports = 3;

struct SurfaceMotion;

/// A surface that holds a particle.
struct SupportSurface {
    Vec3 normal;                     ///< unit, towards the particle
    double friction = 0.0;           ///< Coulomb coefficient
    double rolling_friction = 0.0;   ///< see Material
    double spinning_friction = 0.0;  ///< m, see Material
    /// Of the surface's own material, at the contact and along the surface, m/s: slip is relative to it; and of its
    /// turning, rad/s: so are rolling and spinning. 0 where the surface does not grip.
    Vec3 velocity{};
    Vec3 angular_velocity{};
    const SurfaceMotion* motion = nullptr;  ///< what says the velocity elsewhere; null where it is 0 everywhere
    /// What the surface's curvature adds to the rates, m/s^2: of the distance, and of the slip; and to those of radius
    /// times angular velocity, along the surface and about its normal, since the normal turns. The change of `velocity`
    /// is part of that of the slip.
    double curvature = 0.0;
    Vec3 slip_curvature{};
    Vec3 turning_curvature{};
    double spinning_curvature = 0.0;
};

/// What does not move at a surface.
struct Stuck {
    bool to_slip = false;
    bool to_turning = false;   ///< resistance to rolling holds it
    bool to_spinning = false;  ///< resistance to spinning about the normal holds it
};
using StuckSurfaces = std::array<Stuck, kMostSupports>;

/// The slip of a motion on a surface, see slip_velocity(): relative to the surface's material.
[[nodiscard]] inline Vec3 slip_on(const SupportSurface& surface, const Motion& motion, double radius) {
    return slip_velocity(motion, radius, surface.normal) - surface.velocity;
}

/// The speeds that slips, rolling and spinning on these surfaces are made of, m/s: what is small next to it is none.
[[nodiscard]] double speed_scale(const Motion& motion, double radius, std::span<const SupportSurface> surfaces);

/// The vector nearest to v that is at right angles to all normals.
[[nodiscard]] Vec3 along_all(const Vec3& v, std::span<const Vec3> normals);

/// The shortest vector d with d . n = distance for every normal and its distance; normals that depend on those before
/// them do not count.
[[nodiscard]] Vec3 shift_by(std::span<const Vec3> normals, std::span<const double> distances);

/// The motion nearest to the given one (in energy) that is along all surfaces, and slips and turns on none where
/// `stuck` says so.
/// braked_from: m/s, a speed that the motion had before, whose rounding is no motion.
[[nodiscard]] Motion along_surfaces(const Motion& motion, double radius, std::span<const SupportSurface> surfaces,
                                    const StuckSurfaces& stuck, double braked_from = 0.0);

/// Twice the kinetic energy over the mass of a solid sphere, or a point (radius 0), m^2/s^2.
[[nodiscard]] double twice_kinetic(const Motion& motion, double radius);

/// Surfaces give no energy, whatever the error of a method: slows a motion that has more than `most` of it (twice, over
/// the mass). What positions are rounded by says nothing: offset is what forces do over a contact offset, m^2/s^2.
void limit_energy(Motion& motion, double radius, double most, double offset);

}  // namespace ricochet
