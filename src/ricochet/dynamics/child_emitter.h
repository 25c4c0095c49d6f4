/// \file
/// Particles born of particles: how many, when, and with what. Pure functions of the parent and its lineage, so that
/// births depend on neither threads nor time steps.
/// Method: the hierarchies of W. T. Reeves, "Particle Systems", ACM TOG 2(2), 1983, section 2.6; shares of mass and
/// momentum by conservation.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "ricochet/dynamics/emitter.h"

namespace ricochet {

/// A birth in a parent's life.
struct LifeBirth {
    double time = 0.0;          ///< s, simulation time
    std::uint32_t ordinal = 0;  ///< among the parent's children of this emitter
};

/// Births in an interval of a parent's life.
struct LifeBirths {
    std::vector<LifeBirth> first;  ///< in the order of time
    std::uint32_t more = 0;        ///< how many come after these
};

/// Births of a parent's life in [from, to), of which the first `most` are listed: child k is born at the age
/// (k + 1/2) / rate, with one draw of the rate for each parent, and not past the emitter's limit.
[[nodiscard]] LifeBirths births_in_life(const Emitter& emitter, const Particle& parent, double from, double to,
                                        std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

/// Children of one event. event: its number in the parent's life.
[[nodiscard]] std::uint32_t children_of_event(const Emitter& emitter, const Particle& parent, std::uint32_t event);

/// One child. parent: as it is at the birth. The child's position is the parent's, its velocity is its own launch plus
/// the inherited part; attributes that the emitter does not name are the parent's.
[[nodiscard]] Particle make_child(const Emitter& emitter, const Particle& parent, std::uint32_t ordinal, double time);

/// A child of a cloud.
struct CloudChild {
    Particle particle;
    Vec3 place;  ///< m, about the parent
};

/// One child of a cloud, at its place about the parent, with the velocity of that place besides its own launch. What
/// the test does not like is given another place, see Emitter::draw(); nothing where it refuses all.
[[nodiscard]] std::optional<CloudChild> make_cloud_child(const Emitter& emitter, const Particle& parent,
                                                         std::uint32_t ordinal, double time, const BirthTest& test);

/// Into how many fragments a mass, kg, can be shared out, so that none is below kSmallestMass; at least one.
[[nodiscard]] std::uint32_t most_fragments(double mass);

/// Children that share the parent's mass and momentum, all at its position. Masses are the parent's by the weights that
/// are drawn as masses; they add up to it exactly, in any order. Launches are taken relative to their common centre of
/// mass, so momenta add up to the parent's within rounding, and the kinetic energy grows by that of the launches seen
/// from there. A fragment's radius has the cube in the proportion of its mass. 1 <= count <= most_fragments() of the
/// parent's mass.
[[nodiscard]] std::vector<Particle> make_fragments(const Emitter& emitter, const Particle& parent, std::uint32_t count,
                                                   std::uint32_t first_ordinal, double time);

}  // namespace ricochet
