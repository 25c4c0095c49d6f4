// Forces of the user's: on all particles at once, by a function of Python or by a compiled one.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "python/arrays.h"
#include "python/simulation_handle.h"
#include "ricochet/core/error.h"

namespace ricochet::python {
namespace {

/// Adds forces, N, as accelerations.
void add(std::span<const Vec3> forces, const ParticlesView& particles, std::span<Vec3> result) {
    for (std::size_t i = 0; i < forces.size(); ++i) {
        if (!is_finite(forces[i])) {
            throw InputError(fmt::format("force on particle {}: found [{}, {}, {}], expected finite numbers",
                                         particles.ids[i], forces[i].x, forces[i].y, forces[i].z));
        }
        result[i] += forces[i] / particles.masses[i];
    }
}

template <class T>
py::array copied(std::span<const T> list) {
    return given(std::vector<T>(list.begin(), list.end()));
}

/// Arrays in, an array of forces out. It may keep what it is given: those are copies.
class PythonForce : public ParticlesForce {
public:
    explicit PythonForce(py::object function) : function_(std::move(function)) {}

    void add_accelerations(const ParticlesView& particles, std::span<Vec3> result) const override {
        const py::gil_scoped_acquire acquired;
        const py::object view =
            py::module_::import("ricochet._results")
                .attr("ForceInput")(particles.time, copied(particles.ids), copied(particles.positions),
                                    copied(particles.velocities), copied(particles.masses), copied(particles.radii));
        const Doubles forces = numbers(function_(view), "force", 3);
        require_same_length(static_cast<std::size_t>(forces.shape(0)), particles.size(), "force");
        add(points(forces), particles, result);
    }
    [[nodiscard]] std::optional<double> potential_energy(const ParticlesView&) const override { return std::nullopt; }

private:
    py::object function_;
};

/// The address of a function that ricochet.compiled_force() has made, called without the GIL.
class CompiledForce : public ParticlesForce {
public:
    using Function = void (*)(double time, std::int64_t count, const double* position, const double* velocity,
                              const double* mass, const double* radius, double* force);

    CompiledForce(std::uintptr_t address, py::object owner)
        : function_(reinterpret_cast<Function>(address)), owner_(std::move(owner)) {}

    void add_accelerations(const ParticlesView& particles, std::span<Vec3> result) const override {
        std::vector<Vec3> forces(particles.size());
        function_(particles.time, static_cast<std::int64_t>(particles.size()),
                  reinterpret_cast<const double*>(particles.positions.data()),
                  reinterpret_cast<const double*>(particles.velocities.data()), particles.masses.data(),
                  particles.radii.data(), reinterpret_cast<double*>(forces.data()));
        add(forces, particles, result);
    }
    [[nodiscard]] std::optional<double> potential_energy(const ParticlesView&) const override { return std::nullopt; }

private:
    Function function_;
    py::object owner_;
};

}  // namespace

std::shared_ptr<const ParticlesForce> force_of(const py::object& force) {
    const py::object compiled = py::module_::import("ricochet._forces").attr("CompiledForce");
    if (py::isinstance(force, compiled)) {
        return std::make_shared<CompiledForce>(force.attr("address").cast<std::uintptr_t>(), force);
    }
    if (PyCallable_Check(force.ptr()) == 0) {
        throw InputError(fmt::format("forces: found {}, expected functions",
                                     std::string(py::str(py::type::of(force).attr("__name__")))));
    }
    return std::make_shared<PythonForce>(force);
}

}  // namespace ricochet::python
