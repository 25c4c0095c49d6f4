/// \file
/// Objects of a picture, prepared for ray tracing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Mesh with colours in linear light, 0..1.
struct PreviewMesh {
    TriangleMesh mesh;
    Vec3 color{0.5, 0.5, 0.5};
    std::vector<Vec3> triangle_colors;  ///< one per triangle; empty: `color` applies
    bool glass = false;                 ///< transparent: rays pass through the mesh, and only trace_glass() finds it
    double roughness = 1.0;             ///< 0 (mirror) to 1 (matt)
};

/// Infinite plane. It is visible only from the side to which its normal points.
struct PreviewPlane {
    Vec3 point;
    Vec3 normal{0, 0, 1};  ///< of unit length
    Vec3 color{0.5, 0.5, 0.5};
    double roughness = 1.0;  ///< 0 (mirror) to 1 (matt)
    bool is_plain = false;   ///< drawn without the chequer
};

/// Spheres. The first three vectors have the same length. The last two are empty or have the same length too.
struct PreviewSpheres {
    std::vector<Vec3> centers;  ///< at shutter close, in m
    std::vector<double> radii;
    std::vector<Vec3> colors;
    /// Positions of each sphere at evenly spaced times from the opening to the closing of the shutter. All spheres have
    /// the same number of positions, 2 to 129. Empty if no sphere moves.
    std::vector<std::vector<Vec3>> shutter_paths{};
    std::vector<Vec3> emissions{};  ///< emitted light of each sphere; empty: no sphere emits light
};

/// The drawable spheres of PreviewSpheres at shutter close.
struct DrawnSpheres {
    std::vector<Vec3> centers;
    std::vector<double> radii;
    std::vector<Vec3> colors;
    std::vector<Vec3> emissions;  ///< empty: no sphere emits light
};

/// Thick straight lines with round ends. All vectors except `points` have the same length; the last two can be empty.
/// Glowing lines are visible directly and in reflections. They cast no shadows. Lamps represent the light that they
/// give to their surroundings (see GlowingLine).
struct PreviewLines {
    std::vector<std::array<std::uint32_t, 2>> ends;  ///< indices into points
    std::vector<Vec3> points;
    std::vector<double> radii;  ///< m, > 0
    std::vector<Vec3> colors;
    std::vector<Vec3> emissions{};  ///< emitted light of each line; empty: no line emits light
    /// Share of the exposure time that a glowing sphere spends on each line, 0..1, if lines are the paths of spheres.
    /// The line then gives as much light as the sphere gives in this time. Empty: the whole surface of each line glows.
    std::vector<double> parts{};
};

/// Line that lights its surroundings.
struct GlowingLine {
    Vec3 from, to;        ///< m
    double radius = 0.0;  ///< m
    Vec3 intensity;       ///< intensity of the whole line, in units of light times m^2, see Lamp::intensity
};

/// Copies of the shapes of Preview::set_shapes() or of the unit sphere. All vectors have the same length; the last
/// three can be empty.
struct PreviewCopies {
    std::vector<AffineMap> placements;  ///< from shape coordinates to world coordinates, at shutter close
    std::vector<Vec3> colors;
    /// Positions of the shape's origin, like PreviewSpheres::shutter_paths; the linear part of the map stays constant.
    std::vector<std::vector<Vec3>> shutter_paths{};
    std::vector<Vec3> emissions{};  ///< emitted light
    /// Number of each copy's shape, counted from 1, or 0 for the unit sphere. Empty: all copies use the first shape, or
    /// the unit sphere if no shape is set.
    std::vector<std::uint32_t> shapes{};
};

/// Objects that change from picture to picture.
struct PreviewMoving {
    PreviewSpheres spheres;
    PreviewLines lines;
    PreviewMesh cloth;                  ///< shaded smoothly, without creases
    std::vector<PreviewMesh> meshes{};  ///< colliders that move
    PreviewCopies copies{};
};

/// Option to trace spheres. Callers that compute the visible spheres by other means leave spheres out.
enum class SphereRays { traced, skipped };

/// Option to trace glowing lines. Rays that sample the light on a surface leave them out, because lamps represent their
/// light.
enum class GlowRays { traced, skipped };

/// Ray from a point along a unit vector.
struct PreviewRay {
    Vec3 origin;
    Vec3 direction;
    /// Time within the exposure, from 0 (shutter opens) to 1 (shutter closes).
    double time = 0.0;
    double reach = std::numeric_limits<double>::infinity();  ///< maximum distance, in m; objects beyond it are ignored
};

/// A hit of a ray.
struct PreviewHit {
    double distance = 0.0;  ///< m along the ray
    Vec3 point;
    Vec3 normal;  ///< smoothed, of unit length, towards the ray's origin
    Vec3 face;    ///< unit normal of the unsmoothed surface, towards the ray's origin
    Vec3 color;
    enum class Kind { mesh, plane, sphere, line, cloth, copy } kind = Kind::mesh;
    Vec3 emission{};  ///< emitted light
    /// Offset from `point` to the smooth surface that a mesh approximates, in m; shadow rays start there.
    Vec3 lift{};
    double roughness = 1.0;  ///< 0 (mirror) to 1 (matt)
    double time = 0.0;       ///< `time` of the ray
    bool is_plain = false;   ///< the hit object is a plane without the chequer
};

/// Largest number of rays in a packet.
inline constexpr std::size_t kPacketRays = 8;

/// Roughness of particles.
inline constexpr double kSphereRoughness = 0.42;

/// Colliders and particles in Embree scenes. Coordinates are stored in single precision relative to a given origin,
/// which is sufficient for pictures. Objects with coordinates that are not finite or beyond the drawable range are left
/// out.
class Preview {
public:
    /// Throws RunError if Embree runs out of memory.
    Preview(std::vector<PreviewMesh> meshes, std::vector<PreviewPlane> planes, const Vec3& origin);
    ~Preview();
    Preview(Preview&&) noexcept;
    Preview& operator=(Preview&&) noexcept;

    /// Sets the shapes of the copies. The vertices of each mesh must be at most 1 from its origin. Must not run while
    /// rays are traced.
    void set_shapes(std::vector<TriangleMesh> shapes);
    void set_shape(TriangleMesh shape) { set_shapes({std::move(shape)}); }
    /// Replaces all moving objects by spheres. Must not run while rays are traced.
    void set_spheres(const PreviewSpheres& spheres);
    /// Replaces all moving objects. With `skipped`, rays ignore the spheres until prepare_sphere_rays() is called,
    /// which saves time for drafts. Must not run while rays are traced.
    void set_moving(PreviewMoving moving, SphereRays spheres = SphereRays::traced);
    /// Builds the Embree scene of the spheres if it does not exist. Must not run while rays are traced.
    void prepare_sphere_rays() const;

    /// Returns the first hit that is not glass. Safe from any thread.
    [[nodiscard]] std::optional<PreviewHit> trace(const PreviewRay& ray) const;
    /// Traces up to kPacketRays rays at once, which is faster for coherent rays. The last digits of a result can differ
    /// from the result of a single ray, but the same packet always gives the same digits. `hits` has as many entries as
    /// `rays`.
    void trace(std::span<const PreviewRay> rays, std::span<std::optional<PreviewHit>> hits,
               SphereRays spheres = SphereRays::traced, GlowRays glow = GlowRays::traced) const;
    /// Returns the first hit on a glass mesh. Safe from any thread.
    [[nodiscard]] std::optional<PreviewHit> trace_glass(const PreviewRay& ray) const;
    /// Returns true if a mesh or a moving object blocks the ray. Planes and glowing lines cast no shadows.
    [[nodiscard]] bool occluded(const PreviewRay& ray) const;
    /// Returns occluded() for each of up to kPacketRays rays, in the order of the rays.
    [[nodiscard]] std::array<bool, kPacketRays> occluded(std::span<const PreviewRay> rays,
                                                         SphereRays spheres = SphereRays::traced) const;
    [[nodiscard]] const DrawnSpheres& spheres() const;
    /// Returns the drawn glowing lines.
    [[nodiscard]] const std::vector<GlowingLine>& glowing_lines() const;
    /// Returns true if spheres move while the shutter is open.
    [[nodiscard]] bool spheres_move() const;
    /// Returns the hit of a ray on a sphere at the given distance, with the given unit normal.
    [[nodiscard]] PreviewHit sphere_hit(std::size_t sphere, double distance, const Vec3& normal,
                                        const PreviewRay& ray) const;
    /// Returns true if there are any glass meshes.
    [[nodiscard]] bool has_glass() const;
    /// Returns the origin of the single-precision coordinates.
    [[nodiscard]] const Vec3& origin() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// Normals for smooth shading.

/// Returns unit normals for the three corners of every triangle. A normal is the area-weighted mean of the normals of
/// the triangles around the vertex. Triangles at an angle above crease_degrees to the corner's triangle are excluded,
/// so that sharp edges stay sharp.
[[nodiscard]] std::vector<std::array<Vec3, 3>> corner_normals(const TriangleMesh& mesh, double crease_degrees);

}  // namespace ricochet
