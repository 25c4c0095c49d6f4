/// \file
/// Scopes that release and acquire Python's global interpreter lock (GIL). They are safe while the interpreter ends. At
/// that time Python terminates a thread that asks for the GIL, which C++ code on the thread's stack cannot handle.
/// These scopes make such a thread wait forever instead.
#pragma once

#include <pybind11/pybind11.h>

namespace ricochet::python {

namespace py = pybind11;

/// Registers a function that Python calls when the interpreter ends. The function waits for the threads that run code
/// of this module, for two seconds at most. Running steps end meanwhile.
void wait_for_threads_at_exit();

/// Returns immediately, unless the interpreter is ending. In that case it never returns. Threads that run for a long
/// time without the GIL call it regularly.
void stay_if_ending();

namespace detail {

/// Scope in which a thread counts as busy with code of this module. The exit of the interpreter waits for such threads.
/// The code is C++ code without the GIL, or Python code that such C++ code has called.
class Beside {
public:
    Beside();
    ~Beside();
    Beside(const Beside&) = delete;
    Beside& operator=(const Beside&) = delete;
};

/// Scope of a thread without the GIL. Calls stay_if_ending() after the GIL was released and before it is acquired.
class WithoutLock {
public:
    WithoutLock() { stay_if_ending(); }
    ~WithoutLock() { stay_if_ending(); }
    WithoutLock(const WithoutLock&) = delete;
    WithoutLock& operator=(const WithoutLock&) = delete;
};

}  // namespace detail

/// Scope without the GIL. Replaces py::gil_scoped_release.
class Unlocked {
private:
    detail::Beside beside_;
    py::gil_scoped_release released_;
    detail::WithoutLock without_;
};

/// Scope that acquires the GIL again inside an Unlocked scope. Replaces py::gil_scoped_acquire.
class Locked {
private:
    detail::Beside beside_;
    detail::WithoutLock without_;
    py::gil_scoped_acquire acquired_;
};

}  // namespace ricochet::python
