/// \file
/// Tree of triangles. Queries find all triangles near a segment or a box, and possibly further triangles.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/vec3.h"
#include "ricochet/verify/boxes.h"
#include "ricochet/verify/item_tree.h"
#include "ricochet/verify/triangle_tests.h"

namespace ricochet::verify {

/// A triangle with the indices that identify it.
struct NamedTriangle {
    Corners corners;
    std::uint32_t collider = 0;
    std::uint32_t triangle = 0;  ///< index in the collider's mesh
};

/// Tree of triangles. It is immutable and thread-safe.
class TriangleTree {
public:
    TriangleTree() = default;
    explicit TriangleTree(const std::vector<NamedTriangle>& triangles);

    /// Calls visit(triangle) for every triangle whose box touches the segment [p, q], and possibly for a few further
    /// triangles.
    template <class Visit>
    void near_segment(const Vec3& p, const Vec3& q, const Visit& visit) const {
        visit_near(SegmentTest(p, q, largest_), visit);
    }
    /// Calls visit(triangle) for every triangle whose box touches `box`.
    template <class Visit>
    void near_box(const Box3& box, const Visit& visit) const {
        visit_near([&](const Box3& other) { return meet(box, other); }, visit);
    }

private:
    /// Separating axis test of a segment and a box. The coordinate axes need no tolerance, because their comparisons
    /// have no rounding. Axes perpendicular to the segment and to a coordinate axis use the tolerance slack_.
    class SegmentTest {
    public:
        SegmentTest(const Vec3& p, const Vec3& q, double largest)
            : box_(enclosing(p, q)), start_(p), step_(q - p), size_(abs(step_)) {
            // Each product below has about 5 roundings of 2^-53, relative to coordinates of this size.
            slack_ = 0x1p-48 * std::fmax(largest, std::fmax(max_abs(p), max_abs(q)));
        }
        bool operator()(const Box3& box) const {
            if (!meet(box_, box)) return false;
            const Vec3 half = 0.5 * (box.upper - box.lower);
            // A segment that is short compared with the box seldom misses the box, so the exact test would not pay off.
            if (max_abs(size_) < max_abs(half)) return true;
            const Vec3 centre = 0.5 * (box.lower + box.upper) - start_;
            return overlaps(step_.x, step_.y, centre.x, centre.y, size_.x, size_.y, half.x, half.y) &&
                   overlaps(step_.y, step_.z, centre.y, centre.z, size_.y, size_.z, half.y, half.z) &&
                   overlaps(step_.z, step_.x, centre.z, centre.x, size_.z, size_.x, half.z, half.x);
        }

    private:
        [[nodiscard]] bool overlaps(double du, double dv, double cu, double cv, double su, double sv, double hu,
                                    double hv) const {
            return std::fabs(du * cv - dv * cu) <= su * (hv + slack_) + sv * (hu + slack_);
        }
        Box3 box_;
        Vec3 start_;
        Vec3 step_;
        Vec3 size_;
        double slack_ = 0.0;
    };

    /// Calls visit(triangle) for every triangle whose box passes a test.
    template <class Test, class Visit>
    void visit_near(const Test& test, const Visit& visit) const {
        tree_.visit([&](std::uint32_t node) { return test(node_boxes_[node]); },
                    [&](std::uint32_t k) {
                        if (test(boxes_[k])) visit(triangles_[k]);
                    });
    }

    ItemTree tree_;
    std::vector<NamedTriangle> triangles_;  ///< triangles in the order of the leaves
    std::vector<Box3> boxes_;               ///< one box per triangle
    std::vector<Box3> node_boxes_;          ///< one box per node of the tree
    double largest_ = 0.0;                  ///< largest coordinate, in m
};

}  // namespace ricochet::verify
