#include "ricochet/dynamics/attributes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/reserve_more.h"

namespace ricochet {
namespace {

// Arrays of frames, columns of tables, and what pictures make of them.
constexpr std::array<std::string_view, 22> kOwnArrays = {
    "id",       "x",     "y",        "z",      "vx",       "vy",       "vz",     "position",
    "velocity", "mass",  "radius",   "age",    "contacts", "resting",  "frozen", "unsimulated_time",
    "spin",     "speed", "lifetime", "pinned", "Points",   "TimeValue"};

void require(bool condition, const AttributeDescription& column, const char* what) {
    if (!condition) throw InputError(fmt::format("attribute '{}': {}", column.name, what));
}

}  // namespace

AttributeValue missing_attribute() { return {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}; }

std::optional<AttributeDescription> looks_attribute(std::string_view name) {
    if (name == kColorAttribute) return AttributeDescription{std::string(name), 3, {1, 1, 1}};
    if (name == kOpacityAttribute) return AttributeDescription{std::string(name), 1, {1, 0, 0}};
    if (name == kSizeAttribute) return AttributeDescription{std::string(name), 1, {}};
    return std::nullopt;
}

bool is_own_array(std::string_view name) {
    return std::find(kOwnArrays.begin(), kOwnArrays.end(), name) != kOwnArrays.end();
}

AttributeTable::AttributeTable(std::vector<AttributeDescription> columns)
    : columns_(std::move(columns)), values_(columns_.size()) {
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        const AttributeDescription& column = columns_[k];
        require(!column.name.empty(), column, "the name is empty");
        require(!is_own_array(column.name), column, "the name is one of the particles' own arrays");
        require(find(column.name) == k, column, "the name is taken by another attribute");
        require(column.components == 1 || column.components == 3, column, "components must be 1 or 3");
        require(is_finite(column.fallback), column, "the default must be finite");
        const auto looks = looks_attribute(column.name);
        require(!looks || looks->components == column.components, column,
                "the name is taken by the looks of particles");
    }
}

std::optional<std::size_t> AttributeTable::find(std::string_view name) const {
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        if (columns_[k].name == name) return k;
    }
    return std::nullopt;
}

void AttributeTable::append(std::span<const AttributeValue> values) {
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        const bool given = k < values.size() && !is_missing(values[k]);
        const AttributeValue value = given ? values[k] : columns_[k].fallback;
        for (int c = 0; c < columns_[k].components; ++c) values_[k].push_back(value[c]);
    }
}

void AttributeTable::reserve(std::size_t more) {
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        reserve_more(values_[k], more * static_cast<std::size_t>(columns_[k].components));
    }
}

void AttributeTable::compact(const std::vector<std::uint8_t>& keep) {
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        const auto width = static_cast<std::size_t>(columns_[k].components);
        std::size_t kept = 0;
        for (std::size_t i = 0; i < keep.size(); ++i) {
            if (keep[i] == 0) continue;
            for (std::size_t c = 0; c < width; ++c) values_[k][kept++] = values_[k][i * width + c];
        }
        values_[k].resize(kept);
    }
}

void AttributeTable::clear() {
    for (std::vector<double>& column : values_) column.clear();
}

AttributeValue AttributeTable::value(std::size_t column, std::size_t i) const {
    const std::vector<double>& values = values_[column];
    if (columns_[column].components == 1) return {values[i], 0.0, 0.0};
    return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

void AttributeTable::set(std::size_t column, std::size_t i, const AttributeValue& value) {
    const auto width = static_cast<std::size_t>(columns_[column].components);
    for (std::size_t c = 0; c < width; ++c) values_[column][i * width + c] = value[static_cast<int>(c)];
}

std::vector<AttributeValue> AttributeTable::at(std::size_t i) const {
    std::vector<AttributeValue> values;
    for (std::size_t k = 0; k < columns_.size(); ++k) values.push_back(value(k, i));
    return values;
}

}  // namespace ricochet
