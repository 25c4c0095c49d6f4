/// \file
/// Surfaces near a path that stand in other frames than it is given in, and meshes that deform: the certificate of
/// links in their frames, and in space and time, and what is asked of them.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ricochet/collision/contact_query.h"
#include "ricochet/collision/moving_colliders.h"
#include "ricochet/collision/path_point.h"

namespace ricochet {

/// m, by which a position in a frame has to keep off surfaces so that being carried along does not lead it into them:
/// the rotation of a body that is pushed about has the roundings of all its turns so far, and there and back leads
/// elsewhere. 0 where that is within what contact_offset() is for.
[[nodiscard]] double offset_for_carrying(const MovingPose& pose, const Vec3& local_position);

/// What queries in the frames of other bodies have found near one path, or near a piece of it. Each body sees the path
/// as a cubic of its own; stored positions are what MovingPose::image() says.
class SurfacesInOtherFrames {
public:
    /// A body that is near.
    struct Body {
        BodyId id = kWorldBody;
        Path path;  ///< in its coordinates
        NearSurfaces near;
    };
    /// A triangle of a mesh that deforms.
    struct Deforming {
        SurfaceId surface = 0;
        double radius = 0.0;  ///< m, of the ball that links keep off it, but for the sphere_tolerance() of each
    };

    /// start: of the path, stored. Bodies are added in ascending order of their queries, triangles in that of their
    /// numbers.
    SurfacesInOtherFrames(const MovingView& view, const PathPoint& start) : view_(view), start_(start) {}

    /// The same for another path; without bodies.
    void restart(const MovingView& view, const PathPoint& start) {
        view_ = view;
        start_ = start;
        bodies_.clear();
        deforming_.clear();
    }

    void add(Body body) { bodies_.push_back(std::move(body)); }
    void add(const Deforming& triangle) { deforming_.push_back(triangle); }

    [[nodiscard]] const MovingView& view() const { return view_; }
    [[nodiscard]] const PathPoint& start() const { return start_; }

    /// As NearSurfaces says it of links.
    [[nodiscard]] bool are_free(const PathPoint& p, const PathPoint& q) const;
    [[nodiscard]] std::optional<SurfaceId> blocker(const PathPoint& p, const PathPoint& q) const;
    [[nodiscard]] bool cover_chord(double from, double to) const;

    // Of surfaces of other frames, as they are seen from the path's own.
    [[nodiscard]] bool is_flat(SurfaceId surface) const;
    [[nodiscard]] CollisionWorld::Nearest nearest(SurfaceId surface, const PathPoint& p) const;
    [[nodiscard]] double signed_distance_from(SurfaceId surface, const PathPoint& p) const;
    [[nodiscard]] Vec3 unit_normal_of(SurfaceId surface, const PathPoint& p) const;
    [[nodiscard]] int side_of_surface(SurfaceId surface, const PathPoint& p) const;
    [[nodiscard]] double offset_at(const PathPoint& p) const;

private:
    [[nodiscard]] Vec3 local_position(const Body& body, const PathPoint& p) const {
        return view_.local_position(body.id, p.world, p.time);
    }
    [[nodiscard]] Vec3 local_position_in(SurfaceId surface, const PathPoint& p) const {
        return view_.local_position(view_.bodies().body_of(surface), p.world, p.time);
    }
    [[nodiscard]] const CollisionWorld& world_of(SurfaceId surface) const {
        return view_.bodies().world(view_.bodies().body_of(surface));
    }
    [[nodiscard]] const DeformingColliders& deforming() const { return view_.bodies().deforming(); }
    [[nodiscard]] bool deforms(SurfaceId surface) const { return deforming().owns(surface); }
    [[nodiscard]] double time_of(const PathPoint& p) const { return view_.clock().at(p.time); }
    [[nodiscard]] bool is_free(const Deforming& triangle, const PathPoint& p, const PathPoint& q) const;

    MovingView view_;
    PathPoint start_;
    std::vector<Body> bodies_;
    std::vector<Deforming> deforming_;
};

}  // namespace ricochet
