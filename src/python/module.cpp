// The module ricochet._core.
#include <cstring>
#include <exception>
#include <utility>

#include "inspect/scene_schema.h"
#include "python/arrays.h"
#include "python/gil.h"
#include "python/help_texts.h"
#include "python/made_objects.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/io/scene.h"

namespace {

namespace py = pybind11;
using namespace ricochet;

/// Python classes of the exceptions. They are never destroyed.
struct ErrorClasses {
    PyObject* input = nullptr;
    PyObject* run = nullptr;
    PyObject* diverged = nullptr;
};
ErrorClasses error_classes;

/// Raises an exception. Messages may contain file names that are not valid UTF-8.
void raise(PyObject* type, const char* what) {
    const auto size = static_cast<py::ssize_t>(std::strlen(what));
    const auto text = py::reinterpret_steal<py::object>(PyUnicode_DecodeUTF8(what, size, "backslashreplace"));
    if (text) PyErr_SetObject(type, text.ptr());
}

void translate(std::exception_ptr error) {
    try {
        if (error) std::rethrow_exception(std::move(error));
    } catch (const DivergedError& diverged) {
        raise(error_classes.diverged, diverged.what());
    } catch (const RunError& run) {
        raise(error_classes.run, run.what());
    } catch (const InputError& input) {
        raise(error_classes.input, input.what());
    }
}

void add_errors(py::module_& module) {
    error_classes.input = py::exception<InputError>(module, "InputError", PyExc_ValueError).release().ptr();
    error_classes.run = py::exception<RunError>(module, "RunError", PyExc_RuntimeError).release().ptr();
    error_classes.diverged = py::exception<DivergedError>(module, "DivergedError", error_classes.run).release().ptr();
    py::register_exception_translator(&translate);
}

}  // namespace

PYBIND11_MODULE(_core, module) {
    module.doc() = "The compiled part of the package ricochet.";
    add_errors(module);
    module.attr("__version__") = RICOCHET_VERSION;
    module.def("set_threads", &python::set_threads, py::arg("threads"),
               "Sets the number of threads for queries and steps, at most 1024; 0 means all of the machine. No result "
               "depends on it.");
    module.def("thread_count", &thread_count, "Returns the number of threads that queries and steps use now.");
    module.def("scene_schema", &scene_schema, "Returns the JSON Schema of scenes, as text.");
    python::guard_root_class();
    python::wait_for_threads_at_exit();
    python::bind_mesh(module);
    python::bind_simulation(module);
    for (const py::object& whole :
         {py::object(module), py::object(module.attr("Mesh")), py::object(module.attr("Simulation"))}) {
        python::write_signatures(whole);
    }
}
