#include "ricochet/render/sampling.h"

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

// Owen's scrambling of the bits from the highest down (Burley 2020, listing 3).
std::uint32_t scrambled(std::uint32_t x, std::uint32_t seed) {
    x = reversed_bits(x);
    x += seed;
    x ^= x * 0x6c50b47cU;
    x ^= x * 0xb82f1e52U;
    x ^= x * 0xc7afe638U;
    x ^= x * 0x8d22f6e6U;
    return reversed_bits(x);
}

// The second dimension of Sobol's sequence; the first one is the bits reversed.
std::uint32_t sobol_second(std::uint32_t index) {
    std::uint32_t result = 0;
    for (std::uint32_t direction = 0x80000000U; index != 0; index >>= 1) {
        if ((index & 1U) != 0) result ^= direction;
        direction ^= direction >> 1;
    }
    return result;
}

}  // namespace

PixelSamples::PixelSamples(int x, int y)
    : seed_(mixed(static_cast<std::uint32_t>(x) + mixed(static_cast<std::uint32_t>(y) + 0x9e3779b9U))) {}

SamplePair PixelSamples::get(int sample, SamplePurpose purpose) const {
    const std::uint32_t seed = mixed(seed_ + 0x632be5abU * (static_cast<std::uint32_t>(purpose) + 1));
    // The order is shuffled by scrambling the index, so that pairs of two purposes are independent.
    const std::uint32_t index = scrambled(static_cast<std::uint32_t>(sample), seed);
    return {scrambled(reversed_bits(index), mixed(seed ^ 0x1b873593U)) * kUnit,
            scrambled(sobol_second(index), mixed(seed ^ 0xcc9e2d51U)) * kUnit};
}

double PixelSamples::time(int sample) const {
    const std::uint32_t seed = mixed(seed_ + 0x27d4eb2fU);
    return scrambled(reversed_bits(static_cast<std::uint32_t>(sample)), seed) * kUnit;
}

}  // namespace ricochet
