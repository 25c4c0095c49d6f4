#include "python/simulation_handle.h"

#include <chrono>
#include <cstddef>
#include <cstring>
#include <exception>
#include <span>
#include <utility>

#include "ricochet/core/error.h"

namespace ricochet::python {
namespace {

/// How often a run looks for Ctrl-C and shows how far it is.
constexpr std::chrono::milliseconds kLookAround{100};

/// What goes on between the steps of a run, with the GIL taken back for as long as it takes.
class Watch {
public:
    explicit Watch(const py::object& progress) : progress_(progress) {}

    /// False when the run is to end.
    bool operator()() {
        const auto now = std::chrono::steady_clock::now();
        if (now < next_) return true;
        next_ = now + kLookAround;
        const py::gil_scoped_acquire acquired;
        try {
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
            if (!progress_.is_none()) progress_();
        } catch (...) {
            error_ = std::current_exception();
        }
        return error_ == nullptr;
    }
    void rethrow() const {
        if (error_ != nullptr) std::rethrow_exception(error_);
    }

private:
    const py::object& progress_;
    std::chrono::steady_clock::time_point next_ = std::chrono::steady_clock::now() + kLookAround;
    std::exception_ptr error_;
};

}  // namespace

SimulationHandle::SimulationHandle(std::string text, std::string file, std::vector<std::string> overrides,
                                   bool keeps_contacts, bool verifies, std::vector<ParticlesForceEntry> forces)
    : text_(std::move(text)),
      file_(std::move(file)),
      overrides_(std::move(overrides)),
      keeps_contacts_(keeps_contacts),
      verifies_(verifies),
      scene_(parse_scene(text_, file_, overrides_)) {
    scene_.setup.options.verify = scene_.setup.options.verify || verifies;
    const Vec3 down = uniform_acceleration(scene_.setup);
    if (is_finite(down) && length(down) > 0.0) up_ = -normalized(down);
    for (ParticlesForceEntry& force : forces) scene_.setup.particles_forces.push_back(std::move(force));
    simulation_ = std::make_unique<Simulation>(std::move(scene_.setup));
    if (!keeps_contacts) return;
    simulation_->on_contact([this](std::span<const ContactRecord> records) {
        contacts_.insert(contacts_.end(), records.begin(), records.end());
    });
}

SimulationHandle::~SimulationHandle() {
    try {
        keep_lent();
    } catch (...) {
        (void)simulation_.release();  // without memory for a copy: arrays still show what it holds
    }
}

SimulationHandle::Turn::Turn(const SimulationHandle& handle) : handle_(handle) {
    if (!handle_.is_busy_.exchange(true)) return;
    throw RunError("this simulation is being stepped: it can be asked and changed between its steps only");
}

void SimulationHandle::advance(std::uint64_t count, const py::object& progress) {
    const Turn turn(*this);
    Watch watch(progress);
    {
        const py::gil_scoped_release released;
        keep_lent();
        simulation_->advance(count, [&] { return watch(); });
    }
    watch.rethrow();
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

void SimulationHandle::keep_lent() {
    const std::shared_ptr<LentParticles> lent = lent_.lock();
    if (lent) {
        lent->kept = simulation_->release_particles();
        lent->shown = &lent->kept;
    }
    lent_.reset();
}

std::shared_ptr<LentParticles> SimulationHandle::lend() const {
    const Turn turn(*this);
    std::shared_ptr<LentParticles> lent = lent_.lock();
    if (!lent) {
        lent = std::make_shared<LentParticles>();
        lent->shown = &simulation_->particles();
        lent_ = lent;
    }
    return lent;
}

std::vector<ContactRecord> SimulationHandle::take_contacts() {
    const Turn turn(*this);
    if (!keeps_contacts_) throw InputError("take_contacts: contacts are kept by Simulation(..., contacts=True)");
    return std::exchange(contacts_, {});
}

std::string SimulationHandle::save() const {
    return read([](const Simulation& simulation) {
        std::string bytes;
        simulation.save([&](std::span<const std::byte> part) {
            bytes.append(reinterpret_cast<const char*>(part.data()), part.size());
        });
        return bytes;
    });
}

void SimulationHandle::restore(const std::string& bytes) {
    change([&](Simulation& simulation) {
        std::span<const char> rest(bytes);
        simulation.restore([&](std::span<std::byte> part) {
            if (part.size() > rest.size()) throw InputError("the saved state ends too early");
            std::memcpy(part.data(), rest.data(), part.size());
            rest = rest.subspan(part.size());
        });
    });
}

}  // namespace ricochet::python
