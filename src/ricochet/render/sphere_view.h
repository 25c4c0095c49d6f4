/// \file
/// Which spheres a camera sees through the middles of the pixels: found sphere by sphere, by the pixels that each may
/// cover. For many small spheres that takes a tenth of the time of rays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/render/camera.h"
#include "ricochet/render/preview.h"

namespace ricochet {

/// The nearest sphere on a pixel's ray.
struct SphereFind {
    double distance = std::numeric_limits<double>::infinity();  ///< m; infinite: there is none
    std::uint32_t sphere = 0;
};

/// Stays valid while the spheres do. Safe from any thread.
class SphereView {
public:
    SphereView(const DrawnSpheres& spheres, const Camera& camera, int width, int height);

    /// False where rays are faster: where no sphere is seen, or spheres cover very much.
    [[nodiscard]] bool pays() const { return pays_; }
    /// Rows that find() is asked for at a time.
    [[nodiscard]] static constexpr int band_rows() { return 8; }
    /// Of the rows of one band, from its first; as many as it has pixels.
    void find(int band, std::span<SphereFind> finds) const;

private:
    // The pixels that a sphere may cover, ends left out, and what the test of a pixel needs.
    struct Spot {
        int left = 0, right = 0, top = 0, bottom = 0;
        double ahead = 0.0, across = 0.0, up = 0.0;  // m, of the centre from the camera
        double power = 0.0;                          // m^2, of the camera's place with respect to the sphere
    };

    [[nodiscard]] Spot spot_of(const Vec3& center, double radius) const;
    void sort_into_bands();
    void cover_row(const Spot& spot, std::uint32_t sphere, int row, std::span<SphereFind> finds) const;

    Camera camera_;
    CameraFrame frame_;
    int width_, height_;
    std::vector<double> across_, up_;  // slopes of the rays of columns and rows
    std::vector<Spot> spots_;          // of those in front of the camera, in the order of the spheres
    std::vector<std::uint32_t> numbers_;
    std::vector<std::size_t> first_;      // of a band in in_band_; the last is the end
    std::vector<std::uint32_t> in_band_;  // indices into spots_
    bool pays_ = true;
};

}  // namespace ricochet
