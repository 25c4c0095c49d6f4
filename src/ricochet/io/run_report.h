/// \file
/// What a run says about itself in text: run.json before its first step, summary.json and the final state after its
/// last.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/io/scene.h"
#include "ricochet/io/surface_groups.h"
#include "ricochet/simulation.h"

namespace ricochet {

/// One collider of the run.
struct ColliderInfo {
    std::string name;
    std::string type;            ///< see type_name()
    std::string file;            ///< its file in the run's folder
    std::uint32_t material = 0;  ///< index of its material
    bool moves = false;          ///< its file is in the coordinates of its frame
    ColliderLooks looks{};       ///< how pictures show it
};

/// Everything that run.json says.
struct RunInfo {
    /// True for the file of a collider that moves.
    [[nodiscard]] bool moves(std::string_view file) const {
        return std::any_of(colliders.begin(), colliders.end(),
                           [&](const ColliderInfo& collider) { return collider.moves && collider.file == file; });
    }

    /// The collider of that file; nullptr when none has it.
    [[nodiscard]] const ColliderInfo* find(std::string_view file) const {
        const auto found = std::find_if(colliders.begin(), colliders.end(),
                                        [&](const ColliderInfo& collider) { return collider.file == file; });
        return found == colliders.end() ? nullptr : &*found;
    }

    std::string version;                      ///< of ricochet
    std::string scene;                        ///< the scene file as it was named
    Vec3 up{0, 0, 1};                         ///< against gravity, along the nearest axis
    double time_step = 0.0;                   ///< s; 0: not known
    std::optional<CameraDescription> camera;  ///< its `up` is the one above
    std::optional<PictureDescription> picture;
    std::vector<ParticleDrawingDescription> drawings{};  ///< of the particles of some emitters
    std::vector<ColliderInfo> colliders;
    std::vector<ColliderLooks> looks{};    ///< of all colliders, before they are described
    std::vector<TriangleGroups> groups{};  ///< of all colliders; run.json leaves them out
};

/// What a scene says about its own picture: camera and the upward axis. Version and colliders are left empty.
[[nodiscard]] RunInfo run_info_of(const SceneDescription& scene);
[[nodiscard]] std::string run_info_text(const RunInfo& info);
/// Reads run.json. Throws InputError when it is not one.
[[nodiscard]] RunInfo read_run_info(const std::filesystem::path& path);

/// One collider's totals over the run.
struct ColliderSummary {
    std::string name;
    std::string type;  ///< see type_name()
    std::string file;  ///< the collider's file in the run's folder
    std::uint64_t triangles = 0;
    std::uint64_t hits = 0;
    Vec3 impulse;  ///< N s
    /// Of one that moves, or whose material does; nothing of others.
    std::optional<ColliderTotals> loads = {};
    Vec3 lasting_impulse = {};             ///< N s, the part of `impulse` that no hit gave
    ImpulseSizes sizes = {};               ///< of the impulses of its triangles
    std::vector<GroupTotals> groups = {};  ///< of its triangles; empty where the mesh has none
};

/// Everything that summary.json says.
struct RunSummary {
    std::string version;                    ///< of ricochet
    std::string scene;                      ///< the scene file as it was named
    std::uint64_t processes = 1;            ///< that shared the run
    RankBalance balance{};                  ///< of them
    std::uint64_t common_memory_bytes = 0;  ///< of meshes that those of a machine hold once
    int threads = 0;                        ///< of all of them together
    std::string response;                   ///< by which impacts were answered
    std::uint64_t seed = 0;
    double time_step = 0.0;       ///< s
    double simulated_time = 0.0;  ///< s
    double wall_seconds = 0.0;
    double output_seconds = 0.0;  ///< of them on output: what the simulation spent on it or waiting for it
    std::uint64_t frames = 0;
    bool interrupted = false;
    std::optional<std::string> diverged;  ///< why the run stopped, where its numbers became nonsense
    std::uint64_t particles_alive = 0;
    SimulationStatistics statistics;
    bool spheres_meet = false;                       ///< each other
    std::optional<std::uint64_t> leaks;              ///< violations that a verified run found; nothing without --verify
    std::optional<std::uint64_t> energy_violations;  ///< the same of energies
    double kinetic_energy = 0.0;                     ///< J
    std::optional<double> potential_energy;          ///< J; nothing where a force has no potential
    std::uint64_t state_hash = 0;
    std::uint64_t peak_memory_bytes = 0;  ///< of all processes, each at its peak
    std::vector<ColliderSummary> colliders;
    std::vector<BodyState> bodies;  ///< that impulses move, at the end

    /// Of the impulses of all colliders.
    [[nodiscard]] ImpulseSizes impulse_sizes() const;
};

/// What the simulation itself knows for its summary; the colliders' files are left empty.
/// groups: of the triangles of its colliders, in their order; those that are missing have none.
[[nodiscard]] RunSummary summarize(const Simulation& simulation, const std::vector<TriangleGroups>& groups = {});
/// The JSON text of summary.json. Numbers that are not finite become null.
[[nodiscard]] std::string summary_text(const RunSummary& summary);

/// Writes a header line and one line a particle in the order of the ids: id, x, y, z, vx, vy, vz, radius, mass, age,
/// contacts, resting, unsimulated_time, then the attributes (vectors as name_x, name_y, name_z). Numbers carry 17
/// significant digits, so that they read back to the same bits. time: simulation time, s. Throws RunError or InputError
/// like AtomicFile; nothing half-written appears.
void write_state_csv(const std::filesystem::path& path, const Particles& particles, double time);
/// The same with the attributes as they are shown (Simulation::shown_attributes()).
void write_state_csv(const std::filesystem::path& path, const Particles& particles, const AttributeTable& attributes,
                     double time);

}  // namespace ricochet
