#include "view/render/pixel_sum.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "view/render/tone.h"

namespace ricochet {
namespace {

// Differences between a pixel's samples are measured on the square root of the shown light. This approximates
// perception and the sRGB values of the picture.
constexpr double kEven = 0.06;            // difference below which a pixel needs no extra rays
constexpr double kRaysByContrast = 20.0;  // number of extra rays for a difference of 1
constexpr int kRaysUnseen = 4;            // least number of extra rays if the samples can have missed an outline

Vec3 rooted(const Vec3& shown) { return {std::sqrt(shown.x), std::sqrt(shown.y), std::sqrt(shown.z)}; }

double part(double some, double all) { return all > 0.0 ? std::max(0.0, some) / all : 1.0; }

}  // namespace

void PixelSum::add(const CameraRayResult& result, const Vec3& light, const Vec3& shown, double cover) {
    if (samples_ < kMostPixelRays) {
        kept_[static_cast<std::size_t>(samples_)] = {result.own, result.plain, shown};
        light_ += light - result.own;
        plain_ += result.plain;
    }
    if (samples_ == 0) surface_ = result.surface;
    surfaces_differ_ = surfaces_differ_ || result.surface != surface_;
    farthest_ = std::max(farthest_, result.distance > 0.0 ? result.distance : std::numeric_limits<double>::infinity());
    ++samples_;
    sum_.light += shown;
    const double bright = luminance(shown);
    sum_of_squares_ += bright * bright;
    cover_ += cover;
    seen_by_samples_ += result.covers ? 1.0 : 0.0;
    add_features(result);
}

void PixelSum::add(const CameraRayResult& result) {
    kept_[static_cast<std::size_t>(rays_)] = {result.own, result.plain, {}};
    add_features(result);
}

void PixelSum::add_features(const CameraRayResult& result) {
    ++rays_;
    sum_.normal += result.normal;
    sum_.albedo += result.albedo;
    sum_.distance += result.distance;
    sum_.slope += result.slope;
    seen_ += result.covers ? 1.0 : 0.0;
}

// Returns, for each channel, the samples' light other than CameraRayResult::own, divided by their
// CameraRayResult::plain.
Vec3 PixelSum::lit() const { return {part(light_.x, plain_.x), part(light_.y, plain_.y), part(light_.z, plain_.z)}; }

// Returns the expected light of a sample, in which the ratio `lit` of the pixel replaces the sample's own occlusion.
Vec3 PixelSum::expected(const Sample& sample, const Vec3& lit) const {
    return tone_mapped(exposure_ * (sample.own + times(lit, sample.plain)));
}

// Returns the largest difference between the samples' expected light.
double PixelSum::contrast() const {
    const Vec3 all = lit();
    Vec3 lower = rooted(expected(kept_[0], all));
    Vec3 upper = lower;
    for (int k = 1; k < samples_; ++k) {
        const Vec3 next = rooted(expected(kept_[static_cast<std::size_t>(k)], all));
        lower = min(lower, next);
        upper = max(upper, next);
    }
    return max_abs(upper - lower);
}

int PixelSum::rays_wanted(bool has_outline) const {
    if (samples_ >= kMostPixelRays) return 0;
    const int most = kMostPixelRays - samples_;
    const double differences = contrast();
    const bool is_even = differences < kEven;
    if (has_outline && surfaces_differ_) return is_even ? 0 : most;
    const int by_contrast = is_even ? 0 : static_cast<int>(kRaysByContrast * differences);
    return std::min(most, std::max(by_contrast, has_outline ? kRaysUnseen : 0));
}

PixelLight PixelSum::mean() const {
    PixelLight mean = sum_;
    mean.light = sum_.light / samples_;
    mean.normal = sum_.normal / rays_;
    mean.albedo = sum_.albedo / rays_;
    mean.distance = sum_.distance / rays_;
    mean.slope = sum_.slope / rays_;
    mean.alpha = cover_ / samples_;
    const double bright = luminance(mean.light);
    // The error of a single sample is unknown and assumed to be as large as the sample.
    const double spread = samples_ == 1 ? bright * bright : sum_of_squares_ / samples_ - bright * bright;
    mean.variance = std::max(0.0, spread) / std::max(1, samples_ - 1);
    if (rays_ > samples_) correct(mean);
    return mean;
}

// Replaces the mean of the samples by the control-variate estimate over all rays.
void PixelSum::correct(PixelLight& mean) const {
    const Vec3 all = lit();
    Vec3 few, many;
    double left = 0.0;  // sum of the squared differences between actual and expected luminance
    double square = 0.0;
    double rest = 0.0;
    for (int k = 0; k < rays_; ++k) {
        const Sample& sample = kept_[static_cast<std::size_t>(k)];
        const Vec3 here = expected(sample, all);
        many += here;
        square += luminance(here) * luminance(here);
        if (k >= samples_) continue;
        few += here;
        const double off = luminance(sample.shown - here);
        rest += off;
        left += off * off;
    }
    const Vec3 light = mean.light + many / rays_ - few / samples_;
    mean.light = {std::max(0.0, light.x), std::max(0.0, light.y), std::max(0.0, light.z)};
    mean.alpha = std::clamp(mean.alpha + seen_ / rays_ - seen_by_samples_ / samples_, 0.0, 1.0);
    const double bright = luminance(many / rays_);
    const double of_rest = left / samples_ - (rest / samples_) * (rest / samples_);
    // At edges, the error of the mean of n stratified rays is about their standard deviation divided by n^(3/4).
    const double of_rays = std::max(0.0, square / rays_ - bright * bright) / std::pow(rays_, 1.5);
    if (samples_ > 1) mean.variance = std::max(0.0, of_rest) / (samples_ - 1) + of_rays;
}

}  // namespace ricochet
