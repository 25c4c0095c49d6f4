/// \file
/// Table of benchmark cases. The program and the tests use the same table.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/vec3.h"
#include "ricochet/response/response.h"

namespace ricochet::bench {

/// Surface that particles hit.
enum class Ground {
    cavity,      ///< closed rocky cavity around the origin with a mean radius of 1 m; particles are inside
    bowl,        ///< hollow hemisphere with a radius of 1 m, open at the top
    rough_bowl,  ///< lower half of the cavity, open at the top
    terrain,     ///< open surface of 120 m by 90 m
    wedge,       ///< closed wedge of two planes of 1 m with an angle of 0.01 rad; particles are inside
    bin,         ///< square bin with edges of 0.2 m and a height of 0.8 m, open at the top
    /// Rocks with a radius of 0.5 m on a lattice with a pitch of 2 m; each is a collider of about 1000 triangles.
    rocks,
};

/// Motion of colliders during the measured steps.
enum class Moves {
    nothing,
    shaken,     ///< the ground oscillates with an amplitude of 0.1 m and a period of 5 s
    spinning,   ///< the ground rotates by 1 degree per step; each rock rotates about its centre
    tumbling,   ///< the ground rotates about the x-axis by 0.05 degrees per step
    bystander,  ///< a rock that is far from the ground and the particles rotates by 1 degree per step
    /// The ground deforms. The distance of each vertex from the origin oscillates by 5 % with a period of 40 steps.
    /// There is a keyframe at every fourth step.
    breathing,
};

/// Starting positions of particles.
enum class Start {
    box,     ///< at random in the box
    inside,  ///< at random in the box and inside the closed ground
    /// On a cubic lattice in the box, filled from below. In a closed ground, only lattice positions inside the ground
    /// are used. Each particle has a random offset, which is small enough to leave a gap between the largest spheres.
    lattice,
    above_terrain,  ///< at random in the box, whose z is relative to the height of the terrain
};

/// Base of a case's cost ratio. The base is another case of the same suite on the same mesh. Both cases are measured
/// alternately.
enum class Against {
    nothing,
    points,   ///< the same particles without size
    exact,    ///< the same particles with the exact response
    at_rest,  ///< the same particles without motion of colliders
    apart,    ///< the same spheres without contacts between spheres
};

/// Benchmark case. Particles start at random positions in random directions, so their order in memory is arbitrary.
struct Case {
    std::string_view suite = {};
    std::string_view name = {};  ///< unique in its suite
    Ground ground = Ground::cavity;
    std::size_t triangles = 0;  ///< requested number; the mesh has approximately this number
    std::size_t particles = 0;
    double time_step = 0.0;  ///< in s
    double restitution = 1.0;
    double friction = 0.0;
    double gravity = 0.0;  ///< in m/s^2, downward
    Start start = Start::box;
    Box3 box = {};              ///< box of starting positions, in m
    Vec3 drift = {};            ///< mean velocity, in m/s
    double speed = 0.0;         ///< in m/s, speed of a velocity in a random direction that is added to the drift
    double spread = 0.0;        ///< in m/s, largest random deviation from `speed`
    std::uint64_t warm_up = 0;  ///< number of steps before the measured steps
    std::uint64_t steps = 1;    ///< number of measured steps
    ResponseKind response = ResponseKind::exact;
    double least_radius = 0.0;  ///< in m; the logarithms of the radii are uniformly distributed between both limits
    double largest_radius = 0.0;
    bool spheres_meet = false;  ///< spheres collide with each other, with the case's restitution and friction
    double density = 0.0;       ///< in kg/m^3, density of spheres; 0: every particle has a mass of 1 kg
    double pitch = 0.0;         ///< distance of adjacent lattice positions, in m
    Moves moves = Moves::nothing;
    bool looks_ahead = true;  ///< true: look-ahead is on, so particles in free flight are not queried
    Against against = Against::nothing;
    std::string_view base = {};  ///< name of the base case, if any; the base case has its own name here
};

/// Returns all cases, suite by suite.
[[nodiscard]] const std::vector<Case>& all_cases();

/// Returns the cases of a suite; an empty list for an unknown suite.
[[nodiscard]] std::vector<Case> cases_of(std::string_view suite);

/// Returns the cases of a suite in groups. The cases of a group are measured alternately. A group has the cases with
/// the same base, starting with the base case, or a single case without a base.
[[nodiscard]] std::vector<std::vector<Case>> groups_of(std::string_view suite);

// Suites of the benchmark, by name.

/// Name of the suite whose cases are mesh files, see load.h. Cases of all other suites have the type Case.
inline constexpr std::string_view kLoadSuite = "load";

/// Name of the suite that is measured with several numbers of threads by default.
inline constexpr std::string_view kThreadsSuite = "threads";

/// Returns the names of all suites: in the order of all_cases(), then kLoadSuite.
[[nodiscard]] std::vector<std::string> suite_names();

/// Throws InputError with a list of all suites if no suite has this name.
void require_suite(std::string_view suite);

/// Returns the default numbers of threads of a suite: {0} (all threads), or for kThreadsSuite the powers of two below
/// `hardware`, followed by `hardware`.
/// \param hardware  number of threads of the machine, >= 1
[[nodiscard]] std::vector<int> default_threads(std::string_view suite, int hardware);

}  // namespace ricochet::bench
