/// \file
/// The rigid contact problem of many solid spheres over one time step. The spheres touch each other and walls.
///
/// The spheres would have the velocities v at the end of the step without contact. The unknown contact impulses P
/// change them to v + sum(P / m). Each contact has a gap g at the start of the step, a normal n, and these conditions:
///
///     u_n + g / dt >= 0,  P_n >= 0,  one of the two 0      (so that gaps do not close beyond zero within the step)
///     |P_t| <= friction P_n,  against the slip u_t, if any
///     |moment| <= rolling friction P_n,  against the rolling, if any
///
/// u is the velocity of body a relative to b (or to the wall's material) at the contact, at the end of the step.
/// Contacts with an open gap are included, so that no spheres overlap at the end of the step.
///
/// Spheres can overlap slightly, because the sweeps end before full convergence. A step removes the fraction
/// kOverlapRelease of an overlap. Gaps are measured anew in every step, so errors do not add up. Spheres keep the speed
/// at which an overlap is separated. This speed is therefore limited, so that deep overlaps separate slowly even in
/// short steps.
///
/// Restitution: contacts with P_n > 0 join spheres to connected impacts. A contact that had an impulse in the last step
/// is not a new impact, so its restitution is 0. A connected impact has one restitution e, the smallest of its
/// approaching contacts. This minimum ignores a contact of restitution 0 whose impulse only supports a body
/// (kSupportImpulseRatio). The contacts of the impact then separate with u_n >= -e u_n-, where u_n- is the value before
/// the impulses. A separate restitution for each contact would multiply energy.
///
/// The impulses never add kinetic energy in the frame of the walls, apart from the work that separates overlaps. If the
/// rebounds of a connected impact would add energy, the rebounds are suppressed.
///
/// Sources: J. J. Moreau, "Unilateral contact and dry friction in finite freedom dynamics", CISM 302 (1988), and
/// M. Jean, "The non-smooth contact dynamics method", Comput. Methods Appl. Mech. Engrg. 177 (1999), for time stepping
/// and for sweeps over contacts; H. Mazhar, T. Heyn, D. Negrut, A. Tasora, "Using Nesterov's method to accelerate
/// multibody dynamics with friction and contact", ACM Trans. Graphics 34 (2015), and B. O'Donoghue, E. Candes,
/// "Adaptive restart for accelerated gradient schemes", Found. Comput. Math. 15 (2015), for their acceleration.
#pragma once

#include <cstdint>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// A solid sphere, or a point (radius 0, which does not spin).
struct SolverBody {
    Vec3 velocity;                 ///< in m/s, at the end of the step; solving adds the contact impulses
    Vec3 spin;                     ///< in rad/s, likewise
    double inverse_mass = 1.0;     ///< in 1/kg; 0 for a fixed body
    double inverse_inertia = 0.0;  ///< in 1/(kg m^2)
    double radius = 0.0;           ///< in m
};

/// Impulse of a contact on its body a. Body b receives the opposite impulse.
struct SolverImpulse {
    double normal = 0.0;  ///< in N s, >= 0
    Vec3 tangential;      ///< friction, in N s
    Vec3 moment;          ///< rolling resistance, in N m s

    friend bool operator==(const SolverImpulse&, const SolverImpulse&) = default;
};

/// A contact of two bodies, or of a body and a wall.
struct SolverContact {
    static constexpr std::uint32_t kWall = 0xFFFFFFFFU;

    std::uint32_t a = 0;
    std::uint32_t b = kWall;         ///< another body, or a wall
    Vec3 normal;                     ///< unit, towards a
    double gap = 0.0;                ///< in m, at the start of the step; negative for an overlap
    Vec3 wall_velocity;              ///< velocity of the wall's material at the contact, in m/s
    Vec3 wall_turning;               ///< angular velocity of the wall's material, in rad/s
    double friction = 0.0;           ///< Coulomb's coefficient
    double rolling_friction = 0.0;   ///< moment over normal force, in m
    double restitution = 0.0;        ///< 0..1
    double most_parting = INFINITY;  ///< largest speed at which an overlap is separated, in m/s
    double exactness = 1.0;          ///< >= 1; divides the tolerances of this contact
    bool touched = false;            ///< true if it already pressed in the last step
    SolverImpulse start;             ///< start value: its impulse in the last step
};

/// Conditions that end the solver: all contacts are within `tolerance`, or within `enough` after `sweeps` sweeps, or
/// `most_sweeps` are made. Tolerances are velocities, in m/s, by which contact conditions may be violated.
struct SolverSettings {
    double duration = 1.0;     ///< duration of the step, in s
    double tolerance = 1e-12;  ///< the solver ends after any sweep that meets it
    double enough = 0.0;       ///< the solver ends after `sweeps` sweeps if this is met
    double slip = 0.0;         ///< replaces smaller tolerances for slip and rolling, because they cause no overlap
    double connecting = 0.0;   ///< replaces a smaller `tolerance` while only connected impacts are found
    int sweeps = 10000;
    int most_sweeps = 10000;
};

/// Result of the solver.
struct SolverReport {
    int sweeps = 0;
    double residual = 0.0;       ///< largest violation of a contact condition, in m/s
    bool is_converged = true;    ///< true if the residual is within `tolerance` or `enough`
    double energy_change = 0.0;  ///< by the impulses, in the frame of each contact's wall, in J
};

}  // namespace ricochet
