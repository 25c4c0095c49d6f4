/// \file
/// The two kinds of failure a user can meet, and how they read.
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

/// A failure while running that is not the input's fault (disk full, device error). Exit code 1.
class RunError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The numbers of a run have become nonsense: a step too long for its forces, for example. Says when and where.
class DivergedError : public RunError {
public:
    using RunError::RunError;
};

}  // namespace ricochet
