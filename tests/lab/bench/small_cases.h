/// \file Reduced copies of the benchmark's cases for tests.
#pragma once

#include <algorithm>

#include "lab/bench/cases.h"

namespace ricochet::bench {

/// Returns the same case with fewer particles and triangles.
[[nodiscard]] inline Case small_copy(Case c, std::size_t particles, std::size_t triangles) {
    c.particles = std::min(c.particles, particles);
    c.triangles = std::min(c.triangles, triangles);
    return c;
}

/// Returns a reduced copy of the first case of a suite.
[[nodiscard]] inline Case small_case(std::string_view suite, std::size_t particles = 500,
                                     std::size_t triangles = 5000) {
    return small_copy(cases_of(suite).front(), particles, triangles);
}

}  // namespace ricochet::bench
