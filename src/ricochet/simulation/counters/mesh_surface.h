/// \file
/// Private to the simulation: the triangle mesh of a counter, and passages through it.
///
/// A curved path is replaced by chords between its own points. Near the mesh the chords are so short that they deviate
/// from the path only by rounding. All triangles see the same chords, and the exact predicates decide which triangles a
/// chord crosses. The path is treated as moved by an infinitesimal vector (e, e^2, e^3), so it meets no edge, no vertex
/// and no plane of a triangle along a whole chord. It therefore passes exactly one of two triangles at their common
/// edge, and no passage is lost between two steps.
/// Source of the method: H. Edelsbrunner, E. P. Muecke, "Simulation of Simplicity", ACM Transactions on Graphics 9,
/// 1990.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/geometry/acceleration/box_tree.h"
#include "ricochet/simulation/counters/counter.h"
#include "ricochet/simulation/counters/path_legs.h"

namespace ricochet {

/// Corners of a triangle.
using Corners3 = std::array<Vec3, 3>;

/// Returns the side of a triangle on which a point is: +1 for the side of the normal, -1 for the other side. A point in
/// the plane is moved by the infinitesimal vector. Returns 0 only for triangles without area. Exact.
[[nodiscard]] int moved_side_of(const Corners3& triangle, const Vec3& point);
/// Returns +1 if the chord from p to q passes the triangle from front to back, -1 from back to front, and 0 if it does
/// not pass. The chord is moved by the infinitesimal vector. Exact.
[[nodiscard]] int passage_through(const Corners3& triangle, const Vec3& p, const Vec3& q);

/// The mesh of a counter.
class MeshSurface {
public:
    explicit MeshSurface(const MeshCounter& mesh);

    /// Returns true if the mesh separates an inside from an outside.
    [[nodiscard]] bool is_closed() const { return is_closed_; }

    /// Calls report(leg, is_forward, s, normal) for each passage of a move, at s seconds from the start of the leg. The
    /// normal points from front to back.
    template <class Report>
    void trace(const Vec3& from, const Vec3& to, std::span<const FlownPiece> pieces, const Report& report) const {
        if (is_missed(from, to, pieces)) return;
        std::vector<Found> found;
        for_each_leg(from, to, pieces, [&](const PathLeg& leg) {
            found.clear();
            find(leg, found);
            for (const Found& one : found) report(leg, one.is_forward, one.time, -normals_[one.triangle]);
        });
    }

private:
    struct Found {
        double time = 0.0;  // from the start of the leg, s
        std::uint32_t triangle = 0;
        bool is_forward = false;
    };
    /// Part of a leg between two of its points.
    struct Chord {
        double begin = 0.0;  // s
        double end = 0.0;    // s
        Vec3 from;
        Vec3 to;
    };
    class LegSearch;

    [[nodiscard]] bool is_missed(const Vec3& from, const Vec3& to, std::span<const FlownPiece> pieces) const;
    /// Finds the passages along a leg, in the order of time.
    void find(const PathLeg& leg, std::vector<Found>& found) const;

    std::vector<Corners3> triangles_;  // all with an area
    std::vector<Vec3> normals_;        // of length 1, to the front
    BoxTree tree_;                     // boxes of the triangles
    bool is_closed_ = false;
};

}  // namespace ricochet
