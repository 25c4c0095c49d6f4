/// \file
/// Private to the simulation: checks of setups. Every check throws InputError with one line that names the object and
/// the value.
#pragma once

#include <concepts>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "ricochet/core/error.h"
#include "ricochet/core/setting.h"
#include "ricochet/core/vec3.h"
#include "ricochet/simulation.h"

namespace ricochet {

/// The object whose values are checked. All checks throw InputError.
class Subject {
public:
    /// Messages use the name of the object, or its number if it has no name.
    Subject(std::string_view kind, std::size_t number, std::string_view name = {});
    explicit Subject(std::string_view name) : name_(name) {}

    [[noreturn]] void refuse(std::string_view what, std::string_view found, std::string_view expected) const;
    [[noreturn]] void refuse(std::string_view what, std::floating_point auto found, std::string_view expected) const {
        refuse(what, text(found), expected);
    }
    [[noreturn]] void refuse(std::string_view what, std::integral auto found, std::string_view expected) const {
        refuse(what, std::to_string(found), expected);
    }

    /// Refuses the first member that is outside its range. owner: prefix of the member's name in the message.
    void require_settings(const auto& object, const auto& table, std::string_view owner = "") const {
        const std::string refused = first_refusal(object, table, owner);
        if (!refused.empty()) throw InputError(name_ + ": " + refused);
    }
    void require(const SettingValue& value, const Range& range, std::string_view what, std::string_view unit) const;
    void require_in(double value, double least, double most, std::string_view what, std::string_view expected) const;
    void require_direction(const Vec3& value, std::string_view what) const;
    void require_index(std::size_t index, std::size_t count, std::string_view what, std::string_view of) const;

private:
    [[nodiscard]] static std::string text(double value);

    std::string name_;
};

/// Checks all values of a setup that the classes of its parts do not check themselves. Returns the setup.
const SimulationSetup& validated(const SimulationSetup& setup);

/// Refuses parts that cannot be combined: moving colliders, bodies, spheres that meet, flows, forces between particles.
void validate_together(const SimulationSetup& setup);

/// Checks counters, except whether their names differ.
void validate_counters(std::span<const CounterDescription> counters);

/// Checks the settings that change temperatures, and their requirements on particles and on motion.
void validate_heat(const SimulationSetup& setup);
/// Checks the requirements of forces that depend on temperatures.
void validate_thermal_forces(const SimulationSetup& setup);

/// Checks contacts between spheres, their materials, and their combination with other settings.
void validate_particle_contacts(const SimulationSetup& setup);
/// Checks the mass and the material of a particle that can meet other particles. columns: columns of its attributes.
void validate_sphere(const Particle& particle, std::size_t number, const PairContactSettings& contacts,
                     std::span<const AttributeDescription> columns);

/// Checks a particle. number: index among the given particles. columns: number of attributes of particles.
void validate(const Particle& particle, std::size_t number, std::size_t columns);
/// Checks a collider. materials: number of materials.
void validate(const ColliderDescription& collider, std::size_t number, std::size_t materials);

}  // namespace ricochet
