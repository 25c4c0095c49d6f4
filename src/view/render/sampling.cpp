#include "view/render/sampling.h"

namespace ricochet {
namespace {

// Returns a hash of a 32-bit value. Method: "lowbias32", C. Wellons, 2018.
std::uint32_t mixed(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352dU;
    x ^= x >> 15;
    x *= 0x846ca68bU;
    x ^= x >> 16;
    return x;
}

}  // namespace

PixelSamples::PixelSamples(int x, int y) {
    const std::uint32_t seed =
        mixed(static_cast<std::uint32_t>(x) + mixed(static_cast<std::uint32_t>(y) + 0x9e3779b9U));
    for (std::uint32_t purpose = 0; purpose < kSamplePurposes; ++purpose) {
        const std::uint32_t order = mixed(seed + 0x632be5abU * (purpose + 1));
        seeds_[purpose] = {order, mixed(order ^ 0x1b873593U), mixed(order ^ 0xcc9e2d51U)};
    }
    time_seed_ = mixed(seed + 0x27d4eb2fU);
}

}  // namespace ricochet
