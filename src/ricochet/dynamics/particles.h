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
#include <tuple>
#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Description of one attribute column.
struct AttributeDescription {
    std::string name;    ///< name of the column; not empty, and not a reserved name (is_own_array())
    int components = 1;  ///< number of components: 1, or 3 for a vector
    Vec3 fallback;       ///< value for particles without an explicit value; a scalar uses x
};

/// Value of a particle in one column. A scalar uses x. NaN in x marks a missing value.
using AttributeValue = Vec3;

/// Returns the marker of a missing value.
[[nodiscard]] AttributeValue missing_attribute();
[[nodiscard]] inline bool is_missing(const AttributeValue& value) { return value.x != value.x; }

/// Names of the columns of appearance. These columns may be declared only with the components and fallbacks of
/// looks_attribute(). A scene declares such a column when it uses the name.
inline constexpr std::string_view kColorAttribute = "color";      ///< red, green and blue in linear light, 0..1
inline constexpr std::string_view kOpacityAttribute = "opacity";  ///< opacity from 0 (invisible) to 1
inline constexpr std::string_view kSizeAttribute = "size";  ///< drawn radius, in m; default: the particle's radius
/// Returns the column of appearance with this name; nothing if there is no such column.
[[nodiscard]] std::optional<AttributeDescription> looks_attribute(std::string_view name);

/// Returns true for the names of the arrays and columns that every run writes.
[[nodiscard]] bool is_own_array(std::string_view name);

/// Columns of attribute values, with one entry per particle. Functions throw InputError for an index past the end and
/// for a list of the wrong length.
class AttributeTable {
public:
    AttributeTable() = default;
    /// Throws InputError if a name is empty, used twice or reserved. Also throws if a number of components is neither 1
    /// nor 3, or if a fallback is not finite.
    explicit AttributeTable(std::vector<AttributeDescription> columns);

    [[nodiscard]] std::span<const AttributeDescription> columns() const { return columns_; }
    /// Returns true if there are no columns.
    [[nodiscard]] bool empty() const { return columns_.empty(); }
    /// Returns the number of entries in each column; 0 without columns.
    [[nodiscard]] std::size_t size() const;
    /// Returns the index of the column with this name; nothing if there is none.
    [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;

    /// Appends a particle with one value per column. Missing values are replaced by the fallback.
    void append(std::span<const AttributeValue> values);
    /// Reserves memory for `more` particles.
    void reserve(std::size_t more);
    /// Keeps the entries whose flag is not 0, in their order.
    void compact(const std::vector<std::uint8_t>& keep);
    /// Removes all entries and keeps the columns.
    void clear();

    [[nodiscard]] AttributeValue value(std::size_t column, std::size_t i) const;
    void set(std::size_t column, std::size_t i, const AttributeValue& value);
    /// Returns all values of entry i; empty without columns.
    [[nodiscard]] std::vector<AttributeValue> at(std::size_t i) const;

    /// Saves or restores the values. a: archive of a simulation state. particles: number of entries.
    template <class Archive>
    void archive(Archive& a, std::size_t particles) {
        for (std::size_t k = 0; k < columns_.size(); ++k) {
            a(values_[k], particles * static_cast<std::size_t>(columns_[k].components));
        }
    }

private:
    std::vector<AttributeDescription> columns_;
    std::vector<std::vector<double>> values_;  // one list per column, with interleaved components
};

// The particles: a structure of arrays with one entry per living particle.

/// Emitter number of particles without an emitter.
inline constexpr std::uint32_t kNoEmitter = 0xFFFFFFFFU;

/// Origin of a particle.
struct Origin {
    std::uint32_t emitter = kNoEmitter;  ///< scene number of its emitter
    std::uint32_t generation = 0;        ///< the parent's generation plus one; 0 without a parent
    std::uint64_t lineage = 0;  ///< key of the random numbers for children; it depends on neither ids nor time steps
    std::uint32_t birth_impacts = 0;    ///< number of impacts so far that have spawned children
    std::uint32_t impact_children = 0;  ///< number of children spawned by these impacts
};

/// All data of one particle, as created by emitters and scenes.
struct Particle {
    std::uint64_t id = 0;     ///< unique number in a run, assigned in the order of creation
    Vec3 position;            ///< in m
    Vec3 velocity;            ///< in m/s
    double mass = 1.0;        ///< in kg, > 0
    double radius = 0.0;      ///< radius, in m, >= 0; 0 for a point
    double birth_time = 0.0;  ///< simulation time, in s
    double lifetime = std::numeric_limits<double>::infinity();  ///< age, in s, at which the particle is removed
    Vec3 spin{};                                                ///< angular velocity, in rad/s; spheres only
    bool pinned = false;  ///< true if the particle never moves, for example to attach springs
    Origin origin{};
    std::vector<AttributeValue> attributes = {};  ///< one per column of Particles::attributes; may be missing
};

/// Surface number for "none".
inline constexpr std::uint32_t kNoSupport = 0xFFFFFFFFU;

/// Value in Particles::absorbed for a particle that fragments replace.
inline constexpr std::uint8_t kShattered = 2;

/// Structure of arrays. All vectors have the same length, and entry i of each vector belongs to particle i. at() and
/// compact() throw InputError for an index past the end and for a list of the wrong length.
class Particles {
public:
    std::vector<std::uint64_t> id;
    std::vector<Vec3> position;
    std::vector<Vec3> velocity;
    std::vector<Vec3> spin;  ///< angular velocity, in rad/s; zero for points
    std::vector<double> mass;
    std::vector<double> radius;
    std::vector<double> birth_time;
    std::vector<double> lifetime;
    std::vector<double> unsimulated_time;  ///< time, in s, that the particle missed by exceeding its bounce budget
    std::vector<std::uint32_t> contacts;   ///< number of impacts so far (saturating)
    /// 1 if the state has left the range of the arithmetic, so the particle no longer moves.
    std::vector<std::uint8_t> frozen;
    std::vector<std::uint8_t> resting;  ///< 1 while the particle rests on the surfaces in `support`
    std::vector<std::uint8_t> held;     ///< 1 while friction and support keep the particle at rest
    /// 1 if a surface has absorbed the particle, kShattered if fragments replace it. The entry is removed after the
    /// step.
    std::vector<std::uint8_t> absorbed;
    std::vector<std::uint32_t> draws;  ///< number of random numbers drawn by impacts so far
    /// Surface numbers of the surfaces on which the particle slides, rolls or rests. Unused entries are kNoSupport.
    std::vector<std::array<std::uint32_t, 3>> support;
    std::vector<double> cascade_left;  ///< remaining time, in s, of a bounce cascade that continues in the next step
    std::vector<std::uint8_t> pinned;  ///< 1 if the particle never moves
    /// Simulation time, in s, up to which the loads of a sleeping particle on surfaces have been recorded.
    std::vector<double> accounted_until;
    AttributeTable attributes;   ///< attribute values; the columns must be set before the first particle is appended
    std::vector<Origin> origin;  ///< origins; empty if keeps_origin is false
    bool keeps_origin = false;   ///< true: origins are stored; must be set before the first particle is appended

    [[nodiscard]] std::size_t size() const { return id.size(); }
    [[nodiscard]] bool empty() const { return id.empty(); }
    void append(const Particle& particle);
    /// Reserves memory for `more` entries in every array.
    void reserve(std::size_t more);
    /// Returns the value of entry i.
    [[nodiscard]] Particle at(std::size_t i) const;
    /// Keeps the entries whose flag is not 0, in their order. keep.size() == size().
    void compact(const std::vector<std::uint8_t>& keep);
    /// Returns the indices of the entries in the order of their ids.
    [[nodiscard]] std::vector<std::uint32_t> order_by_id() const;

private:
    /// Returns all lists that have one entry per particle, except attributes and origins.
    [[nodiscard]] auto lists() {
        return std::tie(id, position, velocity, spin, mass, radius, birth_time, lifetime, unsimulated_time, contacts,
                        frozen, resting, held, absorbed, draws, support, cascade_left, pinned, accounted_until);
    }
};

}  // namespace ricochet
