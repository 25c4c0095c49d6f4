#include "ricochet/response/contact_solver/contact_island.h"

#include <algorithm>

#include "ricochet/core/prefetch.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Returns the largest speed, in m/s, at which an overlap, in m, may be separated. The part from forces is at most the
/// speed of a free fall through the overlap, because sinking in released no more energy. The approach speed is added.
/// Without this limit, a small overlap would eject heavy spheres, faster in shorter steps. `pull` is in m/s^2,
/// `approach` in m/s.
double most_parting(double pull, double radius, double overlap, double approach) {
    if (!(overlap > 0.0)) return std::max(0.0, approach);
    const double fall = std::min(kPartingFall * kPartingFall * radius, 2.0 * overlap);
    return std::sqrt(pull * fall) + std::max(0.0, approach);
}

/// Returns the search distance for contacts, in m, of a sphere whose path has the length `travel`, in m.
double reach_of(double travel, double radius) { return 2.0 * travel + kNetworkReach * radius; }

/// Number of members or contacts between the prefetch of their data and its use.
constexpr std::size_t kPrefetchDistance = 8;

/// Factor on the reach of a pair that covers rounding errors. A pair farther apart certainly has no contact. Local,
/// because the exact reach decides about nearer pairs.
constexpr double kOutOfReach = 1.0 + 1e-9;

/// Fraction of the search distance that counts as clear if no wall was found within that distance. The rest covers
/// rounding errors. Local: it affects only the cost.
constexpr double kClear = 0.9;

}  // namespace

SolverReport ContactIsland::plan(std::span<const ContactIslandMember> members, std::span<const NeighbourPair> pairs,
                                 double duration, double part, const WarmStartMemory& memory, MoveScratch& scratch) {
    duration_ = duration;
    contacts_.clear();
    keys_.clear();
    before_.clear();
    edges_of_sleep_.clear();
    first_wall_.clear();
    clear_.clear();
    // Short plans remove less of an overlap, because they would eject spheres. Only coupled particles take substeps.
    part_ = add_bodies(members, memory) ? std::min(1.0, duration_ / rules_.settings.time_step) : part;
    add_pairs(pairs);
    add_walls(members, scratch);
    for (std::size_t k = 0; k < 2 * kPrefetchDistance; ++k) warm_start(keys_.size() + k);
    const Pace pace = pace_of(members);
    const SolverSettings wished = settings(pace);
    if (contacts_.size() > kFewNetworkContacts) set_exactness(pace, wished.enough);
    return solver_.solve(bodies_, contacts_, wished);
}

/// Adds the members. Returns true if one of them is coupled to other particles.
bool ContactIsland::add_bodies(std::span<const ContactIslandMember> members, const WarmStartMemory& memory) {
    bodies_.clear();
    members_.clear();
    memories_.clear();
    bool is_coupled = false;
    for (std::size_t i = 0; i < members.size(); ++i) {
        if (i + kPrefetchDistance < members.size()) prefetch_whole(members[i + kPrefetchDistance].moving->state);
        const ContactIslandMember& member = members[i];
        const ForceInput& state = member.moving->state;
        is_coupled = is_coupled || state.coupling != nullptr;
        memories_.push_back(memory.of_particle(member.moving->id));
        MemberState& cached = members_.emplace_back();
        cached.position = state.position;
        cached.id = member.moving->id;
        cached.radius = member.radius;
        cached.reach = member.reach;
        cached.material = member.material;
        cached.stays = member.stays();
        cached.is_asleep = member.is_asleep;
        SolverBody& body = bodies_.emplace_back();
        body.radius = member.radius;
        if (cached.stays) {
            body.inverse_mass = 0.0;
            continue;
        }
        cached.velocity = state.velocity;
        body.velocity = velocity_in_flight(member);
        const Vec3 gained = body.velocity - state.velocity;
        if (member.duration > 0.0) cached.pull = length(gained) / member.duration;
        body.spin = (state.radius / member.radius) * member.moving->spin;
        body.inverse_mass = 1.0 / state.mass;
        body.inverse_inertia = 2.5 / (state.mass * member.radius * member.radius);
    }
    return is_coupled;
}

void ContactIsland::add_pairs(std::span<const NeighbourPair> pairs) {
    for (const auto& [first, second] : pairs) {
        if (members_[first].stays && members_[second].stays) continue;
        const bool in_order = members_[first].id < members_[second].id;
        add_pair(in_order ? first : second, in_order ? second : first);
    }
}

void ContactIsland::add_pair(std::uint32_t first, std::uint32_t second) {
    const MemberState& a = members_[first];
    const MemberState& b = members_[second];
    const Vec3 apart = a.position - b.position;
    const double squared = length_squared(apart);
    const double farthest = kOutOfReach * (a.radius + b.radius + a.reach + b.reach);
    if (squared > farthest * farthest) return;
    const double distance = std::sqrt(squared);
    if (!(distance > 0.0)) return;  // coincident centres define no normal
    double gap = parted(distance - a.radius - b.radius);
    // Overlaps with sleeping spheres are ignored, because a sphere between two of them may have no room to separate.
    if (a.is_asleep || b.is_asleep) gap = std::max(0.0, gap);
    if (gap > a.reach + b.reach) return;
    SolverContact& contact = contacts_.emplace_back();
    contact.a = first;
    contact.b = second;
    contact.gap = gap;
    contact.normal = apart / distance;
    const PairMaterial& law = materials_.of(a.material, b.material);
    contact.friction = law.friction;
    contact.rolling_friction = law.rolling_friction * a.radius * b.radius / (a.radius + b.radius);
    const double approach = -dot(a.velocity - b.velocity, contact.normal);
    contact.restitution = rebound(law.restitution_at(approach), approach);
    contact.most_parting = most_parting(std::max(a.pull, b.pull), std::min(a.radius, b.radius), -gap, approach);
    if (a.is_asleep != b.is_asleep) edges_of_sleep_.push_back(contacts_.size() - 1);
    add_key(ContactKey::of_pair(a.id, b.id));
}

void ContactIsland::add_walls(std::span<const ContactIslandMember> members, MoveScratch& scratch) {
    const SurfaceGeometry geometry(rules_.world, scratch.contacts.plane_cache);
    for (std::uint32_t i = 0; i < members.size(); ++i) {
        first_wall_.push_back(contacts_.size());
        clear_.push_back(0.0);
        if (members[i].stays()) continue;
        const ForceInput& state = members[i].moving->state;
        walls_.clear();
        const double near = members[i].reach;
        const TimeOfStep step{state.time, state.time + members[i].duration};
        const bool is_near =
            find_wall_contacts(rules_.bodies, geometry, step, state.position, state.radius, near, walls_);
        if (!is_near) clear_.back() = kClear * near;
        for (const WallContact& wall : walls_) add_wall(i, members[i], wall);
    }
    first_wall_.push_back(contacts_.size());
}

void ContactIsland::add_wall(std::uint32_t index, const ContactIslandMember& member, const WallContact& wall) {
    const ForceInput& state = member.moving->state;
    const Material& material = rules_.materials[rules_.world.material_of(wall.surface)];
    SolverContact& contact = contacts_.emplace_back();
    contact.a = index;
    contact.normal = wall.normal;
    contact.gap = parted(wall.gap);
    contact.friction = material.friction;
    contact.rolling_friction = material.rolling_friction * state.radius;
    contact.wall_velocity = wall.carried;
    carry(contact, wall, material, state);
    const Vec3 relative = state.velocity - wall.carried;
    const double approach = -dot(relative, wall.normal);
    const double along = material.has_impact_law() ? length(relative + approach * wall.normal) : 0.0;
    contact.restitution = rebound(material.restitution_at(approach, along), approach);
    contact.most_parting = most_parting(members_[index].pull, member.radius, -contact.gap, approach);
    add_key(ContactKey::of_wall(member.moving->id, wall.surface));
}

/// Adds the surface velocity of the wall's material, and sets the wall's angular velocity.
void ContactIsland::carry(SolverContact& contact, const WallContact& wall, const Material& material,
                          const ForceInput& state) const {
    const BodyId body = rules_.bodies.body_of(wall.surface);
    if (!material.drives() && body == kWorldBody) return;
    const Vec3 foot = state.position - (state.radius + wall.gap) * wall.normal;
    const MovingPose pose = rules_.bodies.pose(body, state.time);
    contact.wall_turning = pose.angular_velocity;
    if (!material.drives()) return;
    const bool is_seen_from_frame = rules_.bodies.has_frame(body);
    const Vec3 seen = is_seen_from_frame ? pose.local_position(foot) : foot;
    const Vec3 normal = is_seen_from_frame ? pose.local_direction(wall.normal) : wall.normal;
    contact.wall_velocity += pose.world_from_frame.direction(material.motion.at(seen, normal));
    contact.wall_turning += pose.world_from_frame.direction(material.motion.angular_velocity);
}

/// Sets the key of the last contact. Its start impulse is looked up while later contacts are added.
void ContactIsland::add_key(const ContactKey& key) {
    keys_.push_back(key);
    before_.push_back(nullptr);
    warm_start(keys_.size() - 1);
}

/// Looks up start impulses, which are scattered in memory, in three stages: prefetches the keys of contact `at`, finds
/// and prefetches the impulse of the contact kPrefetchDistance earlier, copies that of the one twice as far back.
void ContactIsland::warm_start(std::size_t at) {
    const std::size_t count = keys_.size();
    if (at < count) __builtin_prefetch(memories_[contacts_[at].a].others.data());
    if (const std::size_t k = at - kPrefetchDistance; at >= kPrefetchDistance && k < count) {
        before_[k] = memories_[contacts_[k].a].find(keys_[k].other);
        if (before_[k] != nullptr) __builtin_prefetch(&before_[k]->normal), __builtin_prefetch(&before_[k]->moment.z);
    }
    const std::size_t k = at - 2 * kPrefetchDistance;
    if (at < 2 * kPrefetchDistance || before_[k] == nullptr) return;
    contacts_[k].start = *before_[k];
    contacts_[k].touched = before_[k]->normal > 0.0;
}

/// Returns the restitution, or 0 if the rebound would be slower than the resting speed. `approach` is the speed at the
/// start of the step, in m/s. Speed gained from forces within the step does not count as impact speed.
double ContactIsland::rebound(double restitution, double approach) const {
    return restitution * approach >= rules_.settings.resting_speed ? restitution : 0.0;
}

/// Returns tolerances that decrease with the speeds, so that networks are solved more exactly as they come to rest.
SolverSettings ContactIsland::settings(const Pace& pace) const {
    SolverSettings settings;
    settings.duration = duration_;
    const double still = kNetworkStill * pace.smallest / duration_;
    const bool is_few = contacts_.size() <= kFewNetworkContacts;
    const double overlap = (is_few ? kFewContactsOverlap : 1.0) * kNetworkOverlap;
    const double slow = kNetworkSpeedError * std::max(pace.fastest, kNetworkRestingSpeed * pace.force_velocity);
    settings.enough = std::min(overlap * pace.smallest / duration_, std::max(slow, still));
    settings.tolerance = std::min(settings.enough, std::max(kNetworkResidual * pace.fastest, still));
    if (is_few) {
        settings.tolerance = std::min(still, kFewContactsRounding * pace.fastest);
    } else {
        settings.slip = kNetworkResidual * pace.fastest;
        settings.connecting = kNetworkConnecting * settings.enough;
    }
    settings.sweeps = kNetworkSweeps;
    settings.most_sweeps = kMostNetworkSweeps;
    return settings;
}

ContactIsland::Pace ContactIsland::pace_of(std::span<const ContactIslandMember> members) const {
    Pace pace;
    for (const ContactIslandMember& member : members) {
        if (member.is_fixed) continue;
        pace.fastest = std::max(pace.fastest, length(member.moving->state.velocity));
        pace.smallest = std::min(pace.smallest, member.radius);
    }
    for (const MemberState& member : members_)
        pace.force_velocity = std::max(pace.force_velocity, duration_ * member.pull);
    return pace;
}

/// Sets stricter tolerances for slow spheres, because the errors of a fast sphere would keep its neighbours awake.
void ContactIsland::set_exactness(const Pace& pace, double enough) {
    const double still = kNetworkStill * pace.smallest / duration_;
    const auto speed_of = [&](const MemberState& member) {
        return std::max(length(member.velocity), kNetworkForceSpeed * duration_ * member.pull);
    };
    for (SolverContact& contact : contacts_) {
        double speed = std::max(kNetworkFastestShare * pace.fastest, speed_of(members_[contact.a]));
        if (contact.b != SolverContact::kWall) speed = std::max(speed, speed_of(members_[contact.b]));
        contact.exactness = std::max(1.0, enough / std::max(kNetworkSpeedError * speed, still));
    }
}

/// An impulse P on a contact with the approach speed u and the separation speed w takes the energy P (u - w) / 2. A
/// single impact of restitution e separates with e u. Contacts of an island
/// influence each other, so only their sum is meaningful.
PlannedImpacts ContactIsland::impacts() const {
    PlannedImpacts sum;
    std::vector<double> energies(members_.size(), 0.0);  // J, of the members in impacts
    for (std::size_t k = 0; k < contacts_.size(); ++k) {
        const SolverContact& contact = contacts_[k];
        const double impulse = solver_.impulses()[k].normal;
        if (!(impulse > 0.0) || !(contact.restitution > 0.0) || contact.touched) continue;
        const bool is_wall = contact.b == SolverContact::kWall;
        const Vec3& before = is_wall ? contact.wall_velocity : members_[contact.b].velocity;
        const Vec3& after = is_wall ? contact.wall_velocity : bodies_[contact.b].velocity;
        const double approach = -dot(members_[contact.a].velocity - before, contact.normal);
        const double separation = dot(bodies_[contact.a].velocity - after, contact.normal);
        sum.loss += 0.5 * impulse * (contact.restitution * approach - separation);
        for (const std::uint32_t i : {contact.a, is_wall ? contact.a : contact.b}) {
            if (members_[i].stays) continue;
            energies[i] = 0.5 * length_squared(members_[i].velocity) / bodies_[i].inverse_mass;
        }
    }
    for (const double energy : energies) sum.energy += energy;
    sum.loss = std::max(0.0, sum.loss);
    return sum;
}

void ContactIsland::move(std::size_t index, ContactIslandMember& member, MoveScratch& scratch) const {
    if (member.is_fixed) return;
    const double core = member.moving->state.radius;  // the core spins faster than the whole sphere
    PlannedMotion plan{bodies_[index].velocity, core > 0.0 ? (member.radius / core) * bodies_[index].spin : Vec3{},
                       member.duration, impulses_of(index)};
    plan.is_clear = member.duration * length(plan.velocity) < clear_[index];
    member.outcome = move_as_planned(rules_, *member.moving, plan, scratch);
}

Vec3 ContactIsland::given_by_others(std::size_t index, const ContactIslandMember& member) const {
    if (member.stays()) return {};
    Vec3 given = bodies_[index].velocity - velocity_in_flight(member);
    for (const WallImpulse& impulse : impulses_of(index)) given -= impulse.velocity_change;
    return given;
}

std::vector<WallImpulse> ContactIsland::impulses_of(std::size_t index) const {
    std::vector<WallImpulse> impulses;
    const SolverBody& body = bodies_[index];
    for (std::size_t i = first_wall_[index]; i < first_wall_[index + 1]; ++i) {
        const SolverImpulse& impulse = solver_.impulses()[i];
        if (impulse.normal == 0.0) continue;
        const Vec3& normal = contacts_[i].normal;
        const Vec3 turn = impulse.moment - cross(body.radius * normal, impulse.tangential);
        impulses.push_back({static_cast<SurfaceId>(keys_[i].surface()),
                            body.inverse_mass * (impulse.normal * normal + impulse.tangential),
                            body.inverse_inertia * turn});
    }
    return impulses;
}

std::vector<SleeperImpulse> ContactIsland::impulses_on_sleepers() const {
    std::vector<SleeperImpulse> impulses;
    for (const std::size_t i : edges_of_sleep_) {
        const SolverContact& contact = contacts_[i];
        const SolverImpulse& impulse = solver_.impulses()[i];
        if (impulse.normal == 0.0) continue;
        const bool is_first = members_[contact.a].is_asleep;
        const Vec3 onto_first = impulse.normal * contact.normal + impulse.tangential;
        impulses.push_back({members_[is_first ? contact.a : contact.b].id, is_first ? onto_first : -onto_first});
    }
    return impulses;
}

std::vector<WarmStartMemory::Entry> ContactIsland::entries() const {
    std::vector<WarmStartMemory::Entry> entries;
    entries.reserve(keys_.size());
    for (std::size_t i = 0; i < keys_.size(); ++i) {
        const SolverImpulse& impulse = solver_.impulses()[i];
        if (impulse.normal > 0.0) entries.push_back({keys_[i], impulse, solver_.rebounds()[i] != 0});
    }
    return entries;
}

std::vector<NeighbourPair> ContactIsland::pressing() const {
    std::vector<NeighbourPair> pressing;
    const std::size_t pairs = first_wall_.front();  // pairs of spheres come before all walls
    pressing.reserve(pairs);
    for (std::size_t i = 0; i < pairs; ++i) {
        if (solver_.impulses()[i].normal > 0.0) pressing.push_back({contacts_[i].a, contacts_[i].b});
    }
    return pressing;
}

std::vector<ContactKey> ContactIsland::touching() const {
    std::vector<ContactKey> touching;
    for (std::size_t i = 0; i < keys_.size(); ++i) {
        if (keys_[i].is_wall()) continue;
        const double smaller = std::min(bodies_[contacts_[i].a].radius, bodies_[contacts_[i].b].radius);
        if (contacts_[i].gap <= kTouchingGap * smaller) touching.push_back(keys_[i]);
    }
    return touching;
}

Vec3 ContactIsland::velocity_in_flight(const ContactIslandMember& member) const {
    const ForceInput& state = member.moving->state;
    return state.velocity + member.duration * rules_.forces.acceleration(state);
}

double ContactIsland::first_reach(const ContactIslandMember& member) const {
    return reach_of(member.stays() ? 0.0 : member.duration * length(velocity_in_flight(member)), member.radius);
}

std::vector<std::uint32_t> ContactIsland::reach_farther(std::span<ContactIslandMember> members) const {
    std::vector<std::uint32_t> farther;
    for (std::uint32_t i = 0; i < members.size(); ++i) {
        ContactIslandMember& member = members[i];
        const double travel = member.duration * length(bodies_[i].velocity);
        if (member.stays() || !(travel > member.reach)) continue;
        member.reach = reach_of(travel, member.radius);
        farther.push_back(i);
    }
    return farther;
}

}  // namespace ricochet
