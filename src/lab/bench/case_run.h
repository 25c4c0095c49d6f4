/// \file
/// A benchmark case ready to run: its mesh, its particles, and its simulation at the start of the measured steps.
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

// Creation of a case's mesh, particles and simulation.

/// Returns a point from which every point inside the ground is visible in a straight line; nothing if the ground has no
/// inside.
[[nodiscard]] std::optional<Vec3> heart_of(Ground ground);

/// Creates the case's mesh, with about as many triangles as the case requests.
[[nodiscard]] std::shared_ptr<const TriangleMesh> make_mesh(const Case& c);

/// Creates the case's particles on its mesh. Particles inside keep a distance of at least their radius from it. The
/// result does not depend on the machine or its threads.
[[nodiscard]] std::vector<Particle> make_particles(const Case& c, const TriangleMesh& mesh);

/// Creates a setup without particles: the case's response, ballistic steps, and the case's number of steps.
[[nodiscard]] SimulationSetup make_setup(const Case& c, const std::shared_ptr<const TriangleMesh>& mesh);

// Inside tests for a closed mesh that has a heart: a point that sees its whole inside in straight lines.

/// The inside of one mesh. Safe from any number of threads.
class Insides {
public:
    /// The mesh must be closed and star-shaped about the heart. It must outlive this object.
    Insides(const TriangleMesh& mesh, const Vec3& heart);

    /// Returns true if the straight line from the heart to p hits no triangle. The decision is exact.
    [[nodiscard]] bool contains(const Vec3& p) const;
    /// Returns true if a ball's centre is inside and at least the radius (in m, >= 0) away from every triangle, to
    /// rounding.
    [[nodiscard]] bool contains_ball(const Vec3& middle, double radius) const;

private:
    const TriangleMesh& mesh_;
    Vec3 heart_;
    TriangleBvh bvh_;
};

/// Returns the bytes that the process has allocated and not freed; 0 if the allocator does not report them.
[[nodiscard]] std::uint64_t allocated_bytes();

/// Returns freed memory to the system, so that memory of one case is not counted again in the next.
void return_freed_memory();

/// Memory of a case's simulation after a step.
struct MemoryUse {
    /// Includes data that the step keeps for the next one. Memory that Embree maps by itself for the search structures
    /// of spheres is not included.
    double bytes_per_particle = 0.0;
    double bytes_per_triangle = 0.0;  ///< includes the mesh and its search structures, without totals per triangle
};

/// Builds the case's simulation with and without its particles and measures its allocations.
[[nodiscard]] MemoryUse measure_memory(const Case& c, const std::shared_ptr<const TriangleMesh>& mesh,
                                       const std::vector<Particle>& particles);

// One case, advanced to the start of its measured steps, which can be timed repeatedly.

/// Times of the measured steps and of the references, in s, one entry per repeat.
struct CaseTimes {
    std::vector<double> simulation;
    std::vector<double> raw;
    std::vector<double> sorted;
    std::vector<double> bounces;
    std::vector<double> naive;  ///< of the measured steps with NaiveMotion; empty if nothing moves
};

/// Function called before every piece of work. `step` counts from 1; it is 0 if the work has no steps. If it returns
/// false, the measurement ends.
using Announce = std::function<bool(std::string_view doing, std::uint64_t step)>;

/// Approximate number of flights for the references. They get the states of as many evenly spaced steps as this takes,
/// at least one. Fewer: the references of small cases would be too short to be timed. More: the states of large cases
/// would not fit into memory.
inline constexpr std::uint64_t kReferenceFlights = 4'000'000;

/// Results of the measured steps. They are the same in every repeat.
struct Course {
    std::uint64_t particle_steps = 0;
    std::uint64_t contacts = 0;
    std::uint64_t pair_impacts = 0;  ///< between spheres, resolved sequentially
    double largest_overlap = 0.0;    ///< of two spheres, over the smaller radius, from the start on
    std::uint64_t state_hash = 0;
};

/// A case with all data for its timing.
class CaseRun {
public:
    /// Creates the particles.
    CaseRun(const Case& c, std::shared_ptr<const TriangleMesh> mesh);

    /// Measures memory, runs all steps once and prepares the references. Returns false if `announce` ends it.
    [[nodiscard]] bool prepare(const Announce& announce);

    /// Times the measured steps and then each reference, with the present number of threads. Returns false if
    /// `announce` ends it; the times are then useless. Throws RunError if the steps end in another state than in
    /// prepare().
    [[nodiscard]] bool time(CaseTimes& times, const Announce& announce);

    [[nodiscard]] const Case& description() const { return case_; }
    [[nodiscard]] std::size_t particles() const { return particles_.size(); }
    [[nodiscard]] std::size_t triangles() const { return mesh_->triangles.size(); }
    [[nodiscard]] const MemoryUse& memory() const { return memory_; }
    [[nodiscard]] const Course& course() const { return course_; }
    /// Requires prepare().
    [[nodiscard]] const Reference& reference() const { return *reference_; }
    /// Returns the number of particles that NaiveMotion has moved outside a closed moving ground; nothing for other
    /// cases.
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
    std::optional<NaiveMotion> naive_;  ///< set if something moves
    std::vector<Flight> naive_start_;
    std::optional<std::uint64_t> naive_leaks_;
};

}  // namespace ricochet::bench
