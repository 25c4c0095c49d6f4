/// \file
/// Python's lock, let go of and taken again, also while the interpreter ends. Python ends a thread that asks for the
/// lock then, which C++ code on its stack does not survive; here it is kept waiting instead, for ever, as a daemon
/// thread is that has nothing left to do.
#pragma once

#include <pybind11/pybind11.h>

namespace ricochet::python {

namespace py = pybind11;

/// Tells Python to call it at its end: then what runs here is waited for, for two seconds at most. Steps end there.
void wait_for_threads_at_exit();

/// For threads that run long without the lock: does not return once the interpreter ends.
void stay_if_ending();

namespace detail {

/// Counts a thread that runs C++ code beside the interpreter, or Python code within such.
class Beside {
public:
    Beside();
    ~Beside();
    Beside(const Beside&) = delete;
    Beside& operator=(const Beside&) = delete;
};

/// Where a thread has no lock: before it asks for it, and after it has let go of it.
class WithoutLock {
public:
    WithoutLock() { stay_if_ending(); }
    ~WithoutLock() { stay_if_ending(); }
    WithoutLock(const WithoutLock&) = delete;
    WithoutLock& operator=(const WithoutLock&) = delete;
};

}  // namespace detail

/// Without the lock while it lives; instead of py::gil_scoped_release.
class Unlocked {
private:
    detail::Beside beside_;
    py::gil_scoped_release released_;
    detail::WithoutLock without_;
};

/// With the lock while it lives, within Unlocked; instead of py::gil_scoped_acquire.
class Locked {
private:
    detail::Beside beside_;
    detail::WithoutLock without_;
    py::gil_scoped_acquire acquired_;
};

}  // namespace ricochet::python
