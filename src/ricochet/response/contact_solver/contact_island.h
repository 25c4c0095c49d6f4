/// \file
/// Private to the responses: spheres that are moved over a step together, by the problem of all their contacts.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ricochet/dynamics/neighbour_grid.h"
#include "ricochet/response/contact_solver/iterative_contact_solver.h"
#include "ricochet/response/contact_solver/planned_move.h"
#include "ricochet/response/contact_solver/wall_contacts.h"
#include "ricochet/response/contact_solver/warm_start_memory.h"
#include "ricochet/response/pair_materials.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// One of the spheres.
struct ContactIslandMember {
    MovingParticle* moving = nullptr;
    double radius = 0.0;         ///< m, as others meet it
    bool is_fixed = false;       ///< nothing moves it
    double duration = 0.0;       ///< s, of its part of the step
    bool is_pinched = false;     ///< surfaces that close on it have stopped its clock: others find it where it is
    bool is_asleep = false;      ///< fixed as long as it sleeps: what overlaps it is not parted from it
    double reach = 0.0;          ///< m, how far beside its surface its contacts are looked for
    std::uint32_t material = 0;  ///< its number among PairMaterials
    // Out:
    MoveOutcome outcome{};

    [[nodiscard]] bool stays() const { return is_fixed || is_pinched; }
};

/// What one that is awake does to one that sleeps in a step.
struct SleeperImpulse {
    std::uint64_t particle = 0;  ///< id of the sleeper
    Vec3 impulse;                ///< N s
};

/// Plans with the velocities that forces give the spheres within the step (symplectic Euler's), finds their contacts
/// with each other and with walls, solves them, and moves each sphere along its plan. Keeps its memory from one island
/// to the next.
class ContactIsland {
public:
    /// Both must outlive it.
    ContactIsland(const ResponseRules& rules, const PairMaterials& materials) : rules_(rules), materials_(materials) {}

    /// m, for a first plan: as far as a member comes by itself, and more.
    [[nodiscard]] double first_reach(const ContactIslandMember& member) const;
    /// Plans a step of `duration` seconds. pairs: those within reach of each other, by their numbers. memory: of the
    /// last step.
    SolverReport plan(std::span<const ContactIslandMember> members, std::span<const NeighbourPair> pairs,
                      double duration, const WarmStartMemory& memory, MoveScratch& scratch);
    /// Moves one of the members, by its number, as it has been planned. Several threads may move different ones.
    void move(std::size_t index, ContactIslandMember& member, MoveScratch& scratch) const;

    /// What is planned for a member, by its number.
    [[nodiscard]] const SolverBody& planned(std::size_t index) const { return bodies_[index]; }
    /// Plans instead that it stays where it is, without spin.
    void put_to_rest(std::size_t index) { bodies_[index].velocity = bodies_[index].spin = Vec3{}; }
    /// m/s, that other spheres give it in the step.
    [[nodiscard]] Vec3 given_by_others(std::size_t index, const ContactIslandMember& member) const;
    /// What walls do to it in the step.
    [[nodiscard]] std::vector<WallImpulse> impulses_of(std::size_t index) const;
    /// What the contacts of the last plan do, for the memory of the next step.
    [[nodiscard]] std::vector<WarmStartMemory::Entry> entries() const;
    /// Members that press on each other, by their numbers.
    [[nodiscard]] std::vector<NeighbourPair> pressing() const;
    /// By others that do not sleep, contact by contact.
    [[nodiscard]] std::vector<SleeperImpulse> impulses_on_sleepers() const;
    /// Pairs that hardly leave a gap between them, whether they press or not.
    [[nodiscard]] std::vector<ContactKey> touching() const;
    /// Lets members that others push farther than their contacts have been looked for reach as far: their numbers,
    /// ascending. Where there are none what is planned leads into nothing.
    [[nodiscard]] std::vector<std::uint32_t> reach_farther(std::span<ContactIslandMember> members) const;

private:
    /// What contacts need of a member, close together.
    struct MemberState {
        Vec3 position;  ///< m
        Vec3 velocity;  ///< m/s, with which it sets out
        std::uint64_t id = 0;
        double radius = 0.0;  ///< m
        double reach = 0.0;   ///< m
        double pull = 0.0;    ///< m/s^2, of the forces on it
        std::uint32_t material = 0;
        bool stays = false;
        bool is_asleep = false;
    };

    /// What errors are measured by.
    struct Pace {
        double fastest = 0.0;         ///< m/s, with which one sets out
        double force_velocity = 0.0;  ///< m/s, that forces give one in the step at most
        double smallest = INFINITY;   ///< m, radius
    };

    void set_part(bool is_coupled);
    [[nodiscard]] double parted(double gap) const { return gap < 0.0 ? part_ * gap : gap; }
    void add_bodies(std::span<const ContactIslandMember> members, const WarmStartMemory& memory);
    void add_pairs(std::span<const NeighbourPair> pairs);
    void add_pair(std::uint32_t first, std::uint32_t second);
    void add_walls(std::span<const ContactIslandMember> members, MoveScratch& scratch);
    void add_wall(std::uint32_t index, const ContactIslandMember& member, const WallContact& wall);
    void carry(SolverContact& contact, const WallContact& wall, const Material& material,
               const ForceInput& state) const;
    void add_key(const ContactKey& key);
    void warm_start(std::size_t at);
    [[nodiscard]] double rebound(double restitution, double approach) const;
    [[nodiscard]] Vec3 velocity_in_flight(const ContactIslandMember& member) const;
    [[nodiscard]] Pace pace_of(std::span<const ContactIslandMember> members) const;
    [[nodiscard]] SolverSettings settings(const Pace& pace) const;
    void set_exactness(const Pace& pace, double enough);

    const ResponseRules& rules_;
    const PairMaterials& materials_;
    double duration_ = 0.0;
    double part_ = 1.0;  // of the run's step, where those that act on each other take it in parts
    std::vector<SolverBody> bodies_;
    std::vector<MemberState> members_;                   // of the members
    std::vector<WarmStartMemory::OfParticle> memories_;  // of each member
    std::vector<SolverContact> contacts_;
    std::vector<ContactKey> keys_;              // of the contacts
    std::vector<const SolverImpulse*> before_;  // of the contacts, what they did; null where there were none
    std::vector<std::size_t> edges_of_sleep_;   // contacts of one that sleeps with one that does not
    std::vector<NeighbourPair> ends_;           // of the contacts of two, which come first: their members
    std::vector<WallContact> walls_;
    std::vector<std::size_t> first_wall_;  // of each member among the contacts, and the end
    std::vector<SurfaceId> surfaces_;      // of the contacts; of walls
    std::vector<double> clear_;            // m, of each member: so far there is certainly no wall
    IterativeContactSolver solver_;
};

}  // namespace ricochet
