/// \file
/// The surfaces that support a particle, and projections of its motion along them. Pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "ricochet/core/vec3.h"
#include "ricochet/response/contact_motion.h"

namespace ricochet {

/// Largest number of surfaces that support a particle at one time.
inline constexpr std::size_t kMostSupports = 3;

struct SurfaceMotion;

/// A surface that supports a particle.
struct SupportSurface {
    Vec3 normal;                     ///< unit, towards the particle
    double friction = 0.0;           ///< Coulomb coefficient
    double rolling_friction = 0.0;   ///< see Material
    double spinning_friction = 0.0;  ///< m, see Material
    /// Velocity of the surface's material at the contact, along the surface, in m/s, for slip, and angular velocity, in
    /// rad/s, for rolling and spinning. Both are 0 if the surface does not grip.
    Vec3 velocity{};
    Vec3 angular_velocity{};
    const SurfaceMotion* motion = nullptr;  ///< velocity at other positions; null if it is 0 everywhere
    /// Accelerations, in m/s^2, that the surface's curvature adds because the normal turns. `curvature` changes the
    /// distance. `slip_curvature` changes the slip and contains the change of `velocity`. `turning_curvature` and
    /// `spinning_curvature` change radius times angular velocity, along the surface and about its normal.
    double curvature = 0.0;
    Vec3 slip_curvature{};
    Vec3 turning_curvature{};
    double spinning_curvature = 0.0;
    double static_friction = 0.0;  ///< Coulomb coefficient of a contact that sticks; `friction` if that is larger
};

/// Kinds of relative motion at a surface that friction prevents.
struct Stuck {
    bool to_slip = false;
    bool to_turning = false;   ///< rolling friction prevents rolling
    bool to_spinning = false;  ///< spinning friction prevents spinning about the normal
};
using StuckSurfaces = std::array<Stuck, kMostSupports>;

/// Returns the slip of a motion relative to the surface's material, see slip_velocity().
[[nodiscard]] inline Vec3 slip_on(const SupportSurface& surface, const Motion& motion, double radius) {
    return slip_velocity(motion, radius, surface.normal) - surface.velocity;
}

/// Returns the surfaces with friction on which a motion slips no faster than `slow`, in m/s.
[[nodiscard]] StuckSurfaces sticking_surfaces(const Motion& motion, double radius,
                                              std::span<const SupportSurface> surfaces, double slow);

/// Returns the sum of the speeds that contribute to slip, rolling and spinning on these surfaces, in m/s. A speed that
/// is small compared with this sum counts as zero.
[[nodiscard]] double speed_scale(const Motion& motion, double radius, std::span<const SupportSurface> surfaces);

/// Returns the vector nearest to v that is perpendicular to all normals.
[[nodiscard]] Vec3 along_all(const Vec3& v, std::span<const Vec3> normals);

/// The shortest displacement, in m, that moves a point along every normal by the distance given for that normal. Also
/// used for velocities and accelerations. Normals that depend on earlier ones are ignored.
class ShortestShift {
public:
    void add(const Vec3& normal, double distance);
    /// Returns true if nothing has been added.
    [[nodiscard]] bool is_empty() const { return is_empty_; }
    [[nodiscard]] const Vec3& vector() const { return shift_; }

private:
    std::array<Vec3, 3> basis_;
    std::array<double, 3> parts_{};  ///< components of the vector along the basis
    std::size_t count_ = 0;          ///< of the basis
    bool is_empty_ = true;
    Vec3 shift_;
};

/// Returns the motion along all surfaces that differs from the given motion by the least kinetic energy. It does not
/// slip, roll or spin on a surface where `stuck` prevents that. braked_from: an earlier speed of the motion, in m/s. A
/// result within the rounding error of this speed is replaced by zero.
[[nodiscard]] Motion along_surfaces(const Motion& motion, double radius, std::span<const SupportSurface> surfaces,
                                    const StuckSurfaces& stuck, double braked_from = 0.0);

/// Returns twice the kinetic energy, divided by the mass, of a solid sphere, or a point (radius 0), in m^2/s^2.
[[nodiscard]] double twice_kinetic(const Motion& motion, double radius);

/// Slows a motion whose twice_kinetic() exceeds `most`, in m^2/s^2. Surfaces add no energy, so an excess beyond the
/// rounding of positions is an error of the method. offset: work of the forces over a contact offset, in m^2/s^2.
void limit_energy(Motion& motion, double radius, double most, double offset);

}  // namespace ricochet
