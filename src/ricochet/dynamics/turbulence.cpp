#include "ricochet/dynamics/flows.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "ricochet/core/checks.h"
#include "ricochet/core/error.h"
#include "ricochet/core/random.h"

namespace ricochet {
namespace {

constexpr std::uint32_t kTable = 256;  // number of entries, and period of the lattice in points
// Stream keys of random numbers. They differ from the keys of emitters, whose high byte is smaller.
constexpr std::uint32_t kGradientStream = 0xF1040001U;
constexpr std::uint32_t kOrderStream = 0xF1040002U;
constexpr std::uint32_t kOffsetStream = 0xF1040003U;
// Mean square of the curl of three noises with unit gradients, the function fade() and lattice spacing 1. It is twice
// the mean square of the gradient of one noise. The value is rational, because the integrals over a cell are rational.
// A mathematical constant.
constexpr double kMeanSquareCurl = 238536280.0 / 160243083.0;

// Fade function, whose first and second derivatives are zero at both ends (Perlin 2002), and its derivative.
double fade(double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }
double fade_slope(double t) { return 30.0 * t * t * (t - 1.0) * (t - 1.0); }

struct LatticeCell {
    std::uint32_t point;  // index of the lattice point, modulo kTable
    double offset;        // offset from the lattice point, in [0, 1)
};

LatticeCell place_of(double x) {
    const double below = std::floor(x);
    const double wrapped = below - kTable * std::floor(below / kTable);
    if (!(wrapped >= 0.0 && wrapped < kTable)) return {0, 0.0};  // not finite
    return {static_cast<std::uint32_t>(wrapped), x - below};
}

// Curl of three gradient noises on a lattice of spacing 1. Each lattice point adds a weight w times a linear function p
// to every noise, so its curl is curl(w p) = w curl p + grad w x p.
class CurlNoise {
public:
    explicit CurlNoise(std::uint64_t seed) {
        for (std::uint32_t i = 0; i < kTable; ++i) {
            RandomSequence random(seed, kGradientStream, i);
            const Vec3 a = random.unit_vector();
            const Vec3 b = random.unit_vector();
            const Vec3 c = random.unit_vector();
            gradients_[i] = {a, b, c, {c.y - b.z, a.z - c.x, b.x - a.y}};
            order_[i] = static_cast<std::uint8_t>(i);
        }
        RandomSequence random(seed, kOrderStream, 0);
        for (std::uint32_t i = kTable - 1; i > 0; --i) {
            std::swap(order_[i], order_[static_cast<std::uint32_t>(random.uniform() * (i + 1))]);
        }
    }

    // Returns the curl at a position. slice: index of one of many independent noises.
    [[nodiscard]] Vec3 curl(const Vec3& position, std::uint32_t slice) const {
        const LatticeCell at[3] = {place_of(position.x), place_of(position.y), place_of(position.z)};
        double weight[3][2];
        double slope[3][2];
        for (int axis = 0; axis < 3; ++axis) {
            weight[axis][1] = fade(at[axis].offset);
            weight[axis][0] = 1.0 - weight[axis][1];
            slope[axis][1] = fade_slope(at[axis].offset);
            slope[axis][0] = -slope[axis][1];
        }
        Vec3 sum;
        for (std::uint32_t i = 0; i < 2; ++i) {
            // The slice is hashed separately. If the slice were added to the position, the next slice would be the same
            // noise, shifted by one lattice point.
            const std::uint32_t row = hashed(hashed(0, slice), at[0].point + i);
            for (std::uint32_t j = 0; j < 2; ++j) {
                const std::uint32_t column = hashed(row, at[1].point + j);
                for (std::uint32_t k = 0; k < 2; ++k) {
                    const Gradients& g = gradients_[hashed(column, at[2].point + k)];
                    const Vec3 d(at[0].offset - i, at[1].offset - j, at[2].offset - k);
                    const Vec3 potential(dot(g.first, d), dot(g.second, d), dot(g.third, d));
                    const Vec3 gradient(slope[0][i] * weight[1][j] * weight[2][k],
                                        weight[0][i] * slope[1][j] * weight[2][k],
                                        weight[0][i] * weight[1][j] * slope[2][k]);
                    sum += g.curl * (weight[0][i] * weight[1][j] * weight[2][k]) + cross(gradient, potential);
                }
            }
        }
        return sum;
    }

private:
    struct Gradients {
        Vec3 first, second, third;  // gradients of the three noises
        Vec3 curl;                  // curl of the linear functions with these gradients
    };
    [[nodiscard]] std::uint32_t hashed(std::uint32_t before, std::uint32_t point) const {
        return order_[(before + point) % kTable];
    }

    std::array<Gradients, kTable> gradients_;
    std::array<std::uint8_t, kTable> order_;
};

class Turbulence final : public FlowField {
public:
    explicit Turbulence(const TurbulenceSettings& settings) : noise_(settings.seed), frozen_(settings.rate == 0.0) {
        double squares = 0.0;
        double factor = 1.0;  // speed of the octave relative to the first octave
        double finer = 1.0;
        for (std::uint32_t k = 0; k < settings.octaves; ++k) {
            RandomSequence random(settings.seed, kOffsetStream, k);
            Vec3 offset;  // drawn one by one, z first, because compilers differ in the evaluation order of arguments
            for (const int axis : {2, 1, 0}) offset[axis] = random.uniform() * kTable;
            octaves_.push_back({finer / settings.length, factor, settings.rate * finer * factor, offset,
                                static_cast<std::uint32_t>(random.uniform() * kTable)});
            squares += factor * factor;
            factor *= settings.gain;
            finer *= 2.0;
        }
        for (Octave& octave : octaves_) octave.speed *= settings.speed / std::sqrt(squares * kMeanSquareCurl);
    }

    [[nodiscard]] Vec3 velocity(const Vec3& position, double time) const override {
        Vec3 sum;
        for (const Octave& octave : octaves_) sum += octave.speed * curl(octave, position, time);
        return sum;
    }
    [[nodiscard]] bool is_steady() const override { return frozen_; }

private:
    struct Octave {
        double frequency;  // in 1/m
        double speed;      // speed for a curl of 1, in m/s
        double rate;       // in 1/s
        Vec3 offset;       // offset of the lattice, so that the lattices of the octaves do not coincide
        std::uint32_t first_slice;
    };

    [[nodiscard]] Vec3 curl(const Octave& octave, const Vec3& position, double time) const {
        const Vec3 point = position * octave.frequency + octave.offset;
        const LatticeCell now = place_of(octave.rate * time);
        const std::uint32_t slice = octave.first_slice + now.point;
        const double next = fade(now.offset);
        if (next == 0.0) return noise_.curl(point, slice);
        const double scale = 1.0 / std::sqrt(next * next + (1.0 - next) * (1.0 - next));
        return noise_.curl(point, slice) * ((1.0 - next) * scale) + noise_.curl(point, slice + 1) * (next * scale);
    }

    CurlNoise noise_;
    std::vector<Octave> octaves_;
    bool frozen_;
};

}  // namespace

FlowPointer make_turbulence(const TurbulenceSettings& settings) {
    detail::require_not_negative(settings.speed, "turbulence: the speed", "m/s");
    detail::require_positive(settings.length, "turbulence: the length", "m");
    detail::require_positive(settings.gain, "turbulence: the gain", "");
    detail::require_not_negative(settings.rate, "turbulence: the rate", "1/s");
    if (settings.gain > 1.0)
        throw InputError(fmt::format("turbulence: the gain must be <= 1, found {}", settings.gain));
    if (settings.octaves < 1 || settings.octaves > kMostOctaves) {
        throw InputError(
            fmt::format("turbulence: the octaves must be 1 to {}, found {}", kMostOctaves, settings.octaves));
    }
    return std::make_shared<Turbulence>(settings);
}

}  // namespace ricochet
