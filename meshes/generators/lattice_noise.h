/// \file
/// Smooth noise on the integer lattice: the same bits on every machine, because it hashes integers and otherwise only
/// adds, multiplies and rounds down.
#pragma once

#include <cstdint>

#include "ricochet/core/vec3.h"

namespace ricochet::meshes {

/// A noise value with its gradient with respect to the position.
struct NoiseSample {
    double value = 0.0;
    Vec3 gradient;
};

/// Gradient noise with period 2^64 and wavelength about 1: value in (-1.1, 1.1), mean 0, twice differentiable.
/// Method: K. Perlin, "Improving Noise", SIGGRAPH 2002 (quintic fade, twelve edge directions).
[[nodiscard]] NoiseSample gradient_noise(const Vec3& p, std::uint64_t seed);

/// How a fractal sum is built from octaves of noise.
struct Octaves {
    int count = 5;             ///< number of octaves, at least 1
    double lacunarity = 2.03;  ///< frequency ratio of one octave to the one before
    double gain = 0.5;         ///< amplitude ratio of one octave to the one before
};

/// Fractional Brownian motion: octaves added, divided by the sum of their amplitudes; about [-1, 1].
[[nodiscard]] double fractal_noise(const Vec3& p, const Octaves& octaves, std::uint64_t seed);

/// Ridged noise: sharp crests where the octaves change sign, finer octaves fade away from the crests; [0, 1].
/// Method: F. K. Musgrave in D. Ebert et al., "Texturing and Modeling", 3rd ed., chapter 16.
[[nodiscard]] double ridged_noise(const Vec3& p, const Octaves& octaves, std::uint64_t seed);

/// Octaves damped where the octaves before them are steep, so that slopes stay smooth and crests and plains are rough,
/// as on eroded ground; about [-1, 1].
[[nodiscard]] double eroded_noise(const Vec3& p, const Octaves& octaves, std::uint64_t seed);

}  // namespace ricochet::meshes
