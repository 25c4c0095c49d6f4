/// \file
/// Private to triangulation: one polygon of the plane cut into triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/geometry/acceleration/point_tree.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/geometry/predicates/orient2d.h"

namespace ricochet {

/// Cuts polygons by clipping ears, with exact signs. Every corner is tested once at the start and when a neighbour of
/// it was clipped, against the reflex corners near its triangle, which a tree finds: close to linear time.
/// Keeps its memory from one polygon to the next.
class EarClipper {
public:
    /// Appends n - 2 triangles of places in `points` (n >= 3 corners in either orientation; neighbours may not be the
    /// same corner, but may coincide). The triangles have the outline's winding.
    /// Returns false when the outline crosses itself: the triangles then cover it, but overlap.
    [[nodiscard]] bool clip(const std::vector<Point2>& points, std::vector<Triangle>& triangles);

private:
    // How strict an ear is taken. Touching: corners on the rim of an ear and flat ears are accepted, for outlines that
    // touch themselves.
    enum class Strictness { kSimple, kTouching };

    void start(const std::vector<Point2>& points);
    [[nodiscard]] int turn_at(std::uint32_t corner) const;
    [[nodiscard]] int turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
    [[nodiscard]] bool is_ear(std::uint32_t corner, Strictness strictness) const;
    [[nodiscard]] bool fits_between_neighbours(std::uint32_t corner, Strictness strictness) const;
    [[nodiscard]] bool is_free_of_corners(std::uint32_t corner, Strictness strictness) const;
    void clip_all(Strictness strictness, std::vector<Triangle>& triangles);
    void clip_ear(std::uint32_t corner, std::vector<Triangle>& triangles);
    void update(std::uint32_t corner, Strictness strictness);
    void fan_the_rest(std::vector<Triangle>& triangles);

    std::vector<Point2> points_;  // mirrored if need be: the outline runs counter-clockwise
    std::vector<std::uint32_t> next_;
    std::vector<std::uint32_t> previous_;
    std::vector<char> is_reflex_;  // corners that an ear must not contain
    std::vector<char> is_queued_;  // corners that were an ear when last looked at
    std::vector<std::uint32_t> queue_;
    std::uint32_t remaining_ = 0;
    std::uint32_t any_corner_ = 0;  // one that is still there
    PointTree reflex_tree_;
};

}  // namespace ricochet
