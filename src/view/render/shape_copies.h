/// \file
/// Private: many copies of one shape as a single geometry of Embree, which takes a few hundred bytes a copy whatever
/// the shape. Included by the .cpp files that use Embree only.
#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/acceleration/embree.h"
#include "view/render/drawn_mesh.h"
#include "view/render/preview.h"

namespace ricochet {

/// What a query learns about a copy that it hits. A QueryContext's user pointer leads to as many as it has rays, by
/// their ids.
struct CopyHit {
    unsigned triangle = 0;
    float u = 0.0F;
    float v = 0.0F;
};

/// Stays where it is while Embree has its geometry.
class ShapeCopies {
public:
    /// shapes: all of each at most 1 away from its origin.
    void set_shapes(RTCDevice device, std::vector<TriangleMesh> shapes);

    /// The copies that can be drawn, about the origin; null pointer where there are none. Queries need a CopyHit for
    /// each ray.
    [[nodiscard]] RTCGeometry make_geometry(RTCDevice device, const PreviewCopies& copies, const Vec3& origin);

    /// What a ray has hit.
    [[nodiscard]] PreviewHit hit(const RTCRayHit& hit, const CopyHit& copy_hit, const PreviewRay& ray) const;

private:
    struct Copy {
        AffineMap shape_from_world;  // without the translation
        Vec3 center;                 // about the origin, when the shutter closes
        Vec3 half_size;              // of its box
        Vec3 color;
        Vec3 emission;
        std::uint32_t shape;  // from 1 on; 0: a ball of radius 1
    };
    struct Shape {
        DrawnMesh mesh;
        embree::Scene scene;
    };
    // A ray in the shape's own coordinates; distances are those of the world's ray.
    struct LocalRay {
        Vec3 origin, direction;
    };

    [[nodiscard]] Vec3 center_at(std::size_t copy, double time) const;
    [[nodiscard]] LocalRay local_ray(const RTCRay& ray, std::size_t copy) const;
    // How far a ray goes to the ball or the shape, and what it meets; false where it meets nothing nearer.
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
    std::vector<std::vector<Vec3>> ways_;  // about the origin; empty without any
};

}  // namespace ricochet
