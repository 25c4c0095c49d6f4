#include "ricochet/simulation/memory_estimate.h"

#include <fmt/format.h>

#include <string>
#include <variant>

#include "ricochet/core/error.h"
#include "ricochet/core/memory_limit.h"

namespace ricochet {
namespace {

// Sizes in bytes, measured with a million particles and meshes of two million triangles. Local: only for the estimate.
constexpr double kProgram = 12e6;             // libraries and threads
constexpr double kParticle = 380.0;           // a particle in the arrays, in two frames, and as a value at its birth
constexpr double kAttributeComponent = 32.0;  // a component of an attribute, stored like the particle
constexpr double kChildLists = 400.0;         // with children, per particle: its origin, and the lists of its children
constexpr double kCloudParticle = 300.0;      // with clouds, per particle: its parent, and the path of a parent
constexpr double kClearSpace = 96.0;          // per particle under varying forces: the free space around it
constexpr double kSide = 16.0;                // per particle and collider: state of penalty and similar responses
constexpr double kVerifiedParticle = 90.0;    // a particle with options.verify
constexpr double kCollidingSphere = 1500.0;   // per colliding sphere: boxes, pairs, islands and contacts, by counting
constexpr double kTriangle = 456.0;           // a triangle and its search structures, during construction
constexpr double kVerifiedTriangle = 160.0;   // a triangle with options.verify
constexpr double kContact = 412.0;            // a contact record, and its row in the log
constexpr double kMemoryEstimateMostContacts = 500'000.0;  // most buffered log rows, without the rows of one step
constexpr double kJoinedParticle = 800.0;    // like kParticle, with the data from which its rope or cloth is built
constexpr double kSpring = 200.0;            // a spring, with the data from which it is built
constexpr double kLoadedTriangle = 238.0;    // like kTriangle, after the mesh has been read
constexpr double kCoupledParticle = 900.0;   // with forces between particles, per particle: its plan and force lists
constexpr double kImplicitParticle = 390.0;  // a particle in the matrix of implicit_euler
constexpr double kImplicitSpring = 1200.0;   // a spring in the matrix of implicit_euler and in its factors

double mean_of(const MeanSpread& pair) { return std::max(0.0, pair.mean); }

double triangles_of(const ColliderShape& shape) {
    const auto* const mesh = std::get_if<MeshShape>(&shape);
    return mesh != nullptr && mesh->mesh ? static_cast<double>(mesh->mesh->triangles.size()) : 0.0;
}

/// Returns the bytes of one copy of the positions of a deforming mesh.
double positions_of(const ColliderShape& shape) {
    const auto* const mesh = std::get_if<MeshShape>(&shape);
    return mesh != nullptr && mesh->motion ? static_cast<double>(mesh->motion->memory_bytes()) : 0.0;
}

/// Returns the bytes of the estimate that the setup already contains, or that its construction has needed.
double bytes_taken(const SimulationSetup& setup) {
    constexpr double kStillToCome = kParticle - static_cast<double>(sizeof(Particle));
    const double particles = static_cast<double>(setup.particles.size());
    double bytes = particles * ((setup.springs.empty() ? kParticle : kJoinedParticle) - kStillToCome);
    bytes += static_cast<double>(setup.springs.size()) * (kSpring - static_cast<double>(sizeof(Spring)));
    for (const ColliderDescription& collider : setup.colliders) {
        bytes += triangles_of(collider.shape) * (kTriangle - kLoadedTriangle) + positions_of(collider.shape);
    }
    return kProgram + bytes;
}

/// Returns true if something can remove particles before the end of their lifetime.
bool may_retire_early(const SimulationSetup& setup) {
    return setup.bounds.has_value() ||
           std::ranges::any_of(setup.materials, [](const Material& material) { return material.absorption > 0.0; }) ||
           std::ranges::any_of(setup.emitters, [](const EmitterDescription& emitter) {
               return emitter.parent && emitter.parent->share;
           });
}

/// Returns the mean number of particles per second.
double rate_of(const EmitterDescription& emitter, const SimulationSetup& setup) {
    double per_frame = mean_of(emitter.rate_per_frame);
    if (mean_of(emitter.rate_per_area) > 0.0 && setup.reference_camera) {
        per_frame += mean_of(emitter.rate_per_area) * screen_area(emitter.shape, *setup.reference_camera);
    }
    return mean_of(emitter.rate) + per_frame * setup.options.frame_rate;
}

/// Returns the number of an emitter's particles that certainly live at once; 0 for children, whose number is unknown.
double sure_population(const EmitterDescription& emitter, const SimulationSetup& setup) {
    const SimulationOptions& options = setup.options;
    if (emitter.parent || !(emitter.start < options.duration)) return 0.0;
    const double time = std::max(0.0, std::min(options.duration, emitter.stop) - emitter.start);
    const double life = may_retire_early(setup) ? options.time_step : emitter.lifetime.expected();
    const double rate = rate_of(emitter, setup);
    // With a rate curve, the particles born last certainly live at once.
    const double end = emitter.start + time;
    const double by_rate = rate > 0.0 ? rate * std::min(time, life)
                                      : births_of_curve(emitter.rate_curve, std::max(emitter.start, end - life), end);
    return std::min(static_cast<double>(emitter.burst) + by_rate, static_cast<double>(emitter.limit));
}

double columns_of(const SimulationSetup& setup) {
    double columns = 0.0;
    for (const AttributeDescription& attribute : setup.attributes) columns += attribute.components;
    return columns;
}

/// Collects the memory needs of a setup.
class Estimator {
public:
    explicit Estimator(const SimulationSetup& setup)
        : setup_(setup),
          per_particle_(bytes_per_particle(setup)),
          room_(static_cast<double>(setup.options.most_particles)) {}

    MemoryEstimate estimate() {
        add_explicit();
        for (std::size_t k = 0; k < setup_.emitters.size(); ++k) {
            add_particles({MemoryNeed::Part::emitter, k}, sure_population(setup_.emitters[k], setup_));
        }
        add_colliders();
        if (setup_.options.record_contacts) {
            const double living = static_cast<double>(setup_.options.most_particles) - room_;
            add({MemoryNeed::Part::contacts}, std::min(living, kMemoryEstimateMostContacts), kContact);
        }
        return std::move(estimate_);
    }

private:
    void add(MemoryNeed need, double count, double bytes_each) {
        if (!(count >= 1.0)) return;
        need.count = static_cast<std::uint64_t>(count);
        need.bytes = count * bytes_each;
        estimate_.needs.push_back(need);
    }

    // Limits the living particles to the allowed number.
    void add_particles(const MemoryNeed& need, double count) {
        const double living = std::min(count, room_);
        room_ -= living;
        add(need, living, per_particle_);
    }

    void add_explicit() {
        const auto count = static_cast<double>(setup_.particles.size());
        const auto springs = static_cast<double>(setup_.springs.size());
        if (setup_.springs.empty()) return add_particles({MemoryNeed::Part::particles}, count);
        room_ -= std::min(room_, count);
        add({MemoryNeed::Part::springs}, springs,
            bytes_of_springs(count, springs, setup_.options.integrator.kind) / springs);
    }

    void add_colliders() {
        const double each = kTriangle + (setup_.options.verify ? kVerifiedTriangle : 0.0);
        for (std::size_t k = 0; k < setup_.colliders.size(); ++k) {
            const ColliderShape& shape = setup_.colliders[k].shape;
            add({MemoryNeed::Part::collider, k}, triangles_of(shape), each);
            // The given positions and those in the world. options.verify needs a third copy, and boxes of that size.
            const double copies = setup_.options.verify ? 4.0 : 2.0;
            if (positions_of(shape) > 0.0) estimate_.needs.back().bytes += copies * positions_of(shape);
        }
    }

    const SimulationSetup& setup_;
    double per_particle_;
    double room_;
    MemoryEstimate estimate_;
};

template <class Named>
std::string name_of(const std::vector<Named>& all, std::size_t number, const char* kind) {
    const std::string& name = all[number].name;
    return name.empty() ? fmt::format("{} {}", kind, number) : fmt::format("{} \"{}\"", kind, name);
}

std::string name_of(const MemoryNeed& need, const SimulationSetup& setup) {
    switch (need.part) {
        case MemoryNeed::Part::particles:
            return fmt::format("particles: {} of them", need.count);
        case MemoryNeed::Part::springs:
            return fmt::format("springs: {} of them", need.count);
        case MemoryNeed::Part::emitter:
            return fmt::format("{}: {} particles", name_of(setup.emitters, need.number, "emitter"), need.count);
        case MemoryNeed::Part::collider:
            return fmt::format("{}: {} triangles", name_of(setup.colliders, need.number, "collider"), need.count);
        case MemoryNeed::Part::contacts:
            break;
    }
    return fmt::format("contacts: {} records", need.count);
}

}  // namespace

double MemoryEstimate::bytes() const {
    double sum = kProgram;
    for (const MemoryNeed& need : needs) sum += need.bytes;
    return sum;
}

const MemoryNeed& MemoryEstimate::largest() const { return *std::ranges::max_element(needs, {}, &MemoryNeed::bytes); }

MemoryEstimate estimate_memory(const SimulationSetup& setup) {
    MemoryEstimate estimate = Estimator(setup).estimate();
    estimate.taken = bytes_taken(setup);
    return estimate;
}

void require_memory(const SimulationSetup& setup) {
    const MemoryEstimate estimate = estimate_memory(setup);
    const double bytes = estimate.bytes_to_come();
    const MemoryLimit limit = memory_limit();
    if (estimate.needs.empty() || !(bytes > limit.bytes)) return;
    throw InputError(fmt::format("{}: with them the simulation {}", name_of(estimate.largest(), setup),
                                 too_much_memory(bytes, limit)));
}

double bytes_per_particle(const SimulationSetup& setup) {
    double bytes = kParticle + kAttributeComponent * columns_of(setup);
    if (has_children(setup)) bytes += kChildLists;
    if (std::ranges::any_of(setup.emitters, is_cloud)) bytes += kCloudParticle;
    if (setup.options.verify) bytes += kVerifiedParticle;
    if (setup.options.particle_contacts) bytes += kCollidingSphere;
    const auto varies = [](const std::unique_ptr<Force>& force) { return force && !force->is_uniform(); };
    if (std::ranges::any_of(setup.forces, varies)) bytes += kClearSpace;
    if (!setup.particles_forces.empty()) bytes += kCoupledParticle;
    if (setup.options.response != ResponseKind::exact) bytes += kSide * static_cast<double>(setup.colliders.size());
    return bytes;
}

void ParticleMemory::measure(std::uint64_t living) {
    most_ = living + static_cast<std::uint64_t>(std::min(memory_limit().bytes / bytes_each_, 0x1p63));
}

void ParticleMemory::refuse_to_grow(std::uint64_t living) const {
    const MemoryLimit limit = memory_limit();
    throw RunError(fmt::format(
        "more particles are born than memory holds: {} live, at about {} each, and {} are left ({}); ask for fewer, or "
        "lower simulation.most_particles, beyond which births are refused",
        living, memory_text(bytes_each_), memory_text(limit.bytes), limit.source));
}

double bytes_of_springs(double particles, double springs, IntegratorKind integrator) {
    const bool is_implicit = integrator == IntegratorKind::implicit_euler;
    return particles * (kJoinedParticle + (is_implicit ? kImplicitParticle : 0.0)) +
           springs * (kSpring + (is_implicit ? kImplicitSpring : 0.0));
}

}  // namespace ricochet
