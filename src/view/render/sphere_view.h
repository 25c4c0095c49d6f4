/// \file
/// Which spheres a camera sees: found sphere by sphere, by the pixels that each may cover. For many small spheres that
/// takes a tenth of the time of rays.
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

/// The nearest sphere on a pixel's ray.
struct SphereFind {
    double distance = std::numeric_limits<double>::infinity();  ///< m; infinite: there is none
    std::uint32_t sphere = 0;
};

/// A sphere as rays from the camera meet it.
struct NearSphere {
    Vec3 away;             ///< m, of the centre from the camera
    double power = 0.0;    ///< m^2, of the camera's place with respect to the sphere
    double nearest = 0.0;  ///< m, of the surface from the camera; negative within
    double radius = 0.0;   ///< m
    std::uint32_t sphere = 0;
};

/// Of a row of tiles of pixels: the spheres that rays through each may meet, the nearest first.
struct SphereTiles {
    std::vector<NearSphere> spheres;
    std::vector<std::size_t> first;  ///< of a tile in spheres; the last is the end

    [[nodiscard]] std::span<const NearSphere> of(std::size_t tile) const {
        return std::span(spheres).subspan(first[tile], first[tile + 1] - first[tile]);
    }
};

/// Of the given spheres, what each ray from the camera meets first. At most kPacketRays rays, as many finds.
void meet_spheres(std::span<const NearSphere> spheres, std::span<const PreviewRay> rays, std::span<SphereFind> finds);

/// Whether outlines of the given spheres may be seen about each ray from the camera: up to `slope` times the distance
/// off it, and within its reach. At most kPacketRays rays.
[[nodiscard]] std::array<bool, kPacketRays> outlines_about(std::span<const PreviewRay> rays,
                                                           std::span<const NearSphere> spheres, double slope);

/// Where in a pixel rays go through.
enum class WithinPixel { middle, anywhere };

/// Stays valid while the spheres do. Safe from any thread.
class SphereView {
public:
    SphereView(const DrawnSpheres& spheres, const Camera& camera, int width, int height,
               WithinPixel where = WithinPixel::middle);

    /// False where rays are faster: where spheres cover very much.
    [[nodiscard]] bool pays() const { return pays_; }
    /// Whether no sphere is seen.
    [[nodiscard]] bool empty() const { return spots_.empty(); }
    /// Rows that find() is asked for at a time.
    [[nodiscard]] static constexpr int band_rows() { return 8; }
    /// Through the middles of the pixels of one band, from its first row; as many as it has pixels.
    void find(int band, std::span<SphereFind> finds) const;
    /// Of the rows [top, bottom), which are of one band.
    [[nodiscard]] SphereTiles tiles(int top, int bottom, int tile_width) const;

private:
    // The pixels that a sphere may cover, ends left out, and what the test of a pixel needs.
    struct Spot {
        int left = 0, right = 0, top = 0, bottom = 0;
        double ahead = 0.0, across = 0.0, up = 0.0;  // m, of the centre from the camera
        double power = 0.0;                          // m^2, of the camera's place with respect to the sphere
    };

    [[nodiscard]] Spot spot_of(const Vec3& center, double radius) const;
    [[nodiscard]] NearSphere near_sphere(std::uint32_t spot) const;
    void sort_into_bands();
    void cover_row(const Spot& spot, std::uint32_t sphere, int row, std::span<SphereFind> finds) const;

    const DrawnSpheres& spheres_;
    Camera camera_;
    CameraFrame frame_;
    int width_, height_;
    double spread_;                    // pixels, from the middle of a pixel to the outermost rays through it
    std::vector<double> across_, up_;  // slopes of the rays of columns and rows
    std::vector<Spot> spots_;          // of those in front of the camera, in the order of the spheres
    std::vector<std::uint32_t> numbers_;
    std::vector<std::size_t> first_;      // of a band in in_band_; the last is the end
    std::vector<std::uint32_t> in_band_;  // indices into spots_
    bool pays_ = true;
};

}  // namespace ricochet
