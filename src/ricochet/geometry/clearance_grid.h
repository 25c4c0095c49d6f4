/// \file
/// How far is a point from all triangles, at least? Answered by a table, in some ten nanoseconds.
///
/// A fine grid of cubes holds, for the centre of each, a lower bound of the distance from the triangles, up to one and a
/// half cubes; a grid four times coarser knows how many cubes away the next one with a triangle is. A distance changes
/// by no more than the way (it is 1-Lipschitz), so a centre's bound less the way to the centre holds for every point of
/// the cube. Used for walking along a path in steps that are certainly free, as rays are marched through distance fields
/// (J. C. Hart, "Sphere Tracing", The Visual Computer 12, 1996).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/geometry/triangle_mesh.h"

namespace ricochet {

/// Lower bounds of distances from static triangles. Immutable after construction; safe from any number of threads.
class ClearanceGrid {
public:
    /// Bytes of the fine grid for each triangle, and its least and largest size.
    static constexpr std::size_t kCellsPerTriangle = 12;
    static constexpr std::size_t kFewestCells = std::size_t{1} << 15;
    static constexpr std::size_t kMostCells = std::size_t{1} << 27;

    /// Uses all threads. There must be a triangle; coordinates must be finite.
    ClearanceGrid(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

    /// m: no triangle is nearer to p than this. It may be negative, which says as little as 0. p must be finite.
    [[nodiscard]] double clearance(const Vec3& p) const;
    /// Edge of the fine cubes, m: nearer to triangles than about half of it nothing is known.
    [[nodiscard]] double cell_size() const { return cell_; }
    [[nodiscard]] std::size_t memory_bytes() const { return fine_.size() + coarse_.size(); }

private:
    using Index = std::array<std::int64_t, 3>;

    struct Extent {
        Index count{};
        [[nodiscard]] std::size_t size() const {
            return static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]) *
                   static_cast<std::size_t>(count[2]);
        }
        [[nodiscard]] std::size_t at(std::int64_t i, std::int64_t j, std::int64_t k) const {
            return static_cast<std::size_t>((k * count[1] + j) * count[0] + i);
        }
    };

    void choose_cells(const Box3& box, std::size_t most);
    void mark(const Vec3& a, const Vec3& b, const Vec3& c);
    void mark_box(const Index& low, const Index& high, const Vec3& a, const Vec3& b, const Vec3& c);
    void lower(std::size_t cell, double distance);
    void fill_coarse();
    void spread_coarse();

    Vec3 origin_;  ///< lower corner of the grids
    double cell_ = 0.0;
    double per_cell_ = 0.0;
    Box3 box_;  ///< of the triangles
    Extent fine_extent_;
    Extent coarse_extent_;
    std::vector<std::uint8_t> fine_;    ///< eighths of a cell
    std::vector<std::uint8_t> coarse_;  ///< cubes to the next one with a triangle, by the largest coordinate difference
};

}  // namespace ricochet
