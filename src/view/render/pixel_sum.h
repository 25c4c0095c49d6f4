/// \file
/// Sum of the samples of a pixel. If there are few samples, extra camera rays reduce the noise at edges. An extra ray
/// finds the visible surface and its sunlight, but not the light of the sky. The expected light of a ray assumes that
/// the sky's light is occluded equally in the whole pixel. Expected light serves as a control variate. Its mean is
/// computed over all rays, and the samples add the mean difference between actual and expected light. For many samples,
/// the result converges to the same limit as without extra rays.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Light and features of a pixel, computed from its samples.
struct PixelLight {
    Vec3 light;             ///< mean of the samples, in the display's range
    double variance = 0.0;  ///< variance of the mean's luminance
    double alpha = 1.0;     ///< covered share of the pixel if the background is transparent, otherwise 1
    Vec3 normal;            ///< mean over all rays, as are the members below
    Vec3 albedo;
    double distance = 0.0;  ///< m
    double slope = 0.0;     ///< in m per pixel
};

/// Largest number of samples and extra rays of a pixel together. If there are already as many samples, no extra rays
/// are traced.
inline constexpr int kMostPixelRays = 16;

/// Result of a camera ray, without the light of the sky. The defaults describe a ray without a hit.
struct CameraRayResult {
    Vec3 own;    ///< the surface's emission and its reflected sunlight; the background's light if nothing is hit
    Vec3 plain;  ///< the sky's light that the surface reflects if nothing occludes the sky
    Vec3 normal;
    Vec3 albedo{1, 1, 1};
    double distance = 0.0;      ///< m
    double slope = 0.0;         ///< in m per pixel
    std::uint32_t surface = 0;  ///< number of the sphere (from 1) if it is listed in KnownSpheres, otherwise 0
    bool covers = true;         ///< false if the ray hits only a transparent background
};

/// Accumulator for the samples of a pixel.
class PixelSum {
public:
    /// Sets the exposure, which multiplies light before tone mapping.
    explicit PixelSum(double exposure = 1.0) : exposure_(exposure) {}
    /// Adds a sample. `light` is the light of the surface or the background. `shown` is the sample's light after glass
    /// and tone mapping. `cover` is the share of the ray that objects cover, 0..1.
    void add(const CameraRayResult& result, const Vec3& light, const Vec3& shown, double cover);
    /// Returns the number of extra rays that the pixel needs, at most kMostPixelRays together with the samples.
    /// `has_outline` is true if the outline of a known sphere can cross the pixel. The number increases with the
    /// differences between the samples. It is the maximum if the pixel has an outline, and samples hit different
    /// surfaces and differ in light. It is 0 after kMostPixelRays samples.
    [[nodiscard]] int rays_wanted(bool has_outline = false) const;
    /// Returns the distance of the farthest surface that a sample hit, in m. Returns infinity if a sample had no hit.
    [[nodiscard]] double farthest() const { return farthest_; }
    /// Adds an extra camera ray. The caller adds all samples first, and at most kMostPixelRays samples and rays
    /// together.
    void add(const CameraRayResult& result);
    /// Returns the mean of the samples and the extra rays. At least one sample is required.
    [[nodiscard]] PixelLight mean() const;

private:
    struct Sample {
        Vec3 own, plain, shown;
    };
    void add_features(const CameraRayResult& result);
    [[nodiscard]] double contrast() const;
    [[nodiscard]] Vec3 lit() const;
    [[nodiscard]] Vec3 expected(const Sample& sample, const Vec3& lit) const;
    void correct(PixelLight& mean) const;

    double exposure_;
    PixelLight sum_{{}, 0.0, 0.0, {}, {}, 0.0, 0.0};
    double sum_of_squares_ = 0.0;  // sum of the squared luminance of the samples
    Vec3 light_, plain_;           // sums of all light except CameraRayResult::own, and of CameraRayResult::plain
    double cover_ = 0.0;           // sum over the samples
    double seen_ = 0.0;
    double seen_by_samples_ = 0.0;
    double farthest_ = 0.0;
    std::uint32_t surface_ = 0;  // surface of the first sample
    bool surfaces_differ_ = false;
    int samples_ = 0;
    int rays_ = 0;
    std::array<Sample, kMostPixelRays> kept_;
};

}  // namespace ricochet
