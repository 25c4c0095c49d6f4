/// \file
/// Certificates of space-time segments: surfaces near a path in other frames than the path's own, and deforming meshes.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "ricochet/collision/contact_query.h"

namespace ricochet {

/// Returns the distance, in m, that a particle attached to a frame must keep from surfaces: a multiple of the rounding
/// error of a conversion to the world and back, which the orientation of a dynamic body accumulates.
[[nodiscard]] double offset_for_carrying(const MovingPose& pose, const Vec3& local_position);

/// Results of queries in the frames of other bodies near one path, or near a piece of it. In each frame the path is a
/// different cubic. Stored positions are converted by MovingPose::local_position().
class SurfacesInOtherFrames {
public:
    /// A body near the path.
    struct Body {
        BodyId id = kWorldBody;
        Path path;  ///< in the body's coordinates
        NearSurfaces near;
    };
    /// A triangle of a deforming mesh.
    struct Deforming {
        SurfaceId surface = 0;
        double radius = 0.0;  ///< distance that segments keep, minus sphere_tolerance() of each segment, in m
    };

    /// `start` is the stored start of the path. Bodies must be added in the order of their queries, triangles
    /// ascending.
    SurfacesInOtherFrames(const SurfacesInTime& surfaces, const PathPoint& start)
        : surfaces_(surfaces), start_(start) {}

    /// Removes all surfaces and begins with another path.
    void restart(const SurfacesInTime& surfaces, const PathPoint& start) {
        surfaces_ = surfaces;
        start_ = start;
        bodies_.clear();
        deforming_.clear();
    }

    void add(Body body) { bodies_.push_back(std::move(body)); }
    void add(const Deforming& triangle) { deforming_.push_back(triangle); }

    /// Returns all surfaces in the frame and at the times of the path.
    [[nodiscard]] const SurfacesInTime& surfaces() const { return surfaces_; }
    [[nodiscard]] const PathPoint& start() const { return start_; }

    /// The functions of NearSurfaces for space-time segments, applied to the surfaces of other frames.
    [[nodiscard]] bool are_free(const PathPoint& p, const PathPoint& q) const;
    [[nodiscard]] std::optional<SurfaceId> blocker(const PathPoint& p, const PathPoint& q) const;
    [[nodiscard]] std::optional<SurfaceId> overlap_deepened_by(const PathPoint& p, const PathPoint& q) const;
    [[nodiscard]] bool cover_chord(double from, double to) const;
    [[nodiscard]] double offset_at(const PathPoint& p) const;

private:
    [[nodiscard]] Vec3 local_position(const Body& body, const PathPoint& p) const {
        return surfaces_.local_position(body.id, p.world, p.time);
    }
    [[nodiscard]] bool is_free(const Deforming& triangle, const PathPoint& p, const PathPoint& q) const;

    SurfacesInTime surfaces_;
    PathPoint start_;
    std::vector<Body> bodies_;
    std::vector<Deforming> deforming_;
};

}  // namespace ricochet
