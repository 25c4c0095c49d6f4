/// \file
/// Checks for Python objects whose __init__ has not run. pybind11 would pass uninitialised memory to their methods.
/// Such objects are therefore refused as arguments. Every file that binds or casts one of these classes includes this
/// file.
#pragma once

#include <pybind11/pybind11.h>

#include "python/simulation_handle.h"
#include "ricochet/queries/mesh_queries.h"

namespace ricochet::python {

/// Throws TypeError for an instance of a pybind11 class that contains no C++ object yet. Class.__new__(Class) returns
/// such an instance. In a derived class, `self` is such an instance until super().__init__() was called.
void require_made(const py::handle& object);

/// Makes the base class of all pybind11 classes (Mesh.__base__) raise a TypeError when it is instantiated. The same
/// holds for classes that users derive only from this base class. Otherwise pybind11 would terminate the interpreter.
void guard_root_class();

/// Converts arguments to references to T, and calls require_made() first.
template <class T>
class MadeCaster : public py::detail::type_caster_base<T> {
public:
    bool load(const py::handle& source, bool convert) {
        require_made(source);
        return py::detail::type_caster_base<T>::load(source, convert);
    }
};

}  // namespace ricochet::python

namespace pybind11::detail {

template <>
class type_caster<ricochet::MeshQueries> : public ricochet::python::MadeCaster<ricochet::MeshQueries> {};
template <>
class type_caster<ricochet::python::SimulationHandle>
    : public ricochet::python::MadeCaster<ricochet::python::SimulationHandle> {};

}  // namespace pybind11::detail
