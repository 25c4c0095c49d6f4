/// \file
/// Private to the simulation: refusal of values in a setup, with the name of the object that has them.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "ricochet/core/error.h"
#include "ricochet/core/setting.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// The object whose values are checked. All checks throw InputError.
class Subject {
public:
    /// The object is called by its name, or by its number if it has none.
    Subject(std::string_view kind, std::size_t number, std::string_view name = {});
    explicit Subject(std::string_view name) : name_(name) {}

    [[noreturn]] void refuse(std::string_view what, std::string_view found, std::string_view expected) const;
    [[noreturn]] void refuse(std::string_view what, std::floating_point auto found, std::string_view expected) const {
        refuse(what, text(found), expected);
    }
    [[noreturn]] void refuse(std::string_view what, std::integral auto found, std::string_view expected) const {
        refuse(what, std::to_string(found), expected);
    }

    /// Refuses the first member that is outside its range; owner: written before its name.
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

}  // namespace ricochet
