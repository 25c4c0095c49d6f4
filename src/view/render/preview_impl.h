/// \file
/// Private: implementation of Preview. Included only by its .cpp files.
#pragma once

#include <optional>
#include <vector>

#include "ricochet/geometry/acceleration/embree.h"
#include "view/render/drawn_mesh.h"
#include "view/render/preview.h"
#include "view/render/shape_copies.h"

namespace ricochet {

/// Geometries of the scene of moving objects. Spheres and glowing lines have scenes of their own.
enum MovingGeometry : unsigned { kLines, kCloth, kCopies, kGlowingLines };

/// Lines that are traced together, in the order of their primitives.
struct LineGroup {
    std::vector<Vec3> colors;
    std::vector<Vec3> emissions;  // per line, or empty
};

/// Meshes that are traced together; geometry k of the scene is mesh k.
struct MeshGroup {
    embree::Scene scene;
    std::vector<DrawnMesh> meshes;

    [[nodiscard]] bool empty() const { return meshes.empty(); }
};

/// Embree's hit of a ray, with the source of the hit.
struct RayFind {
    RTCRayHit query;
    unsigned geometry = RTC_INVALID_GEOMETRY_ID;  ///< number in the scene of the hit; invalid: no hit
    const MeshGroup* group = nullptr;             ///< group of the hit scene; null: the scene of spheres or of moving
                                                  ///< objects
    bool is_sphere = false;
    CopyHit copy;
};

struct Preview::Impl {
    embree::Device device = embree::make_device();
    MeshGroup solid, glass;
    MeshGroup moving_solid, moving_glass;
    embree::Scene moving_scene, sphere_scene, glow_scene;
    std::vector<PreviewPlane> planes;
    DrawnSpheres spheres;
    std::vector<std::vector<Vec3>> sphere_ways;  // paths of the drawn spheres while the shutter is open; empty at rest
    bool has_sphere_rays = false;
    LineGroup dark_lines, bright_lines;
    std::vector<GlowingLine> glowing_lines;  // in the order of bright_lines
    DrawnMesh cloth;
    ShapeCopies copies;
    bool has_moving = false;
    Vec3 origin;

    // Building, preview.cpp.
    void take_spheres(PreviewSpheres&& source);
    void build_spheres();
    void add_lines(const PreviewLines& lines);
    [[nodiscard]] LineGroup attach_lines(const PreviewLines& lines, const std::vector<std::size_t>& drawn,
                                         RTCScene scene, MovingGeometry id) const;
    void add_cloth(PreviewMesh source);
    void add_copies(const PreviewCopies& source);
    void add_mesh(MeshGroup& group, PreviewMesh mesh) const;
    void fill(MeshGroup& solid_ones, MeshGroup& glass_ones, std::vector<PreviewMesh> meshes) const;

    // Rays, preview_rays.cpp.
    [[nodiscard]] bool is_traceable(const PreviewRay& ray) const;
    [[nodiscard]] bool traces(SphereRays rays) const;
    static void meet(const MeshGroup& group, RayFind& find);
    void meet_spheres(RayFind& find) const;
    void meet_moving(RayFind& find) const;
    void meet_glow(RayFind& find) const;
    [[nodiscard]] PreviewHit hit_of(const RayFind& find, const PreviewRay& ray) const;
    [[nodiscard]] PreviewHit sphere_hit(std::size_t sphere, double distance, const Vec3& normal,
                                        const PreviewRay& ray) const;
    [[nodiscard]] PreviewHit moving_hit(const RayFind& find, const PreviewRay& ray) const;
    void trace_planes(const PreviewRay& ray, std::optional<PreviewHit>& nearest) const;
};

}  // namespace ricochet
