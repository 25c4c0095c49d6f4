/// \file
/// The benchmark's table of cases: which mesh, which particles, which time step. The same table serves the program and
/// the tests.
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

/// What particles run into.
enum class Ground {
    cavity,      ///< closed, rocky, about the origin, mean radius 1 m; particles inside
    bowl,        ///< half a hollow sphere of 1 m, open at the top
    rough_bowl,  ///< the lower half of the cavity, open at the top
    terrain,     ///< open sheet of 120 m by 90 m
    wedge,       ///< closed, two planes of 1 m that meet at a hundredth of a radian; particles inside
    bin,         ///< a square tray of 0.2 m with walls of 0.8 m, open at the top
    rocks,       ///< rocks of half a metre and a thousand triangles each on a lattice of 2 m, a collider each
};

/// What moves in the time that is measured.
enum class Moves {
    nothing,
    shaken,     ///< the ground, to and fro by a decimetre in 5 s
    spinning,   ///< the ground by a degree a step; of rocks each about itself
    tumbling,   ///< the ground about x, by a twentieth of a degree a step
    bystander,  ///< a rock far from the ground and all particles, by a degree a step
    breathing,  ///< every vertex of the ground, which deforms: to and fro by a twentieth of its way from the origin in
                ///< 40 steps, with a key every fourth
};

/// Where particles start.
enum class Start {
    box,      ///< anywhere in the box
    inside,   ///< anywhere in the box that is inside the closed ground
    lattice,  ///< on the places of a cubic lattice in the box, from below, of a closed ground those inside it, each
              ///< beside its place by as much as leaves a gap between the largest spheres
    above_terrain,  ///< anywhere over the box's base; z of the box counts from the ground
};

/// What a case's cost is divided by: a case of its suite on the same mesh, measured in turns with it.
enum class Against {
    nothing,
    points,   ///< the same particles without size
    exact,    ///< the same particles with the exact response
    at_rest,  ///< the same particles where nothing moves
    apart,    ///< the same spheres that pass through each other
};

/// One case. Particles start at random positions with random directions, so their order in memory is arbitrary.
struct Case {
    std::string_view suite = {};
    std::string_view name = {};  ///< unique in its suite
    Ground ground = Ground::cavity;
    std::size_t triangles = 0;  ///< wanted; the mesh comes near it
    std::size_t particles = 0;
    double time_step = 0.0;  ///< s
    double restitution = 1.0;
    double friction = 0.0;
    double gravity = 0.0;  ///< m/s^2, downward
    Start start = Start::box;
    Box3 box = {};              ///< m, of starting positions
    Vec3 drift = {};            ///< m/s, mean velocity
    double speed = 0.0;         ///< m/s, added to the drift in a random direction
    double spread = 0.0;        ///< m/s, the speed varies by as much up and down
    std::uint64_t warm_up = 0;  ///< steps before what is measured
    std::uint64_t steps = 1;    ///< measured steps
    ResponseKind response = ResponseKind::exact;
    double least_radius = 0.0;  ///< m; the logarithms of the radii are spread evenly from the least to the largest
    double largest_radius = 0.0;
    bool spheres_meet = false;  ///< as the ground: with the case's restitution and friction
    double density = 0.0;       ///< kg/m^3, of spheres; 0: every particle has 1 kg
    double pitch = 0.0;         ///< m, of a lattice
    Moves moves = Moves::nothing;
    bool looks_ahead = true;  ///< particles that certainly hit nothing are not queried
    Against against = Against::nothing;
    std::string_view base = {};  ///< name of the case that the cost is divided by (its own for that one), if any
};

/// All cases, suite by suite.
[[nodiscard]] const std::vector<Case>& all_cases();

/// The cases of a suite; none when there is no such suite.
[[nodiscard]] std::vector<Case> cases_of(std::string_view suite);

/// The same in groups that are measured in turns: cases of the same base, which comes first, or one case alone.
[[nodiscard]] std::vector<std::vector<Case>> groups_of(std::string_view suite);

// The benchmark's suites by name.

/// The suite whose cases are files, see load.h; those of the others are in cases.h.
inline constexpr std::string_view kLoadSuite = "load";

/// The suite that is measured with several numbers of threads unless told otherwise.
inline constexpr std::string_view kThreadsSuite = "threads";

/// All suites in the order in which they are told.
[[nodiscard]] std::vector<std::string> suite_names();

/// Throws InputError that lists the suites when there is none of this name.
void require_suite(std::string_view suite);

/// The numbers of threads that a suite is measured with unless told otherwise: {0} (all), or 1, 2, 4 and so on up to
/// all of them, which come last.
/// \param hardware  threads that the machine has, >= 1
[[nodiscard]] std::vector<int> default_threads(std::string_view suite, int hardware);

}  // namespace ricochet::bench
