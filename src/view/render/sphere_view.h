/// \file
/// Visibility of spheres from the camera. Each sphere is tested only against the rays of the pixels that it can cover.
/// For many small spheres this takes a tenth of the time of ray tracing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "ricochet/core/vec3.h"
#include "view/render/camera.h"
#include "view/render/preview.h"

namespace ricochet {

/// Nearest sphere on the ray of a pixel.
struct SphereFind {
    double distance = std::numeric_limits<double>::infinity();  ///< in m; infinite: no sphere
    std::uint32_t sphere = 0;
};

/// Sphere, prepared for intersection with camera rays.
struct NearSphere {
    Vec3 away;             ///< centre relative to the camera, in m
    double power = 0.0;    ///< power of the camera's position with respect to the sphere, in m^2
    double nearest = 0.0;  ///< distance from the camera to the surface, in m; negative if the camera is inside
    double radius = 0.0;   ///< in m
    std::uint32_t sphere = 0;
};

/// Spheres that rays through a tile can hit, nearest first, for each tile in a row of tiles.
struct SphereTiles {
    std::vector<NearSphere> spheres;
    /// Index of each tile's first sphere, and the number of spheres as an additional last entry.
    std::vector<std::size_t> first;

    [[nodiscard]] std::span<const NearSphere> of(std::size_t tile) const {
        return std::span(spheres).subspan(first[tile], first[tile + 1] - first[tile]);
    }
};

/// Finds the first sphere on each camera ray. There are at most kPacketRays rays, and `finds` has as many entries.
void meet_spheres(std::span<const NearSphere> spheres, std::span<const PreviewRay> rays, std::span<SphereFind> finds);

/// Returns, for each camera ray, true if the outline of a sphere can be visible near the ray. The distance of the
/// outline from the ray must be at most `slope` times its distance along the ray. Spheres beyond the ray's reach are
/// ignored. There are at most kPacketRays rays.
[[nodiscard]] std::array<bool, kPacketRays> outlines_about(std::span<const PreviewRay> rays,
                                                           std::span<const NearSphere> spheres, double slope);

/// Position of camera rays within a pixel.
enum class WithinPixel { middle, anywhere };

/// Visibility of spheres from the camera. Refers to the spheres, which must outlive it. Safe from any thread.
class SphereView {
public:
    SphereView(const DrawnSpheres& spheres, const Camera& camera, int width, int height,
               WithinPixel where = WithinPixel::middle);

    /// Returns false if ray tracing is faster, because spheres cover too many pixels.
    [[nodiscard]] bool pays() const { return pays_; }
    /// Returns true if no sphere is visible.
    [[nodiscard]] bool empty() const { return spots_.empty(); }
    /// Returns the number of rows of pixels in a band, which one call of find() processes.
    [[nodiscard]] static constexpr int band_rows() { return 8; }
    /// Finds the visible sphere at the centre of each pixel of a band. `finds` has one entry per pixel, row by row from
    /// the top.
    void find(int band, std::span<SphereFind> finds) const;
    /// Returns the spheres for a row of tiles, which covers the rows of pixels [top, bottom). These rows must be in one
    /// band.
    [[nodiscard]] SphereTiles tiles(int top, int bottom, int tile_width) const;

private:
    // Pixels [left, right) x [top, bottom) that a sphere can cover, and data for intersections with the rays of these
    // pixels.
    struct Spot {
        int left = 0, right = 0, top = 0, bottom = 0;
        double ahead = 0.0, across = 0.0, up = 0.0;  // centre relative to the camera, in m
        double power = 0.0;                          // power of the camera's position with respect to the sphere, in
                                                     // m^2
    };

    [[nodiscard]] Spot spot_of(const Vec3& center, double radius) const;
    [[nodiscard]] NearSphere near_sphere(std::uint32_t spot) const;
    void sort_into_bands();
    void cover_row(const Spot& spot, std::uint32_t sphere, int row, std::span<SphereFind> finds) const;

    const DrawnSpheres& spheres_;
    Camera camera_;
    CameraFrame frame_;
    int width_, height_;
    // Largest distance, in each coordinate, of rays from the middle of their pixel, in pixels.
    double spread_;
    std::vector<double> across_, up_;  // slopes of the rays through the middle of each column and row of pixels
    std::vector<Spot> spots_;          // spots of the spheres that can be visible, in the order of the spheres
    std::vector<std::uint32_t> numbers_;
    // Index of each band's first entry in in_band_, and the size of in_band_ as an additional last entry.
    std::vector<std::size_t> first_;
    std::vector<std::uint32_t> in_band_;  // indices into spots_
    bool pays_ = true;
};

}  // namespace ricochet
