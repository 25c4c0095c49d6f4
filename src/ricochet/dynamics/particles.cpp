#include "ricochet/dynamics/particles.h"

#include <fmt/format.h>
#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>

#include "ricochet/core/algorithms.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/printable.h"

namespace ricochet {

namespace {

// Reserved names: arrays in frame files, columns of tables, and arrays that renderers derive from them.
constexpr std::array<std::string_view, 29> kOwnArrays = {
    "id",       "x",       "y",        "z",       "vx",          "vy",        "vz",     "position",
    "velocity", "mass",    "radius",   "age",     "contacts",    "resting",   "frozen", "unsimulated_time",
    "spin",     "speed",   "lifetime", "pinned",  "Points",      "TimeValue", "spin_x", "spin_y",
    "spin_z",   "color_x", "color_y",  "color_z", "cloud_parent"};

void require(bool condition, const AttributeDescription& column, const char* what) {
    if (!condition) throw InputError(fmt::format("attribute '{}': {}", column.name, what));
}

// Orders particles by id with a table that maps ids to indices. If ids are dense, this is faster than sorting. Returns
// false, without changes, if ids are sparse or not unique.
bool put_in_order_by_table(const std::vector<std::uint64_t>& id, std::vector<std::uint32_t>& order) {
    constexpr std::uint64_t kMostPlacesAnEntry = 8;
    constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();
    const auto [lowest, highest] = std::minmax_element(id.begin(), id.end());
    if ((*highest - *lowest) / kMostPlacesAnEntry >= id.size()) return false;
    std::vector<std::uint32_t> owner(*highest - *lowest + 1, kNobody);
    for (std::uint32_t i = 0; i < id.size(); ++i) {
        std::uint32_t& entry = owner[id[i] - *lowest];
        if (entry != kNobody) return false;
        entry = i;
    }
    std::copy_if(owner.begin(), owner.end(), order.begin(), [](std::uint32_t i) { return i != kNobody; });
    return true;
}

}  // namespace

AttributeValue missing_attribute() { return {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}; }

std::optional<AttributeDescription> looks_attribute(std::string_view name) {
    if (name == kColorAttribute) return AttributeDescription{std::string(name), 3, {1, 1, 1}};
    if (name == kOpacityAttribute) return AttributeDescription{std::string(name), 1, {1, 0, 0}};
    if (name == kSizeAttribute) return AttributeDescription{std::string(name), 1, {}};
    return std::nullopt;
}

bool is_own_array(std::string_view name) { return std::ranges::find(kOwnArrays, name) != kOwnArrays.end(); }

AttributeTable::AttributeTable(std::vector<AttributeDescription> columns)
    : columns_(std::move(columns)), values_(columns_.size()) {
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        const AttributeDescription& column = columns_[k];
        require(!column.name.empty(), column, "the name is empty");
        require(is_column_name(column.name), column, "the name has control characters, commas or quotes");
        require(!is_own_array(column.name), column, "the name is one of the particles' own arrays");
        require(find(column.name) == k, column, "the name is taken by another attribute");
        require(column.components == 1 || column.components == 3, column, "components must be 1 or 3");
        for (const char* const axis : {"_x", "_y", "_z"}) {
            require(column.components == 1 || !find(column.name + axis), column,
                    "its column _x, _y or _z is another attribute");
        }
        require(is_finite(column.fallback), column, "the default must be finite");
        const auto appearance = looks_attribute(column.name);
        require(!appearance || appearance->components == column.components, column,
                "the name is taken by the appearance of particles");
    }
}

std::size_t AttributeTable::size() const {
    return empty() ? 0 : values_[0].size() / static_cast<std::size_t>(columns_[0].components);
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
        grow_capacity_by(values_[k], more * static_cast<std::size_t>(columns_[k].components));
    }
}

void AttributeTable::compact(const std::vector<std::uint8_t>& keep) {
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        const auto width = static_cast<std::size_t>(columns_[k].components);
        require_same_length(keep.size() * width, values_[k].size(), "entries of attributes to be kept");
        keep_marked(values_[k], keep, width);
    }
}

void AttributeTable::clear() {
    for (std::vector<double>& column : values_) column.clear();
}

AttributeValue AttributeTable::value(std::size_t column, std::size_t i) const {
    require_index(column, values_.size(), "attribute");
    const std::vector<double>& values = values_[column];
    require_index(i, size(), "entry of an attribute");
    if (columns_[column].components == 1) return {values[i], 0.0, 0.0};
    return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

void AttributeTable::set(std::size_t column, std::size_t i, const AttributeValue& value) {
    require_index(column, values_.size(), "attribute");
    const auto width = static_cast<std::size_t>(columns_[column].components);
    require_index(i, size(), "entry of an attribute");
    for (std::size_t c = 0; c < width; ++c) values_[column][i * width + c] = value[static_cast<int>(c)];
}

std::vector<AttributeValue> AttributeTable::at(std::size_t i) const {
    std::vector<AttributeValue> values;
    for (std::size_t k = 0; k < columns_.size(); ++k) values.push_back(value(k, i));
    return values;
}

void Particles::append(const Particle& particle) {
    id.push_back(particle.id);
    position.push_back(particle.position);
    velocity.push_back(particle.velocity);
    spin.push_back(particle.spin);
    mass.push_back(particle.mass);
    radius.push_back(particle.radius);
    birth_time.push_back(particle.birth_time);
    lifetime.push_back(particle.lifetime);
    unsimulated_time.push_back(0.0);
    contacts.push_back(0);
    frozen.push_back(0);
    resting.push_back(0);
    held.push_back(0);
    absorbed.push_back(0);
    draws.push_back(0);
    support.push_back({kNoSupport, kNoSupport, kNoSupport});
    cascade_left.push_back(0.0);
    pinned.push_back(particle.pinned ? 1 : 0);
    accounted_until.push_back(0.0);
    attributes.append(particle.attributes);
    if (keeps_origin) origin.push_back(particle.origin);
}

void Particles::reserve(std::size_t more) {
    std::apply([more](auto&... list) { (grow_capacity_by(list, more), ...); }, lists());
    attributes.reserve(more);
    if (keeps_origin) grow_capacity_by(origin, more);
}

Particle Particles::at(std::size_t i) const {
    require_index(i, size(), "particle");
    Particle particle{id[i],         position[i], velocity[i], mass[i],       radius[i],
                      birth_time[i], lifetime[i], spin[i],     pinned[i] != 0};
    if (keeps_origin) particle.origin = origin[i];
    if (!attributes.empty()) particle.attributes = attributes.at(i);
    return particle;
}

void Particles::compact(const std::vector<std::uint8_t>& keep) {
    require_same_length(keep.size(), size(), "particles to be kept");
    const auto keep_in_all = [&keep](auto&... list) {
        const std::array<std::function<void()>, sizeof...(list)> each{[&list, &keep] { keep_marked(list, keep); }...};
        // The work consists only of memory moves, so threads save time only for large arrays.
        constexpr std::size_t kMany = 16384;
        parallel_for_blocks(each.size(), keep.size() < kMany ? each.size() : 1,
                            [&each](std::size_t, std::size_t begin, std::size_t end) {
                                for (std::size_t k = begin; k < end; ++k) each.at(k)();
                            });
    };
    std::apply(keep_in_all, lists());
    attributes.compact(keep);
    if (keeps_origin) keep_marked(origin, keep);
}

std::vector<std::uint32_t> Particles::order_by_id() const {
    std::vector<std::uint32_t> order(size());
    std::iota(order.begin(), order.end(), std::uint32_t{0});
    if (std::is_sorted(id.begin(), id.end()) || put_in_order_by_table(id, order)) return order;
    std::ranges::sort(order, [this](std::uint32_t a, std::uint32_t b) { return id[a] < id[b]; });
    return order;
}

}  // namespace ricochet
