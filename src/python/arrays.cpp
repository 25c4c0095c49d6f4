#include "python/arrays.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "ricochet/core/error.h"
#include "ricochet/core/memory_limit.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/printable.h"

namespace ricochet::python {
namespace {

std::string shape_of(const py::array& array) {
    std::string text = "(";
    for (py::ssize_t k = 0; k < array.ndim(); ++k) text += fmt::format("{}{}", k > 0 ? ", " : "", array.shape(k));
    return text + (array.ndim() == 1 ? ",)" : ")");
}

std::string expected_shape(py::ssize_t columns) {
    return columns == 0 ? "one row of numbers" : fmt::format("numbers of shape (n, {})", columns);
}

std::string kind_of(const py::handle& object) { return py::str(py::type::handle_of(object).attr("__name__")); }

/// Returns NumPy's message, shortened to one line.
std::string reason_of(const py::error_already_set& error) {
    const std::string text = py::str(error.value());
    return printable(text.substr(0, text.find('\n')), 160);
}

/// Returns true if a Python integer fits into 64 bits.
bool has_64_bits(PyObject* number) {
    const bool fits =
        PyLong_AsUnsignedLongLong(number) != static_cast<unsigned long long>(-1) || PyErr_Occurred() == nullptr;
    PyErr_Clear();
    const bool fits_signed = PyLong_AsLongLong(number) != -1 || PyErr_Occurred() == nullptr;
    PyErr_Clear();
    return fits || fits_signed;
}

/// Describes why an array of Python objects is not an array of numbers. Returns the type of the first entry that is not
/// a number. If all entries are numbers, returns why NumPy stored them as objects.
std::string first_odd_entry(const py::array& array, const char* type) {
    const py::object flat = array.attr("ravel")();
    const py::object number = py::module_::import("numpy").attr("number");
    bool is_long = false;
    for (const py::handle& entry : flat) {
        const bool is_whole = PyLong_Check(entry.ptr()) != 0;
        if (is_whole && PyLong_AsDouble(entry.ptr()) == -1.0 && PyErr_Occurred() != nullptr) {
            PyErr_Clear();
            return "a whole number beyond the range of doubles";
        }
        is_long = is_long || (is_whole && !has_64_bits(entry.ptr()));
        if (is_whole || PyFloat_Check(entry.ptr()) != 0 || py::isinstance(entry, number)) continue;
        return kind_of(entry);
    }
    return fmt::format("{} (convert them: numpy.asarray(..., dtype={}))",
                       is_long ? "whole numbers of more than 64 bits" : "numbers as Python objects, dtype=object",
                       type);
}

/// Throws InputError for arrays with masked entries, because NumPy would treat these entries as numbers.
void refuse_masked(const py::handle& object, const char* name, const std::string& expected) {
    const py::module_ masked = py::module_::import("numpy.ma");
    if (!masked.attr("is_masked")(object).cast<bool>()) return;
    throw InputError(fmt::format("{}: found masked entries, expected {}; fill or remove them", name, expected));
}

/// Returns the object as a NumPy array. type: the expected type of numbers. Throws InputError for other objects, such
/// as None, a dictionary or ragged lists.
py::array as_array(const py::handle& object, const char* name, const std::string& expected,
                   const char* type = "float") {
    const bool is_plain = Py_TYPE(object.ptr()) == py::detail::npy_api::get().PyArray_Type_;
    if (!is_plain && py::hasattr(object, "mask")) refuse_masked(object, name, expected);
    py::array array;
    try {
        array = py::module_::import("numpy").attr("asarray")(object);
    } catch (py::error_already_set& error) {
        if (error.matches(PyExc_MemoryError) || error.matches(PyExc_KeyboardInterrupt)) throw;
        throw InputError(
            fmt::format("{}: found {} ({}), expected {}", name, kind_of(object), reason_of(error), expected));
    }
    const char kind = array.dtype().kind();
    if (kind == 'f' || kind == 'i' || kind == 'u' || kind == 'b') return array;
    if (kind == 'O' && array.size() > 0) {
        throw InputError(fmt::format("{}: found {}, expected {}", name, first_odd_entry(array, type), expected));
    }
    throw InputError(fmt::format("{}: found {}, expected {}", name, std::string(py::str(array.dtype())), expected));
}

bool has_shape(const py::array& array, py::ssize_t columns) {
    if (columns == 0) return array.ndim() == 1;
    // An empty list becomes an array without a second axis.
    return (array.ndim() == 2 && array.shape(1) == columns) || (array.ndim() == 1 && array.shape(0) == 0);
}

Doubles as_doubles(const py::array& array, const char* name) {
    if (static_cast<std::size_t>(array.size()) > kFewNumbers && !Doubles::check_(array)) {
        require_memory(8.0 * static_cast<double>(array.size()),
                       fmt::format("{}: a copy of shape {} as doubles", name, shape_of(array)));
    }
    Doubles doubles = Doubles::ensure(array);
    if (doubles) return doubles;
    try {
        return py::module_::import("numpy").attr("ascontiguousarray")(array, "f8");
    } catch (py::error_already_set& error) {
        if (error.matches(PyExc_KeyboardInterrupt)) throw;
        throw InputError(fmt::format("{}: found {} of shape {}, which NumPy cannot make doubles ({})", name,
                                     std::string(py::str(array.dtype())), shape_of(array), reason_of(error)));
    }
}

std::unique_ptr<ThreadLimit>& thread_limit() {
    static std::unique_ptr<ThreadLimit> limit;
    return limit;
}

}  // namespace

Doubles numbers(const py::handle& object, const char* name, py::ssize_t columns) {
    const py::array array = as_array(object, name, expected_shape(columns));
    if (!has_shape(array, columns)) {
        throw InputError(
            fmt::format("{}: found shape {}, expected {}", name, shape_of(array), expected_shape(columns)));
    }
    return as_doubles(array, name);
}

Doubles vectors(const py::handle& object, const char* name) {
    constexpr const char* kExpected = "numbers of shape (n, 3) or (3,)";
    const py::array array = as_array(object, name, kExpected);
    const bool is_one = array.ndim() == 1 && array.shape(0) == 3;
    if (!is_one && !has_shape(array, 3)) {
        throw InputError(fmt::format("{}: found shape {}, expected {}", name, shape_of(array), kExpected));
    }
    Doubles doubles = as_doubles(array, name);
    return array.ndim() == 1 ? Doubles(doubles.reshape({array.shape(0) / 3, py::ssize_t{3}})) : doubles;
}

void repeat_one(Doubles& array, const Doubles& other, const char* name) {
    if (array.shape(0) != 1 || other.shape(0) == 1) return;
    const py::module_ numpy = py::module_::import("numpy");
    array = as_doubles(numpy.attr("broadcast_to")(array, py::make_tuple(other.shape(0), 3)), name);
}

Doubles numbers_or_one(const py::handle& object, const char* name) {
    if (object.is_none()) return Doubles(py::ssize_t{0});
    const py::array array = as_array(object, name, "a number or one row of numbers");
    if (array.ndim() > 1) {
        throw InputError(
            fmt::format("{}: found shape {}, expected a number or one row of numbers", name, shape_of(array)));
    }
    return as_doubles(array, name).reshape({array.size()});
}

std::vector<std::uint64_t> whole_numbers(const py::handle& object, const char* name, py::ssize_t columns) {
    const std::string expected = columns == 0 ? "one row of whole numbers of at least 0"
                                              : fmt::format("whole numbers of shape (n, {})", columns);
    const py::array array = as_array(object, name, expected, "int");
    const char kind = array.dtype().kind();
    const bool is_empty = array.size() == 0;
    if (!has_shape(array, columns) || (!is_empty && kind != 'i' && kind != 'u')) {
        throw InputError(fmt::format("{}: found {} of shape {}, expected {}", name, std::string(py::str(array.dtype())),
                                     shape_of(array), expected));
    }
    using Signed = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
    using Unsigned = py::array_t<std::uint64_t, py::array::c_style | py::array::forcecast>;
    std::vector<std::uint64_t> result(static_cast<std::size_t>(array.size()));
    if (is_empty) return result;
    const std::uint64_t most = columns == 0 ? ~std::uint64_t{0} : 0xFFFFFFFFU;
    const auto take = [&](const auto* data) {
        for (std::size_t k = 0; k < result.size(); ++k) {
            if (data[k] < 0 || static_cast<std::uint64_t>(data[k]) > most) {
                throw InputError(fmt::format("{}: found {}, expected {}", name, data[k], expected));
            }
            result[k] = static_cast<std::uint64_t>(data[k]);
        }
    };
    if (kind == 'u') {
        const Unsigned of = Unsigned::ensure(array);
        std::copy(of.data(), of.data() + of.size(), result.begin());
        for (const std::uint64_t number : result) {
            if (number > most) throw InputError(fmt::format("{}: found {}, expected {}", name, number, expected));
        }
    } else {
        const Signed of = Signed::ensure(array);
        take(of.data());
    }
    return result;
}

py::array lent_flags(const std::uint8_t* data, std::size_t count, std::shared_ptr<const void> keeper) {
    return lent(data, count, std::move(keeper)).attr("view")(py::dtype::of<bool>());
}

py::array given_flags(std::vector<std::uint8_t>&& flags) {
    return given(std::move(flags)).attr("view")(py::dtype::of<bool>());
}

void set_threads(int threads) {
    auto limit = std::make_unique<ThreadLimit>(threads);  // throws for invalid arguments before the old limit is
                                                          // removed
    thread_limit() = std::move(limit);
}

}  // namespace ricochet::python
