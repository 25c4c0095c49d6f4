/// \file
/// The particles: a structure of arrays, one entry a living particle.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/attributes.h"

namespace ricochet {

/// In place of an emitter's number: none.
inline constexpr std::uint32_t kNoEmitter = 0xFFFFFFFFU;

/// Where a particle comes from.
struct Origin {
    std::uint32_t emitter = kNoEmitter;  ///< its emitter's number in the scene
    std::uint32_t generation = 0;        ///< 0; of particles born of particles one more than the parent's
    std::uint64_t lineage = 0;          ///< key of its children's random numbers; depends on neither ids nor time steps
    std::uint32_t birth_impacts = 0;    ///< impacts so far that have given birth
    std::uint32_t impact_children = 0;  ///< and the children born there
};

/// Everything that one particle carries, as a value: what emitters and scenes make and what forces see.
struct Particle {
    std::uint64_t id = 0;                                       ///< unique in a run, given in the order of creation
    Vec3 position;                                              ///< m
    Vec3 velocity;                                              ///< m/s
    double mass = 1.0;                                          ///< kg, > 0
    double radius = 0.0;                                        ///< m, >= 0; 0 is a point
    double birth_time = 0.0;                                    ///< s, simulation time
    double lifetime = std::numeric_limits<double>::infinity();  ///< s after birth at which it is retired
    Vec3 spin{};                                                ///< angular velocity, rad/s; spheres only
    bool pinned = false;                                        ///< it never moves: what springs hang on
    Origin origin{};
    std::vector<AttributeValue> attributes = {};  ///< one a column of Particles::attributes; fewer: fallbacks
};

/// In place of a surface number: none.
inline constexpr std::uint32_t kNoSupport = 0xFFFFFFFFU;

/// In Particles::absorbed: replaced by fragments.
inline constexpr std::uint8_t kShattered = 2;

/// Structure of arrays. All vectors have the same length; entry i of each is particle i.
class Particles {
public:
    std::vector<std::uint64_t> id;
    std::vector<Vec3> position;
    std::vector<Vec3> velocity;
    std::vector<Vec3> spin;  ///< angular velocity, rad/s; zero for points
    std::vector<double> mass;
    std::vector<double> radius;
    std::vector<double> birth_time;
    std::vector<double> lifetime;
    std::vector<double> unsimulated_time;  ///< s that the bounce budget cut off, summed over the particle's life
    std::vector<std::uint32_t> contacts;   ///< impacts so far (saturating)
    std::vector<std::uint8_t> frozen;      ///< 1 when the state left the range of the arithmetic: it no longer moves
    std::vector<std::uint8_t> resting;     ///< 1 while at rest on the surfaces in `support`
    std::vector<std::uint8_t> held;        ///< 1 while at rest because friction and support hold it
    /// 1 when an impact has removed it, kShattered when its fragments take its place; gone after the step.
    std::vector<std::uint8_t> absorbed;
    std::vector<std::uint32_t> draws;  ///< random numbers drawn by impacts so far
    /// Surfaces that it slides, rolls or rests on, filled up with kNoSupport.
    std::vector<std::array<std::uint32_t, 3>> support;
    std::vector<double> cascade_left;     ///< s of a bounce cascade that the end of the step has cut in two
    std::vector<std::uint8_t> pinned;     ///< 1 when it never moves
    std::vector<double> accounted_until;  ///< s, simulation time up to which surfaces have carried a sleeping particle
    AttributeTable attributes;            ///< set its columns before the first particle is appended
    std::vector<Origin> origin;           ///< empty unless keeps_origin
    bool keeps_origin = false;            ///< set before the first particle is appended

    [[nodiscard]] std::size_t size() const { return id.size(); }
    [[nodiscard]] bool empty() const { return id.empty(); }
    void append(const Particle& particle);
    /// Makes room for `more` entries in every array.
    void reserve(std::size_t more);
    /// Value of entry i.
    [[nodiscard]] Particle at(std::size_t i) const;
    /// Keeps the entries whose flag is not 0, in their order. keep.size() == size().
    void compact(const std::vector<std::uint8_t>& keep);
    /// Indices of the entries in the order of their ids.
    [[nodiscard]] std::vector<std::uint32_t> order_by_id() const;
};

}  // namespace ricochet
