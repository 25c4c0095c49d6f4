/// \file
/// Scene of a picture, prepared for ray tracing.
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

/// A mesh with a colour. Colours are linear light, 0..1.
struct PreviewMesh {
    TriangleMesh mesh;
    Vec3 color{0.5, 0.5, 0.5};
    std::vector<Vec3> triangle_colors;  ///< one per triangle, or empty
    bool glass = false;                 ///< transparent: light and rays pass, and only trace_glass() finds it
    double roughness = 1.0;             ///< 0 (a mirror's gloss) .. 1 (matt)
};

/// An infinite plane, visible only from the side that its normal points to.
struct PreviewPlane {
    Vec3 point;
    Vec3 normal{0, 0, 1};  ///< of unit length
    Vec3 color{0.5, 0.5, 0.5};
    double roughness = 1.0;  ///< 0 (a mirror's gloss) .. 1 (matt)
    bool is_plain = false;   ///< without the chequer
};

/// Spheres. The vectors have the same length; the last two can be empty.
struct PreviewSpheres {
    std::vector<Vec3> centers;  ///< at shutter close, in m
    std::vector<double> radii;
    std::vector<Vec3> colors;
    /// Positions of each sphere at evenly spaced times from shutter open to shutter close. All spheres have the same
    /// number of positions, 2 to 129. Empty for spheres at rest.
    std::vector<std::vector<Vec3>> shutter_paths{};
    std::vector<Vec3> emissions{};  ///< emitted light; empty: no sphere emits light
};

/// The drawable spheres of PreviewSpheres at shutter close.
struct DrawnSpheres {
    std::vector<Vec3> centers;
    std::vector<double> radii;
    std::vector<Vec3> colors;
    std::vector<Vec3> emissions;  ///< or empty
};

/// Straight threads with round ends. All vectors except points have the same length; the last two can be empty.
/// Glowing threads (GlowingLine) are visible and reflected. They cast no shadows and light their surroundings as
/// lamps.
struct PreviewLines {
    std::vector<std::array<std::uint32_t, 2>> ends;  ///< indices into points
    std::vector<Vec3> points;
    std::vector<double> radii;  ///< m, > 0
    std::vector<Vec3> colors;
    std::vector<Vec3> emissions{};  ///< emitted light; empty: no line emits light
    /// Share of the open-shutter time that a ball spends on each line, 0..1, if lines are the path of a ball. The line
    /// then gives as much light as the ball does in that time. Empty: each line is a thread that glows all over.
    std::vector<double> parts{};
};

/// A line that lights its surroundings.
struct GlowingLine {
    Vec3 from, to;        ///< m
    double radius = 0.0;  ///< m
    Vec3 intensity;       ///< light times m^2 of the whole line, as for a lamp
};

/// Copies of the shapes of Preview::set_shapes(), or of a ball of radius 1. All vectors have the same length; the last
/// three can be empty.
struct PreviewCopies {
    std::vector<AffineMap> placements;  ///< from shape coordinates to world coordinates, at shutter close
    std::vector<Vec3> colors;
    std::vector<std::vector<Vec3>> shutter_paths{};  ///< path of the shape's origin, as for spheres; the linear map
                                                     ///< stays constant
    std::vector<Vec3> emissions{};                   ///< emitted light
    /// Shape of each copy, counted from 1, or 0 for a ball. Empty: all copies use the first shape, or a ball if no
    /// shape is set.
    std::vector<std::uint32_t> shapes{};
};

/// Moving objects, which change from picture to picture.
struct PreviewMoving {
    PreviewSpheres spheres;
    PreviewLines lines;
    PreviewMesh cloth;                  ///< shaded smoothly everywhere
    std::vector<PreviewMesh> meshes{};  ///< colliders that move
    PreviewCopies copies{};
};

/// Option to trace spheres. Callers that find spheres by other means leave them out.
enum class SphereRays { met, left_out };

/// Option to trace glowing lines. Rays that gather light leave them out, because lamps already give their light.
enum class GlowRays { met, left_out };

/// A ray from a point along a unit vector.
struct PreviewRay {
    Vec3 origin;
    Vec3 direction;
    double time = 0.0;                                       ///< in the open-shutter time, 0..1
    double reach = std::numeric_limits<double>::infinity();  ///< in m; objects farther away are ignored
};

/// A hit of a ray.
struct PreviewHit {
    double distance = 0.0;  ///< m along the ray
    Vec3 point;
    Vec3 normal;  ///< smoothed, of unit length, towards the ray's origin
    Vec3 face;    ///< unit normal of the surface itself, towards the ray's origin
    Vec3 color;
    enum class Kind { mesh, plane, sphere, line, cloth, copy } kind = Kind::mesh;
    Vec3 emission{};         ///< emitted light
    Vec3 lift{};             ///< offset to the origin of shadow rays, on the smooth surface that a mesh approximates,
                             ///< in m
    double roughness = 1.0;  ///< 0 (a mirror's gloss) .. 1 (matt)
    double time = 0.0;       ///< time of the ray
    bool is_plain = false;   ///< for a plane: without the chequer
};

/// Largest number of rays in a packet.
inline constexpr std::size_t kPacketRays = 8;

/// Roughness of particles.
inline constexpr double kSphereRoughness = 0.42;

/// Colliders and particles in Embree scenes. Coordinates are single precision relative to the given origin, which is
/// sufficient for pictures. Points that are not finite or extremely far away are left out.
class Preview {
public:
    /// Throws RunError if Embree runs out of memory.
    Preview(std::vector<PreviewMesh> meshes, std::vector<PreviewPlane> planes, const Vec3& origin);
    ~Preview();
    Preview(Preview&&) noexcept;
    Preview& operator=(Preview&&) noexcept;

    /// Sets the shapes of the copies. All points of a mesh must be at most 1 away from its origin. Must not run while
    /// rays are traced.
    void set_shapes(std::vector<TriangleMesh> shapes);
    void set_shape(TriangleMesh shape) { set_shapes({std::move(shape)}); }
    /// Replaces all moving objects by spheres. Must not run while rays are traced.
    void set_spheres(const PreviewSpheres& spheres);
    /// Replaces all moving objects. With `left_out`, rays ignore the spheres until prepare_sphere_rays(), which saves
    /// a draft the time. Must not run while rays are traced.
    void set_moving(PreviewMoving moving, SphereRays spheres = SphereRays::met);
    /// Makes the spheres traceable, if they are not yet. Must not run while rays are traced.
    void prepare_sphere_rays() const;

    /// Returns the first hit that is not glass. Safe from any thread.
    [[nodiscard]] std::optional<PreviewHit> trace(const PreviewRay& ray) const;
    /// Traces up to kPacketRays rays at once, which is faster for coherent rays. The last digits can differ from
    /// single rays, but the same packet always gives the same digits. `hits` has as many entries as `rays`.
    void trace(std::span<const PreviewRay> rays, std::span<std::optional<PreviewHit>> hits,
               SphereRays spheres = SphereRays::met, GlowRays glow = GlowRays::met) const;
    /// Returns the first hit on a glass mesh. Safe from any thread.
    [[nodiscard]] std::optional<PreviewHit> trace_glass(const PreviewRay& ray) const;
    /// Returns true if a mesh or a moving object blocks the ray. Planes and glowing lines cast no shadows.
    [[nodiscard]] bool occluded(const PreviewRay& ray) const;
    /// Tests up to kPacketRays rays at once, in their order.
    [[nodiscard]] std::array<bool, kPacketRays> occluded(std::span<const PreviewRay> rays,
                                                         SphereRays spheres = SphereRays::met) const;
    [[nodiscard]] const DrawnSpheres& spheres() const;
    /// Returns the drawn glowing lines.
    [[nodiscard]] const std::vector<GlowingLine>& glowing_lines() const;
    /// Returns true if spheres move while the shutter is open.
    [[nodiscard]] bool spheres_move() const;
    /// Returns the hit of a ray on a sphere at the given distance, with the given unit normal.
    [[nodiscard]] PreviewHit sphere_hit(std::size_t sphere, double distance, const Vec3& normal,
                                        const PreviewRay& ray) const;
    /// Returns true if there is any glass to find for trace_glass().
    [[nodiscard]] bool has_glass() const;
    /// Returns the origin of the single-precision coordinates.
    [[nodiscard]] const Vec3& origin() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// Normals for smooth shading.

/// Returns unit normals for the three corners of every triangle. A normal is the area-weighted mean of the faces
/// around the vertex. Faces that lean more than crease_degrees away from the triangle are excluded, so that sharp
/// edges stay sharp.
[[nodiscard]] std::vector<std::array<Vec3, 3>> corner_normals(const TriangleMesh& mesh, double crease_degrees);

}  // namespace ricochet
