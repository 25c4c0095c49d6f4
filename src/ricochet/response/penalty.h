/// \file
/// The penalty response: particles may enter surfaces, and a spring and damper push them out again.
///
/// Source: P. A. Cundall, O. D. L. Strack, "A discrete numerical model for granular assemblies", Geotechnique 29, 1979
/// (linear spring and dashpot, Coulomb friction); M. Moore, J. Wilhelms, "Collision detection and response for computer
/// animation", SIGGRAPH 1988 (penalty springs). Damping from restitution: T. Schwager, T. Poeschel, "Coefficient of
/// restitution and linear-dashpot model revisited", Granular Matter 9, 2007, for contacts that end when the force would
/// begin to pull. Stability: T. Belytschko, W. K. Liu, B. Moran, "Nonlinear Finite Elements for Continua and
/// Structures", section 6.2 (central differences with lagging damping).
///
/// The force on a particle at depth d is max(0, k d + c d') along the normal. Friction mu N acts against the slip; it
/// grows linearly up to PenaltySettings::friction_speed. No braking force exceeds the force that stops its motion in
/// one sub-step. The scene's integrator uses the contact force as part of the acceleration, in sub-steps. The
/// integrator `ballistic`, which keeps forces constant over a step, is replaced by velocity Verlet. On surfaces that
/// absorb or reflect diffusely, the start of a contact is resolved as an impact.
///
/// Limits:
/// - Particles enter surfaces. The depth is m g / k under weight, and v sqrt(m / k) in an impact.
/// - Particles may pass through a wall that is thinner than twice that depth, or thinner than the path of a sub-step. A
///   particle deeper than the middle of a wall is pushed out on the far side.
/// - Restitution does not decrease at low approach speeds: Material::restitution_threshold is not used.
/// - The errors of restitution and friction are inversely proportional to the number of sub-steps per contact. If no
///   stiffness is given, this number does not grow as steps become shorter.
/// - Sub-steps beyond longest_stable_step() are not stable. `midpoint` is never stable, because it adds energy to
///   springs without damping.
/// - Particles at rest on slopes creep, because friction needs slip. Friction oscillates if it changes the velocity in
///   a sub-step by mu g h > 2 friction_speed.
/// - Restitution is at least kMinPenaltyRestitution.
/// - Several walls of one collider do not act at the same time, because each collider pushes only from its nearest
///   point.
#pragma once

#include "ricochet/response/contact_motion.h"
#include "ricochet/response/side_watch.h"

namespace ricochet {

/// A linear spring and damper.
struct ContactSpring {
    double stiffness = 0.0;  ///< N/m
    double damping = 0.0;    ///< kg/s
};

/// Returns the damping, divided by 2 sqrt(k m), of a contact with the restitution e. The contact ends when its force
/// would begin to pull (Schwager and Poeschel 2007). e in [0, 1]; kMinPenaltyRestitution replaces smaller values.
[[nodiscard]] double damping_ratio(double restitution);
/// Returns the restitution of a damping ratio >= 0: the inverse of damping_ratio().
[[nodiscard]] double restitution_of_damping(double ratio);

/// Returns the spring constant, in N/m, for a mass, in kg: the scene's, or by PenaltySettings::contact_steps.
[[nodiscard]] double contact_stiffness(const ResponseSettings& settings, double mass);
/// Returns the spring and damper for a particle of mass m, in kg, on a surface of restitution e.
[[nodiscard]] ContactSpring contact_spring(const ResponseSettings& settings, double mass, double restitution);

/// Returns the longest stable sub-step, in s, of a spring and damper on mass m: 2 / omega (sqrt(1 + zeta^2) - zeta).
[[nodiscard]] double longest_stable_step(const ContactSpring& spring, double mass);

/// Input of force_of(): one contact.
struct PenaltyContact {
    double depth = 0.0;  ///< m, > 0
    Vec3 normal;         ///< unit, outwards
    double stiffness = 0.0;
    double damping = 0.0;
    double friction = 0.0;
    double rolling_friction = 0.0;
    double spinning_friction = 0.0;  ///< m
    double mass = 1.0;               ///< kg, of the particle
    Vec3 velocity{};                 ///< m/s, of the surface's material, see SurfaceMotion
    Vec3 angular_velocity{};         ///< rad/s, of the surface's material
};

/// Force of one contact on the particle, in N.
struct ContactForce {
    Vec3 force;
    Vec3 torque;  ///< N m
};

/// Limits of the force laws.
struct ContactLimits {
    double friction_speed = 1e-3;  ///< m/s, slip speed up to which friction grows linearly
    double step = 0.0;             ///< s, duration for which the integrator uses the force
};

/// Returns the force of a contact: max(0, k d + c d') along the normal, friction against the slip, moments against
/// rolling and spinning. The damper, friction and the moments at most stop their motion within the step. Otherwise, an
/// explicit step would reverse the motion and add energy.
[[nodiscard]] ContactForce force_of(const PenaltyContact& contact, const Motion& motion, double radius,
                                    const ContactLimits& limits);

/// See the top of this file.
class PenaltyResponse final : public SidedResponse {
public:
    explicit PenaltyResponse(const ResponseRules& rules);

    MoveOutcome move(MovingParticle& particle, double duration, MoveScratch& scratch) const override;
    [[nodiscard]] SupportedAcceleration supported_acceleration(const MovingParticle& particle,
                                                               const Vec3& pull) const override;

private:
    std::vector<double> damping_ratios_;  ///< one per material
};

}  // namespace ricochet
