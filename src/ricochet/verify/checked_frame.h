/// \file
/// Private to the verifier: the colliders of one frame, at rest or moving, in its coordinates.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/frame_tree.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/verify/checked_shape.h"
#include "ricochet/verify/parity.h"
#include "ricochet/verify/triangle_tests.h"
#include "ricochet/verify/triangle_tree.h"
#include "ricochet/verify/verifier.h"

namespace ricochet::verify {

/// The colliders of one frame. Immutable after build(); safe from any number of threads. Points are in world
/// coordinates, with times in s.
class CheckedFrame {
public:
    /// For colliders at rest `frames` is null and `frame` is empty.
    CheckedFrame(std::shared_ptr<const FrameTree> frames, std::optional<std::size_t> frame)
        : frames_(std::move(frames)), frame_(frame) {}

    /// Adds a collider. Throws InputError for invalid surfaces. build() must be called after the last one.
    void add(std::uint32_t collider, const VerifiedSurface& surface);
    void build();

    [[nodiscard]] const std::optional<std::size_t>& frame() const { return frame_; }
    [[nodiscard]] std::size_t side_count() const { return planes_.size() + shapes_.size() + bodies_.size(); }
    /// Appends the sides that a point is on, for planes, shapes and closed meshes.
    void append_sides(const Vec3& p, double time, std::vector<Side>& sides) const;
    /// Calls found(k, collider) for each of those surfaces, in the same order.
    template <class Found>
    void visit_sides(const Found& found) const {
        std::size_t k = 0;
        for (const auto& plane : planes_) found(k++, plane.collider);
        for (const auto& shape : shapes_) found(k++, shape.collider);
        for (const auto& body : bodies_) found(k++, body.collider);
    }
    [[nodiscard]] bool is_on_surface(const Vec3& p, double time) const;

    /// A crossing of a travelled segment.
    struct Crossing {
        Vec3 position;  ///< in m, in the world
        std::uint32_t collider;
        std::optional<std::uint32_t> triangle;
    };
    /// Appends the crossings of a segment. If a particle is on surfaces at its start, the segment may leave them to
    /// either side.
    void find_crossings(const Segment& segment, bool starts_on_surface, std::vector<Crossing>& crossings) const;

    /// Calls found(collider, triangle or nothing) for every surface that a sphere about a point overlaps. Overlaps of
    /// up to 1e-12 of its radius and coordinates are ignored. The order is unspecified. `largest` is the largest of its
    /// world coordinates along its path to the point, and `way` is the length of that path, in m. The largest
    /// coordinate in a frame exceeds the last one by at most that length.
    template <class Found>
    void visit_overlapped(const Vec3& world, double time, double radius, double largest, double way,
                          const Found& found) const {
        const Vec3 p = local_position(world, time);
        if (frame_) largest = std::max(largest, max_abs(p) + way);
        const double least = radius - sphere_tolerance(radius, largest);
        if (!(least > 0.0)) return;
        for (const auto& [collider, plane] : planes_) {
            if (is_nearer(p, plane.point, plane.normal, least)) found(collider, std::nullopt);
        }
        for (const auto& [collider, shape] : shapes_) {
            if (shape.is_nearer(p, least)) found(collider, std::nullopt);
        }
        const double padded = (1.0 + 0x1p-40) * least + 0x1p-40 * max_abs(p);
        const Vec3 reach{padded, padded, padded};
        triangles_.near_box({p - reach, p + reach}, [&](const NamedTriangle& t) {
            if (is_nearer(p, t.corners, least)) found(t.collider, t.triangle);
        });
    }

private:
    template <class T>
    struct OfCollider {
        std::uint32_t collider;
        T surface;
    };

    [[nodiscard]] Vec3 local_position(const Vec3& world, double time) const;
    [[nodiscard]] bool stays_away(const Segment& segment) const;

    std::shared_ptr<const FrameTree> frames_;
    std::optional<std::size_t> frame_;
    std::vector<OfCollider<VerifiedPlane>> planes_;
    std::vector<OfCollider<CheckedShape>> shapes_;
    std::vector<OfCollider<ParityOracle>> bodies_;  ///< closed meshes
    std::vector<NamedTriangle> to_build_;
    TriangleTree triangles_;
    Box3 box_;  ///< box of triangles and shapes
};

}  // namespace ricochet::verify
