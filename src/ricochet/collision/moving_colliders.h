/// \file
/// The colliders of a scene that move: each frame's colliders as they stand in its coordinates, and how it moves.
///
/// In its own coordinates a collider never moves, so every predicate and hierarchy works there; what changes is the way
/// of a particle, y(t) = M(t)^-1 x(t). Where a stored position x at a time t is in a frame is MovingPose::image() by
/// definition: no crossing is lost between two coordinates.
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

/// Number of a body: the colliders that stand in one moving frame, or a mesh that deforms.
using BodyId = std::uint32_t;
/// The colliders that stand in the world.
inline constexpr BodyId kWorldBody = 0xFFFFFFFFU;

/// All bodies of a scene. Queries are safe from any number of threads, but not beside begin_step() and
/// prepare_radius().
class MovingColliders {
public:
    /// `at_rest`: the world of the same list. frames: has all frames that the list names; both must outlive it.
    /// Throws InputError as CollisionWorld does, and for a frame that does not exist.
    MovingColliders(const CollisionWorld& at_rest, const std::shared_ptr<ColliderList>& colliders,
                    std::shared_ptr<const FrameTree> frames, double chord_margin);

    [[nodiscard]] const std::shared_ptr<const FrameTree>& frames() const { return frames_; }
    /// Of bodies with a frame; they have the numbers below, and those that deform the ones from there on.
    [[nodiscard]] std::size_t size() const { return bodies_.size(); }
    [[nodiscard]] bool empty() const { return bodies_.empty() && deforming_.empty(); }
    /// The meshes that deform. They stand in the world: their pose() is that of what is at rest.
    [[nodiscard]] const DeformingColliders& deforming() const { return deforming_; }
    [[nodiscard]] bool is_deforming(BodyId body) const { return body != kWorldBody && body >= bodies_.size(); }
    /// The colliders of a body with a frame in its coordinates, or those at rest.
    [[nodiscard]] const CollisionWorld& world(BodyId body) const {
        return body == kWorldBody ? at_rest_ : *bodies_[body].world;
    }
    /// The body that a surface belongs to.
    [[nodiscard]] BodyId body_of(SurfaceId surface) const {
        return body_of_collider_[colliders_->collider_of(surface)];
    }
    [[nodiscard]] BodyId body_of_collider(std::size_t collider) const { return body_of_collider_[collider]; }
    /// The frame that a body stands in.
    [[nodiscard]] std::size_t frame_of(BodyId body) const { return bodies_[body].frame; }
    /// Where a body is at a time, s, and how it moves.
    [[nodiscard]] MovingPose pose(BodyId body, double time) const {
        return body == kWorldBody || is_deforming(body) ? MovingPose{} : pose_of(body, time);
    }
    /// Where a position of the world, m, is in a body's coordinates at a time, s.
    [[nodiscard]] Vec3 local_position(BodyId body, const Vec3& world, double time) const {
        return body == kWorldBody || is_deforming(body) ? world : pose_of(body, time).local_position(world);
    }
    /// As CollisionWorld::prepare_radius().
    void prepare_radius(double radius);
    void set_culling(bool culls);

    /// What follows is asked within [begin, end], s.
    void begin_step(double begin, double end);
    /// Appends the bodies that come into the box during the step, kWorldBody first where its colliders do, in their
    /// order; without `except`.
    void near(const Box3& box, BodyId except, std::vector<BodyId>& out) const;
    /// Appends the bodies with a frame that may be in the box at a time, s, in their order: all of them where the time
    /// is not in the step.
    void near_at(const Box3& box, double time, std::vector<BodyId>& out) const;
    /// True where all bodies certainly stay out of the box during the step.
    [[nodiscard]] bool all_stay_out(const Box3& box) const;
    /// True where a body certainly stays out of the box during the step.
    [[nodiscard]] bool stays_out(BodyId body, const Box3& box) const;
    /// Bounds of a body's motion during the step.
    [[nodiscard]] const MotionBounds& bounds(BodyId body) const;
    /// As FrameTree::next_key(); infinite for kWorldBody.
    [[nodiscard]] double next_key(BodyId body, double time) const;
    /// The first key after `from` and not after `until`, s, at which the body's velocity jumps.
    [[nodiscard]] std::optional<double> next_jump(BodyId body, double from, double until) const;

    // Bodies that impulses move.

    /// How a body of a driven frame yields, in the frame's coordinates.
    void set_mobility(BodyId body, const Mobility& mobility) { bodies_[body].mobility = mobility; }
    /// For what begins next: whether impulses have just changed its velocity; and its angular momentum, kg m^2/s, where
    /// it is free.
    void set_motion(BodyId body, bool has_jumped, const std::optional<Vec3>& angular_momentum) {
        bodies_[body].has_jumped = has_jumped;
        bodies_[body].angular_momentum = angular_momentum;
    }
    /// rad/s, by which the angular velocity of a free body differs at a time, s, from that of its path, which keeps the
    /// one of the path's middle: an impact would not keep the energy with that.
    [[nodiscard]] Vec3 turning_beside_path(BodyId body, double time) const;
    [[nodiscard]] bool is_dynamic(BodyId body) const {
        return body < bodies_.size() && bodies_[body].mobility.has_value();
    }
    /// How it yields at a time, s, in the world; only of one that does.
    [[nodiscard]] Mobility mobility(BodyId body, double time) const {
        return bodies_[body].mobility->seen_by(pose(body, time).world_from_frame);
    }
    /// True when impulses have changed its velocity where this step, or this part of it, begins.
    [[nodiscard]] bool has_jumped(BodyId body) const { return body < bodies_.size() && bodies_[body].has_jumped; }

private:
    struct Body {
        std::unique_ptr<CollisionWorld> world;
        std::size_t frame = 0;
        Box3 swept;  ///< where it comes in the step; everywhere for planes
        MotionBounds bounds;
        MovingPose at_begin;
        MovingPose at_end;
        std::optional<Mobility> mobility{};
        std::optional<Vec3> angular_momentum{};
        bool has_jumped = false;
        bool is_driven = false;
    };

    void sweep(Body& body) const;
    [[nodiscard]] const MovingPose& pose_of(BodyId body, double time) const;

    const CollisionWorld& at_rest_;
    std::shared_ptr<ColliderList> colliders_;
    std::shared_ptr<const FrameTree> frames_;
    std::vector<Body> bodies_;
    std::vector<BodyId> body_of_collider_;
    DeformingColliders deforming_;
    BoxTree swept_;                  ///< of the bodies in bounded_, in this step
    std::vector<BodyId> bounded_;    ///< what does not reach everywhere
    std::vector<BodyId> unbounded_;  ///< the others, looked at one by one
    std::uint64_t step_ = 0;  ///< a number that no other step has, of no other scene: of poses that are remembered
    double begin_ = 0.0;
    double end_ = 0.0;
};

/// The box that holds a body's box, in its own coordinates, wherever it is within [begin, end], s, rounded outward:
/// about straight ways between its places there and at keys, by as much as its motion can lie beside them.
[[nodiscard]] Box3 swept_box(const FrameTree& frames, std::size_t frame, const Box3& box, double begin, double end);

}  // namespace ricochet
