/// \file
/// The colliders of one frame, at rest or moving, in the frame's coordinates. Private to the verifier.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/frame_tree.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/verify/boxes.h"
#include "ricochet/verify/checked_shape.h"
#include "ricochet/verify/parity.h"
#include "ricochet/verify/triangle_tests.h"
#include "ricochet/verify/triangle_tree.h"
#include "ricochet/verify/verifier.h"

namespace ricochet::verify {

/// The colliders of one frame. The object is immutable after build(), and then thread-safe. All functions take points
/// in world coordinates and times in s.
class CheckedFrame {
public:
    /// frames, frame: null and empty for colliders at rest.
    CheckedFrame(std::shared_ptr<const FrameTree> frames, std::optional<std::size_t> frame)
        : frames_(std::move(frames)), frame_(frame) {}

    /// Adds a collider. Throws InputError for an invalid surface. build() must be called after the last collider is
    /// added.
    void add(std::uint32_t collider, const VerifiedSurface& surface);
    void build();

    [[nodiscard]] const std::optional<std::size_t>& frame() const { return frame_; }
    [[nodiscard]] std::size_t side_count() const { return planes_.size() + shapes_.size() + bodies_.size(); }
    /// Appends the side of a point for each plane, shape and closed mesh.
    void append_sides(const Vec3& p, double time, std::vector<Side>& sides) const;
    /// Calls found(k, collider) for each surface for which append_sides() appends a side, in the same order.
    template <class Found>
    void visit_sides(const Found& found) const {
        std::size_t k = 0;
        for (const auto& plane : planes_) found(k++, plane.collider);
        for (const auto& shape : shapes_) found(k++, shape.collider);
        for (const auto& body : bodies_) found(k++, body.collider);
    }
    [[nodiscard]] bool is_on_surface(const Vec3& p, double time) const;

    /// A point at which a travelled segment crosses a surface.
    struct Crossing {
        Vec3 position;  ///< position in the world, in m
        std::uint32_t collider;
        std::optional<std::uint32_t> triangle;
    };
    /// Appends the crossings of a segment. starts_on_surface: true if the particle is on surfaces at the start of the
    /// segment. The segment may then leave these surfaces to either side.
    void find_crossings(const Segment& segment, bool starts_on_surface, std::vector<Crossing>& crossings) const;

    /// Calls found(collider, triangle or nothing) for every surface that overlaps a sphere about a point, in any order.
    /// Overlaps of up to 1e-12 of the sphere's radius and coordinates are ignored. largest: largest world coordinate of
    /// the sphere's centre on its path to the point, in m. path_length: length of this path, in m. On the path, the
    /// centre's coordinates in the frame exceed the coordinates of the point by at most this length.
    template <class Found>
    void visit_overlapped(const Vec3& world, double time, double radius, double largest, double path_length,
                          const Found& found) const {
        const Vec3 p = local_position(world, time);
        if (frame_) largest = std::max(largest, max_abs(p) + path_length);
        const double least = radius - sphere_tolerance(radius, largest);
        if (!(least > 0.0)) return;
        for (const auto& [collider, plane] : planes_) {
            if (is_nearer(p, plane.point, plane.normal, least)) found(collider, std::nullopt);
        }
        for (const auto& [collider, shape] : shapes_) {
            if (shape.is_nearer(p, least)) found(collider, std::nullopt);
        }
        const double padded = (1.0 + 0x1p-40) * least + 0x1p-40 * max_abs(p);
        triangles_.near_box(widened({p, p}, padded), [&](const NamedTriangle& t) {
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
    std::vector<OfCollider<ParityOracle>> bodies_;  ///< inside tests of closed meshes
    std::vector<NamedTriangle> to_build_;
    TriangleTree triangles_;
    Box3 box_;  ///< bounding box of triangles and shapes
};

}  // namespace ricochet::verify
