#include "python/merged_vertices.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/vertex_welder.h"

namespace ricochet {
namespace {

constexpr std::uint32_t kUnknown = std::numeric_limits<std::uint32_t>::max();

/// Grid of kept vertices, with cells as wide as the tolerance. Kept vertices are more than the tolerance apart, so a
/// cell contains few of them.
class VertexGrid {
public:
    VertexGrid(double tolerance, std::vector<Vec3>& kept) : tolerance_(tolerance), kept_(kept) {}

    [[nodiscard]] std::uint32_t index_of(const Vec3& p) {
        const Cell home = cell_of(p);
        std::uint32_t found = kUnknown;
        for (double x = -1; x <= 1; ++x) {
            for (double y = -1; y <= 1; ++y) {
                for (double z = -1; z <= 1; ++z) {
                    const auto cell = cells_.find({home[0] + x, home[1] + y, home[2] + z});
                    if (cell == cells_.end()) continue;
                    for (const std::uint32_t v : cell->second) {
                        if (length(kept_[v] - p) <= tolerance_) found = std::min(found, v);
                    }
                }
            }
        }
        if (found != kUnknown) return found;
        found = static_cast<std::uint32_t>(kept_.size());
        kept_.push_back(p);
        cells_[home].push_back(found);
        return found;
    }

private:
    using Cell = std::array<double, 3>;

    [[nodiscard]] Cell cell_of(const Vec3& p) const {
        return {std::floor(p.x / tolerance_), std::floor(p.y / tolerance_), std::floor(p.z / tolerance_)};
    }

    double tolerance_;
    std::vector<Vec3>& kept_;
    std::map<Cell, std::vector<std::uint32_t>> cells_;
};

void require_tolerance(const TriangleMesh& mesh, double tolerance) {
    double largest = 0.0;
    for (const Vec3& vertex : mesh.vertices) largest = std::max(largest, max_abs(vertex));
    const double least = 0x1p-48 * largest;
    if (tolerance == 0.0 || (tolerance >= least && tolerance > 0.0 && std::isfinite(tolerance))) return;
    throw InputError(fmt::format("merge: found {:g} m, expected 0 or a finite tolerance of at least {:.3g} m",
                                 tolerance, std::max(least, std::numeric_limits<double>::min())));
}

}  // namespace

TriangleMesh merged_within(const TriangleMesh& mesh, double tolerance) {
    require_corners(mesh);
    require_tolerance(mesh, tolerance);
    TriangleMesh merged = mesh;
    std::vector<Vec3> kept;
    const auto rename = [&](auto&& table) {
        rename_corners(merged, [&](std::uint32_t v) { return table.index_of(mesh.vertices[v]); });
    };
    if (tolerance == 0.0) {
        rename(VertexWelder(kept));
    } else {
        rename(VertexGrid(tolerance, kept));
    }
    merged.vertices = std::move(kept);
    const auto has_three = [](const Triangle& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; };
    const auto count = [&](const TriangleMesh& some) {
        return std::count_if(some.triangles.begin(), some.triangles.end(), has_three);
    };
    if (const auto before = count(mesh); before > 0 && count(merged) == 0) {
        throw InputError(
            fmt::format("merge: {:g} m joins corners of all {} triangles; expected a tolerance far below the length of "
                        "edges",
                        tolerance, before));
    }
    return merged;
}

}  // namespace ricochet
