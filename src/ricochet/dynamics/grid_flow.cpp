#include "ricochet/dynamics/grid_flow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/dynamics/detail/checks.h"

namespace ricochet {
namespace {

// Place along one axis: between two samples.
struct Cell {
    std::size_t first = 0;
    std::size_t second = 0;
    double part = 0.0;  // of the second
    bool inside = true;
};

Cell cell_of(double x, double origin, double spacing, std::uint32_t count) {
    if (count == 1) return {};
    const double place = (x - origin) / spacing;
    const double last = count - 1;
    const bool inside = place >= 0.0 && place <= last;
    if (!(place > 0.0)) return {0, 0, 0.0, inside};  // and what is no number
    if (place >= last) return {count - std::size_t{1}, count - std::size_t{1}, 0.0, inside};
    const double below = std::floor(place);
    const auto first = static_cast<std::size_t>(below);
    return {first, first + 1, place - below, inside};
}

Vec3 between(const Vec3& a, const Vec3& b, double part) { return a + (b - a) * part; }

class GridFlow final : public FlowField {
public:
    GridFlow(VectorGrid grid, OutsideGrid outside) : grid_(std::move(grid)), outside_(outside) {}

    [[nodiscard]] Vec3 velocity(const Vec3& position, double) const override {
        const Cell x = cell_of(position.x, grid_.origin.x, grid_.spacing.x, grid_.counts[0]);
        const Cell y = cell_of(position.y, grid_.origin.y, grid_.spacing.y, grid_.counts[1]);
        const Cell z = cell_of(position.z, grid_.origin.z, grid_.spacing.z, grid_.counts[2]);
        if (outside_ == OutsideGrid::zero && !(x.inside && y.inside && z.inside)) return {};
        const Vec3 lower = between(row(x, y.first, z.first), row(x, y.second, z.first), y.part);
        const Vec3 upper = between(row(x, y.first, z.second), row(x, y.second, z.second), y.part);
        return between(lower, upper, z.part);
    }
    [[nodiscard]] bool is_steady() const override { return true; }

private:
    [[nodiscard]] Vec3 row(const Cell& x, std::size_t j, std::size_t k) const {
        const std::size_t start = grid_.counts[0] * (j + grid_.counts[1] * k);
        return between(grid_.values[start + x.first], grid_.values[start + x.second], x.part);
    }

    VectorGrid grid_;
    OutsideGrid outside_;
};

void check(const VectorGrid& grid) {
    detail::require_finite(grid.origin, "grid: the origin", "m");
    for (int axis = 0; axis < 3; ++axis) detail::require_positive(grid.spacing[axis], "grid: the spacing", "m");
    const auto& n = grid.counts;
    // As a quotient, since the product may overflow.
    const bool fits = n[0] > 0 && n[1] > 0 && n[2] > 0 && grid.values.size() % n[0] == 0 &&
                      grid.values.size() / n[0] == std::uint64_t{n[1]} * n[2];
    if (!fits) {
        throw InputError(
            fmt::format("grid: found {} values for {} x {} x {} points", grid.values.size(), n[0], n[1], n[2]));
    }
    const auto bad = std::find_if_not(grid.values.begin(), grid.values.end(), is_finite);
    if (bad != grid.values.end()) {
        throw InputError(fmt::format("grid: the value of point {} is not finite", bad - grid.values.begin()));
    }
}

}  // namespace

FlowPointer make_grid_flow(VectorGrid grid, OutsideGrid outside) {
    check(grid);
    return std::make_shared<GridFlow>(std::move(grid), outside);
}

}  // namespace ricochet
