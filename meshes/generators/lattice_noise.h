/// \file
/// Smooth noise on the integer lattice. It has the same bits on every machine, because it hashes integers and otherwise
/// only adds, multiplies and rounds down.
#pragma once

#include <cstdint>

#include "ricochet/core/vec3.h"

namespace ricochet::meshes {

/// A noise value with its gradient with respect to the position.
struct NoiseSample {
    double value = 0.0;
    Vec3 gradient;
};

/// Returns gradient noise with period 2^64 and wavelength about 1: value in (-1.1, 1.1), mean 0, twice differentiable.
/// Method: K. Perlin, "Improving Noise", SIGGRAPH 2002 (quintic fade, twelve edge directions).
[[nodiscard]] NoiseSample gradient_noise(const Vec3& p, std::uint64_t seed);

/// Parameters of a fractal sum of octaves of noise.
struct Octaves {
    int count = 5;             ///< number of octaves, at least 1
    double lacunarity = 2.03;  ///< frequency ratio of one octave to the one before
    double gain = 0.5;         ///< amplitude ratio of one octave to the one before
};

/// Returns fractional Brownian motion: the sum of octaves, divided by the sum of their amplitudes; about [-1, 1].
[[nodiscard]] double fractal_noise(const Vec3& p, const Octaves& octaves, std::uint64_t seed);

/// Returns ridged noise in [0, 1]. It has sharp crests where the octaves change sign, and finer octaves fade away from
/// the crests.
/// Method: F. K. Musgrave in D. Ebert et al., "Texturing and Modeling", 3rd ed., chapter 16.
[[nodiscard]] double ridged_noise(const Vec3& p, const Octaves& octaves, std::uint64_t seed);

/// Returns noise like eroded ground, about [-1, 1]. Octaves are damped on steep slopes of the octaves before them, so
/// slopes are smooth, and crests and plains are rough.
[[nodiscard]] double eroded_noise(const Vec3& p, const Octaves& octaves, std::uint64_t seed);

}  // namespace ricochet::meshes
