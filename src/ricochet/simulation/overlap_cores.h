/// \file
/// Private to the simulation: cores of spheres that are born in overlap.
///
/// In collisions, a core replaces a sphere that overlaps surfaces. The core is the largest ball about the sphere's
/// centre that overlaps no surface. Therefore the deepest overlap of the sphere never becomes deeper, and contacts are
/// ordinary contacts of a ball without overlap. No force pushes the sphere out of the overlap. While the sphere touches
/// no surface, its core grows with the distance to the surfaces, up to the sphere's radius. A core never shrinks. A
/// sphere that has left its overlap has no core any more. Energies belong to the sphere, because contacts act at the
/// sphere's surface. A core whose radius is the fraction c of the sphere's radius spins 1 / c times as fast. The
/// surface speed and the energy of the core then equal the values of the sphere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ricochet/core/algorithms.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Cores by particle. The object uses no memory until the first set(). Several threads may change cores of different
/// particles, except by this first call.
class OverlapCores {
public:
    /// Returns true if particle i is in overlap.
    [[nodiscard]] bool has(std::size_t i) const { return !cores_.empty() && cores_[i] >= 0.0; }
    /// Returns the radius of the core, in m. has(i) must be true. A sphere with a core of radius 0 collides as a point.
    [[nodiscard]] double radius(std::size_t i) const { return cores_[i]; }
    /// Sets the radius of a core, in m. count: number of particles.
    void set(std::size_t i, double core, std::size_t count) {
        if (cores_.empty()) cores_.assign(count, kNone);
        cores_[i] = core;
    }
    /// Removes the core of a sphere that is no longer in overlap.
    void release(std::size_t i) { cores_[i] = kNone; }

    /// Adds an entry for a particle without overlap.
    void append() {
        if (!cores_.empty()) cores_.push_back(kNone);
    }
    /// Keeps the entries that Particles::compact() keeps.
    void compact(const std::vector<std::uint8_t>& keep) { keep_marked(cores_, keep); }
    /// Saves or restores all cores; a: an archive of core/binary_archive.h, count: number of particles.
    template <class Archive>
    void archive(Archive& a, std::size_t count) {
        a.all_or_none(cores_, count, kNone);
    }

    /// Returns the spin of the core of a sphere, in rad/s.
    [[nodiscard]] static Vec3 spin_of_core(const Vec3& spin, double core, double radius) {
        return core > 0.0 ? (radius / core) * spin : Vec3{};
    }

private:
    // Local: this value marks particles without a core, and is not a radius.
    static constexpr double kNone = -1.0;

    std::vector<double> cores_;  // m
};

}  // namespace ricochet
