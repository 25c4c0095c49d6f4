/// \file
/// Sets of weighted points, for tests of sums over many points.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/core/vec3.h"

namespace ricochet::test {

struct WeightedPoints {
    std::vector<Vec3> positions;
    std::vector<double> weights;
};

/// Returns points in a Plummer distribution, which models a globular cluster. The scale is 1, and the largest radius is
/// ten. The weights add up to 1 and differ by factors up to 3. Source: S. J. Aarseth, M. Henon, R. Wielen, Astron.
/// Astrophys. 37, 1974.
inline WeightedPoints plummer_ball(std::size_t count, std::uint64_t seed) {
    RandomSequence draws(seed, 1, 0);
    WeightedPoints points;
    double sum = 0.0;
    while (points.positions.size() < count) {
        const double part = draws.uniform();
        if (part == 0.0) continue;
        const double root = std::cbrt(part);
        const double radius = root / std::sqrt(1.0 - root * root);
        const Vec3 direction = draws.unit_vector();
        const double weight = 0.5 + draws.uniform();
        if (!(radius < 10.0)) continue;
        points.positions.push_back(radius * direction);
        points.weights.push_back(weight);
        sum += weight;
    }
    for (double& weight : points.weights) weight /= sum;
    return points;
}

/// Returns uniform points in a cube of unit side, with unit weights of both signs.
inline WeightedPoints charges_in_cube(std::size_t count, std::uint64_t seed) {
    RandomSequence draws(seed, 2, 0);
    WeightedPoints points;
    for (std::size_t k = 0; k < count; ++k) {
        const double x = draws.uniform();
        const double y = draws.uniform();
        points.positions.push_back({x, y, draws.uniform()});
        points.weights.push_back(k % 2 == 0 ? 1.0 : -1.0);
    }
    return points;
}

}  // namespace ricochet::test
