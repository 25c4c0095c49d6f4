/// \file
/// Preparation and timing of a benchmark case: mesh, particles, simulation, memory and references.
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

/// Returns the kernel point of a closed ground: a point that is connected with every point inside by a straight line
/// inside. Returns std::nullopt if the ground is open.
[[nodiscard]] std::optional<Vec3> kernel_point_of(Ground ground);

/// Creates the case's mesh, with approximately Case::triangles triangles.
[[nodiscard]] std::shared_ptr<const TriangleMesh> make_mesh(const Case& c);

/// Creates the case's particles. Particles inside a closed ground are at least their radius away from the mesh. The
/// result does not depend on the machine or its number of threads.
[[nodiscard]] std::vector<Particle> make_particles(const Case& c, const TriangleMesh& mesh);

/// Creates the setup of the case's simulation without its particles.
[[nodiscard]] SimulationSetup make_setup(const Case& c, const std::shared_ptr<const TriangleMesh>& mesh);

// Inside tests for a closed mesh with a kernel point, see kernel_point_of().

/// Interior of one mesh. Safe from any number of threads.
class StarShapedInterior {
public:
    /// The mesh must be closed and star-shaped about the kernel point, and must outlive this object.
    StarShapedInterior(const TriangleMesh& mesh, const Vec3& kernel_point);

    /// Returns true if the segment from the kernel point to p hits no triangle. The decision is exact.
    [[nodiscard]] bool contains(const Vec3& p) const;
    /// Returns true if a ball's centre is inside, and if the distance from the centre to each triangle is at least the
    /// radius (in m, >= 0). Distances have rounding errors.
    [[nodiscard]] bool contains_ball(const Vec3& middle, double radius) const;

private:
    const TriangleMesh& mesh_;
    Vec3 kernel_point_;
    TriangleBvh bvh_;
};

/// Returns the bytes that the process has allocated and not freed; 0 if the allocator does not report them.
[[nodiscard]] std::uint64_t allocated_bytes();

/// Returns freed memory to the operating system. Otherwise the memory of one case would count again in the next case.
void return_freed_memory();

/// Memory of a case's simulation after a step.
struct MemoryUse {
    /// Includes data that a step stores for the next step. Does not include memory that Embree maps directly from the
    /// operating system for hierarchies of spheres.
    double bytes_per_particle = 0.0;
    double bytes_per_triangle = 0.0;  ///< includes the mesh and its hierarchies, but not the totals per triangle
};

/// Builds the case's simulation with and without its particles, and measures the allocated memory.
[[nodiscard]] MemoryUse measure_memory(const Case& c, const std::shared_ptr<const TriangleMesh>& mesh,
                                       const std::vector<Particle>& particles);

// Timing of one case. Each repeat starts from the same saved state.

/// Times of the measured steps and of the references, in s. Each list has one entry per repeat.
struct CaseTimes {
    std::vector<double> simulation;
    std::vector<double> raw;
    std::vector<double> sorted;
    std::vector<double> bounces;
    std::vector<double> naive;  ///< time of the same steps with NaiveMotion; empty if no collider moves
};

/// Function that is called before each task and at each step. `step` counts from 1, and is 0 if the task has no steps.
/// If the function returns false, the measurement ends.
using Announce = std::function<bool(std::string_view doing, std::uint64_t step)>;

/// Approximate number of flights that a reference processes. The flights come from the states before evenly spaced
/// steps, at least one step. With fewer flights, the references of small cases would be too short to be timed. With
/// more flights, the states of large cases would not fit into memory.
inline constexpr std::uint64_t kReferenceFlights = 4'000'000;

/// Results of the measured steps. They are the same in every repeat.
struct CaseResults {
    std::uint64_t particle_steps = 0;
    std::uint64_t contacts = 0;
    std::uint64_t pair_impacts = 0;  ///< impacts between spheres that are resolved sequentially
    double largest_overlap = 0.0;    ///< largest overlap of two spheres since the start, divided by the smaller radius
    std::uint64_t state_hash = 0;
};

/// Case with all data for its timing.
class CaseRun {
public:
    /// Creates the particles.
    CaseRun(const Case& c, std::shared_ptr<const TriangleMesh> mesh);

    /// Measures memory, runs all steps once and prepares the references. Returns false if `announce` returns false.
    [[nodiscard]] bool prepare(const Announce& announce);

    /// Times the measured steps and then each reference, with the current number of threads. Returns false if
    /// `announce` returns false; `times` is then incomplete. Throws RunError if the final state of the steps differs
    /// from the final state in prepare().
    [[nodiscard]] bool time(CaseTimes& times, const Announce& announce);

    [[nodiscard]] const Case& description() const { return case_; }
    [[nodiscard]] std::size_t particles() const { return particles_.size(); }
    [[nodiscard]] std::size_t triangles() const { return mesh_->triangles.size(); }
    [[nodiscard]] const MemoryUse& memory() const { return memory_; }
    [[nodiscard]] const CaseResults& results() const { return results_; }
    /// Requires prepare().
    [[nodiscard]] const Reference& reference() const { return *reference_; }
    /// Returns the number of particles that NaiveMotion moved outside a closed moving ground. Returns std::nullopt for
    /// other cases.
    [[nodiscard]] std::optional<std::uint64_t> naive_leaks() const { return naive_leaks_; }

private:
    [[nodiscard]] Simulation make_simulation() const;
    [[nodiscard]] bool run_once(const Announce& announce, std::vector<std::vector<Flight>>& states);
    [[nodiscard]] bool time_simulation(CaseTimes& times, const Announce& announce);
    [[nodiscard]] NaiveMotion::Steps naive_steps() const;
    [[nodiscard]] double end_of_steps() const;
    [[nodiscard]] std::uint64_t count_outside(const std::vector<Flight>& flights, const Vec3& kernel_point) const;

    Case case_;
    std::shared_ptr<const TriangleMesh> mesh_;
    std::vector<Particle> particles_;
    /// Saved state before the last step of the warm-up, or the initial state if there is no warm-up.
    std::vector<std::byte> start_;
    MemoryUse memory_;
    CaseResults results_;
    std::optional<Reference> reference_;
    std::optional<NaiveMotion> naive_;  ///< set if a collider moves
    std::vector<Flight> naive_start_;
    std::optional<std::uint64_t> naive_leaks_;
};

}  // namespace ricochet::bench
