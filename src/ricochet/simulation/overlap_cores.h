/// \file
/// Private to the simulation: the cores with which spheres born in overlap collide.
///
/// A sphere in overlap collides as its core: the largest ball about its centre that overlaps nothing. So the deepest of
/// its overlaps never deepens, and contact is ordinary contact of a ball without overlap. Nothing pushes the sphere
/// out. While the sphere touches no surface, its core grows with the distance to the surfaces, but never beyond the
/// sphere. It never shrinks. A sphere that is free stays without a core. Energies belong to the sphere: its contacts
/// act at its own surface. A core whose radius is the fraction c of the sphere's radius spins 1 / c times as fast. The
/// speed of its surface and its energy equal those of the sphere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ricochet/core/algorithms.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Cores by particle. Takes no memory until one is set. Several threads may change different particles, except by the
/// first set().
class OverlapCores {
public:
    /// Returns true if particle i is in overlap.
    [[nodiscard]] bool has(std::size_t i) const { return !cores_.empty() && cores_[i] >= 0.0; }
    /// Returns the radius of the core, in m, if has(i). 0: the sphere collides as a point.
    [[nodiscard]] double radius(std::size_t i) const { return cores_[i]; }
    /// count: number of particles.
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
    // Local: a mark, not a radius.
    static constexpr double kNone = -1.0;

    std::vector<double> cores_;  // m
};

}  // namespace ricochet
