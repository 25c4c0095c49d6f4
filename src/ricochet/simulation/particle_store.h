/// \file
/// Private to the simulation: particles with the state that the response keeps for each, and their transfer to it.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/dynamics/particles.h"
#include "ricochet/response/response.h"
#include "ricochet/simulation/overlap_cores.h"

namespace ricochet {

/// The particles of a simulation. Particles are appended at the end and keep their order.
class ParticleStore {
public:
    /// may_sleep: true if supports do not change, so that a held particle needs no further query. colliders: number of
    /// colliders for which the response keeps sides; 0 without sides. keeps_attachments: true if colliders move.
    ParticleStore(std::vector<AttributeDescription> attributes, bool keeps_origin, bool may_sleep,
                  std::size_t colliders, bool keeps_attachments = false);

    [[nodiscard]] const Particles& particles() const { return particles_; }
    [[nodiscard]] Particles& particles() { return particles_; }
    [[nodiscard]] std::size_t size() const { return particles_.size(); }

    /// Gives the particle its id and appends it. The particle's sides of surfaces are not known yet.
    void append(Particle&& particle);
    void reserve(std::size_t more);
    /// Keeps the particles whose flag is not 0.
    void compact(const std::vector<std::uint8_t>& keep);

    /// Sets the contacts of a particle at the start of its next step.
    void set_contact(std::size_t i, const ContactState& contact);

    /// Returns the cores of spheres in overlap. In collisions, a core replaces its sphere.
    [[nodiscard]] const OverlapCores& cores() const { return cores_; }
    [[nodiscard]] OverlapCores& cores() { return cores_; }

    [[nodiscard]] std::span<SideMemory> sides_of(std::size_t i) {
        return std::span(sides_).subspan(i * colliders_, colliders_);
    }
    [[nodiscard]] std::span<const SideMemory> sides_of(std::size_t i) const {
        return std::span(sides_).subspan(i * colliders_, colliders_);
    }
    /// Returns the sides of all particles from `first` on, one after the other.
    [[nodiscard]] std::span<const SideMemory> sides_from(std::size_t first) const {
        return std::span(sides_).subspan(first * colliders_);
    }
    /// Returns true if the particle is frozen or pinned, or if an earlier substep has removed it.
    [[nodiscard]] bool is_fixed(std::size_t i) const {
        return particles_.frozen[i] != 0 || particles_.pinned[i] != 0 || particles_.absorbed[i] != 0;
    }
    [[nodiscard]] bool is_asleep(std::size_t i) const { return particles_.held[i] != 0 && may_sleep_; }
    [[nodiscard]] bool may_sleep() const { return may_sleep_; }
    void set_may_sleep(bool may_sleep) { may_sleep_ = may_sleep; }
    /// Wakes a particle, because its supports may have changed.
    void wake(std::size_t i) { particles_.held[i] = 0; }
    /// Returns the index of the particle with an id, or nothing if the particle is gone.
    [[nodiscard]] std::optional<std::size_t> index_of(std::uint64_t id) const;
    /// Returns the input of forces on a particle at a time, in s.
    [[nodiscard]] ForceInput force_input(std::size_t i, double time) const {
        ForceInput input{particles_.position[i], particles_.velocity[i], particles_.mass[i], particles_.radius[i], time,
                         particles_.id[i]};
        if (temperature_column_) input.temperature = particles_.attributes.value(*temperature_column_, i).x;
        return input;
    }

    /// Returns particle i for a move by the response from `start`, in s. in_contact: true if the arrays may contain a
    /// contact of the particle. Otherwise they are not read, because each read costs a cache miss.
    [[nodiscard]] MovingParticle load(std::size_t i, double start, bool in_contact);
    /// Stores a particle after a move. in_contact: true if the arrays may contain a contact of the particle, or if the
    /// particle has a contact now. may_be_supported: false for a particle on which other particles act.
    void store(std::size_t i, const MovingParticle& moved, const MoveOutcome& outcome, bool in_contact,
               bool may_be_supported);

    /// Prefetches the data that load() and store() use.
    void prefetch(std::size_t i) const;

    /// Returns the time, in s, of the stored position. This time is `now`, except for stalled particles.
    [[nodiscard]] double stored_time(std::size_t i, double now) const {
        return keeps_attachments_ && !std::isnan(attachments_[i].stored_time) ? attachments_[i].stored_time : now;
    }

    /// Returns the id of the next particle that is added.
    [[nodiscard]] std::uint64_t next_id() const { return next_id_; }
    /// Sets the id of the next particle, because particles with the ids in between live on other ranks.
    void set_next_id(std::uint64_t id) { next_id_ = id; }
    /// Returns a store with the same settings and without particles.
    [[nodiscard]] ParticleStore empty_copy() const;

    /// Saves or restores the state between steps. a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a);

    /// Returns false if no run can produce the present state of particle i.
    [[nodiscard]] bool is_sound(std::size_t i) const;

    /// Returns the spin, in rad/s, of particle i as it is stored after a move by the response.
    [[nodiscard]] Vec3 spin_of(std::size_t i, const MovingParticle& moved) const;

private:
    Particles particles_;
    OverlapCores cores_;
    /// State that is stored for each particle if colliders move.
    struct AttachmentMemory {
        double stored_time = std::numeric_limits<double>::quiet_NaN();  ///< s, for a stalled particle; else NaN
        std::uint8_t is_attached = 0;
        MovingParticle::Attachment attachment{};  ///< valid if is_attached
    };
    std::vector<AttachmentMemory> attachments_;  // one per particle if keeps_attachments_, else empty
    bool keeps_attachments_ = false;
    std::vector<SideMemory> sides_;  // for each particle one per collider, if the response keeps sides
    std::size_t colliders_;
    std::uint64_t next_id_ = 0;
    bool may_sleep_;
    std::optional<std::size_t> temperature_column_;  // of kTemperatureAttribute; empty without temperatures
};

/// Returns true if the life of particle i is over at a time, in s, or if a surface has absorbed or shattered it.
[[nodiscard]] inline bool has_ended(const Particles& particles, std::size_t i, double time) {
    return particles.absorbed[i] != 0 || particles.birth_time[i] + particles.lifetime[i] <= time;
}

/// Prefetches a vector, which may lie across two cache lines.
inline void prefetch_vector(const Vec3& v) {
    __builtin_prefetch(&v.x, 1);
    __builtin_prefetch(&v.z, 1);
}

template <class Archive>
void ParticleStore::archive(Archive& a) {
    a(next_id_);
    Particles& p = particles_;
    a(p.id);
    const std::size_t n = p.id.size();
    a(p.position, n), a(p.velocity, n), a(p.spin, n), a(p.mass, n), a(p.radius, n), a(p.birth_time, n);
    a(p.lifetime, n), a(p.unsimulated_time, n), a(p.contacts, n), a(p.frozen, n), a(p.resting, n), a(p.held, n);
    a(p.absorbed, n), a(p.pinned, n), a(p.draws, n), a(p.support, n), a(p.cascade_left, n), a(p.accounted_until, n);
    p.attributes.archive(a, n);
    cores_.archive(a, n);
    const auto origin_of = [&](Origin& origin) {
        a(origin.emitter), a(origin.generation), a(origin.lineage), a(origin.birth_impacts), a(origin.impact_children);
    };
    archive_entries(a, p.origin, origin_of, p.keeps_origin ? n : 0);
    const auto side_of = [&](SideMemory& memory) {
        a(memory.side), a(memory.penetrating), a(memory.touching), a(memory.depth);
    };
    archive_entries(a, sides_, side_of, n * colliders_);
    const auto attachment_of = [&](AttachmentMemory& memory) {
        a(memory.stored_time), a(memory.is_attached), a(memory.attachment.position), a(memory.attachment.spin);
    };
    archive_entries(a, attachments_, attachment_of, keeps_attachments_ ? n : 0);
}

}  // namespace ricochet
