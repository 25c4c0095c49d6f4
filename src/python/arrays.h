/// \file
/// Conversion of arrays between Python and C++. Input from users is checked, and messages contain the name of the
/// argument. Returned arrays keep their memory alive.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet::python {

namespace py = pybind11;

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Largest number of entries that are copied without a check of the available memory. Larger arrays are checked,
/// because an array from broadcast_to() has many entries in few bytes.
inline constexpr std::size_t kFewNumbers = std::size_t{1} << 20;

/// Returns an array of shape (count, columns) as doubles. If columns is 0, the shape is (count). An array of doubles is
/// not copied. Throws InputError "NAME: found ..., expected ..." for other shapes and types, such as text and complex
/// numbers.
[[nodiscard]] Doubles numbers(const py::handle& object, const char* name, py::ssize_t columns);
/// Returns an array of shape (n, 3) as doubles. Also accepts the shape (3,) for a single row.
[[nodiscard]] Doubles vectors(const py::handle& object, const char* name);
/// If an array has a single row, repeats this row until the array has as many rows as the other one.
void repeat_one(Doubles& array, const Doubles& other, const char* name);
/// Returns an array with one axis as doubles. Also accepts a single number, and None for an empty array.
[[nodiscard]] Doubles numbers_or_one(const py::handle& object, const char* name);
/// Returns the whole numbers of an array of shape (count, columns). They must be at least 0 and below 2^32. If columns
/// is 0, the shape is (count) and the limit is 2^64.
[[nodiscard]] std::vector<std::uint64_t> whole_numbers(const py::handle& object, const char* name, py::ssize_t columns);

/// Returns the rows of an array of three columns.
[[nodiscard]] inline std::span<const Vec3> points(const Doubles& array) {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    return {reinterpret_cast<const Vec3*>(array.data()), static_cast<std::size_t>(array.shape(0))};
}
[[nodiscard]] inline std::span<const double> values(const Doubles& array) {
    return {array.data(), static_cast<std::size_t>(array.size())};
}

/// Returns an array over memory that `keeper` keeps alive. If T is Vec3, the array has a second axis of length 3.
template <class T>
[[nodiscard]] py::array array_over(const T* data, std::size_t count, std::shared_ptr<const void> keeper) {
    const py::capsule owner(new std::shared_ptr<const void>(std::move(keeper)),
                            [](void* p) { delete static_cast<std::shared_ptr<const void>*>(p); });
    const auto rows = static_cast<py::ssize_t>(count);
    if constexpr (std::is_same_v<T, Vec3>) {
        return py::array_t<double>({rows, py::ssize_t{3}}, reinterpret_cast<const double*>(data), owner);
    } else {
        return py::array_t<T>({rows}, data, owner);
    }
}

/// Returns an array like array_over(), but read-only.
template <class T>
[[nodiscard]] py::array lent(const T* data, std::size_t count, std::shared_ptr<const void> keeper) {
    py::array array = array_over(data, count, std::move(keeper));
    array.attr("flags").attr("writeable") = false;
    return array;
}

/// Returns an array of booleans over flags. It is read-only, like the result of lent().
[[nodiscard]] py::array lent_flags(const std::uint8_t* data, std::size_t count, std::shared_ptr<const void> keeper);

/// Returns an array that owns the memory of a vector. The user may write into it.
template <class T>
[[nodiscard]] py::array given(std::vector<T>&& vector) {
    auto keeper = std::make_shared<std::vector<T>>(std::move(vector));
    const T* data = keeper->data();
    const std::size_t count = keeper->size();
    return array_over(data, count, std::move(keeper));
}
/// Returns an array of booleans that owns the memory of the flags, like the result of given().
[[nodiscard]] py::array given_flags(std::vector<std::uint8_t>&& flags);

/// Sets the thread limit of queries and steps (ricochet.set_threads).
void set_threads(int threads);

// Parts of the module.
void bind_mesh(py::module_& module);
void bind_simulation(py::module_& module);

}  // namespace ricochet::python
