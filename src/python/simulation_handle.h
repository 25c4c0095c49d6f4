/// \file
/// A simulation as Python holds it: stepped while other threads of Python run, its arrays lent without a copy.
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

/// The particles as arrays of Python show them: the simulation's own memory until the simulation changes, which leaves
/// the memory to the arrays and goes on with a copy.
struct LentParticles {
    const Particles* shown = nullptr;
    Particles kept;  ///< after that
};

/// The user's own forces: those that force_of() has made.
using UserForces = std::vector<std::shared_ptr<const ParticlesForce>>;

class SimulationHandle {
public:
    /// forces: besides the scene's. text: a scene; file: its name in messages, to whose folder its
    /// paths are relative.
    SimulationHandle(std::string text, std::string file, std::vector<std::string> overrides, bool keeps_contacts,
                     bool verifies, UserForces forces);
    ~SimulationHandle();
    SimulationHandle(const SimulationHandle&) = delete;
    SimulationHandle& operator=(const SimulationHandle&) = delete;

    /// Calls use(simulation) with the GIL held. RunError while another thread steps it.
    template <class Use>
    auto read(const Use& use) const {
        const Turn turn(*this);
        return use(const_cast<const Simulation&>(*simulation_));
    }
    /// The same for what changes it between steps: lent arrays stay what they are.
    template <class Change>
    auto change(const Change& change) {
        const Turn turn(*this);
        keep_lent();
        return change(*simulation_);
    }
    /// Steps without the GIL, at most `count` steps. Ctrl-C ends it with its exception: after the step that runs, or
    /// before it where it takes long. progress (None or a callable without arguments) is called some ten times a
    /// second, and what it throws ends it too.
    void advance(std::uint64_t count, const py::object& progress);

    [[nodiscard]] std::shared_ptr<LentParticles> lend() const;
    /// The contacts since the last call; RunError without keeps_contacts.
    [[nodiscard]] std::vector<ContactRecord> take_contacts();

    [[nodiscard]] const SceneDescription& scene() const { return scene_; }
    /// Against gravity, of unit length.
    [[nodiscard]] const Vec3& up() const { return up_; }
    [[nodiscard]] const std::string& text() const { return text_; }
    [[nodiscard]] const std::string& file() const { return file_; }
    [[nodiscard]] const std::vector<std::string>& overrides() const { return overrides_; }
    [[nodiscard]] bool keeps_contacts() const { return keeps_contacts_; }
    [[nodiscard]] bool verifies() const { return verifies_; }
    [[nodiscard]] const UserForces& forces() const { return forces_; }
    /// The library's state, and which forces it was made under.
    [[nodiscard]] std::string save() const;
    /// Throws InputError for what save() has not given, or a simulation with other forces has; then nothing has
    /// changed. Then what Simulation::restore() throws.
    void restore(const std::string& bytes);

private:
    /// One thread at a time.
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
    SceneDescription scene_;  ///< without its setup
    UserForces forces_;
    Vec3 up_{0, 0, 1};
    std::unique_ptr<Simulation> simulation_;
    std::vector<ContactRecord> contacts_;
    mutable std::weak_ptr<LentParticles> lent_;
    mutable std::atomic<bool> is_busy_ = false;
};

/// A force that is a function of Python, or a compiled one; its number is for messages. Throws InputError for anything
/// else.
[[nodiscard]] std::shared_ptr<const ParticlesForce> force_of(const py::object& force, std::size_t number);
/// For Python's search for cycles: what force_of() has made keeps a function alive, which may keep the simulation
/// alive.
[[nodiscard]] int visit_functions(const UserForces& forces, visitproc visit, void* arg);
void let_go_of_functions(const UserForces& forces);
void bind_picture(py::class_<SimulationHandle>& type);

}  // namespace ricochet::python
