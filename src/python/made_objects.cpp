#include "python/made_objects.h"

#include <fmt/format.h>

#include <string>

namespace ricochet::python {
namespace {

PyObject* new_object(PyTypeObject* type, PyObject* arguments, PyObject* keys) {
    if (!py::detail::all_type_info(type).empty()) return py::detail::pybind11_object_new(type, arguments, keys);
    PyErr_Format(PyExc_TypeError, "%s: objects of this class cannot be made", type->tp_name);
    return nullptr;
}

}  // namespace

void guard_root_class() {
    auto* const root = reinterpret_cast<PyTypeObject*>(py::detail::get_internals().instance_base);
    root->tp_new = &new_object;
    PyType_Modified(root);
}

void require_made(const py::handle& object) {
    auto* const root = reinterpret_cast<PyTypeObject*>(py::detail::get_internals().instance_base);
    if (!object || PyType_IsSubtype(Py_TYPE(object.ptr()), root) == 0) return;
    auto* const instance = reinterpret_cast<py::detail::instance*>(object.ptr());
    for (auto& part : py::detail::values_and_holders(instance)) {
        if (part.value_ptr() != nullptr) continue;
        throw py::type_error(fmt::format("{}: this object has not been made: its __init__() has not run, or has failed",
                                         std::string(py::str(py::type::handle_of(object).attr("__name__")))));
    }
}

}  // namespace ricochet::python
