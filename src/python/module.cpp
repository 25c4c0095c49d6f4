// The module ricochet._core.
#include "python/arrays.h"
#include "python/made_objects.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/io/scene.h"

PYBIND11_MODULE(_core, module) {
    namespace py = pybind11;
    using namespace ricochet;
    module.doc() = "The compiled part of the package ricochet.";
    // What is registered later is asked first.
    py::register_exception<InputError>(module, "InputError", PyExc_ValueError);
    const auto run_error = py::register_exception<RunError>(module, "RunError", PyExc_RuntimeError);
    py::register_exception<DivergedError>(module, "DivergedError", run_error.ptr());
    module.attr("__version__") = RICOCHET_VERSION;
    module.def("set_threads", &python::set_threads, py::arg("threads"),
               "Let questions and steps use so many threads; 0 is all that the machine has. No result depends on it.");
    module.def("thread_count", &thread_count, "How many threads questions and steps use now.");
    module.def("scene_schema", &scene_schema, "The JSON Schema of scenes, as text.");
    python::guard_root_class();
    python::bind_mesh(module);
    python::bind_simulation(module);
}
