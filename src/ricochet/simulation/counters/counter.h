/// \file
/// Counters: surfaces that count the particles that pass through them, and do not affect the motion.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "ricochet/core/running_mean.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

// Shapes of counters. The normal of a flat shape points to its front side, and the points of the shape belong to the
// front side. A centre that moves forward has therefore passed when it is exactly on the shape.

/// A disk. Passages along the normal are forward.
struct DiskCounter {
    Vec3 center;           ///< m
    Vec3 normal{0, 0, 1};  ///< of any length above 0
    double radius = 1.0;   ///< m, above 0; the rim belongs to the disk
};

/// An infinite plane. Passages along the normal are forward.
struct PlaneCounter {
    Vec3 center;           ///< a point on the plane, m
    Vec3 normal{0, 0, 1};  ///< of any length above 0
};

/// A rectangle. Passages along the normal are forward.
struct RectangleCounter {
    Vec3 center;                       ///< m
    Vec3 normal{0, 0, 1};              ///< of any length above 0
    Vec3 along{1, 0, 0};               ///< direction of the first side; its part along the normal is ignored
    std::array<double, 2> size{1, 1};  ///< lengths of the sides along `along` and across it, m, above 0
};

/// Returns true if the two directions of a rectangle are not parallel.
[[nodiscard]] bool has_two_sides(const RectangleCounter& rectangle);

/// A box whose edges are parallel to the axes. Entering is forward, leaving is backward. The faces at the lower ends
/// belong to the box, the others do not.
struct BoxCounter {
    Vec3 center;         ///< m
    Vec3 size{1, 1, 1};  ///< full edge lengths, m, above 0
};

/// A triangle mesh, open or closed. Passages from the front side, to which the normals point, are forward. Particles
/// that enter a closed mesh with outward normals thus pass forward.
struct MeshCounter {
    std::shared_ptr<const TriangleMesh> mesh;  ///< in world coordinates
};

using CounterShape = std::variant<DiskCounter, PlaneCounter, RectangleCounter, BoxCounter, MeshCounter>;

/// Property of a passage.
enum class PassageQuantity : std::uint8_t {
    speed,   ///< m/s
    angle,   ///< between the velocity and the direction of the passage along the normal, degrees, 0..90
    radius,  ///< of the particle, m
    spin,    ///< angular speed of the particle, rad/s
    energy,  ///< kinetic energy of translation and spin, J
    time,    ///< of the passage, s
};
[[nodiscard]] const char* name_of(PassageQuantity quantity);

/// Histogram of a property of passages. The bins have equal widths, and each bin has its lower end.
struct HistogramDescription {
    PassageQuantity quantity = PassageQuantity::speed;
    std::array<double, 2> range{0, 1};  ///< lower and upper end, in the unit of the quantity; the lower one is smaller
    std::uint32_t bins = 20;            ///< 1..kMostHistogramBins
};

/// Largest number of bins of a histogram. Local: a limit of input values.
inline constexpr std::uint32_t kMostHistogramBins = 100000;

/// A surface at rest that counts the particles whose centres pass through it.
struct CounterDescription {
    std::string name;  ///< not empty, and different from the names of other counters
    CounterShape shape;
    std::vector<HistogramDescription> histograms = {};
};

/// Passages of a counter in one direction, in addition to their number and mass.
struct PassageStatistics {
    Vec3 momentum;                ///< sum of the momenta, kg m/s
    double kinetic_energy = 0.0;  ///< sum of the kinetic energies of translation, J
    double spin_energy = 0.0;     ///< sum of the kinetic energies of spin, J
    RunningMean speed;            ///< m/s
    RunningMean angle;            ///< see PassageQuantity::angle, degrees
    RunningMean radius;           ///< m
    RunningMean spin;             ///< angular speed, rad/s
    double first_time = 0.0;      ///< of the first passage, s; 0 without a passage
    double last_time = 0.0;       ///< of the last passage, s; 0 without a passage
};

/// Numbers of passages by direction and bin.
struct PassageHistogram {
    HistogramDescription description;
    std::vector<std::uint64_t> forward;   ///< one entry for each bin
    std::vector<std::uint64_t> backward;  ///< one entry for each bin
    std::uint64_t forward_outside = 0;    ///< forward passages outside the range
    std::uint64_t backward_outside = 0;   ///< backward passages outside the range

    /// Returns the lower end of a bin, or the upper end of the range for the number of bins.
    [[nodiscard]] double edge(std::size_t bin) const;
};

/// Passages of one counter since the start of the run. A particle that passes several times counts each time.
struct CounterTotals {
    std::string name;
    std::uint64_t forward = 0;   ///< passages along the normal, or into a box
    std::uint64_t backward = 0;  ///< passages against the normal, or out of a box
    double forward_mass = 0.0;   ///< kg, sum of the masses of the forward passages
    double backward_mass = 0.0;  ///< kg
    PassageStatistics forward_statistics;
    PassageStatistics backward_statistics;
    std::uint64_t particles = 0;  ///< particles ever created in the run, children included
    /// Times from birth to the first forward passage of each particle, s. The count is the number of particles that
    /// have passed forward at least once.
    RunningMean first_passage;
    bool encloses = false;  ///< true for a box and for a closed mesh
    RunningMean residence;  ///< times between entering and leaving, s; only if the counter encloses a volume
    std::vector<PassageHistogram> histograms;

    /// Returns the share of the particles that have passed forward at least once; 0 without particles.
    [[nodiscard]] double transmission() const;
    /// Returns the standard error of transmission() for independent particles (binomial distribution).
    [[nodiscard]] double transmission_error() const;
};

}  // namespace ricochet
