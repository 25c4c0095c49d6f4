// Forces that users write as a Python function or as a compiled function. One call computes the forces on all
// particles.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "python/arrays.h"
#include "python/gil.h"
#include "python/simulation_handle.h"
#include "ricochet/core/error.h"
#include "ricochet/core/printable.h"

namespace ricochet::python {
namespace {

/// Returns the name of a force in messages. It contains the index in `forces`, and the name of the function or the type
/// of the callable object.
std::string name_of(const py::object& function, std::size_t number) {
    py::object name = py::getattr(function, "__name__", py::none());
    if (!py::isinstance<py::str>(name)) name = py::type::of(function).attr("__name__");
    return fmt::format("forces[{}] ({})", number, printable(std::string(py::str(name)), 100));
}

template <class T>
py::array copied(std::span<const T> list) {
    py::array array = given(std::vector<T>(list.begin(), list.end()));
    array.attr("flags").attr("writeable") = false;
    return array;
}

/// Common part of both kinds of forces.
class UserForce : public ParticlesForce {
public:
    UserForce(py::object function, std::string name) : function_(std::move(function)), name_(std::move(name)) {}

    [[nodiscard]] std::optional<double> potential_energy(const ParticlesView&) const override { return std::nullopt; }
    [[nodiscard]] std::string name() const override { return name_; }
    void let_go() const { function_ = py::none(); }

    [[nodiscard]] const py::object& function() const { return function_; }

protected:
    /// Divides forces, in N, by the masses, and adds the accelerations to the result.
    void add(std::span<const Vec3> forces, const ParticlesView& particles, std::span<Vec3> result) const {
        for (std::size_t i = 0; i < forces.size(); ++i) {
            const Vec3 acceleration = forces[i] / particles.masses[i];
            if (!is_finite(acceleration)) refuse(forces[i], particles, i);
            result[i] += acceleration;
        }
    }

private:
    [[noreturn]] void refuse(const Vec3& force, const ParticlesView& particles, std::size_t i) const {
        throw InputError(fmt::format(
            "{}: found [{}, {}, {}] N on particle {} of {} kg at {} s, expected numbers that make finite accelerations",
            name_, force.x, force.y, force.z, particles.ids[i], particles.masses[i], particles.time));
    }

    mutable py::object function_;
    std::string name_;
};

/// Force of a Python function. The function gets arrays and returns an array of forces. It may store its input, because
/// the arrays are copies.
class PythonForce : public UserForce {
public:
    using UserForce::UserForce;

    void add_accelerations(const ParticlesView& particles, std::span<Vec3> result) const override {
        const Locked locked;
        const py::object view =
            py::module_::import("ricochet._results")
                .attr("ForceInput")(particles.time, copied(particles.ids), copied(particles.positions),
                                    copied(particles.velocities), copied(particles.masses), copied(particles.radii));
        const Doubles forces = numbers(function()(view), name().c_str(), 3);
        require_same_length(static_cast<std::size_t>(forces.shape(0)), particles.size(), name().c_str());
        add(points(forces), particles, result);
    }
};

/// Force made by ricochet.compiled_force(), called without the GIL.
class CompiledForce : public UserForce {
public:
    /// Compiled function. Returns 0 if the user's function has raised an exception.
    using Function = std::int32_t (*)(double time, std::int64_t count, const double* position, const double* velocity,
                                      const double* mass, const double* radius, double* force);

    CompiledForce(py::object compiled, std::string name)
        : UserForce(std::move(compiled), std::move(name)),
          call_(reinterpret_cast<Function>(function().attr("address").cast<std::uintptr_t>())) {}

    void add_accelerations(const ParticlesView& particles, std::span<Vec3> result) const override {
        std::vector<Vec3> forces(particles.size());
        const std::int32_t is_done =
            call_(particles.time, static_cast<std::int64_t>(particles.size()),
                  reinterpret_cast<const double*>(particles.positions.data()),
                  reinterpret_cast<const double*>(particles.velocities.data()), particles.masses.data(),
                  particles.radii.data(), reinterpret_cast<double*>(forces.data()));
        if (is_done == 0) raise_again(particles);
        add(forces, particles, result);
    }

private:
    /// Raises the exception of the user's function. Compiled code cannot return the exception, so this function repeats
    /// the same call from Python.
    [[noreturn]] void raise_again(const ParticlesView& particles) const {
        const Locked locked;
        function().attr("_call")(particles.time, copied(particles.positions), copied(particles.velocities),
                                 copied(particles.masses), copied(particles.radii));
        throw RunError(
            fmt::format("{}: it raised an exception at {} s, but not when it was called again: forces "
                        "must be pure",
                        name(), particles.time));
    }

    Function call_;
};

const UserForce& user_force(const std::shared_ptr<const ParticlesForce>& force) {
    return static_cast<const UserForce&>(*force);
}

}  // namespace

int visit_functions(const UserForces& forces, visitproc visit, void* arg) {
    for (const auto& force : forces) Py_VISIT(user_force(force).function().ptr());
    return 0;
}

void release_functions(const UserForces& forces) {
    for (const auto& force : forces) user_force(force).let_go();
}

std::shared_ptr<const ParticlesForce> force_of(const py::object& force, std::size_t number) {
    const py::object compiled = py::module_::import("ricochet._forces").attr("CompiledForce");
    if (py::isinstance(force, compiled)) {
        if (!py::hasattr(force, "_callback")) {
            throw py::type_error(
                fmt::format("forces[{}]: CompiledForce: this object has not been made: use compiled_force()", number));
        }
        return std::make_shared<CompiledForce>(force, name_of(force.attr("function"), number));
    }
    if (PyCallable_Check(force.ptr()) == 0) {
        throw InputError(fmt::format("forces[{}]: found {}, expected a function", number,
                                     std::string(py::str(py::type::of(force).attr("__name__")))));
    }
    return std::make_shared<PythonForce>(force, name_of(force, number));
}

}  // namespace ricochet::python
