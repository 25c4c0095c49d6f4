/// \file
/// A simulation that Python owns. It makes steps while other Python threads run. Python arrays can refer to its memory
/// without a copy.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/io/scene.h"
#include "ricochet/simulation.h"

namespace ricochet::python {

namespace py = pybind11;

/// Particles that Python arrays refer to. They are in the simulation's own memory until the simulation changes. The
/// arrays then keep this memory, and the simulation continues with a copy.
struct LentParticles {
    const Particles* shown = nullptr;
    Particles kept;  ///< memory of the arrays after the simulation has changed
};

/// Forces that the user has written; force_of() creates them.
using UserForces = std::vector<std::shared_ptr<const ParticlesForce>>;

class SimulationHandle {
public:
    /// text: text of a scene. file: file name in messages; paths in the scene are relative to this file's folder.
    /// forces: forces in addition to those in the scene.
    SimulationHandle(std::string text, std::string file, std::vector<std::string> overrides, bool keeps_contacts,
                     bool verifies, UserForces forces);
    ~SimulationHandle();
    SimulationHandle(const SimulationHandle&) = delete;
    SimulationHandle& operator=(const SimulationHandle&) = delete;

    /// Calls use(simulation) with the GIL held. Throws RunError while another thread steps the simulation.
    template <class Use>
    auto read(const Use& use) const {
        const Turn turn(*this);
        return use(const_cast<const Simulation&>(*simulation_));
    }
    /// Calls change(simulation), which may change the simulation between steps. Arrays that refer to its particles keep
    /// their values.
    template <class Change>
    auto change(const Change& change) {
        const Turn turn(*this);
        keep_lent();
        return change(*simulation_);
    }
    /// Makes at most `count` steps without the GIL. Ctrl-C ends the call with an exception, after the current step, or
    /// within the step if it takes long. progress is None or a callable without arguments. It is called about ten times
    /// a second. An exception of progress also ends the call.
    void advance(std::uint64_t count, const py::object& progress);

    [[nodiscard]] std::shared_ptr<LentParticles> share_particles() const;
    /// Returns the contacts since the last call. Throws InputError if keeps_contacts is false.
    [[nodiscard]] std::vector<ContactRecord> take_contacts();

    [[nodiscard]] const SceneDescription& scene() const { return scene_; }
    /// Returns the direction against gravity, of unit length.
    [[nodiscard]] const Vec3& up() const { return up_; }
    [[nodiscard]] const std::string& text() const { return text_; }
    [[nodiscard]] const std::string& file() const { return file_; }
    [[nodiscard]] const std::vector<std::string>& overrides() const { return overrides_; }
    [[nodiscard]] bool keeps_contacts() const { return keeps_contacts_; }
    [[nodiscard]] bool verifies() const { return verifies_; }
    [[nodiscard]] const UserForces& forces() const { return forces_; }
    /// Returns the bytes of Simulation::save(), together with the names of the forces.
    [[nodiscard]] std::string save() const;
    /// Restores a state. Throws InputError if the bytes are not from save(), or if the saved simulation had other
    /// forces. In these cases nothing has changed. Otherwise throws like Simulation::restore().
    void restore(const std::string& bytes);

private:
    /// Scope in which one thread uses the simulation exclusively. Throws RunError if another thread uses it.
    class Turn {
    public:
        explicit Turn(const SimulationHandle& handle);
        ~Turn() { handle_.is_busy_ = false; }
        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;

    private:
        const SimulationHandle& handle_;
    };

    void keep_lent();
    [[nodiscard]] std::string forces_named() const;

    std::string text_;
    std::string file_;
    std::vector<std::string> overrides_;
    bool keeps_contacts_;
    bool verifies_;
    SceneDescription scene_;  ///< the setup was moved into the simulation
    UserForces forces_;
    Vec3 up_{0, 0, 1};
    std::unique_ptr<Simulation> simulation_;
    std::vector<ContactRecord> contacts_;
    mutable std::weak_ptr<LentParticles> lent_;
    mutable std::atomic<bool> is_busy_ = false;
};

/// Returns the force of a Python function or of a compiled function. number: index of the force in messages. Throws
/// InputError for other objects.
[[nodiscard]] std::shared_ptr<const ParticlesForce> force_of(const py::object& force, std::size_t number);
/// Visits the functions of forces for Python's garbage collector. A force keeps its function alive, and the function
/// may keep the simulation alive. This would be an undetected cycle.
[[nodiscard]] int visit_functions(const UserForces& forces, visitproc visit, void* arg);
void release_functions(const UserForces& forces);
void bind_picture(py::class_<SimulationHandle>& type);

}  // namespace ricochet::python
