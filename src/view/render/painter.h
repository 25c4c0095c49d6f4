/// \file
/// The light that comes to the camera from what a picture shows: sun with soft shadows, sky light, one bounce of light
/// between surfaces, glass.
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

/// Where a pixel is: column and row.
struct PixelPlace {
    int x = 0;
    int y = 0;
};

/// What is known of the spheres without rays, where that is faster.
struct KnownSpheres {
    /// Those that rays from the camera through a tile may meet, the nearest first; nothing: rays find them.
    std::optional<std::span<const NearSphere>> listed;
    /// What shadows they throw; null: rays find them.
    const SunShadows* shadows = nullptr;
};

/// Safe from any thread. Pixels are worked on in tiles, whose rays go alike: up to kPacketRays at once.
class Painter {
public:
    Painter(const Preview& preview, const Camera& camera, const PictureOptions& options, std::vector<Lamp> lamps = {});

    /// out: as many as places, which are of one tile. known: of the spheres that are seen there.
    void pixels(std::span<const PixelPlace> places, std::span<PixelLight> out, const KnownSpheres& known = {}) const;
    /// As PictureOptions::quick has it: light and alpha alone are set. finds: the spheres that are seen, as many as
    /// places, and what shadows spheres throw towards sun_middle(); without them rays find both.
    void quick_pixels(std::span<const PixelPlace> places, std::span<PixelLight> out,
                      std::span<const SphereFind> finds = {}, const SunShadows* shadows = nullptr) const;
    /// Direction to the middle of the sun; nothing without a sun.
    [[nodiscard]] std::optional<Vec3> sun_middle() const;
    /// Tangent of the angle between that and the sun's rim.
    [[nodiscard]] double sun_slope() const { return light_.sun_size; }

private:
    // What one ray sees.
    struct Seen {
        Vec3 light;
        double cover = 1.0;
    };
    using Hits = std::array<std::optional<PreviewHit>, kPacketRays>;
    // A sample of a pixel on its way.
    struct Look {
        PreviewRay ray;
        const PixelSamples* samples = nullptr;
        int sample = 0;
        const PreviewHit* hit = nullptr;
        std::uint32_t surface = 0;  // as that of Glance
        Vec3 color;                 // of what is hit
        double left = 1.0;          // of its light: the rest is what is behind everything on the horizon
        Vec3 sun, sky;              // light that falls on what is hit

        [[nodiscard]] SamplePair get(SamplePurpose purpose) const { return samples->get(sample, purpose); }
    };
    // Asks for the sun's light on a surface.
    struct SunAsk {
        const PreviewHit* hit = nullptr;
        Vec3 to_sun{};
        Vec3 light{};  // the answer
    };

    [[nodiscard]] PreviewRay camera_ray(double x, double y, const SamplePair& lens) const;
    void trace(std::span<Look> looks, const KnownSpheres& known, Hits& hits) const;
    void aim(Look& look, const PixelPlace& place, int sample) const;
    void add(const Look& look, PixelSum& sum) const;
    void add_glances(std::span<const PixelPlace> places, std::span<Look> looks, std::span<PixelSum> sums,
                     const KnownSpheres& known) const;
    [[nodiscard]] std::array<int, kPacketRays> rays_wanted(std::span<const PixelPlace> places,
                                                           std::span<const PixelSum> sums,
                                                           const KnownSpheres& known) const;
    [[nodiscard]] Glance glance(const Look& look) const;
    void add_sun_light(std::span<Look> looks, const SunShadows* shadows) const;
    void add_sky_light(std::span<Look> looks, const SunShadows* shadows) const;
    [[nodiscard]] Seen through_glass(PreviewRay ray, double distance, const Vec3& behind) const;
    [[nodiscard]] Vec3 solid_light(const Look& look) const;
    [[nodiscard]] Vec3 quick_light(const PreviewHit& hit, const Vec3& sun) const;
    void trace_besides(std::span<PreviewRay> rays, std::span<std::optional<PreviewHit>> hits,
                       std::span<const SphereFind> finds) const;
    void ask_sun(std::span<SunAsk> asks, const SunShadows* shadows = nullptr) const;
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
    Vec3 horizon_;     // what is behind everything there
    double tangent_;
    double half_pixel_;  // slope
    double focus_;       // m from the camera's plane to the plane that is sharp
    double extent_;      // half the height of what the picture shows at the target, m
    double tile_;        // edge of the chequer on planes, m
};

}  // namespace ricochet
