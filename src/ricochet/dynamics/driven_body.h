/// \file
/// A rigid body that forces and impulses move: free, or on an axis or a straight guide that is fixed in the world.
///
/// On a joint a spring and a damper are followed in closed form, all else with a linear acceleration between the ends
/// (N. M. Newmark, "A method of computation for structural dynamics", J. Eng. Mech. Div. ASCE 85, 1959): of second
/// order. A free body keeps its angular momentum to rounding, and turns by the angular velocity of the step's middle
/// (S. R. Buss, "Accurate and efficient simulation of rigid-body rotations", J. Comput. Phys. 164, 2000).
#pragma once

#include <optional>
#include <string>

#include "ricochet/core/body_path.h"
#include "ricochet/core/mobility.h"
#include "ricochet/core/symmetric_matrix.h"
#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/forces.h"

namespace ricochet {

/// What holds a body.
enum class JointKind {
    free,    ///< nothing
    hinge,   ///< it turns about an axis through the frame's origin
    slider,  ///< it moves along an axis, without turning
};

/// What acts between a body on a joint and the world. Units of a hinge (of a slider): the coordinate is an angle, rad
/// (a way, m), 0 where the body starts.
struct JointSettings {
    double spring = 0.0;       ///< N m/rad (N/m), >= 0, towards `spring_rest`
    double spring_rest = 0.0;  ///< rad (m)
    double damping = 0.0;      ///< N m s/rad (N s/m), >= 0
    double drive = 0.0;        ///< N m (N), constant
    double friction = 0.0;     ///< N m (N), >= 0, against the motion: dry friction
    double motor_rate = 0.0;   ///< rad/s (m/s) that a motor aims at
    double motor_most = 0.0;   ///< N m (N), >= 0, with which it does at most; 0: there is none
};

/// A body as a scene describes it.
struct BodyDescription {
    std::string frame;        ///< that it is, and that its colliders stand in; driven
    double mass = 1.0;        ///< kg, > 0
    Vec3 center;              ///< of mass, m, in the frame's coordinates
    SymmetricMatrix inertia;  ///< about that, kg m^2, in the frame's axes; positive definite
    JointKind joint = JointKind::free;
    Vec3 axis{0, 0, 1};     ///< of a joint, in the frame's axes as it starts; of any length but zero
    Vec3 velocity;          ///< of the centre at first, m/s; free
    Vec3 angular_velocity;  ///< at first, rad/s; free
    double rate = 0.0;      ///< at first, rad/s of a hinge, m/s of a slider
    JointSettings settings = {};
    /// The scene's forces act on it, as on a particle of its mass and without a radius at its centre of mass.
    bool feels_forces = true;
};

/// One body: where it is, how it moves, and its plan for the part of a step that comes.
class DrivenBody {
public:
    /// world_from_frame: where its frame starts. Throws InputError, naming the frame, for numbers that cannot be.
    DrivenBody(BodyDescription description, const AffineMap& world_from_frame);

    [[nodiscard]] const BodyDescription& description() const { return description_; }

    /// The path over [begin, end], s, under what acts on it but impulses, and under a steady load: a force, N, and its
    /// moment about moment_center(), N m.
    [[nodiscard]] BodyPath plan(const ForceField& forces, const Wrench& load, double begin, double end) const;
    /// Goes along a path that was planned with a load to its end, and takes the impulses of that time there. wrench:
    /// all of them, with those of the load, about moment_center(); the particles' own arms are from the places of their
    /// hits.
    void follow(const BodyPath& path, const Wrench& load, const Wrench& wrench);
    /// Takes impulses where it is.
    void take(const Wrench& wrench);
    /// The point that moments of impulses are about, m, in the world.
    [[nodiscard]] Vec3 moment_center() const { return description_.joint == JointKind::hinge ? pivot_ : center_; }

    /// How it yields, in the frame's coordinates, at all times.
    [[nodiscard]] Mobility mobility() const;

    /// Kinetic energy, J, that a wrench about moment_center() would give it, were it at rest.
    [[nodiscard]] double quadratic_energy(const Wrench& wrench) const;
    /// By how much it would change the velocity, m/s, of its point at `where` in the world.
    [[nodiscard]] Vec3 velocity_change(const Wrench& wrench, const Vec3& where) const;

    [[nodiscard]] double kinetic_energy() const;                                    ///< J
    [[nodiscard]] const AffineMap& world_from_frame() const { return map_; }        ///< where its frame is
    [[nodiscard]] const Vec3& center() const { return center_; }                    ///< of mass, m
    [[nodiscard]] Vec3 velocity() const;                                            ///< of that, m/s
    [[nodiscard]] Vec3 angular_velocity() const;                                    ///< rad/s
    [[nodiscard]] double coordinate() const { return coordinate_; }                 ///< of a joint, rad or m
    [[nodiscard]] double rate() const { return rate_; }                             ///< of that, per s
    [[nodiscard]] Vec3 momentum() const { return description_.mass * velocity(); }  ///< kg m/s
    /// About the centre of mass, kg m^2/s.
    [[nodiscard]] Vec3 angular_momentum() const;

    /// Saves or restores how it moves; a: an archive, which takes members one by one.
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
    [[nodiscard]] double held_change(double rate, double duration) const;
    [[nodiscard]] Vec3 acceleration_at(const ForceField& forces, const Vec3& center, const Vec3& velocity,
                                       double time) const;
    [[nodiscard]] Vec3 center_at(double coordinate) const;
    [[nodiscard]] SymmetricMatrix inverse_inertia(const AffineMap& map) const;

    BodyDescription description_;
    SymmetricMatrix inverse_inertia_;  // in the frame's axes
    AffineMap start_;                  // where the frame started
    Vec3 axis_;                        // of the joint, in the world
    Vec3 pivot_;                       // a point of a hinge's axis
    double inertia_ = 0.0;             // of the joint's coordinate: kg m^2, or kg
    AffineMap map_;                    // where the frame is
    Vec3 center_;                      // m
    Vec3 velocity_;                    // of that, m/s; free
    Vec3 angular_momentum_;            // about that; free
    double degrees_ = 0.0;             // of a hinge; the path's own sum, so that paths leave no gap
    double coordinate_ = 0.0;          // of a joint
    double rate_ = 0.0;
};

}  // namespace ricochet
