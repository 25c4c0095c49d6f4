/// \file
/// A rigid body that is moved by forces and impulses. The body is free, or moves on an axis or a straight guide that is
/// fixed in the world.
///
/// The spring and damper of a joint are integrated in closed form. For all other forces the acceleration varies
/// linearly over the step, a method of second order (N. M. Newmark, "A method of computation for structural dynamics",
/// J. Eng. Mech. Div. ASCE 85, 1959). A free body conserves its angular momentum to rounding. It turns with the angular
/// velocity in the middle of the step (S. R. Buss, J. Comput. Phys. 164, 2000).
#pragma once

#include <string>

#include "ricochet/core/body_path.h"
#include "ricochet/core/mobility.h"
#include "ricochet/core/symmetric_matrix.h"
#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/forces.h"

namespace ricochet {

/// Kind of joint between a body and the world.
enum class JointKind {
    free,    ///< no joint
    hinge,   ///< the body turns about an axis through the frame's origin
    slider,  ///< the body moves along an axis without turning
};

/// Forces between a body on a joint and the world. Units apply to a hinge; units in parentheses apply to a slider. The
/// coordinate is an angle in rad (a displacement in m). It is 0 at the start position of the body.
struct JointSettings {
    double spring = 0.0;       ///< stiffness of the spring, in N m/rad (N/m), >= 0
    double spring_rest = 0.0;  ///< rest coordinate of the spring, in rad (m)
    double damping = 0.0;      ///< damping constant, in N m s/rad (N s/m), >= 0
    double drive = 0.0;        ///< constant torque in N m (force in N)
    double friction = 0.0;     ///< dry friction against the motion, in N m (N), >= 0
    double motor_rate = 0.0;   ///< target rate of the motor, in rad/s (m/s)
    double motor_most = 0.0;   ///< largest torque (force) of the motor, in N m (N), >= 0; 0: no motor
};

/// Body as described by a scene.
struct BodyDescription {
    std::string frame;  ///< name of the driven frame of the body and its colliders
    double mass = 1.0;  ///< in kg, > 0
    Vec3 center;        ///< centre of mass, in m, in the frame's coordinates
    /// Inertia tensor about the centre of mass, in kg m^2, in the frame's axes; positive definite.
    SymmetricMatrix inertia;
    JointKind joint = JointKind::free;
    Vec3 axis{0, 0, 1};     ///< direction of the joint's axis at the start, in the frame's axes; any nonzero length
    Vec3 velocity;          ///< initial velocity of the centre, in m/s; only for free bodies
    Vec3 angular_velocity;  ///< initial angular velocity, in rad/s; only for free bodies
    double rate = 0.0;      ///< initial rate, in rad/s for a hinge, in m/s for a slider
    JointSettings settings = {};
    /// True if the scene's forces act on the body. They act as on a point particle with the body's mass at its centre
    /// of mass.
    bool feels_forces = true;
};

/// State of one body, and the plan of its motion over a substep.
class DrivenBody {
public:
    /// world_from_frame: start transform of the body's frame. Throws an InputError that names the frame if a number is
    /// invalid.
    DrivenBody(BodyDescription description, const AffineMap& world_from_frame);

    [[nodiscard]] const BodyDescription& description() const { return description_; }

    /// Returns the path over the interval [begin, end], in s, under all forces and a steady load, without impulses. The
    /// load is a force, in N, and a moment about moment_center(), in N m.
    [[nodiscard]] BodyPath plan(const ForceField& forces, const Wrench& load, double begin, double end) const;
    /// Moves the body to the end of a path that was planned with `load`, and applies the impulses received during the
    /// path there. wrench: sum of all impulses, including the load, about moment_center().
    void follow(const BodyPath& path, const Wrench& load, const Wrench& wrench);
    /// Applies impulses at the current position.
    void take(const Wrench& wrench);
    /// Returns the reference point for moments of impulses, in m, in the world.
    [[nodiscard]] Vec3 moment_center() const { return description_.joint == JointKind::hinge ? pivot_ : center_; }

    /// Returns the response of the body to impulses, in the frame's coordinates. The response is constant in time.
    [[nodiscard]] Mobility mobility() const;

    /// Returns the kinetic energy, in J, that a wrench about moment_center() would give the body at rest.
    [[nodiscard]] double quadratic_energy(const Wrench& wrench) const;
    /// Returns the velocity change, in m/s, that a wrench causes at a point of the body. where: the point in the world,
    /// in m.
    [[nodiscard]] Vec3 velocity_change(const Wrench& wrench, const Vec3& where) const;

    [[nodiscard]] double kinetic_energy() const;                              ///< in J
    [[nodiscard]] const AffineMap& world_from_frame() const { return map_; }  ///< current transform of its frame
    [[nodiscard]] const Vec3& center() const { return center_; }              ///< centre of mass, in m
    [[nodiscard]] Vec3 velocity() const;                             ///< velocity of the centre of mass, in m/s
    [[nodiscard]] Vec3 angular_velocity() const;                     ///< in rad/s
    [[nodiscard]] double coordinate() const { return coordinate_; }  ///< coordinate of the joint, in rad or m
    [[nodiscard]] double rate() const { return rate_; }              ///< rate of the coordinate, in rad/s or m/s
    [[nodiscard]] Vec3 momentum() const { return description_.mass * velocity(); }  ///< in kg m/s
    /// Returns the angular momentum about the centre of mass, in kg m^2/s.
    [[nodiscard]] Vec3 angular_momentum() const;

    /// Saves or restores the state of motion. a: archive that is called with one member at a time.
    template <class Archive>
    void archive(Archive& a) {
        map_.archive(a);
        a(center_), a(velocity_), a(angular_momentum_), a(degrees_), a(coordinate_), a(rate_);
    }

private:
    [[nodiscard]] BodyPath plan_free(const ForceField& forces, const Wrench& load, double begin, double end) const;
    [[nodiscard]] BodyPath plan_joint(const ForceField& forces, const Wrench& load, double begin, double end) const;
    [[nodiscard]] double joint_acceleration(const ForceField& forces, double coordinate, double rate,
                                            double time) const;
    [[nodiscard]] double along_joint(const Wrench& wrench) const;
    [[nodiscard]] double constrained_change(double rate, double duration) const;
    [[nodiscard]] Vec3 acceleration_at(const ForceField& forces, const Vec3& center, const Vec3& velocity,
                                       double time) const;
    [[nodiscard]] Vec3 center_at(double coordinate) const;
    [[nodiscard]] SymmetricMatrix inverse_inertia(const AffineMap& map) const;

    BodyDescription description_;
    SymmetricMatrix inverse_inertia_;  // inverse inertia tensor in the frame's axes
    AffineMap start_;                  // start transform of the frame
    Vec3 axis_;                        // direction of the joint's axis in the world
    Vec3 pivot_;                       // a point on a hinge's axis
    double inertia_ = 0.0;             // inertia of the joint's coordinate, in kg m^2 or kg
    AffineMap map_;                    // current transform of the frame
    Vec3 center_;                      // in m
    Vec3 velocity_;                    // velocity of the centre, in m/s; only for free bodies
    Vec3 angular_momentum_;            // angular momentum about the centre; only for free bodies
    // Angle of a hinge, summed over the paths, so that each path starts exactly where the last one ended.
    double degrees_ = 0.0;
    double coordinate_ = 0.0;  // coordinate of a joint, in rad or m
    double rate_ = 0.0;
};

}  // namespace ricochet
