/// \file
/// Distance field: a grid of guaranteed lower bounds on the distance to the nearest triangle.
///
/// Each cell stores its chessboard distance to the nearest cell that contains a triangle (A. Rosenfeld, J. L. Pfaltz,
/// "Distance Functions on Digital Pictures", Pattern Recognition 1, 1968). Sphere tracing (J. C. Hart, The Visual
/// Computer 12, 1996) uses the field to cross free space. The field is needed if curved paths leave the broad phase's
/// margin too soon.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// A distance field of static triangles. Immutable after construction, so it is safe from any number of threads.
class DistanceField {
public:
    /// Makes an empty field, whose lower_bound() is 0 everywhere.
    DistanceField() = default;
    /// Builds the field with all threads, from triangles with finite corners inside the box. The field has about two
    /// cells per triangle, at least 2^15 for small meshes and at most kMaxCells. A cell has one byte. The grid is
    /// coarser if
    /// large triangles overlap.
    DistanceField(std::span<const Vec3> vertices, std::span<const Triangle> triangles, const Box3& box);

    /// Returns a distance, in m, such that no triangle is nearer to p. The distance is 0 near triangles. p must be
    /// finite.
    [[nodiscard]] double lower_bound(const Vec3& p) const;
    /// Returns the edge length of a cell, in m, or 0 for an empty field. lower_bound() is 0 within about two cells of
    /// the triangles.
    [[nodiscard]] double cell() const { return cell_; }
    [[nodiscard]] std::size_t memory_bytes() const { return cells_.capacity(); }

    static constexpr std::size_t kMaxCells = std::size_t{1} << 21;

private:
    void choose_cells(std::size_t most, const std::function<bool(double cell)>& is_cheap);
    void mark(const std::array<Vec3, 3>& corners);
    void mark_cells_of(const Box3& box);
    void spread();
    void spread_rows(std::size_t z, std::size_t y, int direction);
    [[nodiscard]] std::size_t index(std::size_t x, std::size_t y, std::size_t z) const {
        return (z * count_[1] + y) * count_[0] + x;
    }

    Box3 box_;
    double cell_ = 0.0;
    double per_cell_ = 0.0;  ///< in 1/m
    std::array<std::size_t, 3> count_{};
    std::vector<std::uint8_t> cells_;
};

}  // namespace ricochet
