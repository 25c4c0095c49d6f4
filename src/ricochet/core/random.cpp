#include "ricochet/core/random.h"

namespace ricochet {
namespace {

constexpr std::uint32_t kMultiplier0 = 0xD2511F53;
constexpr std::uint32_t kMultiplier1 = 0xCD9E8D57;
constexpr std::uint32_t kWeyl0 = 0x9E3779B9;
constexpr std::uint32_t kWeyl1 = 0xBB67AE85;
constexpr int kRounds = 10;

}  // namespace

std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
    for (int round = 0; round < kRounds; ++round) {
        const std::uint64_t product0 = std::uint64_t{kMultiplier0} * counter[0];
        const std::uint64_t product1 = std::uint64_t{kMultiplier1} * counter[2];
        counter = {
            static_cast<std::uint32_t>(product1 >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(product1),
            static_cast<std::uint32_t>(product0 >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(product0)};
        key[0] += kWeyl0;
        key[1] += kWeyl1;
    }
    return counter;
}

RandomSequence::RandomSequence(std::uint64_t seed, std::uint32_t stream, std::uint64_t id, std::uint32_t draw)
    : id_(id),
      stream_(stream),
      draw_(draw),
      key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)} {}

double RandomSequence::uniform() {
    const auto bits =
        philox4x32({draw_, stream_, static_cast<std::uint32_t>(id_), static_cast<std::uint32_t>(id_ >> 32)}, key_);
    ++draw_;
    const std::uint64_t wide = (std::uint64_t{bits[0]} << 32) | bits[1];
    return static_cast<double>(wide >> 11) * 0x1p-53;
}

double RandomSequence::uniform_around(double mean, double spread) { return mean + spread * (2.0 * uniform() - 1.0); }

// Rejection avoids the C library's sine and cosine, whose last bit differs between systems. Each attempt draws from the
// same per-particle counter, so the outcome depends on the key alone.
Vec3 RandomSequence::in_unit_disk() {
    for (;;) {
        const double x = 2.0 * uniform() - 1.0;
        const double y = 2.0 * uniform() - 1.0;
        if (x * x + y * y <= 1.0) return {x, y, 0.0};
    }
}

Vec3 RandomSequence::in_unit_ball() {
    for (;;) {
        const double x = 2.0 * uniform() - 1.0;
        const double y = 2.0 * uniform() - 1.0;
        const double z = 2.0 * uniform() - 1.0;
        if (x * x + y * y + z * z <= 1.0) return {x, y, z};
    }
}

// Method: G. Marsaglia, "Choosing a Point from the Surface of a Sphere", Ann. Math. Statist. 43(2), 1972.
Vec3 RandomSequence::unit_vector() {
    for (;;) {
        const double x = 2.0 * uniform() - 1.0;
        const double y = 2.0 * uniform() - 1.0;
        const double s = x * x + y * y;
        if (s >= 1.0) continue;
        const double r = 2.0 * std::sqrt(1.0 - s);
        return {x * r, y * r, 1.0 - 2.0 * s};
    }
}

}  // namespace ricochet
