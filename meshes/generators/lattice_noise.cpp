#include "generators/lattice_noise.h"

#include <array>
#include <cmath>

namespace ricochet::meshes {
namespace {

constexpr double kAxisShift = 17.31;  // keeps the octaves' lattices from sharing their zeros at the origin

/// Mixes bits: every input bit changes every output bit with probability near one half.
/// Method: G. Steele et al., "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014.
std::uint64_t mix(std::uint64_t bits) {
    bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9ULL;
    bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EBULL;
    return bits ^ (bits >> 31);
}

std::uint64_t mix_seed(std::uint64_t seed) { return mix(seed + 0x9E3779B97F4A7C15ULL); }
// Lattice coordinates are mixed in one after the other, so that the corners of a cell share the work.
std::uint64_t mix_i(std::uint64_t bits, std::int64_t i) {
    return mix(bits ^ (static_cast<std::uint64_t>(i) * 0xD6E8FEB86659FD93ULL));
}
std::uint64_t mix_j(std::uint64_t bits, std::int64_t j) {
    return mix(bits ^ (static_cast<std::uint64_t>(j) * 0xA0761D6478BD642FULL));
}
std::uint64_t mix_k(std::uint64_t bits, std::int64_t k) {
    return mix(bits ^ (static_cast<std::uint64_t>(k) * 0xE7037ED1A0B428DBULL));
}

constexpr std::array<std::array<double, 3>, 12> kDirections{{{1, 1, 0},
                                                             {-1, 1, 0},
                                                             {1, -1, 0},
                                                             {-1, -1, 0},
                                                             {1, 0, 1},
                                                             {-1, 0, 1},
                                                             {1, 0, -1},
                                                             {-1, 0, -1},
                                                             {0, 1, 1},
                                                             {0, -1, 1},
                                                             {0, 1, -1},
                                                             {0, -1, -1}}};

Vec3 direction_of(std::uint64_t hash) {
    const auto& d = kDirections[hash % kDirections.size()];
    return {d[0], d[1], d[2]};
}

double fade(double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }
double fade_slope(double t) { return 30.0 * t * t * (t * (t - 2.0) + 1.0); }

/// Blend weight of one corner of the cell along one axis, and its derivative.
struct Weight {
    double value;
    double slope;
};

std::array<Weight, 2> axis_weights(double t) {
    const double w = fade(t);
    const double slope = fade_slope(t);
    return {{{1.0 - w, -slope}, {w, slope}}};
}

Vec3 octave_position(const Vec3& p, double frequency, int octave) {
    const double shift = kAxisShift * static_cast<double>(octave);
    return frequency * p + Vec3{shift, -shift, 0.5 * shift};
}

/// Computes gradient_noise() within a cell. Inlined, so that an unused gradient costs nothing.
inline NoiseSample sample_noise(const Vec3& p, std::uint64_t mixed_seed) {
    const Vec3 cell{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
    const Vec3 t = p - cell;
    const auto wx = axis_weights(t.x);
    const auto wy = axis_weights(t.y);
    const auto wz = axis_weights(t.z);
    NoiseSample sample;
    for (std::size_t cx = 0; cx < 2; ++cx) {
        const std::uint64_t hash_i =
            mix_i(mixed_seed, static_cast<std::int64_t>(cell.x) + static_cast<std::int64_t>(cx));
        const auto [x, dx] = wx[cx];
        for (std::size_t cy = 0; cy < 2; ++cy) {
            const std::uint64_t hash_j =
                mix_j(hash_i, static_cast<std::int64_t>(cell.y) + static_cast<std::int64_t>(cy));
            const auto [y, dy] = wy[cy];
            for (std::size_t cz = 0; cz < 2; ++cz) {
                const auto k = static_cast<std::int64_t>(cell.z) + static_cast<std::int64_t>(cz);
                const auto [z, dz] = wz[cz];
                const Vec3 direction = direction_of(mix_k(hash_j, k));
                const Vec3 corner{static_cast<double>(cx), static_cast<double>(cy), static_cast<double>(cz)};
                const double ramp = dot(direction, t - corner);
                sample.value += x * y * z * ramp;
                sample.gradient += x * y * z * direction + ramp * Vec3{dx * y * z, x * dy * z, x * y * dz};
            }
        }
    }
    return sample;
}

}  // namespace

NoiseSample gradient_noise(const Vec3& p, std::uint64_t seed) { return sample_noise(p, mix_seed(seed)); }

double fractal_noise(const Vec3& p, const Octaves& octaves, std::uint64_t seed) {
    const std::uint64_t mixed_seed = mix_seed(seed);
    double sum = 0.0;
    double amplitude_sum = 0.0;
    double amplitude = 1.0;
    double frequency = 1.0;
    for (int octave = 0; octave < octaves.count; ++octave) {
        sum += amplitude * sample_noise(octave_position(p, frequency, octave), mixed_seed).value;
        amplitude_sum += amplitude;
        amplitude *= octaves.gain;
        frequency *= octaves.lacunarity;
    }
    return sum / amplitude_sum;
}

double ridged_noise(const Vec3& p, const Octaves& octaves, std::uint64_t seed) {
    const std::uint64_t mixed_seed = mix_seed(seed);
    double sum = 0.0;
    double amplitude_sum = 0.0;
    double amplitude = 1.0;
    double frequency = 1.0;
    double weight = 1.0;
    for (int octave = 0; octave < octaves.count; ++octave) {
        const double n = sample_noise(octave_position(p, frequency, octave), mixed_seed).value;
        const double crest = 1.0 - std::fmin(1.0, std::fabs(n));
        const double signal = crest * crest * weight;
        sum += amplitude * signal;
        amplitude_sum += amplitude;
        weight = std::fmin(1.0, 2.0 * signal);
        amplitude *= octaves.gain;
        frequency *= octaves.lacunarity;
    }
    return sum / amplitude_sum;
}

double eroded_noise(const Vec3& p, const Octaves& octaves, std::uint64_t seed) {
    const std::uint64_t mixed_seed = mix_seed(seed);
    double sum = 0.0;
    double amplitude_sum = 0.0;
    double amplitude = 1.0;
    double frequency = 1.0;
    Vec3 slope;
    for (int octave = 0; octave < octaves.count; ++octave) {
        const NoiseSample n = sample_noise(octave_position(p, frequency, octave), mixed_seed);
        slope += n.gradient;
        sum += amplitude * n.value / (1.0 + length_squared(slope));
        amplitude_sum += amplitude;
        amplitude *= octaves.gain;
        frequency *= octaves.lacunarity;
    }
    return sum / amplitude_sum;
}

}  // namespace ricochet::meshes
