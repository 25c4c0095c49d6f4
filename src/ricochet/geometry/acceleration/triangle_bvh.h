/// \file
/// The broad phase: which triangles may a segment touch, which are near a point? A bounding volume hierarchy over
/// padded boxes, traversed by Embree in single precision.
///
/// It only proposes candidates: every triangle within the margin of the segment or point (in exact arithmetic), and
/// some others. No number that Embree computes about triangles is used, so results do not depend on its version,
/// instruction set or layout.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/geometry/acceleration/triangle_clusters.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Broad phase over static triangles in world coordinates.
class TriangleBvh {
public:
    /// Called for a candidate. Returns the fraction of the segment, in [0, 1], beyond which triangles are no longer of
    /// interest (1: all are). The smallest value returned so far holds.
    using VisitSegment = double (*)(void* context, std::uint32_t triangle);

    using Clusters = std::shared_ptr<const TriangleClusters>;

    /// Builds the hierarchy with all threads. Coordinates must be finite and, after centring, below kLargestCoordinate.
    /// margin (m, >= 0): AABB margin, by which paths may leave the segments of queries. Throws RunError when memory is
    /// short.
    TriangleBvh(std::span<const Vec3> vertices, std::span<const Triangle> triangles, double margin);
    /// Whether a hierarchy has an Embree device of its own, which counts its memory, or one with all others that share:
    /// for thousands of hierarchies, since Embree makes some 1000 devices at most.
    enum class Device : std::uint8_t { own, shared };
    /// The same over clusters that several hierarchies share.
    TriangleBvh(Clusters clusters, double margin, Device device = Device::own);
    ~TriangleBvh();
    TriangleBvh(TriangleBvh&&) noexcept;
    TriangleBvh& operator=(TriangleBvh&&) noexcept;

    /// Visits every triangle whose distance from the segment [from, to] is at most margin() + slack() (and
    /// possibly more), up to the narrowed fraction, in unspecified order. Safe from any number of threads. Both ends
    /// must be finite.
    void query_segment(const Vec3& from, const Vec3& to, void* context, VisitSegment visit) const;

    /// The same with any callable `double(std::uint32_t triangle)`.
    template <class Callable>
    void query_segment(const Vec3& from, const Vec3& to, Callable&& callable) const {
        using Function = std::remove_reference_t<Callable>;
        query_segment(
            from, to, const_cast<void*>(static_cast<const void*>(&callable)),
            [](void* context, std::uint32_t triangle) { return (*static_cast<Function*>(context))(triangle); });
    }

    /// Called for a triangle that the tube may touch, with the interval (fractions of the path) outside of which it
    /// certainly does not. Returns as VisitSegment does.
    using VisitTube = double (*)(void* context, std::uint32_t triangle, double enter, double leave);

    /// Visits every triangle that the tube touches, and few others: TriangleCluster::overlaps() decides, four triangles
    /// at a time. The tube's margin and sagitta together must be at most margin() + slack().
    void query_tube(const Tube& tube, void* context, VisitTube visit) const;

    /// The same with any callable `double(std::uint32_t triangle, double enter, double leave)`.
    template <class Callable>
    void query_tube(const Tube& tube, Callable&& callable) const {
        using Function = std::remove_reference_t<Callable>;
        query_tube(tube, const_cast<void*>(static_cast<const void*>(&callable)),
                   [](void* context, std::uint32_t triangle, double enter, double leave) {
                       return (*static_cast<Function*>(context))(triangle, enter, leave);
                   });
    }

    /// Called for a candidate. Returns the distance, m, beyond which triangles are no longer of interest. The smallest
    /// value returned so far holds.
    using VisitPoint = double (*)(void* context, std::uint32_t triangle);

    /// Visits every triangle whose distance from p is at most within + margin() + slack() (and possibly more), where
    /// `within` (m, >= 0, may be infinite) is replaced by the narrowed distance; in unspecified order. Safe from any
    /// number of threads. p must be finite.
    void query_point(const Vec3& p, double within, void* context, VisitPoint visit) const;

    /// The same with any callable `double(std::uint32_t triangle)`.
    template <class Callable>
    void query_point(const Vec3& p, double within, Callable&& callable) const {
        using Function = std::remove_reference_t<Callable>;
        query_point(p, within, const_cast<void*>(static_cast<const void*>(&callable)),
                    [](void* context, std::uint32_t triangle) { return (*static_cast<Function*>(context))(triangle); });
    }

    /// m, as given.
    [[nodiscard]] double margin() const;
    /// m, what the boxes allow for positions beside the segment (see kBoxSlack).
    [[nodiscard]] double slack() const;
    /// Bytes that the hierarchy holds (without the vertices and triangles); 0 with a shared device, which does not
    /// know.
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Embree device configuration of hierarchies built from now on ("isa=sse2"); empty: defaults. For tests that no result
/// depends on it. Not while hierarchies are being built.
void set_embree_config(std::string config);

/// Embree's name and version, for `--version` and reports.
[[nodiscard]] std::string embree_version();

}  // namespace ricochet
