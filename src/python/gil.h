/// \file
/// Scopes that release and take Python's lock, also safe while the interpreter ends. At that time Python ends a thread
/// that asks for the lock, and C++ code on its stack does not survive this. These scopes make such a thread wait
/// forever instead, like a daemon thread without work.
#pragma once

#include <pybind11/pybind11.h>

namespace ricochet::python {

namespace py = pybind11;

/// Registers a function that Python calls at its end. It waits, for two seconds at most, for the threads that run here.
/// Running steps end meanwhile.
void wait_for_threads_at_exit();

/// Does not return once the interpreter ends. For threads that run long without the lock.
void stay_if_ending();

namespace detail {

/// Scope that counts a thread that runs C++ code beside the interpreter, or Python code within such code.
class Beside {
public:
    Beside();
    ~Beside();
    Beside(const Beside&) = delete;
    Beside& operator=(const Beside&) = delete;
};

/// Scope of a thread without the lock: before it asks for the lock, and after it has released it.
class WithoutLock {
public:
    WithoutLock() { stay_if_ending(); }
    ~WithoutLock() { stay_if_ending(); }
    WithoutLock(const WithoutLock&) = delete;
    WithoutLock& operator=(const WithoutLock&) = delete;
};

}  // namespace detail

/// Scope without the lock. Replaces py::gil_scoped_release.
class Unlocked {
private:
    detail::Beside beside_;
    py::gil_scoped_release released_;
    detail::WithoutLock without_;
};

/// Scope that takes the lock again inside an Unlocked scope. Replaces py::gil_scoped_acquire.
class Locked {
private:
    detail::Beside beside_;
    detail::WithoutLock without_;
    py::gil_scoped_acquire acquired_;
};

}  // namespace ricochet::python
