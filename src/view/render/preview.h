/// \file
/// What a picture shows, as a thing that rays can be shot at.
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
    std::vector<Vec3> triangle_colors;  ///< one a triangle, or empty
    bool glass = false;                 ///< seen through: light and rays pass, only trace_glass() finds it
    double roughness = 1.0;             ///< 0 (a mirror's gloss) .. 1 (matt)
};

/// An infinite plane, seen from the side that its normal points to; from behind it is not there.
struct PreviewPlane {
    Vec3 point;
    Vec3 normal{0, 0, 1};  ///< of unit length
    Vec3 color{0.5, 0.5, 0.5};
    double roughness = 1.0;  ///< 0 (a mirror's gloss) .. 1 (matt)
    bool is_plain = false;   ///< without the chequer
};

/// Spheres; the vectors have the same length, the last one may be empty.
struct PreviewSpheres {
    std::vector<Vec3> centers;  ///< m, when the shutter closes
    std::vector<double> radii;
    std::vector<Vec3> colors;
    /// Where each is at evenly spaced times from the shutter's opening to its closing, as many for each, 2 to 129;
    /// empty for spheres at rest.
    std::vector<std::vector<Vec3>> ways{};
    std::vector<Vec3> emissions{};  ///< light of their own; empty: none has any
};

/// Spheres as they are drawn: those of PreviewSpheres that can be, when the shutter closes.
struct DrawnSpheres {
    std::vector<Vec3> centers;
    std::vector<double> radii;
    std::vector<Vec3> colors;
    std::vector<Vec3> emissions;  ///< or empty
};

/// Straight threads with round ends; all vectors but points have the same length, the last two may be empty. Those that
/// shine (GlowingLine) are seen and mirrored; they throw no shadows, and light what is around them as lamps.
struct PreviewLines {
    std::vector<std::array<std::uint32_t, 2>> ends;  ///< indices into points
    std::vector<Vec3> points;
    std::vector<double> radii;  ///< m, > 0
    std::vector<Vec3> colors;
    std::vector<Vec3> emissions{};  ///< light of their own; empty: none has any
    /// Where lines are the way of a ball while the shutter is open, the part of that time that it is on each, 0..1: the
    /// line then gives as much light as the ball does in that part. Empty: each is a thread that shines all over.
    std::vector<double> parts{};
};

/// A line that gives light to what is around it.
struct GlowingLine {
    Vec3 from, to;        ///< m
    double radius = 0.0;  ///< m
    Vec3 intensity;       ///< light times m^2, as that of a lamp, of the whole line
};

/// Copies of the shapes of Preview::set_shapes(), or of a ball of radius 1; all vectors have the same length, the last
/// three may be empty.
struct PreviewCopies {
    std::vector<AffineMap> places;  ///< into the world from the shape's own coordinates, when the shutter closes
    std::vector<Vec3> colors;
    std::vector<std::vector<Vec3>> ways{};  ///< of the shape's origin, as those of spheres; maps stay the same on them
    std::vector<Vec3> emissions{};          ///< light of their own
    /// Which shape each is a copy of, from 1 on, or 0 for a ball; empty: the first one, or a ball where none is set.
    std::vector<std::uint32_t> shapes{};
};

/// What moves: changes from picture to picture.
struct PreviewMoving {
    PreviewSpheres spheres;
    PreviewLines lines;
    PreviewMesh cloth;                  ///< shaded smoothly everywhere
    std::vector<PreviewMesh> meshes{};  ///< colliders that move
    PreviewCopies copies{};
};

/// Whether rays meet spheres; those who find them by other means leave them out.
enum class SphereRays { met, left_out };

/// Whether rays meet lines that shine; those that look for light leave them out, which comes from them as from lamps.
enum class GlowRays { met, left_out };

/// A ray from a point along a unit vector.
struct PreviewRay {
    Vec3 origin;
    Vec3 direction;
    double time = 0.0;                                       ///< within the time that the shutter is open, 0..1
    double reach = std::numeric_limits<double>::infinity();  ///< m: what is farther away does not count
};

/// Where a ray hits something.
struct PreviewHit {
    double distance = 0.0;  ///< m along the ray
    Vec3 point;
    Vec3 normal;  ///< smoothed, of unit length, towards the ray's origin
    Vec3 face;    ///< of the surface itself, of unit length, towards the ray's origin
    Vec3 color;
    enum class Kind { mesh, plane, sphere, line, cloth, copy } kind = Kind::mesh;
    Vec3 emission{};         ///< light of its own
    Vec3 lift{};             ///< m, to where rays for shadows begin, on the smooth surface that a mesh stands for
    double roughness = 1.0;  ///< 0 (a mirror's gloss) .. 1 (matt)
    double time = 0.0;       ///< the ray's
    bool is_plain = false;   ///< of a plane: without the chequer
};

/// Most rays that are traced at once.
inline constexpr std::size_t kPacketRays = 8;

/// Of particles.
inline constexpr double kSphereRoughness = 0.42;

/// Colliders and particles behind Embree. Coordinates are single precision about the given origin: good for pictures.
/// Points that are not finite, or absurdly far away, are left out.
class Preview {
public:
    /// Throws RunError when Embree runs out of memory.
    Preview(std::vector<PreviewMesh> meshes, std::vector<PreviewPlane> planes, const Vec3& origin);
    ~Preview();
    Preview(Preview&&) noexcept;
    Preview& operator=(Preview&&) noexcept;

    /// What copies are copies of: meshes all of which are at most 1 away from their origins. Not while rays are being
    /// shot.
    void set_shapes(std::vector<TriangleMesh> shapes);
    void set_shape(TriangleMesh shape) { set_shapes({std::move(shape)}); }
    /// Replaces all that moves by spheres. Not while rays are being shot.
    void set_spheres(const PreviewSpheres& spheres);
    /// Replaces all that moves. With `left_out` rays do not meet the spheres until prepare_sphere_rays(), which spares
    /// a draft the time. Not while rays are being shot.
    void set_moving(PreviewMoving moving, SphereRays spheres = SphereRays::met);
    /// Lets rays meet the spheres, if they do not yet. Not while rays are being shot.
    void prepare_sphere_rays() const;

    /// The first thing on the ray that is no glass; may be called from any thread.
    [[nodiscard]] std::optional<PreviewHit> trace(const PreviewRay& ray) const;
    /// The same for up to kPacketRays rays at once, which is faster where they start and point alike. The last digits
    /// may differ from those of rays alone, and are the same whenever the packet is. hits: as many.
    void trace(std::span<const PreviewRay> rays, std::span<std::optional<PreviewHit>> hits,
               SphereRays spheres = SphereRays::met, GlowRays glow = GlowRays::met) const;
    /// The first glass mesh on the ray; may be called from any thread.
    [[nodiscard]] std::optional<PreviewHit> trace_glass(const PreviewRay& ray) const;
    /// True when a mesh or something that moves stands on the ray; planes and lines that shine throw no shadow.
    [[nodiscard]] bool occluded(const PreviewRay& ray) const;
    /// The same for up to kPacketRays rays at once, in their order.
    [[nodiscard]] std::array<bool, kPacketRays> occluded(std::span<const PreviewRay> rays,
                                                         SphereRays spheres = SphereRays::met) const;
    [[nodiscard]] const DrawnSpheres& spheres() const;
    /// The drawn lines that shine.
    [[nodiscard]] const std::vector<GlowingLine>& glowing_lines() const;
    /// Whether spheres move while the shutter is open.
    [[nodiscard]] bool spheres_move() const;
    /// What a ray meets at that distance on a sphere, given the unit normal of the surface there.
    [[nodiscard]] PreviewHit sphere_hit(std::size_t sphere, double distance, const Vec3& normal,
                                        const PreviewRay& ray) const;
    /// True when trace_glass() can find anything.
    [[nodiscard]] bool has_glass() const;
    /// The point about which coordinates are rounded.
    [[nodiscard]] const Vec3& origin() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// Normals for smooth shading.

/// Unit normals for the three corners of every triangle: the area-weighted mean of the faces around the vertex that
/// lean less than crease_degrees away from the triangle itself, so that sharp edges stay sharp.
[[nodiscard]] std::vector<std::array<Vec3, 3>> corner_normals(const TriangleMesh& mesh, double crease_degrees);

}  // namespace ricochet
