/// \file
/// Texts of compiled functions for help() and inspect.signature().
#pragma once

#include <pybind11/pybind11.h>

#include <utility>

namespace ricochet::python {

namespace py = pybind11;

/// Wrapper type for each class of ricochet._results, so that signatures show the name of the class.
template <class Name>
struct ResultObject : py::object {
    ResultObject() = default;
    ResultObject(py::object made) : py::object(std::move(made)) {}  // NOLINT(google-explicit-constructor)
};
struct HitsName {};
struct AllHitsName {};
struct ContactsName {};
struct TriangleTotalsName {};
struct MeshName {};
using HitsObject = ResultObject<HitsName>;
using AllHitsObject = ResultObject<AllHitsName>;
using ContactsObject = ResultObject<ContactsName>;
using TriangleTotalsObject = ResultObject<TriangleTotalsName>;
using MeshObject = ResultObject<MeshName>;

/// Rewrites the texts of the functions in a class or a module. pybind11 writes the signature into the first line, which
/// Python treats as ordinary text. The new text has the signature in Python's form. It ends with the type of the result
/// and the fields of named tuples. Call this function once for each class and module, after its last function was
/// defined.
void write_signatures(const py::object& class_or_module);

}  // namespace ricochet::python

namespace pybind11::detail {

template <>
struct handle_type_name<ricochet::python::HitsObject> {
    static constexpr auto name = const_name("ricochet.Hits");
};
template <>
struct handle_type_name<ricochet::python::AllHitsObject> {
    static constexpr auto name = const_name("ricochet.AllHits");
};
template <>
struct handle_type_name<ricochet::python::ContactsObject> {
    static constexpr auto name = const_name("ricochet.Contacts");
};
template <>
struct handle_type_name<ricochet::python::TriangleTotalsObject> {
    static constexpr auto name = const_name("ricochet.TriangleTotals");
};
template <>
struct handle_type_name<ricochet::python::MeshObject> {
    static constexpr auto name = const_name("ricochet.Mesh");
};

}  // namespace pybind11::detail
