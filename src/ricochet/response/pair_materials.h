/// \file
/// Contact parameters of spheres of any two materials, looked up by the numbers of the materials.
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

/// Returns true if a value of kMaterialAttribute is a valid material number, an integer below `materials`.
[[nodiscard]] inline bool is_material(const AttributeValue& value, std::size_t materials) {
    return value.x >= 0.0 && value.x < static_cast<double>(materials) && value.x == std::floor(value.x);
}

/// Returns the contact parameters of all pairs of materials that have none of their own.
[[nodiscard]] inline PairMaterial material_of_all(const PairContactSettings& settings) {
    return {settings.restitution,       settings.friction,
            settings.rolling_friction,  settings.tangential_restitution,
            settings.restitution_speed, settings.restitution_exponent};
}

/// Numbers of materials by name. The pairs of a thousand materials need a million look-ups.
class MaterialNumbers {
public:
    /// The names must outlive the object. If names are equal, the first one is used.
    explicit MaterialNumbers(const std::vector<std::string>& names) {
        for (std::size_t k = 0; k < names.size(); ++k) numbers_.try_emplace(names[k], k);
    }

    /// Returns the number of a name, or std::nullopt if the name is unknown.
    [[nodiscard]] std::optional<std::size_t> of(std::string_view name) const {
        const auto found = numbers_.find(name);
        return found == numbers_.end() ? std::nullopt : std::optional(found->second);
    }

private:
    std::map<std::string_view, std::size_t> numbers_;
};

/// Contact parameters of all pairs of materials. The table has one entry if there are no materials.
class PairMaterials {
public:
    /// Throws an InputError if a pair has a name that is no material.
    explicit PairMaterials(const PairContactSettings& settings);

    /// Returns the contact parameters of two materials. Both numbers must be below count().
    [[nodiscard]] const PairMaterial& of(std::uint32_t a, std::uint32_t b) const { return table_[a * count_ + b]; }
    /// Returns the number of materials; 1 if all spheres have the same one.
    [[nodiscard]] std::size_t count() const { return count_; }
    /// Returns true if some impacts lose energy along the normal.
    [[nodiscard]] bool loses_energy() const { return loses_energy_; }

private:
    std::size_t count_ = 1;
    std::vector<PairMaterial> table_;
    bool loses_energy_ = false;
};

}  // namespace ricochet
