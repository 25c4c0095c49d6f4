#include "ricochet/simulation/particle_store.h"

#include <algorithm>
#include <utility>

#include "ricochet/core/algorithms.h"
#include "ricochet/dynamics/heat.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

std::uint32_t saturating_sum(std::uint32_t a, std::uint32_t b) {
    return a + std::min(b, std::numeric_limits<std::uint32_t>::max() - a);
}

}  // namespace

ParticleStore::ParticleStore(std::vector<AttributeDescription> attributes, bool keeps_origin, bool may_sleep,
                             std::size_t colliders, bool keeps_attachments)
    : keeps_attachments_(keeps_attachments), colliders_(colliders), may_sleep_(may_sleep) {
    particles_.attributes = AttributeTable(std::move(attributes));
    particles_.keeps_origin = keeps_origin;
    temperature_column_ = particles_.attributes.find(kTemperatureAttribute);
}

ParticleStore ParticleStore::empty_copy() const {
    const auto columns = particles_.attributes.columns();
    return {{columns.begin(), columns.end()}, particles_.keeps_origin, may_sleep_, colliders_, keeps_attachments_};
}

void ParticleStore::append(Particle&& particle) {
    particle.id = next_id_++;
    particle.position = flush_tiny(particle.position);
    const auto size = particles_.attributes.find(kSizeAttribute);
    if (size) {
        particle.attributes.resize(particles_.attributes.columns().size(), missing_attribute());
        if (is_missing(particle.attributes[*size])) particle.attributes[*size] = {particle.radius, 0.0, 0.0};
    }
    if (particle.pinned) particle.velocity = particle.spin = Vec3{};
    particles_.append(particle);
    cores_.append();
    sides_.resize(particles_.size() * colliders_);
    if (keeps_attachments_) attachments_.emplace_back();
}

void ParticleStore::reserve(std::size_t more) {
    particles_.reserve(more);
    grow_capacity_by(sides_, more * colliders_);
    if (keeps_attachments_) grow_capacity_by(attachments_, more);
}

void ParticleStore::compact(const std::vector<std::uint8_t>& keep) {
    if (colliders_ > 0) keep_marked(sides_, keep, colliders_);
    if (keeps_attachments_) keep_marked(attachments_, keep);
    cores_.compact(keep);
    particles_.compact(keep);
}

MovingParticle ParticleStore::load(std::size_t i, double start, bool in_contact) {
    MovingParticle particle{force_input(i, start), particles_.spin[i], particles_.id[i], particles_.draws[i], {}};
    if (cores_.has(i)) {
        // Forces act on the whole sphere. The rest of the response uses its core.
        particle.state.whole_radius = particles_.radius[i];
        particle.state.radius = cores_.radius(i);
        particle.spin = OverlapCores::spin_of_core(particle.spin, cores_.radius(i), particles_.radius[i]);
    }
    if (in_contact) {
        ContactState& contact = particle.contact;
        for (const SurfaceId surface : particles_.support[i]) {
            if (surface != kNoSupport) contact.surfaces[contact.count++] = surface;
        }
        contact.cascade_left = particles_.cascade_left[i];
    }
    particle.sides = sides_of(i);
    particle.stored_time = start;
    if (keeps_attachments_) {
        const AttachmentMemory& known = attachments_[i];
        if (!std::isnan(known.stored_time)) particle.stored_time = known.stored_time;
        if (known.is_attached != 0) particle.attachment = known.attachment;
    }
    return particle;
}

/// Converts the spin of a core to the spin of the sphere. An unchanged spin stays bitwise the same.
Vec3 ParticleStore::spin_of(std::size_t i, const MovingParticle& moved) const {
    if (!cores_.has(i)) return moved.spin;
    const double core = cores_.radius(i);
    const Vec3& before = particles_.spin[i];
    if (moved.spin == OverlapCores::spin_of_core(before, core, particles_.radius[i])) return before;
    return (core / particles_.radius[i]) * moved.spin;
}

void ParticleStore::store(std::size_t i, const MovingParticle& moved, const MoveOutcome& outcome, bool in_contact,
                          bool may_be_supported) {
    particles_.position[i] = moved.state.position;
    particles_.velocity[i] = moved.state.velocity;
    if (const Vec3 spin = spin_of(i, moved); particles_.spin[i] != spin) particles_.spin[i] = spin;
    if (particles_.draws[i] != moved.draws) particles_.draws[i] = moved.draws;
    if (outcome.bounces > 0) particles_.contacts[i] = saturating_sum(particles_.contacts[i], outcome.bounces);
    if (outcome.unsimulated_time > 0.0) particles_.unsimulated_time[i] += outcome.unsimulated_time;
    if (in_contact) {
        // An attached particle moves with its body, so it is not held.
        const bool is_held = outcome.end == MoveEnd::held && may_be_supported && !moved.attachment;
        particles_.resting[i] = outcome.is_resting() ? 1 : 0;
        particles_.held[i] = is_held ? 1 : 0;
        particles_.frozen[i] = outcome.is_frozen() ? 1 : 0;
        particles_.absorbed[i] = outcome.end == MoveEnd::shattered ? kShattered : outcome.is_absorbed() ? 1 : 0;
        set_contact(i, moved.contact);
    }
    if (!keeps_attachments_) return;
    attachments_[i] = {};
    if (moved.stored_time < moved.step_end) attachments_[i].stored_time = moved.stored_time;
    if (moved.attachment) attachments_[i].is_attached = 1, attachments_[i].attachment = *moved.attachment;
}

void ParticleStore::set_contact(std::size_t i, const ContactState& contact) {
    particles_.support[i].fill(kNoSupport);
    std::copy_n(contact.surfaces.begin(), contact.count, particles_.support[i].begin());
    particles_.cascade_left[i] = contact.cascade_left;
}

void ParticleStore::prefetch(std::size_t i) const {
    prefetch_vector(particles_.position[i]);
    prefetch_vector(particles_.velocity[i]);
    __builtin_prefetch(&particles_.mass[i]);
    __builtin_prefetch(&particles_.radius[i]);
    __builtin_prefetch(&particles_.id[i]);
    __builtin_prefetch(&particles_.spin[i]);
    __builtin_prefetch(&particles_.draws[i]);
    __builtin_prefetch(&particles_.birth_time[i]);
    __builtin_prefetch(&particles_.lifetime[i]);
    __builtin_prefetch(&particles_.frozen[i]);
    __builtin_prefetch(&particles_.pinned[i]);
    __builtin_prefetch(&particles_.absorbed[i]);
    __builtin_prefetch(&particles_.held[i]);
    __builtin_prefetch(&particles_.contacts[i], 1);
}

bool ParticleStore::is_sound(std::size_t i) const {
    const std::span<const SideMemory> sides = sides_of(i);
    const bool are_sides_known = std::ranges::all_of(sides, [](const SideMemory& memory) {
        return memory.side >= -1 && memory.side <= 1 && !std::isnan(memory.depth);
    });
    const bool is_core_inside = !cores_.has(i) || cores_.radius(i) <= particles_.radius[i];
    const bool is_attachment_finite =
        !keeps_attachments_ ||
        (!std::isinf(attachments_[i].stored_time) && is_finite(attachments_[i].attachment.position) &&
         is_finite(attachments_[i].attachment.spin) && attachments_[i].is_attached <= 1);
    return are_sides_known && is_core_inside && is_attachment_finite && std::isfinite(particles_.birth_time[i]) &&
           !std::isnan(particles_.lifetime[i]) && std::isfinite(particles_.accounted_until[i]) &&
           std::isfinite(particles_.cascade_left[i]) && std::isfinite(particles_.unsimulated_time[i]);
}

std::optional<std::size_t> ParticleStore::index_of(std::uint64_t id) const {
    const std::vector<std::uint64_t>& ids = particles_.id;
    if (ids.empty() || id < ids.front()) return std::nullopt;
    const std::size_t guess = id - ids.front();  // correct if no particle has been removed
    if (guess < ids.size() && ids[guess] == id) return guess;
    const auto at = std::lower_bound(ids.begin(), ids.end(), id);
    if (at == ids.end() || *at != id) return std::nullopt;
    return static_cast<std::size_t>(at - ids.begin());
}

}  // namespace ricochet
