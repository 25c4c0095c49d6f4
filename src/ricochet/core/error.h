/// \file
/// The kinds of failure that reach the user, and the form of their messages.
#pragma once

#include <cstddef>
#include <stdexcept>

namespace ricochet {

/// Wrong input: arguments, scene or mesh. The command line ends with exit code 2.
/// The text is one line: the fault, its location (file and line, byte offset or JSON path), the expected value, and the
/// remedy.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A failure that the input did not cause (disk full, device error). Exit code 1.
class RunError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Divergence of a run, for example because its time step is too long for its forces. The text says when and where the
/// run diverged.
class DivergedError : public RunError {
public:
    using RunError::RunError;
};

namespace detail {
[[noreturn]] void refuse_index(std::size_t index, std::size_t size, const char* what);
[[noreturn]] void refuse_length(std::size_t found, std::size_t expected, const char* what);
}  // namespace detail

/// Throws InputError "NAME: found 7, expected a number below 3" unless index < size.
inline void require_index(std::size_t index, std::size_t size, const char* what) {
    if (index >= size) detail::refuse_index(index, size, what);
}

/// Throws InputError "NAME: found 7 entries, expected 3" unless the lengths are equal.
inline void require_same_length(std::size_t found, std::size_t expected, const char* what) {
    if (found != expected) detail::refuse_length(found, expected, what);
}

}  // namespace ricochet
