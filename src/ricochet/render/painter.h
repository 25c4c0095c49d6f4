/// \file
/// The light that comes to the camera from what a picture shows: sun with soft shadows, sky light, one bounce of light
/// between surfaces, glass.
#pragma once

#include <optional>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/render/camera.h"
#include "ricochet/render/lamps.h"
#include "ricochet/render/light.h"
#include "ricochet/render/picture.h"
#include "ricochet/render/preview.h"
#include "ricochet/render/sampling.h"

namespace ricochet {

/// What the samples of a pixel say together.
struct PixelLight {
    Vec3 light;             ///< in the display's range, mean of the samples
    double variance = 0.0;  ///< of the mean's luminance
    double alpha = 1.0;     ///< part of the samples that show something, where the background is transparent
    Vec3 normal;            ///< means over the samples
    Vec3 albedo;
    double distance = 0.0;  ///< m
    double slope = 0.0;     ///< m from pixel to pixel
};

/// Safe from any thread.
class Painter {
public:
    Painter(const Preview& preview, const Camera& camera, const PictureOptions& options, std::vector<Lamp> lamps = {});

    [[nodiscard]] PixelLight pixel(int x, int y) const;
    /// As PictureOptions::quick has it: light and alpha alone.
    [[nodiscard]] PixelLight quick_pixel(int x, int y) const;

private:
    // What one ray sees.
    struct Seen {
        Vec3 light;
        std::optional<PreviewHit> hit;
        double cover = 1.0;
    };

    [[nodiscard]] PreviewRay camera_ray(double x, double y, const SamplePair& lens) const;
    [[nodiscard]] Seen seen(const PreviewRay& ray, const PixelSamples& samples, int s) const;
    [[nodiscard]] Seen through_glass(PreviewRay ray, double distance, const Vec3& behind) const;
    [[nodiscard]] Vec3 solid_light(const PreviewRay& ray, const std::optional<PreviewHit>& hit,
                                   const PixelSamples& samples, int s) const;
    [[nodiscard]] Vec3 quick_light(const PreviewRay& ray, const PreviewHit& hit) const;
    [[nodiscard]] Vec3 sun_light(const PreviewHit& hit, const SamplePair& at) const;
    [[nodiscard]] Vec3 lamp_light(const PreviewHit& hit, const SamplePair& at) const;
    [[nodiscard]] Vec3 sky_light(const PreviewHit& hit, const PixelSamples& samples, int s) const;
    [[nodiscard]] Vec3 gloss(const PreviewHit& hit, const PreviewRay& ray) const;
    [[nodiscard]] Vec3 off_surface(const PreviewHit& hit) const;
    [[nodiscard]] Vec3 surface_color(const PreviewHit& hit) const;
    [[nodiscard]] Vec3 faded(const Vec3& light, const PreviewHit& hit, const PreviewRay& ray) const;
    [[nodiscard]] Vec3 behind_everything(const Vec3& direction) const;

    const Preview& preview_;
    Camera camera_;
    CameraFrame frame_;
    PictureOptions options_;
    Light light_;
    std::vector<Lamp> lamps_;
    double tangent_;
    double focus_;   // m from the camera's plane to the plane that is sharp
    double extent_;  // half the height of what the picture shows at the target, m
    double tile_;    // edge of the chequer on planes, m
};

}  // namespace ricochet
