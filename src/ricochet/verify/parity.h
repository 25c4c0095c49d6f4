/// \file
/// Exact test whether a point is inside a closed mesh. It is independent of the sweep's predicates, and is the
/// reference for every claim that no particle has passed through a surface.
///
/// Method: the test counts the crossings of an axis-parallel ray with the triangles of the ray's column. The two fixed
/// coordinates of the ray are moved by infinitesimal amounts (symbolic perturbation: H. Edelsbrunner, E. P. Muecke,
/// "Simulation of Simplicity", ACM Transactions on Graphics 9, 1990). The ray then hits no edge and no vertex. The
/// parity is correct for every point that is not on the surface.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/verify/verifier.h"

namespace ricochet {

/// Returns the number of edges that belong to an odd number of triangle sides. An edge is a pair of different
/// positions. The result is 0 for a closed mesh.
[[nodiscard]] std::size_t count_open_edges(const TriangleMesh& mesh);

/// Inside test for one closed mesh. A point inside an even number of nested shells is outside the mesh. Triangles
/// without area are ignored, as in collisions, because their neighbours cover them.
class ParityOracle {
public:
    /// Throws std::invalid_argument if the mesh has open edges, because parity is then undefined.
    explicit ParityOracle(const TriangleMesh& mesh);

    /// Returns the exact side of a point. A point with a non-finite coordinate is outside. The function is thread-safe.
    [[nodiscard]] Side side(const Vec3& point) const;
    [[nodiscard]] bool inside(const Vec3& point) const { return side(point) == Side::inside; }

private:
    /// A triangle with permuted coordinates, such that the ray runs along +z.
    struct Face {
        std::array<Vec3, 3> corners;
        Box3 box;
        int area_sign = 0;  // sign of the area projected along z; 0 if the projection has no area
    };
    enum class Crossing { none, above, touches };
    struct CellRange {
        std::size_t first = 0;
        std::size_t last = 0;
    };

    void add_faces(const TriangleMesh& mesh);
    void choose_resolution();
    void fill_columns();
    [[nodiscard]] Vec3 permuted(const Vec3& point) const;
    [[nodiscard]] CellRange cells(double lower, double upper, double origin, double per_length) const;
    [[nodiscard]] std::size_t count_entries() const;
    [[nodiscard]] static Crossing crossing(const Face& face, const Vec3& point);

    int ray_axis_ = 2;
    Box3 box_;
    std::vector<Face> faces_;
    std::size_t resolution_ = 1;
    double per_x_ = 0.0;  // number of columns per metre
    double per_y_ = 0.0;
    std::vector<std::uint32_t> column_begin_;
    // Faces of each column, in descending order of their upper ends along the ray.
    std::vector<std::uint32_t> column_faces_;
};

}  // namespace ricochet
