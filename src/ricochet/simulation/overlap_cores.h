/// \file
/// Private to the simulation: as what spheres that were born in overlap collide.
///
/// A sphere in overlap collides as its core: the largest ball about its centre that overlaps nothing. So the deepest of
/// its overlaps never deepens, contact is ordinary contact of a ball that overlaps nothing, and nothing pushes it out.
/// The core grows with the distance to the surfaces while the sphere touches none, never beyond the sphere, and never
/// shrinks; a sphere that is free is itself for good. Energies are the sphere's: its contacts act at its own surface,
/// so a core of part c of the radius turns 1 / c times as fast, with the same speed there and the same energy.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ricochet/core/algorithms.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// The cores by particle; takes no memory until one is set. Different particles may be changed from several threads,
/// except by the first set().
class OverlapCores {
public:
    /// True when particle i is in overlap.
    [[nodiscard]] bool has(std::size_t i) const { return !cores_.empty() && cores_[i] >= 0.0; }
    /// m, only when has(i); 0: it collides as a point.
    [[nodiscard]] double radius(std::size_t i) const { return cores_[i]; }
    /// count: of the particles.
    void set(std::size_t i, double core, std::size_t count) {
        if (cores_.empty()) cores_.assign(count, kNone);
        cores_[i] = core;
    }
    /// It is in overlap no more.
    void release(std::size_t i) { cores_[i] = kNone; }

    /// For one more particle, which is in no overlap.
    void append() {
        if (!cores_.empty()) cores_.push_back(kNone);
    }
    /// Keeps what Particles::compact() keeps.
    void compact(const std::vector<std::uint8_t>& keep) { keep_marked(cores_, keep); }
    /// Saves or restores all; a: an archive of core/binary_archive.h, count: of the particles.
    template <class Archive>
    void archive(Archive& a, std::size_t count) {
        a.all_or_none(cores_, count, kNone);
    }

    /// Spin of the core of a sphere, rad/s.
    [[nodiscard]] static Vec3 spin_of_core(const Vec3& spin, double core, double radius) {
        return core > 0.0 ? (radius / core) * spin : Vec3{};
    }

private:
    // Local: a mark, not a radius.
    static constexpr double kNone = -1.0;

    std::vector<double> cores_;  // m
};

}  // namespace ricochet
