/// \file
/// The kinds of failure that reach the user, and how they read.
#pragma once

#include <stdexcept>
#include <string>

namespace ricochet {

/// Wrong input: arguments, scene or mesh. The command line ends with exit code 2.
/// The text is one line: what, where (file and line, byte offset or JSON path), what was expected, what to do.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A failure that the input did not cause (disk full, device error). Exit code 1.
class RunError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A run has diverged: for example by a step too long for its forces. The text says when and where.
class DivergedError : public RunError {
public:
    using RunError::RunError;
};

}  // namespace ricochet
