#include "bench/cases.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "ricochet/core/error.h"

namespace ricochet::bench {
namespace {

// Everything inside the cavity: its radius is at most 1.8 m.
const Box3 kAroundCavity{{-1.8, -1.8, -1.8}, {1.8, 1.8, 1.8}};

// Some 1.5 % of the particle-steps hit; a finer mesh is rougher.
constexpr double kGasStep = 0.0084;
constexpr double kGasStepOnFineMesh = 0.0069;

Case gas(std::string_view suite, std::string_view name, std::size_t triangles, std::size_t particles,
         double time_step) {
    return {.suite = suite,
            .name = name,
            .ground = Ground::cavity,
            .triangles = triangles,
            .particles = particles,
            .time_step = time_step,
            .start = Start::inside,
            .box = kAroundCavity,
            .speed = 1.0,
            .spread = 0.5,
            .warm_up = 4,
            .steps = 60};
}

Case settle(std::string_view suite, std::string_view name, std::size_t triangles, std::size_t particles) {
    return {.suite = suite,
            .name = name,
            .ground = Ground::bowl,
            .triangles = triangles,
            .particles = particles,
            .time_step = 0.02,
            .restitution = 0.5,
            .friction = 0.5,
            .gravity = 9.81,
            .box = {{-0.5, -0.5, 0.7}, {0.5, 0.5, 1.0}},
            .speed = 0.5,
            .spread = 0.5,
            .steps = 200};
}

// Half a second in which everything lands and bounces once or twice.
Case hail(std::string_view suite, std::string_view name, std::size_t triangles, std::size_t particles) {
    return {.suite = suite,
            .name = name,
            .ground = Ground::terrain,
            .triangles = triangles,
            .particles = particles,
            .time_step = 1.0 / 60.0,
            .restitution = 0.9,
            .gravity = 9.81,
            .start = Start::above_terrain,
            .box = {{20.0, -35.0, 1.0}, {100.0, 35.0, 8.0}},
            .drift = {0.0, 0.0, -20.0},
            .speed = 1.0,
            .spread = 1.0,
            .warm_up = 5,
            .steps = 25};
}

// The drops pass from the rim to the ground in one step, which is the only one, and hardly bounce.
Case rain(std::string_view suite, std::string_view name, std::size_t triangles, std::size_t particles) {
    return {.suite = suite,
            .name = name,
            .ground = Ground::rough_bowl,
            .triangles = triangles,
            .particles = particles,
            .time_step = 1.0 / 60.0,
            .restitution = 0.1,
            .friction = 1.0,
            .gravity = 9.81,
            .box = {{-0.45, -0.45, 0.0}, {0.45, 0.45, 0.4}},
            .drift = {0.0, 0.0, -71.0},
            .speed = 3.0,
            .spread = 1.0};
}

// A step is longer than the cavity is wide (3.6 m at most), so every particle hits in every step.
Case pinball(std::string_view suite, std::string_view name, std::size_t triangles, std::size_t particles) {
    return {.suite = suite,
            .name = name,
            .ground = Ground::cavity,
            .triangles = triangles,
            .particles = particles,
            .time_step = 4.0,
            .start = Start::inside,
            .box = kAroundCavity,
            .speed = 1.0,
            .warm_up = 1,
            .steps = 2};
}

// Into the edge and out again: some pi / 0.01 bounces.
Case wedge(std::string_view suite, std::string_view name, std::size_t triangles, std::size_t particles) {
    return {.suite = suite,
            .name = name,
            .ground = Ground::wedge,
            .triangles = triangles,
            .particles = particles,
            .time_step = 1.0,
            .box = {{0.4, -0.3, -0.0015}, {0.8, 0.3, 0.0015}},
            .drift = {-1.0, 0.0, 0.0},
            .speed = 0.1,
            .steps = 1};
}

}  // namespace

const std::vector<Case>& all_cases() {
    static const std::vector<Case> cases = {
        gas("gas", "gas-20k", 20'000, 1'000'000, kGasStep),
        gas("gas", "gas-1300k", 1'300'000, 1'000'000, kGasStepOnFineMesh),
        settle("settle", "settle", 1'300'000, 1'000'000),
        hail("hail", "hail", 1'300'000, 1'000'000),
        rain("rain", "rain", 1'300'000, 1'000'000),
        pinball("pinball", "pinball", 1'300'000, 1'000'000),
        wedge("wedge", "wedge", 20'000, 20'000),
        gas("quick", "gas", 20'000, 100'000, kGasStep),
        hail("quick", "hail", 50'000, 50'000),
        pinball("quick", "pinball", 20'000, 20'000),
    };
    return cases;
}

std::vector<std::string> suite_names() {
    std::vector<std::string> names;
    for (const Case& c : all_cases()) {
        if (names.empty() || names.back() != c.suite) names.emplace_back(c.suite);
    }
    return names;
}

std::vector<Case> cases_of(std::string_view suite) {
    std::vector<Case> cases;
    std::copy_if(all_cases().begin(), all_cases().end(), std::back_inserter(cases),
                 [&](const Case& c) { return c.suite == suite; });
    if (cases.empty()) {
        throw InputError(
            fmt::format("--suite {}: there is no such suite; there are {}", suite, fmt::join(suite_names(), ", ")));
    }
    return cases;
}

}  // namespace ricochet::bench
