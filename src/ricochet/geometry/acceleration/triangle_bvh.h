/// \file
/// Broad phase: finds the triangles that a segment may touch or that are near a point. It is a bounding volume
/// hierarchy over padded boxes, traversed by Embree in single precision.
///
/// The broad phase only proposes candidates. They include every triangle within the margin of the segment or point, in
/// exact arithmetic, and some other triangles. The library uses no number that Embree computes about triangles. Results
/// therefore do not depend on Embree's version, instruction set or memory layout.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>

#include "ricochet/core/box3.h"
#include "ricochet/geometry/acceleration/triangle_clusters.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Broad phase over static triangles in world coordinates.
class TriangleBvh {
public:
    /// Callback for a candidate. It returns the fraction of the segment, in [0, 1], beyond which triangles no longer
    /// matter (1: all matter). The query uses the smallest fraction returned so far.
    using VisitSegment = double (*)(void* context, std::uint32_t triangle);

    using Clusters = std::shared_ptr<const TriangleClusters>;

    /// Builds the hierarchy with all threads. Coordinates must be finite and, after centring, below kLargestCoordinate.
    /// `margin` (m, >= 0) is the AABB margin by which paths may leave the segments of queries. Throws RunError if
    /// memory is short.
    TriangleBvh(std::span<const Vec3> vertices, std::span<const Triangle> triangles, double margin);
    /// Ownership of a hierarchy's Embree device. A device of its own counts the memory of the hierarchy. A shared
    /// device serves several hierarchies. Scenes with thousands of hierarchies need a shared device, because Embree
    /// creates at most about 1000 devices.
    enum class Device : std::uint8_t { own, shared };
    /// Builds the hierarchy over clusters that several hierarchies share.
    TriangleBvh(Clusters clusters, double margin, Device device = Device::own);
    ~TriangleBvh();
    TriangleBvh(TriangleBvh&&) noexcept;
    TriangleBvh& operator=(TriangleBvh&&) noexcept;

    /// Visits every triangle whose distance from the segment [from, to] is at most margin() + slack(), up to the
    /// smallest fraction returned so far. May visit further triangles. The order is unspecified. Any number of threads
    /// may call it. Both ends must be finite.
    void query_segment(const Vec3& from, const Vec3& to, void* context, VisitSegment visit) const;

    /// Calls query_segment() with any callable `double(std::uint32_t triangle)`.
    template <class Callable>
    void query_segment(const Vec3& from, const Vec3& to, Callable&& callable) const {
        using Function = std::remove_reference_t<Callable>;
        query_segment(
            from, to, const_cast<void*>(static_cast<const void*>(&callable)),
            [](void* context, std::uint32_t triangle) { return (*static_cast<Function*>(context))(triangle); });
    }

    /// Callback for a triangle that the tube may touch. The triangle is certainly not touched outside the given
    /// interval, in fractions of the path. Returns the same value as VisitSegment.
    using VisitTube = double (*)(void* context, std::uint32_t triangle, double enter, double leave);

    /// Visits every triangle that the tube touches, and few other triangles. TriangleCluster::overlaps() selects them,
    /// four triangles at a time. Of a tube whose margin and sagitta exceed margin() + slack(), only the triangles
    /// within that distance of the path are certain to be visited.
    void query_tube(const Tube& tube, void* context, VisitTube visit) const;

    /// Calls query_tube() with any callable `double(std::uint32_t triangle, double enter, double leave)`.
    template <class Callable>
    void query_tube(const Tube& tube, Callable&& callable) const {
        using Function = std::remove_reference_t<Callable>;
        query_tube(tube, const_cast<void*>(static_cast<const void*>(&callable)),
                   [](void* context, std::uint32_t triangle, double enter, double leave) {
                       return (*static_cast<Function*>(context))(triangle, enter, leave);
                   });
    }

    /// Callback for a candidate. It returns the distance, in m, beyond which triangles no longer matter. The query uses
    /// the smallest distance returned so far.
    using VisitPoint = double (*)(void* context, std::uint32_t triangle);

    /// Visits every triangle whose distance from p is at most within + margin() + slack(), in unspecified order. May
    /// visit further triangles. The smallest distance returned so far replaces `within` (m, >= 0, may be infinite). Any
    /// number of threads may call it. p must be finite.
    void query_point(const Vec3& p, double within, void* context, VisitPoint visit) const;

    /// Calls query_point() with any callable `double(std::uint32_t triangle)`.
    template <class Callable>
    void query_point(const Vec3& p, double within, Callable&& callable) const {
        using Function = std::remove_reference_t<Callable>;
        query_point(p, within, const_cast<void*>(static_cast<const void*>(&callable)),
                    [](void* context, std::uint32_t triangle) { return (*static_cast<Function*>(context))(triangle); });
    }

    /// Returns the margin given at construction, in m.
    [[nodiscard]] double margin() const;
    /// Returns the distance, in m, by which positions may be beside the segment in addition to the margin (see
    /// kBoxSlack).
    [[nodiscard]] double slack() const;
    /// Returns the bytes of the hierarchy, without vertices and triangles. It is 0 with a shared device, which does not
    /// count memory.
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Sets the Embree device configuration of hierarchies built later ("isa=sse2"); empty: defaults. Tests use this
/// function to show that no result depends on the configuration. It must not be called while hierarchies are being
/// built.
void set_embree_config(std::string config);

/// Returns Embree's name and version, for `--version` and reports.
[[nodiscard]] std::string embree_version();

}  // namespace ricochet
