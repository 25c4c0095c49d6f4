/// \file
/// Private: many copies of shapes in a single Embree geometry. A copy takes a few hundred bytes, independent of its
/// shape. Included only by the .cpp files that use Embree.
#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/acceleration/embree.h"
#include "view/render/drawn_mesh.h"
#include "view/render/preview.h"

namespace ricochet {

/// Point of a copy's mesh that a ray hits. The user pointer of a QueryContext points to an array of these results,
/// indexed by the ray's id.
struct CopyHit {
    unsigned triangle = 0;
    float u = 0.0F;
    float v = 0.0F;
};

/// Copies of shapes. The object must keep its address while Embree uses its geometry.
class ShapeCopies {
public:
    /// Sets the shapes. The vertices of each shape must be at most 1 from its origin.
    void set_shapes(RTCDevice device, std::vector<TriangleMesh> shapes);

    /// Creates a geometry of the drawable copies, with coordinates relative to `origin`. Returns a null pointer if no
    /// copy is drawable. Queries need a CopyHit for each ray.
    [[nodiscard]] RTCGeometry make_geometry(RTCDevice device, const PreviewCopies& copies, const Vec3& origin);

    /// Converts Embree's hit on a copy.
    [[nodiscard]] PreviewHit hit(const RTCRayHit& hit, const CopyHit& copy_hit, const PreviewRay& ray) const;

private:
    struct Copy {
        AffineMap shape_from_world;  // linear part only
        Vec3 center;                 // relative to `origin`, when the shutter closes
        Vec3 half_size;              // half the edge lengths of the copy's bounding box
        Vec3 color;
        Vec3 emission;
        std::uint32_t shape;  // counted from 1; 0: the unit sphere
    };
    struct Shape {
        DrawnMesh mesh;
        embree::Scene scene;
    };
    // Ray in the coordinates of a shape. `direction` is not normalized, so that distances along the ray are in world
    // units.
    struct LocalRay {
        Vec3 origin, direction;
    };

    [[nodiscard]] Vec3 center_at(std::size_t copy, double time) const;
    [[nodiscard]] LocalRay local_ray(const RTCRay& ray, std::size_t copy) const;
    // Intersects a ray with a copy. Returns false if the ray misses the copy or already has a closer hit.
    [[nodiscard]] bool meet(const RTCRay& ray, std::size_t copy, float& distance, CopyHit& what) const;
    [[nodiscard]] bool meet_ball(const LocalRay& local, const RTCRay& ray, float& distance) const;
    [[nodiscard]] static bool meet_mesh(const Shape& shape, const LocalRay& local, const RTCRay& ray, float& distance,
                                        CopyHit& what);
    [[nodiscard]] Vec3 world_normal(std::size_t copy, const Vec3& shape_normal) const;
    static void write_bounds(const RTCBoundsFunctionArguments* args);
    static void intersect(const RTCIntersectFunctionNArguments* args);
    static void occlude(const RTCOccludedFunctionNArguments* args);

    std::vector<Shape> shapes_;
    std::vector<Copy> copies_;
    std::vector<std::vector<Vec3>> shutter_paths_;  // relative to `origin`; empty if no copy moves
};

}  // namespace ricochet
