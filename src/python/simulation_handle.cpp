#include "python/simulation_handle.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <exception>
#include <span>
#include <thread>
#include <utility>

#include "python/ctrl_c.h"
#include "python/gil.h"
#include "python/scene_forces.h"
#include "ricochet/core/binary_archive.h"
#include "ricochet/core/error.h"
#include "ricochet/core/hash.h"
#include "ricochet/core/printable.h"

namespace ricochet::python {
namespace {

/// Interval at which a run checks for Ctrl-C and shows its progress.
constexpr std::chrono::milliseconds kLookAround{100};

/// Time that a step may continue after Ctrl-C before it is abandoned.
constexpr std::chrono::milliseconds kPatience{250};

constexpr const char* kBallisticWarning =
    "forces: with them the integrator ballistic moves all particles like velocity_verlet; set simulation.integrator to "
    "\"velocity_verlet\" or another one";

/// First word of every saved state. Its last digit is the version of the layout.
constexpr std::uint64_t kSavedFormat = 0x5249434f50590001ULL;

/// A saved state.
struct Saved {
    std::uint64_t scene_forces = 0;
    std::string forces;  ///< names of the user's forces
    std::string state;   ///< state from Simulation::save(), which ends with a checksum
};

/// Returns a source that reads from `rest` and removes the read bytes. The source throws InputError if too few bytes
/// are left.
ByteSource source_of(std::span<const char>& rest) {
    return [&rest](std::span<std::byte> part) {
        if (part.size() > rest.size()) throw InputError("restore: the saved state ends too early");
        std::memcpy(part.data(), rest.data(), part.size());
        rest = rest.subspan(part.size());
    };
}

bool is_whole(const std::string& state) {
    std::uint64_t checksum = 0;
    if (state.size() < sizeof(checksum)) return false;
    const std::size_t size = state.size() - sizeof(checksum);
    std::memcpy(&checksum, state.data() + size, sizeof(checksum));
    StateHash hash;
    hash.add(std::as_bytes(std::span(state.data(), size)));
    return hash.value() == checksum;
}

/// Reads a saved state. Makes all checks that are possible without changing a simulation.
Saved saved_in(const std::string& bytes) {
    std::span<const char> rest(bytes);
    BinaryReader reader(source_of(rest));
    std::uint64_t format = 0;
    if (bytes.size() >= sizeof(format)) reader(format);
    if (format != kSavedFormat) {
        throw InputError("restore: found other bytes, expected the result of save() of this version");
    }
    Saved saved;
    reader(saved.scene_forces);
    reader(saved.forces);
    reader(saved.state);
    if (!rest.empty()) {
        throw InputError(fmt::format(
            "restore: found {} bytes behind the end of the state, expected the bytes of one save()", rest.size()));
    }
    if (!is_whole(saved.state)) throw InputError("restore: the state is damaged: its checksum is wrong");
    return saved;
}

/// Checks for Ctrl-C and shows progress during a run. Holds the GIL only during a check. Only the thread that created
/// the Watch makes checks.
class Watch {
public:
    explicit Watch(const py::object& progress) : progress_(progress) {}

    /// Returns false if the run must end. Any thread may call it, between steps.
    [[nodiscard]] bool goes_on() {
        stay_if_ending();
        look();
        return !has_error_;
    }
    /// Returns false if the run must end, and kPatience has passed since the check that decided this. Any thread may
    /// call it, within a step.
    [[nodiscard]] bool goes_on_within() {
        look();
        return !has_error_ || Clock::now() < latest_;
    }
    void rethrow() const {
        if (error_ != nullptr) std::rethrow_exception(error_);
    }

private:
    using Clock = std::chrono::steady_clock;

    void look() {
        if (has_error_ || std::this_thread::get_id() != thread_ || Clock::now() < next_) return;
        next_ = Clock::now() + kLookAround;
        const Locked locked;
        try {
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
            if (!progress_.is_none()) progress_();
        } catch (...) {
            error_ = std::current_exception();
            latest_ = Clock::now() + kPatience;
            has_error_ = true;
        }
    }

    const py::object& progress_;
    std::thread::id thread_ = std::this_thread::get_id();
    Clock::time_point next_ = Clock::now() + kLookAround;
    Clock::time_point latest_;  // time by which the step must end; set before has_error_
    std::exception_ptr error_;
    std::atomic<bool> has_error_ = false;
};

/// Largest number of particles that a single thread moves. A single step then needs no separate thread that checks for
/// Ctrl-C.
constexpr std::size_t kFewParticles = 256;

}  // namespace

SimulationHandle::SimulationHandle(std::string text, std::string file, std::vector<std::string> overrides,
                                   bool keeps_contacts, bool verifies, UserForces forces)
    : text_(std::move(text)),
      file_(std::move(file)),
      overrides_(std::move(overrides)),
      keeps_contacts_(keeps_contacts),
      verifies_(verifies),
      scene_(parse_scene(text_, file_, overrides_)),
      forces_(std::move(forces)) {
    scene_.setup.options.verify = scene_.setup.options.verify || verifies;
    const Vec3 down = uniform_acceleration(scene_.setup);
    if (is_finite(down) && length(down) > 0.0) up_ = -normalized(down);
    // Removes the warning that no particle will move, because particles can be added later.
    std::erase_if(scene_.warnings, [](const std::string& warning) { return warning.ends_with("nothing will move"); });
    if (!forces_.empty() && scene_.setup.options.integrator.kind == IntegratorKind::ballistic) {
        scene_.warnings.emplace_back(kBallisticWarning);
    }
    for (const auto& force : forces_) scene_.setup.particles_forces.push_back({force});
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
        (void)simulation_.release();  // out of memory for a copy, so the simulation is leaked and the arrays stay valid
    }
}

SimulationHandle::Turn::Turn(const SimulationHandle& handle) : handle_(handle) {
    if (!handle_.is_busy_.exchange(true)) return;
    throw RunError("this simulation is being stepped: it can be read and changed only between its steps");
}

void SimulationHandle::advance(std::uint64_t count, const py::object& progress) {
    const Turn turn(*this);
    Watch watch(progress);
    {
        const Unlocked unlocked;
        keep_lent();
        const auto advance = [&] {
            try {
                simulation_->advance(
                    count, [&] { return watch.goes_on(); }, [&] { return watch.goes_on_within(); });
            } catch (const StoppedError&) {  // watch.rethrow() throws the reason
            }
        };
        // Longer work runs on a separate thread, because this thread must check for Ctrl-C and must not wait in
        // parallel loops.
        const bool is_short = count == 1 && simulation_->particles().size() <= kFewParticles;
        is_short ? advance() : run_beside(advance, kLookAround, [&] { (void)watch.goes_on(); });
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

std::shared_ptr<LentParticles> SimulationHandle::share_particles() const {
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

std::string SimulationHandle::forces_named() const {
    std::string names;
    for (const auto& force : forces_) names += (names.empty() ? "" : ", ") + force->name();
    return names.empty() ? "none" : names;
}

std::string SimulationHandle::save() const {
    std::string bytes;
    const ByteSink sink = [&](std::span<const std::byte> part) {
        bytes.append(reinterpret_cast<const char*>(part.data()), part.size());
    };
    Saved saved{forces_fingerprint(text_, overrides_), forces_named(), {}};
    read([&](const Simulation& simulation) { simulation.save(sink); });
    saved.state.swap(bytes);
    BinaryWriter writer(sink);
    writer(kSavedFormat);
    writer(saved.scene_forces);
    writer(saved.forces);
    writer(saved.state);
    return bytes;
}

void SimulationHandle::restore(const std::string& bytes) {
    const Saved saved = saved_in(bytes);
    if (saved.forces != forces_named()) {
        throw InputError(
            fmt::format("restore: found a state made under the forces {}, expected one under this "
                        "simulation's own: {}",
                        printable(saved.forces, 200), forces_named()));
    }
    if (saved.scene_forces != forces_fingerprint(text_, overrides_)) {
        throw InputError(
            "restore: found a state made under other forces or flows of the scene, expected the ones of this "
            "simulation");
    }
    change([&](Simulation& simulation) {
        std::span<const char> rest(saved.state);
        simulation.restore(source_of(rest));
    });
}

}  // namespace ricochet::python
