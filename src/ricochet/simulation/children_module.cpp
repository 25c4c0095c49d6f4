#include "ricochet/simulation/modules.h"

#include <algorithm>

#include "ricochet/simulation/cloud_motion.h"

namespace ricochet {

ChildrenModule::ChildrenModule(const ModuleParts& parts)
    : parts_(parts), offspring_({parts.emitters, parts.scene, parts.share, parts.population.memory(), parts.options}) {
    parts.hooks.offspring = &offspring_;
}

void ChildrenModule::set_clouds(CloudMotion& clouds) {
    clouds_ = &clouds;
    offspring_.set_clouds(&clouds);
}

void ChildrenModule::begin_step(const TimeSpan& /*step*/) {
    births_.clear();
    is_in_step_ = true;
}

void ChildrenModule::before_generation(const ParticleRange& generation, const TimeSpan& /*step*/) {
    const ParticleStore& store = parts_.population.store();
    offspring_.before_move(store.particles(), generation.begin, store.sides_from(generation.begin));
}

bool ChildrenModule::spawn(const TimeSpan& step) {
    ParticleStore& store = parts_.population.store();
    const std::uint64_t first_id = store.next_id();
    OffspringCounts counts;
    std::vector<Child> children =
        offspring_.after_move(store.particles(), step.begin, step.end, parts_.recorder.generation_contacts(), counts);
    std::vector<Particle*> born;
    for (Child& child : children) {
        child.particle.id = first_id + child.number;
        born.push_back(&child.particle);
    }
    parts_.population.add(born, [&](std::size_t k) {
        if (children[k].cloud) clouds_->join(store.size() - 1, *children[k].cloud);
        if (parts_.response.keeps_sides()) inherit_sides(children[k]);
    });
    store.set_next_id(first_id + counts.children);
    parts_.share.add_births(counts.children);
    if (parts_.share.is_first()) count(counts);
    if (counts.children > 0) parts_.population.bind();
    return counts.children > 0;
}

/// Copies the parent's sides of surfaces to the last particle, even if the particle starts on other sides.
void ChildrenModule::inherit_sides(const Child& child) {
    ParticleStore& store = parts_.population.store();
    const std::size_t i = store.size() - 1;
    const Particles& particles = store.particles();
    if (!is_finite(particles.position[i])) return;
    std::ranges::copy(child.parent_sides, store.sides_of(i).begin());
    parts_.response.inherit_sides({child.parent_start, particles.position[i], particles.radius[i], child.goes_on},
                                  store.sides_of(i));
}

void ChildrenModule::count(const OffspringCounts& counts) {
    SimulationStatistics& statistics = parts_.recorder.statistics();
    statistics.children += counts.children - counts.refused_by_overlap;
    statistics.births_refused_by_overlap += counts.refused_by_overlap;
    statistics.births_refused_by_depth += counts.refused_by_depth;
    statistics.births_refused_by_population += counts.refused_by_population;
}

void ChildrenModule::append() {
    const Particles& particles = parts_.population.particles();
    if (is_in_step_) births_.push_back({particles.id.back(), particles.origin.back()});
}

void ChildrenModule::end_step(SimulationStatistics& /*statistics*/) { is_in_step_ = false; }

}  // namespace ricochet
