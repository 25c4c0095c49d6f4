/// \file
/// Which triangles may a segment touch, which are near a point? A bounding volume hierarchy over padded boxes; the ray
/// library lives behind it.
///
/// The hierarchy works in single precision and only proposes: every triangle that comes within the reach
/// of the segment or point (in exact arithmetic) is visited, and some that do not. Nothing that the ray library
/// computes about triangles is used, so results do not depend on its version, instruction set or layout.
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
    /// Called for a proposed triangle. Returns the fraction of the segment, in [0, 1], beyond which triangles are no
    /// longer of interest (1: all are). A pure narrowing: the smallest value returned so far holds.
    using Visit = double (*)(void* context, std::uint32_t triangle);

    using Clusters = std::shared_ptr<const std::vector<TriangleCluster>>;

    /// Builds the hierarchy with all threads. Coordinates must be finite and, after centring, below kLargestCoordinate.
    /// reach (m, >= 0): paths may bulge that far off the segments that are asked about. Throws RunError when memory is
    /// short.
    TriangleBvh(std::span<const Vec3> vertices, std::span<const Triangle> triangles, double reach);
    /// The same over clusters that several hierarchies share.
    TriangleBvh(Clusters clusters, double reach);
    ~TriangleBvh();
    TriangleBvh(TriangleBvh&&) noexcept;
    TriangleBvh& operator=(TriangleBvh&&) noexcept;

    /// Visits every triangle whose distance from the segment [from, to] is at most margin() + slack() (and
    /// possibly more), up to the narrowed fraction, in unspecified order. Safe from any number of threads. Both ends
    /// must be finite.
    void query_segment(const Vec3& from, const Vec3& to, void* context, Visit visit) const;

    /// The same with any callable `double(std::uint32_t triangle)`.
    template <class Callable>
    void query_segment(const Vec3& from, const Vec3& to, Callable&& callable) const {
        using Function = std::remove_reference_t<Callable>;
        query_segment(
            from, to, const_cast<void*>(static_cast<const void*>(&callable)),
            [](void* context, std::uint32_t triangle) { return (*static_cast<Function*>(context))(triangle); });
    }

    /// Called for a triangle that the tube may touch, with the stretch of its way (fractions of it) outside of which it
    /// certainly does not. Returns as Visit does.
    using VisitTube = double (*)(void* context, std::uint32_t triangle, double enter, double leave);

    /// Visits every triangle that the tube touches, and few others: TriangleCluster::near() decides, four triangles at
    /// a time. The tube's margin and sagitta together must be at most margin() + slack().
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

    /// Called for a proposed triangle. Returns the distance, m, beyond which triangles are no longer of interest. A
    /// pure narrowing: the smallest value returned so far holds.
    using VisitNear = double (*)(void* context, std::uint32_t triangle);

    /// Visits every triangle whose distance from p is at most within + margin() + slack() (and possibly more), where
    /// `within` (m, >= 0, may be infinite) is replaced by the narrowed distance; in unspecified order. Safe from any
    /// number of threads. p must be finite.
    void query_point(const Vec3& p, double within, void* context, VisitNear visit) const;

    /// The same with any callable `double(std::uint32_t triangle)`.
    template <class Callable>
    void query_point(const Vec3& p, double within, Callable&& callable) const {
        using Function = std::remove_reference_t<Callable>;
        query_point(p, within, const_cast<void*>(static_cast<const void*>(&callable)),
                    [](void* context, std::uint32_t triangle) { return (*static_cast<Function*>(context))(triangle); });
    }

    /// m, as given.
    [[nodiscard]] double margin() const;
    /// m, what the boxes allow for places beside the segment (see kBoxSlack).
    [[nodiscard]] double slack() const;
    /// Bytes that the hierarchy holds (without the vertices and triangles).
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Settings that hierarchies built from now on hand to the ray library, in its own words ("isa=sse2"); empty: its
/// defaults. No result depends on them, which is what they are for: to show it. Not while hierarchies are being built.
void set_embree_config(std::string settings);

/// Name, version and instruction sets of the ray library, for `--version` and reports.
[[nodiscard]] std::string embree_version();

}  // namespace ricochet
