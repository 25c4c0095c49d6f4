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
/// The force on a particle at depth d: max(0, k d + c d') along the normal, and friction mu N against the slip, which
/// grows linearly up to PenaltySettings::friction_speed. What brakes is at most what stops its motion in one sub-step.
/// It is part of the acceleration that the scene's integrator steps with, in sub-steps; `ballistic`, which holds forces
/// over a step, becomes velocity Verlet, the same parabola wherever the force is constant. Surfaces that absorb or
/// reflect diffusely answer the beginning of a contact at once.
///
/// What it does not guarantee: that particles stay out (the depth under weight is m g / k, in an impact v sqrt(m / k));
/// that a wall holds that is thinner than twice that (what is deeper than its middle is pushed out on the far side) or
/// than a sub-step is long; that restitution falls below a threshold (Material::restitution_threshold is not used);
/// restitution and friction to better than the first order in sub-steps per contact, which without a stiffness do not
/// grow as steps shrink; stability beyond longest_stable_step(), for `midpoint`, which feeds springs without damping,
/// none at all; rest without creep on slopes (friction needs slip, and shakes where a sub-step's friction, mu g h,
/// exceeds 2 friction_speed); restitution below kMinPenaltyRestitution; that walls of one collider are felt together
/// (each collider pushes from its nearest point only).
#pragma once

#include "ricochet/collision/signed_distance.h"
#include "ricochet/response/contact_motion.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// A linear spring and damper.
struct ContactSpring {
    double stiffness = 0.0;  ///< N/m
    double damping = 0.0;    ///< kg/s
};

/// Damping over 2 sqrt(k m) with which a contact that ends when the force would begin to pull has the restitution e
/// (Schwager and Poeschel 2007). e in [0, 1]; below kMinPenaltyRestitution that value counts.
[[nodiscard]] double damping_ratio(double restitution);
/// The inverse: restitution of a damping ratio >= 0.
[[nodiscard]] double restitution_of_damping(double ratio);

/// Spring constant, N/m, for a particle of mass m, kg: the scene's, or that of PenaltySettings::contact_steps.
[[nodiscard]] double contact_stiffness(const ResponseSettings& settings, double mass);
/// The spring and damper of a particle of mass m, kg, on a surface of restitution e.
[[nodiscard]] ContactSpring contact_spring(const ResponseSettings& settings, double mass, double restitution);

/// Longest stable sub-step, s, of a spring and damper on mass m: 2 / omega (sqrt(1 + zeta^2) - zeta).
[[nodiscard]] double longest_stable_step(const ContactSpring& spring, double mass);

/// A contact as a force sees it.
struct PenaltyContact {
    double depth = 0.0;  ///< m, > 0
    Vec3 normal;         ///< unit, outwards
    double stiffness = 0.0;
    double damping = 0.0;
    double friction = 0.0;
    double rolling_friction = 0.0;
    double spinning_friction = 0.0;  ///< m
    double mass = 1.0;               ///< kg, of the particle
    Vec3 velocity{};                 ///< m/s, of the surface's own material, see SurfaceMotion
    Vec3 angular_velocity{};         ///< rad/s, of the same
};

/// Force of one contact, N, on the particle.
struct ContactForce {
    Vec3 force;
    Vec3 torque;  ///< N m
};

/// Where the laws are cut off.
struct ContactLimits {
    double friction_speed = 1e-3;  ///< m/s, up to which friction grows linearly
    double step = 0.0;             ///< s that the integrator takes the force for
};

/// max(0, k d + c d') along the normal, friction against the slip, moments against rolling and spinning. What brakes
/// (the damper, friction, the moments) is at most what stops its motion within the step: an explicit step would turn it
/// round, and make energy.
[[nodiscard]] ContactForce force_of(const PenaltyContact& contact, const Motion& motion, double radius,
                                    const ContactLimits& limits);

/// See the top of this file.
class PenaltyResponse final : public Response {
public:
    explicit PenaltyResponse(const ResponseRules& rules);

    MoveOutcome move(MovingParticle& particle, double duration, MoveScratch& scratch) const override;
    [[nodiscard]] SupportedAcceleration supported_acceleration(const MovingParticle& particle,
                                                               const Vec3& pull) const override;
    [[nodiscard]] bool keeps_sides() const override { return true; }
    void first_sides(const Vec3& position, std::span<SideMemory> sides) const override;
    void inherit_sides(const ChildStart& start, std::span<SideMemory> sides) const override;

private:
    SignedDistance distance_;
    std::vector<double> damping_ratios_;  ///< one a material
};

}  // namespace ricochet
