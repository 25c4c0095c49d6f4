/// \file
/// Private to the responses: many solid spheres that touch each other and walls, as one problem of rigid contact over a
/// time step.
///
/// With the velocities v that spheres would have at the end of the step without contact, the impulses P of the contacts
/// change them to v + sum(P / m), and for each contact of gap g (at the begin of the step) and normal n
///
///     u_n + g / dt >= 0,  P_n >= 0,  one of the two 0      (so that gaps do not close beyond zero within the step)
///     |P_t| <= friction P_n,  against the slip u_t where there is any
///     |moment| <= rolling friction P_n,  against the rolling where there is any
///
/// u is the velocity of a relative to b (or to the wall's material) at the contact, at the end of the step. A contact
/// that is not closed yet takes part with what is left of its gap, so that nothing overlaps at the end. Where spheres
/// overlap (sweeps end before the last digit) they part by kOverlapRelease of that: gaps are measured anew in every
/// step, so that errors do not add up. They keep the speed with which they part, and so that is limited: deep overlaps
/// part slowly, however short steps are.
///
/// Restitution: contacts with P_n > 0 join spheres to connected impacts. Each has one restitution e, the smallest of
/// its approaching contacts, 0 for those that touched before (they press, and are no impacts); its contacts then leave
/// with u_n >= -e u_n-, u_n- that before the impulses. Restitution contact by contact multiplies energy. The impulses
/// never add kinetic energy, in the frame of the walls, but for the work that parts what overlaps; where a rebound
/// would add some, there is none.
///
/// Sources: J. J. Moreau, "Unilateral contact and dry friction in finite freedom dynamics", CISM 302 (1988), and
/// M. Jean, "The non-smooth contact dynamics method", Comput. Methods Appl. Mech. Engrg. 177 (1999), for time stepping
/// and for sweeps over contacts; H. Mazhar, T. Heyn, D. Negrut, A. Tasora, "Using Nesterov's method to accelerate
/// multibody dynamics with friction and contact", ACM Trans. Graphics 34 (2015), and B. O'Donoghue, E. Candes,
/// "Adaptive restart for accelerated gradient schemes", Found. Comput. Math. 15 (2015), for their acceleration.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// A solid sphere, or a point (radius 0, which does not spin).
struct SolverBody {
    Vec3 velocity;                 ///< m/s, at the end of the step without contact; after solving, with it
    Vec3 spin;                     ///< rad/s, likewise
    double inverse_mass = 1.0;     ///< 1/kg; 0: nothing moves it
    double inverse_inertia = 0.0;  ///< 1/(kg m^2)
    double radius = 0.0;           ///< m
};

/// What a contact does to its body a; b gets the opposite.
struct SolverImpulse {
    double normal = 0.0;  ///< N s, >= 0
    Vec3 tangential;      ///< N s, of friction
    Vec3 moment;          ///< N m s, that resists rolling

    friend bool operator==(const SolverImpulse&, const SolverImpulse&) = default;
};

/// A contact of two bodies, or of one with a wall.
struct SolverContact {
    static constexpr std::uint32_t kWall = 0xFFFFFFFFU;

    std::uint32_t a = 0;
    std::uint32_t b = kWall;        ///< another body, or a wall
    Vec3 normal;                    ///< unit, towards a
    double gap = 0.0;               ///< m, at the begin of the step; < 0: they overlap
    Vec3 wall_velocity;             ///< m/s, of the wall's material at the contact
    Vec3 wall_turning;              ///< rad/s, of the wall's material
    double friction = 0.0;          ///< Coulomb's coefficient
    double rolling_friction = 0.0;  ///< m, moment over normal force
    double restitution = 0.0;       ///< 0..1
    double most_parting =
        INFINITY;            ///< m/s, speed with which what overlaps is parted at most, beside what sweeps leave
    double exactness = 1.0;  ///< >= 1: of the tolerances it may use only a part, 1 over this
    bool touched = false;    ///< it was closed at the begin of the step already
    SolverImpulse start;     ///< what it did in the last step, to begin with
};

/// When the solver ends: when the conditions are met to the tolerance; or after `sweeps` of them, when they are met to
/// `enough`; or after `most_sweeps`.
struct SolverSettings {
    double duration = 1.0;     ///< s, of the step
    double tolerance = 1e-12;  ///< m/s, velocity by which the conditions may be violated
    double enough = 0.0;       ///< m/s, the same
    double slip = 0.0;         ///< m/s, the same of slip and rolling, where it is more: they lead to no overlap
    double connecting = 0.0;   ///< m/s, the same of the impact without rebound, where it only says what is connected
    int sweeps = 10000;
    int most_sweeps = 10000;
};

/// How well it went.
struct SolverReport {
    int sweeps = 0;
    double residual = 0.0;       ///< m/s, largest velocity by which the conditions are violated
    bool is_converged = true;    ///< it is within the tolerance, or is enough
    double energy_change = 0.0;  ///< J, by the impulses, in the frame of each contact's wall
};

}  // namespace ricochet
