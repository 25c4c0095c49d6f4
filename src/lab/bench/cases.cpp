#include "lab/bench/cases.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "ricochet/core/error.h"

namespace ricochet::bench {

namespace {

// Box around the cavity. The cavity has a radius of at most 1.8 m.
const Box3 kAroundCavity{{-1.8, -1.8, -1.8}, {1.8, 1.8, 1.8}};

// Time steps, in s, at which about 1.5 % of the particle-steps have an impact. A finer mesh is rougher, so particles
// hit it more often.
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

// Particles fall on a terrain for half a second. In this time, each particle bounces once or twice.
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

// Drops fall from the rim of the bowl to its surface in a single step. Their restitution is small.
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

// Particles in a cavity whose paths of 4 m per step exceed its diameter (at most 3.6 m). Every particle therefore has
// an impact in every step.
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

// Particles move towards the edge of the wedge and back, with about pi / 0.01 bounces each.
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

// Radii of spheres, in m: a single radius, and the limits of a range of three decades. The mesh of these cases has
// edges of about 12 mm.
constexpr std::size_t kTrianglesForSpheres = 320'000;
constexpr double kRadius = 0.002;
constexpr double kLeastRadius = 2e-5;
constexpr double kLargestRadius = 2e-2;

Case with_radii(Case c, std::string_view base, double least, double largest) {
    c.least_radius = least;
    c.largest_radius = largest;
    c.against = Against::points;
    c.base = base;
    return c;
}

// Gas with gravity, so that every response has to support particles.
Case response_case(ResponseKind response) {
    Case c = gas("response", name_of(response), 20'000, 100'000, kGasStep);
    c.gravity = 9.81;
    c.response = response;
    c.against = Against::exact;
    c.base = name_of(ResponseKind::exact);
    return c;
}

// Returns a group of two cases without look-ahead. In the first case no collider moves, and in the second case
// colliders move.
std::vector<Case> rest_and_moving_cases(Case c, std::string_view at_rest, std::string_view moving, Moves moves) {
    c.against = Against::at_rest;
    c.base = c.name = at_rest;
    c.looks_ahead = false;
    Case other = c;
    other.name = moving;
    other.moves = moves;
    return {c, other};
}

Case with_steps(Case c, std::uint64_t warm_up, std::uint64_t steps) {
    c.warm_up = warm_up;
    c.steps = steps;
    return c;
}

using Cases = std::vector<Case>;

void append(Cases& to, const Cases& cases) { to.insert(to.end(), cases.begin(), cases.end()); }

// Cases with different numbers of triangles. In each case, about 1.5 % of the particle-steps have an impact (measured
// with 60 000 particles). The rate of impacts is proportional to the ratio of the cavity's surface to its volume. This
// ratio grows with the number of triangles until the mesh resolves the whole roughness.
Cases size_cases() {
    constexpr std::size_t kMany = 1'000'000;
    constexpr double kStepOnFinestMeshes = 0.0066;
    return {gas("size", "size-20", 20, kMany, 0.0137),
            gas("size", "size-320", 320, kMany, 0.0124),
            gas("size", "size-5k", 5'000, kMany, 0.009),
            gas("size", "size-20k", 20'000, kMany, kGasStep),
            gas("size", "size-80k", 80'000, kMany, 0.0074),
            gas("size", "size-320k", 320'000, kMany, 0.0071),
            gas("size", "size-1300k", 1'300'000, kMany, kGasStepOnFineMesh),
            gas("size", "size-5M", 5'000'000, kMany, kStepOnFinestMeshes),
            gas("size", "size-10M", 10'000'000, kMany, kStepOnFinestMeshes)};
}

// Cases with different numbers of particles. Cases with few particles have many steps, so that their timed work lasts
// some tenths of a second.
Cases count_cases() {
    const auto count = [](std::string_view name, std::size_t particles) {
        return gas("count", name, 1'300'000, particles, kGasStepOnFineMesh);
    };
    return {with_steps(count("count-1k", 1'000), 4, 1000), with_steps(count("count-10k", 10'000), 4, 100),
            count("count-100k", 100'000), count("count-1M", 1'000'000),
            with_steps(count("count-10M", 10'000'000), 4, 20)};
}

Cases radius_cases() {
    Cases cases;
    const Case gas_points = gas("radius", "gas-points", kTrianglesForSpheres, 100'000, 0.007);
    const Case pinball_points = pinball("radius", "pinball-points", kTrianglesForSpheres, 10'000);
    const auto add = [&](const Case& points, std::string_view spheres, std::string_view decades) {
        cases.push_back(with_radii(points, points.name, 0.0, 0.0));
        cases.push_back(with_radii(points, points.name, kRadius, kRadius));
        cases.back().name = spheres;
        cases.push_back(with_radii(points, points.name, kLeastRadius, kLargestRadius));
        cases.back().name = decades;
    };
    add(gas_points, "gas-spheres", "gas-decades");
    add(pinball_points, "pinball-spheres", "pinball-decades");
    return cases;
}

Cases response_cases() {
    Cases cases;
    for (const ResponseKind kind : response_kinds()) cases.push_back(response_case(kind));
    return cases;
}

// Groups of three kinds: flights of 0.7 m per step with an impact in half of the particle-steps, a gas, and a gas among
// rocks.
Cases moving_cases() {
    constexpr std::size_t kTriangles = 100'000;
    constexpr std::size_t kParticles = 50'000;
    constexpr double kStepOnTheseMeshes = 0.0074;
    Case hits = gas("moving", "", kTriangles, kParticles, 0.7);
    hits.steps = 8;
    hits.warm_up = 1;
    const Case inside = with_steps(gas("moving", "", kTriangles, kParticles, kStepOnTheseMeshes), 4, 30);
    Case rocks = with_steps(gas("moving", "", 1'000'000, kParticles, 0.02), 4, 30);
    rocks.ground = Ground::rocks;
    rocks.start = Start::box;
    rocks.box = {{-11, -11, -11}, {11, 11, 11}};
    Cases cases;
    append(cases, rest_and_moving_cases(hits, "hits-rest", "hits-shaken", Moves::shaken));
    append(cases, rest_and_moving_cases(inside, "inside-rest", "inside-spinning", Moves::spinning));
    append(cases, rest_and_moving_cases(inside, "far-rest", "far-moving", Moves::bystander));
    append(cases, rest_and_moving_cases(inside, "deforming-rest", "deforming", Moves::breathing));
    append(cases, rest_and_moving_cases(rocks, "rocks-rest", "rocks-spinning", Moves::spinning));
    return cases;
}

// Returns a group of two cases: spheres that pass through each other, and spheres that collide.
std::vector<Case> apart_and_together_cases(Case c, std::string_view apart, std::string_view together) {
    c.against = Against::apart;
    c.base = c.name = apart;
    Case other = c;
    other.name = together;
    other.spheres_meet = true;
    return {c, other};
}

// Gas of spheres with a volume fraction of 0.01. Each sphere moves by one radius per step.
Case dilute_spheres() {
    constexpr std::size_t kMany = 20'000;
    constexpr double kRadiusOfGas = 0.0079;  // (0.01 / 20 000)^(1/3) times the cavity's radius of 1 m
    Case c = with_steps(gas("pairs", "", 20'000, kMany, kRadiusOfGas), 4, 60);
    c.spread = 0.0;
    c.start = Start::lattice;
    c.pitch = 0.05;
    c.least_radius = c.largest_radius = kRadiusOfGas;
    return c;
}

// Scene for the comparison with other programs in docs/particle-contacts.md. A loose cloud of spheres with radii of 5
// mm plus or minus 20 % falls for one second.
Case filling_spheres(std::size_t particles) {
    return {.suite = "pairs",
            .name = "filling",
            .ground = Ground::bin,
            .triangles = 500,
            .particles = particles,
            .time_step = 1e-3,
            .restitution = 0.5,
            .friction = 0.5,
            .gravity = 9.81,
            .start = Start::lattice,
            .box = {{-0.0931, -0.0931, 0.007}, {0.0931, 0.0931, 0.79}},
            .speed = 0.1,
            .steps = 1000,
            .least_radius = 0.004,
            .largest_radius = 0.006,
            .density = 2500.0,
            .pitch = 0.0132};
}

// Spheres fill a quarter of the cavity, which rotates at 25 degrees per second.
Case tumbling_spheres() {
    return {.suite = "pairs",
            .name = "drum",
            .ground = Ground::cavity,
            .triangles = 20'000,
            .particles = 3000,
            .time_step = 2e-3,
            .restitution = 0.5,
            .friction = 0.5,
            .gravity = 9.81,
            .start = Start::lattice,
            .box = kAroundCavity,
            .speed = 0.1,
            .warm_up = 500,
            .steps = 500,
            .least_radius = 0.03,
            .largest_radius = 0.04,
            .spheres_meet = true,
            .density = 2500.0,
            .pitch = 0.085,
            .moves = Moves::tumbling};
}

Cases pair_cases() {
    Cases cases;
    append(cases, apart_and_together_cases(dilute_spheres(), "dilute-apart", "dilute"));
    append(cases, apart_and_together_cases(filling_spheres(10'000), "filling-apart", "filling"));
    Case pile = with_steps(filling_spheres(2000), 2500, 1000);
    pile.name = "pile";
    pile.spheres_meet = true;
    append(cases, {pile, tumbling_spheres()});
    return cases;
}

Cases make_all_cases() {
    Cases cases = {
        gas("gas", "gas-20k", 20'000, 1'000'000, kGasStep),
        gas("gas", "gas-1300k", 1'300'000, 1'000'000, kGasStepOnFineMesh),
        settle("settle", "settle", 1'300'000, 1'000'000),
        hail("hail", "hail", 1'300'000, 1'000'000),
        rain("rain", "rain", 1'300'000, 1'000'000),
        pinball("pinball", "pinball", 1'300'000, 1'000'000),
        wedge("wedge", "wedge", 20'000, 20'000),
    };
    append(cases, size_cases());
    append(cases, count_cases());
    // Cases with expensive steps have fewer particles, because they also run with one thread.
    append(cases, {gas("threads", "gas", 1'300'000, 1'000'000, kGasStepOnFineMesh),
                   settle("threads", "settle", 1'300'000, 200'000), pinball("threads", "pinball", 1'300'000, 200'000)});
    append(cases, radius_cases());
    append(cases, response_cases());
    append(cases, moving_cases());
    append(cases, pair_cases());
    append(cases, {gas("quick", "gas", 20'000, 100'000, kGasStep), hail("quick", "hail", 50'000, 50'000),
                   pinball("quick", "pinball", 20'000, 20'000)});
    return cases;
}

}  // namespace

const std::vector<Case>& all_cases() {
    static const std::vector<Case> cases = make_all_cases();
    return cases;
}

std::vector<Case> cases_of(std::string_view suite) {
    std::vector<Case> cases;
    std::copy_if(all_cases().begin(), all_cases().end(), std::back_inserter(cases),
                 [&](const Case& c) { return c.suite == suite; });
    return cases;
}

std::vector<std::vector<Case>> groups_of(std::string_view suite) {
    std::vector<std::vector<Case>> groups;
    for (const Case& c : cases_of(suite)) {
        if (groups.empty() || c.base.empty() || groups.back().front().base != c.base) groups.emplace_back();
        groups.back().push_back(c);
    }
    return groups;
}

std::vector<std::string> suite_names() {
    std::vector<std::string> names;
    for (const Case& c : all_cases()) {
        if (names.empty() || names.back() != c.suite) names.emplace_back(c.suite);
    }
    names.emplace_back(kLoadSuite);
    return names;
}

void require_suite(std::string_view suite) {
    const std::vector<std::string> names = suite_names();
    if (std::find(names.begin(), names.end(), suite) != names.end()) return;
    throw InputError(fmt::format("--suite {}: there is no such suite; there are {}", suite, fmt::join(names, ", ")));
}

std::vector<int> default_threads(std::string_view suite, int hardware) {
    if (suite != kThreadsSuite) return {0};
    std::vector<int> counts;
    for (int threads = 1; threads < hardware; threads *= 2) counts.push_back(threads);
    counts.push_back(hardware);
    return counts;
}

}  // namespace ricochet::bench
