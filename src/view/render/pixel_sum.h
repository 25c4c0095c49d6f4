/// \file
/// What the samples of a pixel add up to. Where these are few, more rays from the camera, which go on to the sun alone,
/// tell how much of the pixel each surface covers and how much of it lies in the sun. The mean of what they would show
/// takes the place of that of the samples, which are left to say by how much the light differs from it (a control
/// variate: the picture that many samples converge to is the same).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "ricochet/core/vec3.h"

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

/// Most rays from the camera of a pixel whose samples see different things; where samples are as many, there are no
/// others.
inline constexpr int kGlances = 16;

/// What a ray from the camera shows before the sky's light is traced; as it is where it meets nothing.
struct Glance {
    Vec3 own;    ///< light that is known: the surface's own, the sun's on it, and what is behind everything
    Vec3 plain;  ///< light that the surface sends besides if nothing keeps the sky from it
    Vec3 normal;
    Vec3 albedo{1, 1, 1};
    double distance = 0.0;      ///< m
    double slope = 0.0;         ///< m from pixel to pixel
    std::uint32_t surface = 0;  ///< a number for each sphere that is known; 0 for all else
    bool covers = true;         ///< whether it is in the picture: the background is not where that is transparent
};

/// What is known of a pixel, sample by sample.
class PixelSum {
public:
    /// exposure: by which light is multiplied before it is shown.
    explicit PixelSum(double exposure = 1.0) : exposure_(exposure) {}
    /// light: what the surface sends, or what is behind everything; shown: what the pixel shows of it, in the display's
    /// range; cover: part of it that is in the picture.
    void add(const Glance& glance, const Vec3& light, const Vec3& shown, double cover);
    /// How many rays more make the pixel good, at most kGlances with the samples: the more, the more these differ, and
    /// all where they do on both sides of an outline. 0 after kGlances. has_outline: whether that of a known sphere may
    /// be seen.
    [[nodiscard]] int rays_wanted(bool has_outline = false) const;
    /// Distance of the farthest surface of the samples, m; infinite where one saw none.
    [[nodiscard]] double farthest() const { return farthest_; }
    /// A ray from the camera beyond the samples; at most kGlances with them.
    void add(const Glance& glance);
    /// Of the samples, at least one, and the glances.
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
    double sum_of_squares_ = 0.0;  // of the luminance
    Vec3 light_, plain_;           // sums of what surfaces send and would send
    double cover_ = 0.0;           // sums over the samples, and over all rays
    double seen_ = 0.0;
    double seen_by_samples_ = 0.0;
    double farthest_ = 0.0;
    std::uint32_t surface_ = 0;  // of the first sample
    bool surfaces_differ_ = false;
    int samples_ = 0;
    int rays_ = 0;
    std::array<Sample, kGlances> kept_;
};

}  // namespace ricochet
