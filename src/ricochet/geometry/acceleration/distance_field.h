/// \file
/// Distance field: a grid of certain lower bounds of the distance to the nearest triangle.
///
/// Each cell holds its chessboard distance to the nearest cell with a triangle in it (A. Rosenfeld, J. L. Pfaltz,
/// "Distance Functions on Digital Pictures", Pattern Recognition 1, 1968). Sphere tracing (J. C. Hart, The Visual
/// Computer 12, 1996) crosses free space with it where curved paths leave the broad phase's margin too soon.
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

/// Immutable after construction; safe from any number of threads.
class DistanceField {
public:
    /// Empty: lower_bound() is 0 everywhere.
    DistanceField() = default;
    /// Built with all threads, from triangles with finite corners inside the box. Some two cells a triangle, 2^15 for
    /// small meshes, at most kMaxCells, a byte each; fewer for large triangles that overlap.
    DistanceField(std::span<const Vec3> vertices, std::span<const Triangle> triangles, const Box3& box);

    /// m: no triangle is nearer to p than this. 0 near triangles. p must be finite.
    [[nodiscard]] double lower_bound(const Vec3& p) const;
    /// Edge of a cell, m: lower_bound() is 0 within about two of them around the triangles. 0 when empty.
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
    double per_cell_ = 0.0;  ///< 1 / m
    std::array<std::size_t, 3> count_{};
    std::vector<std::uint8_t> cells_;
};

}  // namespace ricochet
