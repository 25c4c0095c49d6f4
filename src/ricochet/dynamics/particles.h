/// \file
/// Particles as a structure of arrays, and the named attributes that users add to them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// One column.
struct AttributeDescription {
    std::string name;    ///< not empty, not one of the particles' own arrays (is_own_array())
    int components = 1;  ///< 1, or 3 for a vector
    Vec3 fallback;       ///< what particles have that nobody gives another value; of one component: x
};

/// What a particle carries in one column; of one component: x. Not finite: not given.
using AttributeValue = Vec3;

/// The mark for a value that is not given.
[[nodiscard]] AttributeValue missing_attribute();
[[nodiscard]] inline bool is_missing(const AttributeValue& value) { return value.x != value.x; }

/// Names of the columns of appearance. They may be declared only with the components and fallbacks that
/// looks_attribute() gives; a scene declares them by using them.
inline constexpr std::string_view kColorAttribute = "color";      ///< red, green, blue, 0..1, as linear light
inline constexpr std::string_view kOpacityAttribute = "opacity";  ///< 0 (not seen) to 1
inline constexpr std::string_view kSizeAttribute = "size";        ///< radius that is drawn, m; default the radius
/// The column of that name; nothing when it is not one of appearance.
[[nodiscard]] std::optional<AttributeDescription> looks_attribute(std::string_view name);

/// True for the names of the arrays and columns that every run writes of itself.
[[nodiscard]] bool is_own_array(std::string_view name);

/// Columns of values, one entry a particle in each. Numbers past the end and lists of another length are InputErrors.
class AttributeTable {
public:
    AttributeTable() = default;
    /// Throws InputError for a name that is empty, taken twice or one of the particles' own, for components other than
    /// 1 and 3, and for a fallback that is not finite.
    explicit AttributeTable(std::vector<AttributeDescription> columns);

    [[nodiscard]] std::span<const AttributeDescription> columns() const { return columns_; }
    /// True without columns.
    [[nodiscard]] bool empty() const { return columns_.empty(); }
    /// Entries in each column; 0 without columns.
    [[nodiscard]] std::size_t size() const;
    /// Number of the column of that name.
    [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;

    /// Appends a particle: one value a column; where there are fewer values, or one is missing, the fallback.
    void append(std::span<const AttributeValue> values);
    /// Makes room for `more` particles.
    void reserve(std::size_t more);
    /// Keeps the entries whose flag is not 0, in their order.
    void compact(const std::vector<std::uint8_t>& keep);
    /// Forgets all entries, keeps the columns.
    void clear();

    [[nodiscard]] AttributeValue value(std::size_t column, std::size_t i) const;
    void set(std::size_t column, std::size_t i, const AttributeValue& value);
    /// All values of entry i; empty without columns.
    [[nodiscard]] std::vector<AttributeValue> at(std::size_t i) const;

    /// Saves or restores the values; a: what a simulation saves to or restores from.
    template <class Archive>
    void archive(Archive& a, std::size_t particles) {
        for (std::size_t k = 0; k < columns_.size(); ++k) {
            a(values_[k], particles * static_cast<std::size_t>(columns_[k].components));
        }
    }

private:
    std::vector<AttributeDescription> columns_;
    std::vector<std::vector<double>> values_;  // one list a column, components side by side
};

// The particles: a structure of arrays, one entry a living particle.

/// Instead of an emitter's number: none.
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

/// Instead of a surface number: none.
inline constexpr std::uint32_t kNoSupport = 0xFFFFFFFFU;

/// In Particles::absorbed: replaced by fragments.
inline constexpr std::uint8_t kShattered = 2;

/// Structure of arrays. All vectors have the same length; entry i of each is particle i. at() and compact() throw
/// InputError for numbers past the end and lists of another length.
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
    /// 1 when an impact has removed it, kShattered when its fragments replace it; gone after the step.
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
