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
    std::string name;    ///< not empty, not one of the particles' own arrays (is_own_array())
    int components = 1;  ///< 1, or 3 for a vector
    Vec3 fallback;       ///< default for particles without another value; a scalar uses x
};

/// Value of a particle in one column; a scalar uses x. A non-finite x marks a missing value.
using AttributeValue = Vec3;

/// Returns the marker of a missing value.
[[nodiscard]] AttributeValue missing_attribute();
[[nodiscard]] inline bool is_missing(const AttributeValue& value) { return value.x != value.x; }

/// Names of the columns of appearance. They may be declared only with the components and fallbacks of
/// looks_attribute(). A scene declares them by using them.
inline constexpr std::string_view kColorAttribute = "color";      ///< red, green, blue, 0..1, as linear light
inline constexpr std::string_view kOpacityAttribute = "opacity";  ///< 0 (invisible) to 1
inline constexpr std::string_view kSizeAttribute = "size";  ///< drawn radius, in m; default: the particle's radius
/// Returns the column of that name; nothing if it is not a column of appearance.
[[nodiscard]] std::optional<AttributeDescription> looks_attribute(std::string_view name);

/// Returns true for the names of the arrays and columns that every run writes.
[[nodiscard]] bool is_own_array(std::string_view name);

/// Columns of values, with one entry per particle. Indices past the end and lists of another length cause an
/// InputError.
class AttributeTable {
public:
    AttributeTable() = default;
    /// Throws InputError for a name that is empty, taken twice or one of the particles' own, and for components other
    /// than 1 and 3. It also throws for a fallback that is not finite.
    explicit AttributeTable(std::vector<AttributeDescription> columns);

    [[nodiscard]] std::span<const AttributeDescription> columns() const { return columns_; }
    /// Returns true if there are no columns.
    [[nodiscard]] bool empty() const { return columns_.empty(); }
    /// Returns the number of entries in each column; 0 without columns.
    [[nodiscard]] std::size_t size() const;
    /// Returns the index of the column of that name.
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

    /// Saves or restores the values. a: the archive of a simulation state.
    template <class Archive>
    void archive(Archive& a, std::size_t particles) {
        for (std::size_t k = 0; k < columns_.size(); ++k) {
            a(values_[k], particles * static_cast<std::size_t>(columns_[k].components));
        }
    }

private:
    std::vector<AttributeDescription> columns_;
    std::vector<std::vector<double>> values_;  // one list per column, components interleaved
};

// The particles: a structure of arrays, one entry per living particle.

/// Emitter number of particles without an emitter.
inline constexpr std::uint32_t kNoEmitter = 0xFFFFFFFFU;

/// Origin of a particle.
struct Origin {
    std::uint32_t emitter = kNoEmitter;  ///< scene number of its emitter
    std::uint32_t generation = 0;        ///< 0, or the parent's generation plus one
    std::uint64_t lineage = 0;          ///< key of its children's random numbers; depends on neither ids nor time steps
    std::uint32_t birth_impacts = 0;    ///< impacts so far that have given birth
    std::uint32_t impact_children = 0;  ///< children born at those impacts
};

/// All data of one particle, as a value: the output of emitters and scenes.
struct Particle {
    std::uint64_t id = 0;                                       ///< unique in a run, given in the order of creation
    Vec3 position;                                              ///< in m
    Vec3 velocity;                                              ///< in m/s
    double mass = 1.0;                                          ///< in kg, > 0
    double radius = 0.0;                                        ///< in m, >= 0; 0 is a point
    double birth_time = 0.0;                                    ///< simulation time, in s
    double lifetime = std::numeric_limits<double>::infinity();  ///< age, in s, at which the particle is removed
    Vec3 spin{};                                                ///< angular velocity, in rad/s; spheres only
    bool pinned = false;                                        ///< it never moves, as an attachment of springs
    Origin origin{};
    std::vector<AttributeValue> attributes =
        {};  ///< one per column of Particles::attributes; missing values: fallbacks
};

/// Surface number for "none".
inline constexpr std::uint32_t kNoSupport = 0xFFFFFFFFU;

/// Value in Particles::absorbed: replaced by fragments.
inline constexpr std::uint8_t kShattered = 2;

/// Structure of arrays. All vectors have the same length; entry i of each belongs to particle i. at() and compact()
/// throw InputError for indices past the end and lists of another length.
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
    std::vector<double>
        unsimulated_time;  ///< time, in s, that the bounce budget cut off, summed over the particle's life
    std::vector<std::uint32_t> contacts;  ///< impacts so far (saturating)
    std::vector<std::uint8_t>
        frozen;  ///< 1 if the state left the range of the arithmetic: the particle no longer moves
    std::vector<std::uint8_t> resting;  ///< 1 while at rest on the surfaces in `support`
    std::vector<std::uint8_t> held;     ///< 1 while friction and support keep the particle at rest
    /// 1 if an impact has removed the particle, kShattered if its fragments replace it. It is removed after the step.
    std::vector<std::uint8_t> absorbed;
    std::vector<std::uint32_t> draws;  ///< random numbers drawn by impacts so far
    /// Surfaces on which the particle slides, rolls or rests, padded with kNoSupport.
    std::vector<std::array<std::uint32_t, 3>> support;
    std::vector<double>
        cascade_left;  ///< remaining time, in s, of a bounce cascade that the end of the step interrupted
    std::vector<std::uint8_t> pinned;  ///< 1 if the particle never moves
    /// Simulation time, in s, up to which surfaces have carried a sleeping particle.
    std::vector<double> accounted_until;
    AttributeTable attributes;   ///< set its columns before the first particle is appended
    std::vector<Origin> origin;  ///< empty unless keeps_origin
    bool keeps_origin = false;   ///< set before the first particle is appended

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
    /// Returns all lists that every particle has an entry in, but not its attributes.
    [[nodiscard]] auto lists() {
        return std::tie(id, position, velocity, spin, mass, radius, birth_time, lifetime, unsimulated_time, contacts,
                        frozen, resting, held, absorbed, draws, support, cascade_left, pinned, accounted_until);
    }
};

}  // namespace ricochet
