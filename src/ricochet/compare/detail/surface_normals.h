/// \file
/// Which way a collider's surface faces where a particle met it, as well as a report of the verifier says where.
#pragma once

#include <optional>
#include <vector>

#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"
#include "ricochet/simulation.h"
#include "ricochet/verify/violation.h"

namespace ricochet::detail {

/// Keeps the surfaces of a simulation.
class SurfaceNormals {
public:
    explicit SurfaceNormals(const Simulation& simulation);
    /// Of any length, for a crossing. Of a triangle by the counter-clockwise rule; of a ball or cylinder outward, for
    /// the place where the segment ended, since that is what is reported. Zero where there is none: planes.
    [[nodiscard]] Vec3 at(const Violation& crossing) const;

private:
    struct Shape {
        AffineMap world_from_unit;
        bool is_cylinder = false;
    };
    struct Surface {
        std::optional<TriangleMesh> mesh;
        std::optional<Shape> shape;
    };
    [[nodiscard]] static Vec3 shape_normal(const Shape& shape, const Vec3& place);

    std::vector<Surface> surfaces_;
};

}  // namespace ricochet::detail
