/// \file
/// Computation of the light that reaches the camera: sun with soft shadows, sky light, one bounce of light between
/// surfaces, and glass.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/core/vec3.h"
#include "view/render/camera.h"
#include "view/render/lamps.h"
#include "view/render/light.h"
#include "view/render/picture.h"
#include "view/render/pixel_sum.h"
#include "view/render/preview.h"
#include "view/render/sampling.h"
#include "view/render/sphere_view.h"
#include "view/render/sun_shadows.h"

namespace ricochet {

/// Column and row of a pixel.
struct PixelPosition {
    int x = 0;
    int y = 0;
};

/// Precomputed data about the spheres. It replaces ray tracing of the spheres if it is faster.
struct KnownSpheres {
    /// Spheres that camera rays through a tile can hit, nearest first. If std::nullopt, rays find the spheres.
    std::optional<std::span<const NearSphere>> listed;
    /// Shadows of the spheres. If null, rays find the shadows.
    const SunShadows* shadows = nullptr;
};

/// Computes the light of pixels. Safe to use from any thread. Pixels are processed in tiles. The rays of a tile are
/// coherent and traced in packets of up to kPacketRays.
class Painter {
public:
    Painter(const Preview& preview, const Camera& camera, const PictureOptions& options, std::vector<Lamp> lamps = {});

    /// Computes the pixels of one tile. `out` has as many entries as `pixel_positions`. `known` describes the spheres
    /// that are visible in the tile.
    void pixels(std::span<const PixelPosition> pixel_positions, std::span<PixelLight> out,
                const KnownSpheres& known = {}) const;
    /// Computes the pixels of a draft (see PictureOptions::quick). Sets only light and alpha. `finds` has the visible
    /// sphere of each pixel. `shadows` has the shadows of the spheres for light from sun_middle(). If `finds` is empty,
    /// rays find the spheres. If `shadows` is null, rays find the shadows.
    void quick_pixels(std::span<const PixelPosition> pixel_positions, std::span<PixelLight> out,
                      std::span<const SphereFind> finds = {}, const SunShadows* shadows = nullptr) const;
    /// Returns the direction to the middle of the sun, or std::nullopt if there is no sun.
    [[nodiscard]] std::optional<Vec3> sun_middle() const;
    /// Returns the tangent of the angle between the middle of the sun and its rim.
    [[nodiscard]] double sun_slope() const { return light_.sun_size; }

private:
    // Light along one camera ray, and the share that glass covers.
    struct Seen {
        Vec3 light;
        double cover = 1.0;
    };
    using Hits = std::array<std::optional<PreviewHit>, kPacketRays>;
    // State of one sample of a pixel.
    struct SampleState {
        PreviewRay ray;
        const PixelSamples* samples = nullptr;
        int sample = 0;
        const PreviewHit* hit = nullptr;
        std::uint32_t surface = 0;  // see CameraRayResult::surface
        Vec3 color;                 // colour of the surface at the hit
        // Share of the surface's light in the result; the rest is the background at the horizon.
        double left = 1.0;
        Vec3 sun, sky;  // light that the surface receives

        [[nodiscard]] SamplePair get(SamplePurpose purpose) const { return samples->get(sample, purpose); }
    };
    // Query for the sun's light at a point of a surface.
    struct SunQuery {
        const PreviewHit* hit = nullptr;
        Vec3 to_sun{};
        Vec3 light{};  // result
    };

    [[nodiscard]] PreviewRay camera_ray(double x, double y, const SamplePair& lens) const;
    void trace(std::span<SampleState> states, const KnownSpheres& known, Hits& hits) const;
    void aim(SampleState& state, const PixelPosition& pixel_position, int sample) const;
    void add(const SampleState& state, PixelSum& sum) const;
    void add_extra_rays(std::span<const PixelPosition> pixel_positions, std::span<SampleState> states,
                        std::span<PixelSum> sums, const KnownSpheres& known) const;
    [[nodiscard]] std::array<int, kPacketRays> rays_wanted(std::span<const PixelPosition> pixel_positions,
                                                           std::span<const PixelSum> sums,
                                                           const KnownSpheres& known) const;
    [[nodiscard]] CameraRayResult camera_ray_result(const SampleState& state) const;
    void add_sun_light(std::span<SampleState> states, const SunShadows* shadows) const;
    void add_sky_light(std::span<SampleState> states, const SunShadows* shadows) const;
    [[nodiscard]] Seen through_glass(PreviewRay ray, double distance, const Vec3& behind) const;
    [[nodiscard]] Vec3 solid_light(const SampleState& state) const;
    [[nodiscard]] Vec3 quick_light(const PreviewHit& hit, const Vec3& sun) const;
    void trace_besides(std::span<PreviewRay> rays, std::span<std::optional<PreviewHit>> hits,
                       std::span<const SphereFind> finds) const;
    void query_sun(std::span<SunQuery> queries, const SunShadows* shadows = nullptr) const;
    [[nodiscard]] PreviewHit sphere_hit(const SphereFind& find, const PreviewRay& ray) const;
    [[nodiscard]] bool faces_sun(const PreviewHit& hit) const;
    [[nodiscard]] Vec3 sun_light(const PreviewHit& hit, const Vec3& to_sun) const;
    [[nodiscard]] Vec3 lamp_light(const PreviewHit& hit, const SamplePair& at) const;
    [[nodiscard]] Vec3 gloss(const PreviewHit& hit, const PreviewRay& ray, bool in_sun) const;
    [[nodiscard]] Vec3 off_surface(const PreviewHit& hit) const;
    [[nodiscard]] Vec3 surface_color(const PreviewHit& hit) const;
    [[nodiscard]] Vec3 faded(const Vec3& light, double left) const;
    [[nodiscard]] double nearness(const PreviewHit& hit) const;
    [[nodiscard]] Vec3 behind_everything(const Vec3& direction) const;

    const Preview& preview_;
    Camera camera_;
    CameraFrame frame_;
    PictureOptions options_;
    bool has_glass_;
    Light light_;
    SunDisc sun_;
    std::vector<Lamp> lamps_;
    Vec3 sun_middle_;  // direction to the middle of the sun
    Vec3 horizon_;     // background at the horizon
    double tangent_;
    double half_pixel_;  // half the size of a pixel at a distance of 1
    double focus_;       // distance from the camera to the plane of focus, in m
    double extent_;      // half the visible height at the target, in m
    double tile_;        // edge length of the chequer on planes, in m
};

}  // namespace ricochet
