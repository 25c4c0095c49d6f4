/// \file
/// Sample numbers of pixels. Every pair of dimensions is well stratified, every pixel has different numbers, and the
/// numbers do not depend on the number of threads.
/// Method: Owen-scrambled (0, 2)-sequences by hashing: B. Burley, "Practical Hash-based Owen Scrambling", Journal of
/// Computer Graphics Techniques 9(4), 2020. Points: I. M. Sobol, 1967, first two dimensions.
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

/// Maps a pair uniformly to the unit disc. The angle is v turns, to 3e-9, and the squared radius is u.
/// The function uses series around the nearest quarter turn, because a general library sine takes longer than many of
/// its uses here.
[[nodiscard]] inline DiscPoint on_disc(const SamplePair& at) {
    const int quarter = static_cast<int>(4.0 * at.v + 0.5);  // v is not negative
    const double t = (4.0 * at.v - quarter) * (0.5 * std::numbers::pi);
    const double q = t * t;
    const double sine =
        t * (1.0 - q * (1.0 / 6.0) * (1.0 - q * (1.0 / 20.0) * (1.0 - q * (1.0 / 42.0) * (1.0 - q * (1.0 / 72.0)))));
    const double cosine =
        1.0 -
        q * (1.0 / 2.0) *
            (1.0 - q * (1.0 / 12.0) * (1.0 - q * (1.0 / 30.0) * (1.0 - q * (1.0 / 56.0) * (1.0 - q * (1.0 / 90.0)))));
    const double radius = std::sqrt(at.u);
    // Tables avoid branches on the quarter, which a processor cannot predict.
    constexpr std::array<double, 4> kSigns = {1.0, 1.0, -1.0, -1.0};
    const std::array<double, 2> either = {radius * cosine, radius * sine};
    const auto turns = static_cast<std::size_t>(quarter & 3);
    return {kSigns[(turns + 1) & 3] * either[turns & 1], kSigns[turns] * either[(turns & 1) ^ 1]};
}

/// Bit operations of PixelSamples.
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

/// Applies Owen's scrambling of the bits from the highest down (Burley 2020, listing 3) to a number whose bits are
/// reversed.
[[nodiscard]] inline std::uint32_t scrambled_reversed(std::uint32_t x, std::uint32_t seed) {
    x += seed;
    x ^= x * 0x6c50b47cU;
    x ^= x * 0xb82f1e52U;
    x ^= x * 0xc7afe638U;
    x ^= x * 0x8d22f6e6U;
    return reversed_bits(x);
}

/// Returns the second dimension of Sobol's sequence with its bits reversed. The first dimension is the index with
/// reversed bits.
/// The direction numbers are the powers of 1 + t over the field of two elements. The bits are the coefficients of a
/// polynomial in t, in which 1 + t replaces t. The substitution works half by half, because (1 + t)^16 = 1 + t^16 in
/// this field, and so on.
[[nodiscard]] inline std::uint32_t reversed_sobol_second(std::uint32_t index) {
    index ^= index >> 16;
    index ^= (index & 0xff00ff00U) >> 8;
    index ^= (index & 0xf0f0f0f0U) >> 4;
    index ^= (index & 0xccccccccU) >> 2;
    return index ^ ((index & 0xaaaaaaaaU) >> 1);
}

}  // namespace sampling

/// Purpose of a sample pair. Pairs of different purposes are independent.
enum class SamplePurpose : std::uint32_t { pixel, lens, sun, sky, far_sun, lamp };
inline constexpr std::size_t kSamplePurposes = 6;

/// The samples of one pixel.
class PixelSamples {
public:
    PixelSamples(int x, int y);
    /// Returns the pair of a sample (0, 1, ...). The first 2^k samples are stratified in every elementary interval of
    /// the square.
    [[nodiscard]] SamplePair get(int sample, SamplePurpose purpose) const;
    /// Returns the time of a sample within the shutter interval, as get() does in one dimension.
    [[nodiscard]] double time(int sample) const;

private:
    // Seeds for the order of the pairs of a purpose, and for its two dimensions.
    struct Seeds {
        std::uint32_t order = 0, first = 0, second = 0;
    };
    std::array<Seeds, kSamplePurposes> seeds_;
    std::uint32_t time_seed_ = 0;
};

inline SamplePair PixelSamples::get(int sample, SamplePurpose purpose) const {
    const Seeds& seeds = seeds_[static_cast<std::size_t>(purpose)];
    // Scrambling the index shuffles the order, so that pairs of two purposes are independent.
    const std::uint32_t index =
        sampling::scrambled_reversed(sampling::reversed_bits(static_cast<std::uint32_t>(sample)), seeds.order);
    return {sampling::scrambled_reversed(index, seeds.first) * sampling::kUnit,
            sampling::scrambled_reversed(sampling::reversed_sobol_second(index), seeds.second) * sampling::kUnit};
}

inline double PixelSamples::time(int sample) const {
    return sampling::scrambled_reversed(static_cast<std::uint32_t>(sample), time_seed_) * sampling::kUnit;
}

}  // namespace ricochet
