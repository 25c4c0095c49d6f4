/// \file
/// Quasi-random numbers for the samples of pixels. Each pair of dimensions is well stratified, and the pixels have
/// different numbers. The numbers do not depend on the number of threads.
/// Method: the first two dimensions of I. M. Sobol's sequence (1967), with Owen scrambling by hashing (B. Burley,
/// "Practical Hash-based Owen Scrambling", Journal of Computer Graphics Techniques 9(4), 2020).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace ricochet {

/// Two numbers in [0, 1).
struct SamplePair {
    double u = 0.0;
    double v = 0.0;
};

/// A point of the unit disc.
struct DiscPoint {
    double x = 0.0;
    double y = 0.0;
};

/// Maps a pair uniformly to the unit disc. The angle is v turns, with an error of at most 3e-9. The squared radius is
/// u. Sine and cosine are computed by series around the nearest quarter turn, because library functions are slower.
[[nodiscard]] inline DiscPoint on_disc(const SamplePair& at) {
    const int quarter = static_cast<int>(4.0 * at.v + 0.5);  // the cast rounds down, because v is not negative
    const double t = (4.0 * at.v - quarter) * (0.5 * std::numbers::pi);
    const double q = t * t;
    const double sine =
        t * (1.0 - q * (1.0 / 6.0) * (1.0 - q * (1.0 / 20.0) * (1.0 - q * (1.0 / 42.0) * (1.0 - q * (1.0 / 72.0)))));
    const double cosine =
        1.0 -
        q * (1.0 / 2.0) *
            (1.0 - q * (1.0 / 12.0) * (1.0 - q * (1.0 / 30.0) * (1.0 - q * (1.0 / 56.0) * (1.0 - q * (1.0 / 90.0)))));
    const double radius = std::sqrt(at.u);
    // Tables replace branches on the quarter, because a processor cannot predict these branches.
    constexpr std::array<double, 4> kSigns = {1.0, 1.0, -1.0, -1.0};
    const std::array<double, 2> either = {radius * cosine, radius * sine};
    const auto turns = static_cast<std::size_t>(quarter & 3);
    return {kSigns[(turns + 1) & 3] * either[turns & 1], kSigns[turns] * either[(turns & 1) ^ 1]};
}

/// Factor that maps 32-bit integers to [0, 1).
namespace sampling {

inline constexpr double kUnit = 1.0 / 4294967296.0;

/// Returns the number with its 32 bits in reverse order.
[[nodiscard]] inline std::uint32_t reversed_bits(std::uint32_t x) {
    x = (x >> 16) | (x << 16);
    x = ((x & 0x00ff00ffU) << 8) | ((x & 0xff00ff00U) >> 8);
    x = ((x & 0x0f0f0f0fU) << 4) | ((x & 0xf0f0f0f0U) >> 4);
    x = ((x & 0x33333333U) << 2) | ((x & 0xccccccccU) >> 2);
    return ((x & 0x55555555U) << 1) | ((x & 0xaaaaaaaaU) >> 1);
}

/// Applies Owen scrambling (Burley 2020, listing 3) to a number whose bits are given in reverse order. The result has
/// normal bit order.
[[nodiscard]] inline std::uint32_t scrambled_reversed(std::uint32_t x, std::uint32_t seed) {
    x += seed;
    x ^= x * 0x6c50b47cU;
    x ^= x * 0xb82f1e52U;
    x ^= x * 0xc7afe638U;
    x ^= x * 0x8d22f6e6U;
    return reversed_bits(x);
}

/// Returns the second dimension of Sobol's sequence with its bits in reverse order. The first dimension is the index in
/// reversed bit order. The bits of the index are the coefficients of a polynomial in t over the field of two elements.
/// The function substitutes 1 + t for t. In this field (1 + t)^16 = 1 + t^16, and so on for 8, 4, 2 and 1. Each line
/// therefore substitutes one power for all coefficients at once.
[[nodiscard]] inline std::uint32_t reversed_sobol_second(std::uint32_t index) {
    index ^= index >> 16;
    index ^= (index & 0xff00ff00U) >> 8;
    index ^= (index & 0xf0f0f0f0U) >> 4;
    index ^= (index & 0xccccccccU) >> 2;
    return index ^ ((index & 0xaaaaaaaaU) >> 1);
}

}  // namespace sampling

/// Use of a sample pair. Pairs of different purposes are independent.
enum class SamplePurpose : std::uint32_t { pixel, lens, sun, sky, far_sun, lamp };
inline constexpr std::size_t kSamplePurposes = 6;

/// Generator of the sample numbers of one pixel.
class PixelSamples {
public:
    PixelSamples(int x, int y);
    /// Returns the pair of a sample (0, 1, ...). Each elementary interval of area 2^-k in the unit square contains
    /// exactly one of the first 2^k pairs.
    [[nodiscard]] SamplePair get(int sample, SamplePurpose purpose) const;
    /// Returns the time of a sample within the exposure, in [0, 1). The times are stratified like the pairs of get().
    [[nodiscard]] double time(int sample) const;

private:
    // Seeds of one purpose: for the order of its pairs, and for the two dimensions.
    struct Seeds {
        std::uint32_t order = 0, first = 0, second = 0;
    };
    std::array<Seeds, kSamplePurposes> seeds_;
    std::uint32_t time_seed_ = 0;
};

inline SamplePair PixelSamples::get(int sample, SamplePurpose purpose) const {
    const Seeds& seeds = seeds_[static_cast<std::size_t>(purpose)];
    // The scrambled index shuffles the order of the pairs, so that the pairs of two purposes are independent.
    const std::uint32_t index =
        sampling::scrambled_reversed(sampling::reversed_bits(static_cast<std::uint32_t>(sample)), seeds.order);
    return {sampling::scrambled_reversed(index, seeds.first) * sampling::kUnit,
            sampling::scrambled_reversed(sampling::reversed_sobol_second(index), seeds.second) * sampling::kUnit};
}

inline double PixelSamples::time(int sample) const {
    return sampling::scrambled_reversed(static_cast<std::uint32_t>(sample), time_seed_) * sampling::kUnit;
}

}  // namespace ricochet
