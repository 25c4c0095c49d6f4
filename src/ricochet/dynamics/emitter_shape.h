/// \file
/// Where particles are born: points, surfaces and volumes, each filled uniformly.
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/random.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/mesh_interior.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// All births at one point.
struct PointShape {
    Vec3 center;
};
/// Uniform on a flat disk.
struct DiskShape {
    Vec3 center;
    Vec3 normal{0, 0, 1};  ///< not zero
    double radius = 1.0;   ///< m, > 0
};
/// Uniform in an axis-aligned box.
struct BoxShape {
    Vec3 center;
    Vec3 size{1, 1, 1};  ///< full edge lengths, m, >= 0
};
/// Uniform in a ball, or on its surface.
struct SphereShape {
    Vec3 center;
    double radius = 1.0;   ///< m, > 0
    bool surface = false;  ///< true: births on the sphere itself, launched along the outward normal
};
/// Uniform by area on a triangle mesh, launched along the triangle normals.
struct MeshSurfaceShape {
    std::shared_ptr<const TriangleMesh> mesh;  ///< in world coordinates (placement already applied)
};
/// Uniform in a cone, launched along the line from the apex.
struct ConeShape {
    Vec3 apex;
    Vec3 axis{0, 0, 1};           ///< from the apex into the cone, not zero
    double angle_degrees = 20.0;  ///< between the axis and the side, 0 (a line) to below 90
    double height = 1.0;          ///< m, > 0
};
/// Uniform in the inside of a closed mesh, decided exactly (MeshInterior).
struct MeshVolumeShape {
    std::shared_ptr<const TriangleMesh> mesh;  ///< in world coordinates
};
using EmitterShape =
    std::variant<PointShape, DiskShape, BoxShape, SphereShape, MeshSurfaceShape, ConeShape, MeshVolumeShape>;

/// A place of birth.
struct LaunchPlace {
    Vec3 position;
    Vec3 direction;  ///< the shape's own, of unit length
};

/// Draws places of a shape.
class ShapeSampler {
public:
    /// Throws InputError, with a sentence on what is wrong, for a shape outside the ranges stated there, for a mesh
    /// without area, and for a volume that is not closed or fills less than kSmallestFill of its box.
    explicit ShapeSampler(const EmitterShape& shape);

    /// radius: of the particle, m; on mesh surfaces it is born so far off the surface.
    [[nodiscard]] LaunchPlace draw(double radius, RandomSequence& random) const;

    /// Inside test by rejection must come to an end: least part of its box that a mesh's volume has to fill.
    static constexpr double kSmallestFill = 1e-4;

private:
    [[nodiscard]] LaunchPlace on_disk(const DiskShape& disk, RandomSequence& random) const;
    [[nodiscard]] LaunchPlace in_cone(const ConeShape& cone, RandomSequence& random) const;
    [[nodiscard]] LaunchPlace on_mesh(const TriangleMesh& mesh, double radius, RandomSequence& random) const;
    [[nodiscard]] LaunchPlace in_mesh(RandomSequence& random) const;

    EmitterShape shape_;
    std::vector<double> cumulative_area_;         // of a mesh surface's triangles
    std::shared_ptr<const MeshInterior> inside_;  // of a mesh volume
    double cone_slope_ = 0.0;                     // tangent of a cone's angle
};

/// Points whose convex hull is that of the shape; round shapes by `segments` points a circle that touches from inside.
/// seen_from: of a ball only the outline seen from there counts.
[[nodiscard]] std::vector<Vec3> outline_points(const EmitterShape& shape, const Vec3& seen_from, int segments);
/// A box around the shape.
[[nodiscard]] Box3 bounds(const EmitterShape& shape);

}  // namespace ricochet
