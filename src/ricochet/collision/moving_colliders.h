/// \file
/// Bodies of a scene: the colliders of each frame in its coordinates, and the motion of the frame.
///
/// In its own frame a collider never moves, so every predicate and hierarchy works there. Only the path of a particle
/// changes: y(t) = M(t)^-1 x(t). MovingPose::local_position() defines the local position of a stored position x at a
/// time t. No crossing is lost between the two coordinate systems, because all tests use this definition.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "ricochet/collision/collider_list.h"
#include "ricochet/collision/collision_world.h"
#include "ricochet/collision/deforming_colliders.h"
#include "ricochet/core/box3.h"
#include "ricochet/core/frame_tree.h"
#include "ricochet/core/mobility.h"
#include "ricochet/geometry/acceleration/box_tree.h"

namespace ricochet {

/// Number of a body: the colliders of one moving frame, or a deforming mesh.
using BodyId = std::uint32_t;
/// The world body: all colliders at rest.
inline constexpr BodyId kWorldBody = 0xFFFFFFFFU;

/// Returns true if a velocity differs between two poses of a frame at the same time.
[[nodiscard]] bool has_jump(const MovingPose& before, const MovingPose& after);

/// All bodies of a scene: the world body and the moving bodies. Queries are safe from any number of threads, but not
/// during begin_step() and prepare_radius().
class MovingColliders {
public:
    /// `at_rest` is the world body. `frames` must contain all frames to which the colliders refer. Both must outlive
    /// the object. Throws InputError like CollisionWorld, and for a frame that does not exist.
    explicit MovingColliders(const CollisionWorld& at_rest, std::shared_ptr<const FrameTree> frames = nullptr);

    [[nodiscard]] const std::shared_ptr<const FrameTree>& frames() const { return frames_; }
    /// Returns true if all colliders are at rest.
    [[nodiscard]] bool empty() const { return body_of_collider_.empty(); }
    /// Returns the number of bodies with a frame. They are numbered first, and deforming meshes follow.
    [[nodiscard]] std::size_t size() const { return bodies_.size(); }
    [[nodiscard]] bool has_frame(BodyId body) const { return body < bodies_.size(); }
    /// Returns the deforming meshes. They have world coordinates, so their pose() is the pose at rest.
    [[nodiscard]] const DeformingColliders& deforming() const { return deforming_; }
    [[nodiscard]] bool is_deforming(BodyId body) const { return body != kWorldBody && body >= bodies_.size(); }
    /// Returns the colliders of a body with a frame, in its coordinates, or the colliders at rest.
    [[nodiscard]] const CollisionWorld& world(BodyId body) const {
        return body == kWorldBody ? at_rest_ : *bodies_[body].world;
    }
    /// Returns the body of a surface.
    [[nodiscard]] BodyId body_of(SurfaceId surface) const {
        return empty() ? kWorldBody : body_of_collider_[at_rest_.list()->collider_of(surface)];
    }
    [[nodiscard]] BodyId body_of_collider(std::size_t collider) const {
        return empty() ? kWorldBody : body_of_collider_[collider];
    }
    /// Returns the frame of a body.
    [[nodiscard]] std::size_t frame_of(BodyId body) const { return bodies_[body].frame; }
    /// Returns the pose of a body at a time, in s, and its motion at that time.
    [[nodiscard]] MovingPose pose(BodyId body, double time) const {
        return has_frame(body) ? pose_of(body, time) : MovingPose{};
    }
    /// Converts a position in the world to a body's coordinates at a time, in s.
    [[nodiscard]] Vec3 local_position(BodyId body, const Vec3& world, double time) const {
        return has_frame(body) ? pose_of(body, time).local_position(world) : world;
    }
    /// See CollisionWorld::prepare_radius().
    void prepare_radius(double radius);
    void set_culling(bool culls);

    /// Begins a step over [begin, end], in s. "The step" below is this one.
    void begin_step(double begin, double end);
    /// Appends the bodies that come into the box during the step, except `except`, ascending, but kWorldBody first.
    void near(const Box3& box, BodyId except, std::vector<BodyId>& out) const;
    /// Appends the bodies with a frame that may be in the box at a time, in s, ascending; outside the step all.
    void near_at(const Box3& box, double time, std::vector<BodyId>& out) const;
    /// Returns true if all bodies certainly stay out of the box during the step.
    [[nodiscard]] bool all_stay_out(const Box3& box) const;
    /// Returns true if a body certainly stays out of the box during the step.
    [[nodiscard]] bool stays_out(BodyId body, const Box3& box) const;
    /// Returns bounds of a body's motion during the step.
    [[nodiscard]] const MotionBounds& bounds(BodyId body) const;
    /// Returns FrameTree::next_key() of the body's frame, or infinity for kWorldBody.
    [[nodiscard]] double next_key(BodyId body, double time) const;
    /// Returns the first key in (from, until], in s, at which the body's velocity jumps.
    [[nodiscard]] std::optional<double> next_jump(BodyId body, double from, double until) const;

    // Dynamic bodies.

    /// Sets the mobility of a dynamic body, in its frame's coordinates.
    void set_mobility(BodyId body, const Mobility& mobility) { bodies_[body].mobility = mobility; }
    /// Sets the state in the next substep: a flag for a velocity jump, and a free body's angular momentum, kg m^2/s.
    void set_motion(BodyId body, bool has_jumped, const std::optional<Vec3>& angular_momentum) {
        bodies_[body].has_jumped = has_jumped;
        bodies_[body].angular_momentum = angular_momentum;
    }
    /// Returns the angular velocity of a free body at a time, in s, relative to that of its planned path, in rad/s. The
    /// path has one angular velocity throughout, that of its middle, with which impacts would not conserve energy.
    [[nodiscard]] Vec3 turning_beside_path(BodyId body, double time) const;
    [[nodiscard]] bool is_dynamic(BodyId body) const { return has_frame(body) && bodies_[body].mobility.has_value(); }
    /// Returns the mobility of a dynamic body at a time, in s, in world coordinates. Requires is_dynamic().
    [[nodiscard]] Mobility mobility(BodyId body, double time) const {
        return bodies_[body].mobility->seen_by(pose(body, time).world_from_frame);
    }
    /// Returns true if impulses have changed the body's velocity at the start of this step or substep.
    [[nodiscard]] bool has_jumped(BodyId body) const { return has_frame(body) && bodies_[body].has_jumped; }

private:
    struct Body {
        std::unique_ptr<CollisionWorld> world;
        std::size_t frame = 0;
        Box3 swept;  ///< box of its colliders during the step; infinite for planes
        MotionBounds bounds;
        MovingPose at_begin;
        MovingPose at_end;
        std::optional<Mobility> mobility{};
        std::optional<Vec3> angular_momentum{};
        bool has_jumped = false;
        bool is_driven = false;
    };

    [[nodiscard]] const MovingPose& pose_of(BodyId body, double time) const;

    const CollisionWorld& at_rest_;
    std::shared_ptr<const FrameTree> frames_;
    std::vector<Body> bodies_;
    std::vector<BodyId> body_of_collider_;  ///< empty if all colliders are at rest
    DeformingColliders deforming_;
    BoxTree swept_;                  ///< boxes of the bodies in bounded_ during the step
    std::vector<BodyId> bounded_;    ///< bodies with finite boxes
    std::vector<BodyId> unbounded_;  ///< other bodies, tested one by one
    std::uint64_t step_ = 0;         ///< key of cached poses, unique among all steps of all scenes
    double begin_ = 0.0;
    double end_ = 0.0;
};

/// Returns a box in the world that contains a body's box, given in its own coordinates, at all times in [begin, end],
/// in s: straight paths between the positions at both ends and at keys, grown by a bound on the deviation.
[[nodiscard]] Box3 swept_box(const FrameTree& frames, std::size_t frame, const Box3& box, double begin, double end);

}  // namespace ricochet
