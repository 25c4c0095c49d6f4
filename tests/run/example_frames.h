// Small frames that several tests write and read.
#pragma once

#include <cstdint>

#include "ricochet/core/random.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/io/vtk.h"
#include "ricochet/simulation.h"
#include "run/frame_writer.h"
#include "support/random_draws.h"

namespace ricochet::test {

/// Returns particles with distinct attributes. Their entries are not sorted by id.
inline Particles example_particles(std::uint64_t count) {
    Particles particles;
    RandomSequence random(11, 0, 0);
    for (std::uint64_t i = 0; i < count; ++i) {
        Particle particle;
        particle.id = (std::uint64_t{1} << 40) + count - i;
        particle.position = 3.0 * random.unit_vector();
        particle.velocity = testing::scaled({random.unit_vector(), random.uniform()});
        particle.mass = 1.0 + random.uniform();
        particle.radius = 0.01 * random.uniform();
        particle.birth_time = -random.uniform();
        particles.append(particle);
        particles.contacts.back() = static_cast<std::uint32_t>(i);
        particles.resting.back() = static_cast<std::uint8_t>(i % 2);
        particles.unsimulated_time.back() = 0.001 * static_cast<double>(i);
    }
    return particles;
}

/// Returns rows of the contact log with increasing times.
inline ContactColumns example_contacts(std::size_t rows) {
    ContactColumns columns;
    columns.resize(rows);
    RandomSequence random(12, 0, 0);
    for (std::size_t i = 0; i < rows; ++i) {
        columns.point[i] = random.unit_vector();
        columns.time[i] = 0.01 * static_cast<double>(i);
        columns.particle[i] = (std::int64_t{1} << 40) - static_cast<std::int64_t>(i);
        columns.collider[i] = static_cast<std::uint32_t>(i % 3);
        columns.triangle[i] = static_cast<std::int64_t>(i) - 1;
        columns.barycentric[i] = {0.25, 0.5, 0.25};
        columns.normal[i] = random.unit_vector();
        columns.velocity_before[i] = random.unit_vector();
        columns.velocity_after[i] = random.unit_vector();
        columns.impulse[i] = columns.velocity_before[i] - columns.velocity_after[i];
        columns.radius[i] = 0.01 * random.uniform();
    }
    return columns;
}

/// Returns a tetrahedron.
inline TriangleMesh example_mesh() {
    return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

inline TriangleTotals example_totals() {
    return {{0, 1, 7, std::uint64_t{1} << 33}, {{0, 0, 0}, {1, 2, 3}, {-1, 0.5, 0}, {0, 0, 1e-300}}};
}

}  // namespace ricochet::test
