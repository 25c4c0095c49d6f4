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

/// Geometry numbers in the scenes of moving objects and of glowing lines. The scene of moving objects contains neither
/// spheres nor glowing lines.
enum MovingGeometry : unsigned { kLines, kCloth, kCopies, kGlowingLines };

/// Colours of the lines of one Embree geometry, in the order of its primitives.
struct LineGroup {
    std::vector<Vec3> colors;
    std::vector<Vec3> emissions;  // one per line; empty: no line emits light
};

/// Meshes in one Embree scene; geometry k of the scene is mesh k.
struct MeshGroup {
    embree::Scene scene;
    std::vector<DrawnMesh> meshes;

    [[nodiscard]] bool empty() const { return meshes.empty(); }
};

/// Embree's hit of a ray, and the object that was hit.
struct RayFind {
    RTCRayHit query;
    unsigned geometry = RTC_INVALID_GEOMETRY_ID;  ///< geometry number in the scene that was hit; invalid: no hit
    /// Group whose scene was hit; null: another scene (spheres, moving objects or glowing lines).
    const MeshGroup* group = nullptr;
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
    // Paths of the drawn spheres while the shutter is open; empty if no sphere moves.
    std::vector<std::vector<Vec3>> sphere_paths;
    bool has_sphere_rays = false;
    LineGroup dark_lines, bright_lines;
    std::vector<GlowingLine> glowing_lines;  // one per glowing line, in the order of bright_lines
    DrawnMesh cloth;
    ShapeCopies copies;
    bool has_moving = false;
    Vec3 origin;

    // Construction of the scenes, in preview.cpp.
    void take_spheres(PreviewSpheres&& source);
    void build_spheres();
    void add_lines(const PreviewLines& lines);
    [[nodiscard]] LineGroup attach_lines(const PreviewLines& lines, const std::vector<std::size_t>& drawn,
                                         RTCScene scene, MovingGeometry id) const;
    void add_cloth(PreviewMesh source);
    void add_copies(const PreviewCopies& source);
    void add_mesh(MeshGroup& group, PreviewMesh mesh) const;
    void fill(MeshGroup& solid_ones, MeshGroup& glass_ones, std::vector<PreviewMesh> meshes) const;

    // Ray tracing, in preview_rays.cpp.
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
