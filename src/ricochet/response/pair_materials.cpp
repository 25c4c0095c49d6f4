#include "ricochet/response/pair_materials.h"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/core/error.h"

namespace ricochet {
namespace {

std::size_t number_of(const MaterialNumbers& numbers, const std::string& name) {
    const auto found = numbers.of(name);
    if (!found) throw InputError(fmt::format("particle_contacts: no material is named '{}'", name));
    return *found;
}

}  // namespace

PairMaterials::PairMaterials(const PairContactSettings& settings)
    : count_(std::max<std::size_t>(1, settings.materials.size())), table_(count_ * count_, material_of_all(settings)) {
    const MaterialNumbers numbers(settings.materials);
    for (const MaterialPair& pair : settings.pairs) {
        const std::size_t a = number_of(numbers, pair.first);
        const std::size_t b = number_of(numbers, pair.second);
        table_[a * count_ + b] = table_[b * count_ + a] = pair.material;
    }
    loses_energy_ = std::ranges::any_of(
        table_, [](const PairMaterial& pair) { return pair.restitution < 1.0 || pair.restitution_speed.has_value(); });
}

}  // namespace ricochet
