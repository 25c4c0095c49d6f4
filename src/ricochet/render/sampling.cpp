#include "ricochet/render/sampling.h"

#include <cmath>
#include <numbers>

namespace ricochet {
namespace {

constexpr double kUnit = 1.0 / 4294967296.0;

// A well-mixed 32-bit value. Method: the integer finaliser of the hash "lowbias32", C. Wellons, 2018.
std::uint32_t mixed(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352dU;
    x ^= x >> 15;
    x *= 0x846ca68bU;
    x ^= x >> 16;
    return x;
}

std::uint32_t reversed_bits(std::uint32_t x) {
    x = (x >> 16) | (x << 16);
    x = ((x & 0x00ff00ffU) << 8) | ((x & 0xff00ff00U) >> 8);
    x = ((x & 0x0f0f0f0fU) << 4) | ((x & 0xf0f0f0f0U) >> 4);
    x = ((x & 0x33333333U) << 2) | ((x & 0xccccccccU) >> 2);
    return ((x & 0x55555555U) << 1) | ((x & 0xaaaaaaaaU) >> 1);
}

// Owen's scrambling of the bits from the highest down (Burley 2020, listing 3), of a number whose bits are reversed.
std::uint32_t scrambled_reversed(std::uint32_t x, std::uint32_t seed) {
    x += seed;
    x ^= x * 0x6c50b47cU;
    x ^= x * 0xb82f1e52U;
    x ^= x * 0xc7afe638U;
    x ^= x * 0x8d22f6e6U;
    return reversed_bits(x);
}

// The second dimension of Sobol's sequence, bits reversed; the first one is the index with reversed bits. Its direction
// numbers are the powers of 1 + t over the field of two elements: bits are the coefficients of a polynomial in t, into
// which 1 + t is put for t, half by half, since (1 + t)^16 = 1 + t^16 there, and so on.
std::uint32_t reversed_sobol_second(std::uint32_t index) {
    index ^= index >> 16;
    index ^= (index & 0xff00ff00U) >> 8;
    index ^= (index & 0xf0f0f0f0U) >> 4;
    index ^= (index & 0xccccccccU) >> 2;
    return index ^ ((index & 0xaaaaaaaaU) >> 1);
}

}  // namespace

// Series about the nearest quarter of a turn: a library's sine of any angle takes longer than much of what it is for.
DiscPoint on_disc(const SamplePair& at) {
    const double quarter = std::floor(4.0 * at.v + 0.5);
    const double t = (4.0 * at.v - quarter) * (0.5 * std::numbers::pi);
    const double q = t * t;
    const double sine =
        t * (1.0 - q * (1.0 / 6.0) * (1.0 - q * (1.0 / 20.0) * (1.0 - q * (1.0 / 42.0) * (1.0 - q * (1.0 / 72.0)))));
    const double cosine =
        1.0 -
        q * (1.0 / 2.0) *
            (1.0 - q * (1.0 / 12.0) * (1.0 - q * (1.0 / 30.0) * (1.0 - q * (1.0 / 56.0) * (1.0 - q * (1.0 / 90.0)))));
    const double radius = std::sqrt(at.u);
    const int turns = static_cast<int>(quarter) & 3;
    const double along = radius * (turns % 2 == 0 ? cosine : -sine);
    const double across = radius * (turns % 2 == 0 ? sine : cosine);
    return turns < 2 ? DiscPoint{along, across} : DiscPoint{-along, -across};
}

PixelSamples::PixelSamples(int x, int y)
    : seed_(mixed(static_cast<std::uint32_t>(x) + mixed(static_cast<std::uint32_t>(y) + 0x9e3779b9U))) {}

SamplePair PixelSamples::get(int sample, SamplePurpose purpose) const {
    const std::uint32_t seed = mixed(seed_ + 0x632be5abU * (static_cast<std::uint32_t>(purpose) + 1));
    // The order is shuffled by scrambling the index, so that pairs of two purposes are independent.
    const std::uint32_t index = scrambled_reversed(reversed_bits(static_cast<std::uint32_t>(sample)), seed);
    return {scrambled_reversed(index, mixed(seed ^ 0x1b873593U)) * kUnit,
            scrambled_reversed(reversed_sobol_second(index), mixed(seed ^ 0xcc9e2d51U)) * kUnit};
}

double PixelSamples::time(int sample) const {
    const std::uint32_t seed = mixed(seed_ + 0x27d4eb2fU);
    return scrambled_reversed(static_cast<std::uint32_t>(sample), seed) * kUnit;
}

}  // namespace ricochet
