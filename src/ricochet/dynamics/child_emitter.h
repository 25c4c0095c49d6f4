/// \file
/// Particles that are born from other particles: their number, birth times and initial states. All functions are pure
/// functions of the parent and its lineage, so births depend on neither threads nor time steps. Method: the hierarchies
/// of W. T. Reeves, "Particle Systems", ACM TOG 2(2), 1983, section 2.6.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "ricochet/dynamics/emitter.h"

namespace ricochet {

/// Birth during a parent's life.
struct LifeBirth {
    double time = 0.0;          ///< simulation time, in s
    std::uint32_t ordinal = 0;  ///< index among the parent's children of this emitter
};

/// Births in an interval of a parent's life.
struct LifeBirths {
    std::vector<LifeBirth> first;  ///< in order of time
    std::uint32_t more = 0;        ///< number of later births that are not listed
};

/// Returns the births in the interval [from, to) of a parent's life. At most `most` births are listed. Child k is born
/// at the parent's age (k + 1/2) / rate. The rate is drawn once per parent. The births end at the emitter's limit.
[[nodiscard]] LifeBirths births_in_life(const Emitter& emitter, const Particle& parent, double from, double to,
                                        std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

/// Returns the number of children of one event. event: index of the event in the parent's life.
[[nodiscard]] std::uint32_t children_of_event(const Emitter& emitter, const Particle& parent, std::uint32_t event);

/// Makes one child at the parent's position. parent: the parent's state at the birth. The child's velocity is its
/// launch velocity plus the inherited part of the parent's. It inherits the attributes that the emitter does not name.
[[nodiscard]] Particle make_child(const Emitter& emitter, const Particle& parent, std::uint32_t ordinal, double time);

/// Child of a cloud.
struct CloudChild {
    Particle particle;
    Vec3 offset;  ///< position relative to the parent, in m
};

/// Makes one child of a cloud at its target position, with the target's velocity plus its launch velocity. If the test
/// rejects the child, another position is drawn, see Emitter::draw(). Returns nothing if it rejects all positions.
[[nodiscard]] std::optional<CloudChild> make_cloud_child(const Emitter& emitter, const Particle& parent,
                                                         std::uint32_t ordinal, double time, const BirthTest& test);

/// Returns the largest number of fragments, at least 1, that each have at least kSmallestMass. mass: in total, in kg.
[[nodiscard]] std::uint32_t most_fragments(double mass);

/// Makes children that share the parent's mass and momentum, all at the parent's position. The drawn masses are weights
/// of the shares. The sum of the masses is exactly the parent's mass, in any order of summation. The launch velocities
/// are relative to the common centre of mass, so the sum of the momenta is the parent's within rounding. The cube of a
/// fragment's radius is proportional to its mass. 1 <= count <= most_fragments() of the parent's mass.
[[nodiscard]] std::vector<Particle> make_fragments(const Emitter& emitter, const Particle& parent, std::uint32_t count,
                                                   std::uint32_t first_ordinal, double time);

}  // namespace ricochet
