/// \file
/// Sum of the samples of a pixel. If the samples are few, extra camera rays that trace only the sun add information.
/// They measure how much of the pixel each surface covers and how much of it is in sunlight. Their mean expected light
/// replaces the samples' mean expected light. The samples supply the difference between actual and expected light (a
/// control variate). The limit for many samples is the same.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Result of the samples of a pixel.
struct PixelLight {
    Vec3 light;             ///< in the display's range, mean of the samples
    double variance = 0.0;  ///< variance of the mean's luminance
    double alpha = 1.0;     ///< share of the samples that hit something, if the background is transparent
    Vec3 normal;            ///< means over the samples
    Vec3 albedo;
    double distance = 0.0;  ///< m
    double slope = 0.0;     ///< in m per pixel
};

/// Largest number of camera rays of a pixel whose samples see different things. No extra rays are traced if there are
/// as many samples.
inline constexpr int kGlances = 16;

/// Result of a camera ray before the sky's light is traced. The defaults describe a ray without a hit.
struct Glance {
    Vec3 own;    ///< known light: the surface's emission, the sun's light on it, and the background
    Vec3 plain;  ///< further light of the surface if nothing occludes the sky
    Vec3 normal;
    Vec3 albedo{1, 1, 1};
    double distance = 0.0;      ///< m
    double slope = 0.0;         ///< in m per pixel
    std::uint32_t surface = 0;  ///< a number for each known sphere; 0 for everything else
    bool covers = true;         ///< true if it is part of the picture: a transparent background is not
};

/// Accumulator for the samples of a pixel.
class PixelSum {
public:
    /// Sets the exposure, which multiplies light before it is shown.
    explicit PixelSum(double exposure = 1.0) : exposure_(exposure) {}
    /// Adds a sample. `light` is the light of the surface or the background. `shown` is the result in the display's
    /// range. `cover` is the covered share.
    void add(const Glance& glance, const Vec3& light, const Vec3& shown, double cover);
    /// Returns the number of extra rays that the pixel needs, at most kGlances together with the samples. The number
    /// grows with the differences between the samples. It is the maximum if the samples differ on both sides of an
    /// outline. It is 0 after kGlances samples. `has_outline` tells whether the outline of a known sphere can be
    /// visible.
    [[nodiscard]] int rays_wanted(bool has_outline = false) const;
    /// Returns the distance of the farthest surface of the samples, in m. It is infinite if a sample had no hit.
    [[nodiscard]] double farthest() const { return farthest_; }
    /// Adds a camera ray beyond the samples. Rays and samples together are at most kGlances.
    void add(const Glance& glance);
    /// Returns the mean of the samples, at least one, and the extra rays.
    [[nodiscard]] PixelLight mean() const;

private:
    struct Sample {
        Vec3 own, plain, shown;
    };
    void add_features(const Glance& glance);
    [[nodiscard]] double contrast() const;
    [[nodiscard]] Vec3 lit() const;
    [[nodiscard]] Vec3 expected(const Sample& sample, const Vec3& lit) const;
    void correct(PixelLight& mean) const;

    double exposure_;
    PixelLight sum_{{}, 0.0, 0.0, {}, {}, 0.0, 0.0};
    double sum_of_squares_ = 0.0;  // squares of the luminance
    Vec3 light_, plain_;           // sums of actual and of unoccluded light
    double cover_ = 0.0;           // sums over the samples, and over all rays
    double seen_ = 0.0;
    double seen_by_samples_ = 0.0;
    double farthest_ = 0.0;
    std::uint32_t surface_ = 0;  // surface of the first sample
    bool surfaces_differ_ = false;
    int samples_ = 0;
    int rays_ = 0;
    std::array<Sample, kGlances> kept_;
};

}  // namespace ricochet
