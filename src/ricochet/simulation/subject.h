/// \file
/// Private to the simulation: refuses what a setup holds, by the name of the object that holds it.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// The object whose values are checked. Everything that does not hold throws InputError.
class Subject {
public:
    /// By its name, or its number where it has none.
    Subject(std::string_view kind, std::size_t number, std::string_view name = {});
    explicit Subject(std::string_view name) : name_(name) {}

    [[noreturn]] void refuse(std::string_view what, std::string_view found, std::string_view expected) const;
    [[noreturn]] void refuse(std::string_view what, std::floating_point auto found, std::string_view expected) const {
        refuse(what, text(found), expected);
    }
    [[noreturn]] void refuse(std::string_view what, std::integral auto found, std::string_view expected) const {
        refuse(what, std::to_string(found), expected);
    }

    void require_in(double value, double least, double most, std::string_view what, std::string_view expected) const;
    void require_positive(double value, std::string_view what, std::string_view unit) const;
    /// Lengths that positions are made of.
    void require_length(double value, std::string_view what) const;
    void require_not_negative(double value, std::string_view what, std::string_view unit) const;
    /// Every component finite and at most `most`.
    void require_size(const Vec3& value, double most, std::string_view what, std::string_view unit) const;
    /// The same with kLargestCoordinate.
    void require_coordinates(const Vec3& value, std::string_view what, std::string_view unit) const;
    void require_direction(const Vec3& value, std::string_view what) const;
    void require_index(std::size_t index, std::size_t count, std::string_view what, std::string_view of) const;

private:
    [[nodiscard]] static std::string text(double value);

    std::string name_;
};

}  // namespace ricochet
