/// \file
/// Checks for Python objects whose __init__ has not run. pybind11 would give their methods uninitialised memory, so
/// they are refused as arguments. Every file that binds or casts one of these classes includes this file.
#pragma once

#include <pybind11/pybind11.h>

#include "python/simulation_handle.h"
#include "ricochet/queries/mesh_queries.h"

namespace ricochet::python {

/// Throws TypeError for an instance of a pybind11 class that has no value yet. Such an instance comes from
/// Class.__new__(Class), or from a derived class whose __init__ uses it before super().__init__().
void require_made(const py::handle& object);

/// Makes the base class of all pybind11 classes (Mesh.__base__) raise a TypeError when an object of it is made. This
/// also applies to classes that users derive from it alone. pybind11 would end the interpreter.
void guard_root_class();

/// Converts arguments to references to T.
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
