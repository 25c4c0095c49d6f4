/// \file
/// Objects of Python whose __init__ has not run. pybind11 would give their methods memory that holds nothing: they are
/// refused wherever they are handed in. Every file that binds or casts one of these classes includes this one.
#pragma once

#include <pybind11/pybind11.h>

#include "python/simulation_handle.h"
#include "ricochet/queries/mesh_queries.h"

namespace ricochet::python {

/// Throws TypeError for an instance of a class of pybind11's that has no value yet: one of Class.__new__(Class), or of
/// a class derived from it whose __init__ uses it before super().__init__().
void require_made(const py::handle& object);

/// Lets the class that all classes of pybind11 derive from (Mesh.__base__), and what users derive from it alone, refuse
/// to make objects with a TypeError: pybind11 ends the interpreter.
void guard_root_class();

/// How arguments become references to T.
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
