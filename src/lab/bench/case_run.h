/// \file
/// A case made ready: its mesh, its particles, its simulation, run to where its measured steps begin.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "lab/bench/cases.h"
#include "lab/bench/naive_motion.h"
#include "lab/bench/reference.h"
#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/geometry/acceleration/triangle_bvh.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/simulation.h"

namespace ricochet::bench {

// From a case to its mesh, its particles and its simulation.

/// A point that sees every point inside the ground in a straight line; nothing where the ground has no inside.
[[nodiscard]] std::optional<Vec3> heart_of(Ground ground);

/// The case's mesh, with about as many triangles as it wants.
[[nodiscard]] std::shared_ptr<const TriangleMesh> make_mesh(const Case& c);

/// The case's particles on its mesh, those inside clear of it by their radius; the same every time, whatever the
/// machine and its threads.
[[nodiscard]] std::vector<Particle> make_particles(const Case& c, const TriangleMesh& mesh);

/// Everything for a simulation but the particles: the case's response, ballistic steps, as many as the case has.
[[nodiscard]] SimulationSetup make_setup(const Case& c, const std::shared_ptr<const TriangleMesh>& mesh);

// Which points are inside a closed mesh that has a heart: a point that sees its whole inside in straight lines.

/// The inside of one mesh. Safe from any number of threads.
class Insides {
public:
    /// The mesh must be closed, star-shaped about the heart, and outlive this.
    Insides(const TriangleMesh& mesh, const Vec3& heart);

    /// Exact: true when the straight line from the heart to p hits no triangle.
    [[nodiscard]] bool contains(const Vec3& p) const;
    /// The same for a ball's middle, which must be at least the radius (m, >= 0) away from every triangle, to rounding.
    [[nodiscard]] bool contains_ball(const Vec3& middle, double radius) const;

private:
    const TriangleMesh& mesh_;
    Vec3 heart_;
    TriangleBvh bvh_;
};

/// Bytes that the process has allocated and not freed; 0 where the allocator does not tell.
[[nodiscard]] std::uint64_t allocated_bytes();

/// Hands back to the system what has been freed, so that one case's memory is not there twice in the next.
void return_freed_memory();

/// What a case's simulation holds after a step.
struct MemoryUse {
    /// With what the step itself keeps for the next one; of the search structures for spheres only what the ray
    /// library does not map past the allocator.
    double bytes_per_particle = 0.0;
    double bytes_per_triangle = 0.0;  ///< with the mesh and its search structures, without totals per triangle
};

/// Builds the case's simulation with and without its particles and counts what it has allocated.
[[nodiscard]] MemoryUse measure_memory(const Case& c, const std::shared_ptr<const TriangleMesh>& mesh,
                                       const std::vector<Particle>& particles);

// One case, brought to where its measured steps begin, to be timed as often as wanted.

/// Times of the measured steps and of the references, s, one entry a repeat.
struct CaseTimes {
    std::vector<double> simulation;
    std::vector<double> raw;
    std::vector<double> sorted;
    std::vector<double> bounces;
    std::vector<double> naive;  ///< of the measured steps in the usual way; empty where nothing moves
};

/// Told before every piece of work; step counts from 1, 0 where the work has no steps. False ends the measurement.
using Announce = std::function<bool(std::string_view doing, std::uint64_t step)>;

/// The references get the states of evenly spaced steps: as many as give about so many flights, at least one. Fewer
/// would make the references of small cases too short to be timed, more would not fit into memory for large ones.
inline constexpr std::uint64_t kReferenceFlights = 4'000'000;

/// What the measured steps do: the same every time.
struct Course {
    std::uint64_t particle_steps = 0;
    std::uint64_t contacts = 0;
    std::uint64_t pair_impacts = 0;  ///< of spheres on each other that are worked off one after the other
    double largest_overlap = 0.0;    ///< of two spheres, over the smaller radius, from the start on
    std::uint64_t state_hash = 0;
};

/// A case and everything that timing it needs.
class CaseRun {
public:
    /// Makes the particles.
    CaseRun(const Case& c, std::shared_ptr<const TriangleMesh> mesh);

    /// Measures memory, goes through all steps once and prepares the references. False when told to end.
    [[nodiscard]] bool prepare(const Announce& announce);

    /// Times the measured steps and then each reference, with the threads that there are. False when told to end; the
    /// times are of no use then. Throws RunError when the steps end in another state than in prepare().
    [[nodiscard]] bool time(CaseTimes& times, const Announce& announce);

    [[nodiscard]] const Case& description() const { return case_; }
    [[nodiscard]] std::size_t particles() const { return particles_.size(); }
    [[nodiscard]] std::size_t triangles() const { return mesh_->triangles.size(); }
    [[nodiscard]] const MemoryUse& memory() const { return memory_; }
    [[nodiscard]] const Course& course() const { return course_; }
    /// After prepare().
    [[nodiscard]] const Reference& reference() const { return *reference_; }
    /// Particles that the usual way has brought outside a closed ground that moves; nothing for others.
    [[nodiscard]] std::optional<std::uint64_t> naive_leaks() const { return naive_leaks_; }

private:
    [[nodiscard]] Simulation make_simulation() const;
    [[nodiscard]] bool scout(const Announce& announce, std::vector<std::vector<Flight>>& states);
    [[nodiscard]] bool time_simulation(CaseTimes& times, const Announce& announce);
    [[nodiscard]] NaiveMotion::Steps naive_steps() const;
    [[nodiscard]] double end_of_steps() const;
    [[nodiscard]] std::uint64_t count_outside(const std::vector<Flight>& flights, const Vec3& heart) const;

    Case case_;
    std::shared_ptr<const TriangleMesh> mesh_;
    std::vector<Particle> particles_;
    std::vector<std::byte> start_;  ///< saved state before the last step of the warm-up
    MemoryUse memory_;
    Course course_;
    std::optional<Reference> reference_;
    std::optional<NaiveMotion> naive_;  ///< where something moves
    std::vector<Flight> naive_start_;
    std::optional<std::uint64_t> naive_leaks_;
};

}  // namespace ricochet::bench
