/// \file
/// Named values of the user's own that particles carry: declared once, one column each, kept with the particles through
/// sorting and output. Nothing is stored while nothing is declared.
#pragma once

#include <cstddef>
#include <cstdint>
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

/// Names of the columns for looks. They may be declared only with the components and fallbacks that looks_attribute()
/// gives; a scene declares them by using them.
inline constexpr std::string_view kColorAttribute = "color";      ///< red, green, blue, 0..1, as linear light
inline constexpr std::string_view kOpacityAttribute = "opacity";  ///< 0 (not seen) to 1
inline constexpr std::string_view kSizeAttribute = "size";        ///< radius that is drawn, m; default the radius
/// The column of that name; nothing when it is not one for looks.
[[nodiscard]] std::optional<AttributeDescription> looks_attribute(std::string_view name);

/// True for the names of the arrays and columns that every run writes of itself.
[[nodiscard]] bool is_own_array(std::string_view name);

/// Columns of values, one entry a particle in each.
class AttributeTable {
public:
    AttributeTable() = default;
    /// Throws InputError for a name that is empty, taken twice or one of the particles' own, for components other than
    /// 1 and 3, and for a fallback that is not finite.
    explicit AttributeTable(std::vector<AttributeDescription> columns);

    [[nodiscard]] std::span<const AttributeDescription> columns() const { return columns_; }
    [[nodiscard]] bool empty() const { return columns_.empty(); }
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

    /// Saves or restores the values; a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        for (std::vector<double>& column : values_) a(column);
    }

private:
    std::vector<AttributeDescription> columns_;
    std::vector<std::vector<double>> values_;  // one list a column, components side by side
};

}  // namespace ricochet
