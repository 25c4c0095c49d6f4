/// \file
/// Private to the responses: what spheres of any two materials do to each other, by the numbers of the materials.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/dynamics/particles.h"
#include "ricochet/response/settings.h"

namespace ricochet {

/// A value of kMaterialAttribute that is the number of one of so many materials.
[[nodiscard]] inline bool is_material(const AttributeValue& value, std::size_t materials) {
    return value.x >= 0.0 && value.x < static_cast<double>(materials) && value.x == std::floor(value.x);
}

/// Returns the contact of the pairs of spheres that have none of their own.
[[nodiscard]] inline PairMaterial material_of_all(const PairContactSettings& settings) {
    return {settings.restitution, settings.friction, settings.rolling_friction};
}

/// The numbers of materials by their names; pairs of a thousand of them look up a million.
class MaterialNumbers {
public:
    /// The names must outlive it. Of equal ones the first counts.
    explicit MaterialNumbers(const std::vector<std::string>& names) {
        for (std::size_t k = 0; k < names.size(); ++k) numbers_.try_emplace(names[k], k);
    }

    /// Nothing for a name that is none of them.
    [[nodiscard]] std::optional<std::size_t> of(std::string_view name) const {
        const auto found = numbers_.find(name);
        return found == numbers_.end() ? std::nullopt : std::optional(found->second);
    }

private:
    std::map<std::string_view, std::size_t> numbers_;
};

/// A table for all pairs; of one entry where there are no materials.
class PairMaterials {
public:
    /// Names of pairs that are none of the materials are InputErrors.
    explicit PairMaterials(const PairContactSettings& settings);

    /// Of two numbers below count().
    [[nodiscard]] const PairMaterial& of(std::uint32_t a, std::uint32_t b) const { return table_[a * count_ + b]; }
    /// Materials; 1 where all spheres are of one.
    [[nodiscard]] std::size_t count() const { return count_; }
    /// Some impacts take energy along the normal.
    [[nodiscard]] bool loses_energy() const { return loses_energy_; }

private:
    std::size_t count_ = 1;
    std::vector<PairMaterial> table_;
    bool loses_energy_ = false;
};

}  // namespace ricochet
