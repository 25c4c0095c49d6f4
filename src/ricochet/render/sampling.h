/// \file
/// The numbers that the samples of a pixel are made of: well spread in every pair of dimensions, other ones in every
/// pixel, the same for any number of threads.
/// Method: Owen-scrambled (0, 2)-sequences by hashing: B. Burley, "Practical Hash-based Owen Scrambling", Journal of
/// Computer Graphics Techniques 9(4), 2020. Points: I. M. Sobol, 1967, first two dimensions.
#pragma once

#include <array>
#include <cstdint>

namespace ricochet {

/// Two numbers in 0..1, 1 left out.
struct SamplePair {
    double u = 0.0;
    double v = 0.0;
};

/// A point of the unit disc.
struct DiscPoint {
    double x = 0.0;
    double y = 0.0;
};

/// Evenly over the disc: the angle is v turns to 3e-9, the square of the distance from the middle u.
[[nodiscard]] DiscPoint on_disc(const SamplePair& at);

/// What a pair is for; pairs of different purposes are independent of each other.
enum class SamplePurpose : std::uint32_t { pixel, lens, sun, sky, far_sun, lamp };

/// The samples of one pixel.
class PixelSamples {
public:
    PixelSamples(int x, int y);
    /// sample: 0, 1, ...; any first 2^k of them are stratified in every elementary interval of the square.
    [[nodiscard]] SamplePair get(int sample, SamplePurpose purpose) const;
    /// A number for the time within the shutter: as get(), in one dimension.
    [[nodiscard]] double time(int sample) const;

private:
    std::uint32_t seed_;
};

}  // namespace ricochet
