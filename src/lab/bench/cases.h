/// \file
/// Table of benchmark cases: their mesh, particles and time step. The program and the tests use the same table.
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
    cavity,      ///< closed, rocky, about the origin, mean radius 1 m; particles inside
    bowl,        ///< half a hollow sphere of 1 m, open at the top
    rough_bowl,  ///< the lower half of the cavity, open at the top
    terrain,     ///< open sheet of 120 m by 90 m
    wedge,       ///< closed, two planes of 1 m that meet at a hundredth of a radian; particles inside
    bin,         ///< a square tray of 0.2 m with walls of 0.8 m, open at the top
    rocks,       ///< rocks of half a metre and a thousand triangles each on a lattice of 2 m, one collider each
};

/// Motion of colliders during the measured steps.
enum class Moves {
    nothing,
    shaken,     ///< the ground oscillates by a decimetre in 5 s
    spinning,   ///< the ground rotates by a degree per step; rocks rotate about themselves
    tumbling,   ///< the ground rotates about x by a twentieth of a degree per step
    bystander,  ///< a rock far from the ground and all particles rotates by a degree per step
    /// The ground deforms. Every vertex oscillates by a twentieth of its distance from the origin in 40 steps, with a
    /// key at every fourth.
    breathing,
};

/// Starting positions of particles.
enum class Start {
    box,     ///< anywhere in the box
    inside,  ///< anywhere in the box and inside the closed ground
    /// Positions of a cubic lattice in the box, from below; in a closed ground, those inside it. Each particle is
    /// displaced at random, so far that a gap remains between the largest spheres.
    lattice,
    above_terrain,  ///< anywhere above the box's base; z of the box is relative to the ground
};

/// Base of a case's cost: another case of its suite on the same mesh, measured alternately with it.
enum class Against {
    nothing,
    points,   ///< the same particles without size
    exact,    ///< the same particles with the exact response
    at_rest,  ///< the same particles without motion of colliders
    apart,    ///< the same spheres without contacts between them
};

/// One benchmark case. Particles start at random positions with random directions, so their order in memory is
/// arbitrary.
struct Case {
    std::string_view suite = {};
    std::string_view name = {};  ///< unique in its suite
    Ground ground = Ground::cavity;
    std::size_t triangles = 0;  ///< requested number; the mesh comes near it
    std::size_t particles = 0;
    double time_step = 0.0;  ///< in s
    double restitution = 1.0;
    double friction = 0.0;
    double gravity = 0.0;  ///< in m/s^2, downward
    Start start = Start::box;
    Box3 box = {};              ///< box of starting positions, in m
    Vec3 drift = {};            ///< mean velocity, in m/s
    double speed = 0.0;         ///< in m/s, added to the drift in a random direction
    double spread = 0.0;        ///< in m/s, largest deviation from the speed, up and down
    std::uint64_t warm_up = 0;  ///< steps before the measured ones
    std::uint64_t steps = 1;    ///< measured steps
    ResponseKind response = ResponseKind::exact;
    double least_radius = 0.0;  ///< in m; logarithms of radii are uniform between the least and the largest
    double largest_radius = 0.0;
    bool spheres_meet = false;  ///< spheres collide with each other, with the case's restitution and friction
    double density = 0.0;       ///< in kg/m^3, of spheres; 0: every particle has 1 kg
    double pitch = 0.0;         ///< of a lattice, in m
    Moves moves = Moves::nothing;
    bool looks_ahead = true;  ///< true: particles that certainly hit nothing are not queried
    Against against = Against::nothing;
    std::string_view base = {};  ///< name of the base case of the cost, if any; the base names itself
};

/// Returns all cases, suite by suite.
[[nodiscard]] const std::vector<Case>& all_cases();

/// Returns the cases of a suite; an empty list for an unknown suite.
[[nodiscard]] std::vector<Case> cases_of(std::string_view suite);

/// Returns the cases of a suite in groups that are measured alternately. A group contains the cases of one base, which
/// comes first, or a single case.
[[nodiscard]] std::vector<std::vector<Case>> groups_of(std::string_view suite);

// The benchmark's suites by name.

/// The suite whose cases are files, see load.h. The cases of all other suites are in cases.h.
inline constexpr std::string_view kLoadSuite = "load";

/// The suite that is measured with several numbers of threads by default.
inline constexpr std::string_view kThreadsSuite = "threads";

/// Returns all suites in the order in which they are listed.
[[nodiscard]] std::vector<std::string> suite_names();

/// Throws InputError with a list of the suites if there is none of this name.
void require_suite(std::string_view suite);

/// Returns the default numbers of threads of a suite: {0} (all threads), or 1, 2, 4 and so on, with the number of all
/// threads at the end.
/// \param hardware  threads of the machine, >= 1
[[nodiscard]] std::vector<int> default_threads(std::string_view suite, int hardware);

}  // namespace ricochet::bench
