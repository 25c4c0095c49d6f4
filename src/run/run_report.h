/// \file
/// Text reports of a run: run.json before its first step, summary.json and the final state after its last step.
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
#include "ricochet/simulation.h"
#include "run/surface_groups.h"

namespace ricochet {

/// Description of one collider of the run.
struct ColliderInfo {
    std::string name;
    std::string type;            ///< see type_name()
    std::string file;            ///< file name in the run's folder
    std::uint32_t material = 0;  ///< index of its material
    bool moves = false;          ///< a moving collider's file has coordinates of its reference frame
    ColliderLooks looks{};       ///< appearance in pictures
};

/// Content of run.json.
struct RunInfo {
    /// Returns true if the file belongs to a moving collider.
    [[nodiscard]] bool moves(std::string_view file) const {
        return std::any_of(colliders.begin(), colliders.end(),
                           [&](const ColliderInfo& collider) { return collider.moves && collider.file == file; });
    }

    /// Returns the collider of that file, or nullptr.
    [[nodiscard]] const ColliderInfo* find(std::string_view file) const {
        const auto found = std::find_if(colliders.begin(), colliders.end(),
                                        [&](const ColliderInfo& collider) { return collider.file == file; });
        return found == colliders.end() ? nullptr : &*found;
    }

    std::string version;                      ///< version of ricochet
    std::string scene;                        ///< name of the scene file, as given by the user
    Vec3 up{0, 0, 1};                         ///< coordinate axis that points most against gravity
    double time_step = 0.0;                   ///< s; 0: unknown
    std::optional<CameraDescription> camera;  ///< its `up` equals the member `up`
    std::optional<PictureDescription> picture;
    std::vector<ParticleDrawingDescription> drawings{};  ///< drawings for the particles of some emitters
    std::vector<ColliderInfo> colliders;
    std::vector<ColliderLooks> looks{};    ///< appearance of all colliders, until `colliders` is filled
    std::vector<TriangleGroups> groups{};  ///< triangle groups of all colliders; not in run.json
};

/// Returns the scene's camera, upward axis and drawings. Version and colliders stay empty.
[[nodiscard]] RunInfo run_info_of(const SceneDescription& scene);
[[nodiscard]] std::string run_info_text(const RunInfo& info);
/// Reads run.json. Throws InputError if the file is not valid.
[[nodiscard]] RunInfo read_run_info(const std::filesystem::path& path);

/// Totals of one collider over the run.
struct ColliderSummary {
    std::string name;
    std::string type;  ///< see type_name()
    std::string file;  ///< file name in the run's folder
    std::uint64_t triangles = 0;
    std::uint64_t hits = 0;
    Vec3 impulse;  ///< N s
    /// Loads on a collider that moves, or whose material has a moving surface, such as a conveyor belt. Nothing for
    /// other colliders.
    std::optional<ColliderTotals> loads = {};
    Vec3 lasting_impulse = {};             ///< part of `impulse` that is not due to impacts, in N s
    ImpulseSizes sizes = {};               ///< impulses of its triangles, by origin
    std::vector<GroupTotals> groups = {};  ///< totals of each triangle group; empty if the mesh has no groups
};

/// Content of summary.json.
struct RunSummary {
    std::string version;                    ///< version of ricochet
    std::string scene;                      ///< name of the scene file, as given by the user
    std::uint64_t processes = 1;            ///< number of processes that shared the run
    RankBalance balance{};                  ///< balance of work between the processes
    std::uint64_t common_memory_bytes = 0;  ///< memory of meshes that the processes of one machine share
    int threads = 0;                        ///< sum over all processes
    std::string response;                   ///< name of the collision response
    std::uint64_t seed = 0;
    double time_step = 0.0;       ///< s
    double simulated_time = 0.0;  ///< s
    double wall_seconds = 0.0;
    double output_seconds = 0.0;  ///< part of wall_seconds that the simulation spent on output or waiting for it
    std::uint64_t frames = 0;
    bool interrupted = false;
    std::optional<std::string> diverged;  ///< reason why the run stopped with invalid numbers
    std::uint64_t particles_alive = 0;
    SimulationStatistics statistics;
    bool spheres_meet = false;               ///< true if spheres collide with each other
    bool verified = false;                   ///< true for a run with --verify; other runs do not count violations
    double kinetic_energy = 0.0;             ///< J
    std::optional<double> potential_energy;  ///< J; nothing if a force has no potential
    std::uint64_t state_hash = 0;
    std::uint64_t peak_memory_bytes = 0;  ///< sum of the peaks of all processes
    std::vector<ColliderSummary> colliders;
    std::vector<BodyState> bodies;        ///< final states of the dynamic bodies
    std::vector<CounterTotals> counters;  ///< in the order of the scene

    /// Returns the sum of `sizes` over all colliders.
    [[nodiscard]] ImpulseSizes impulse_sizes() const;
};

/// Returns a summary with the values that the simulation knows. The names of the colliders' files stay empty.
/// groups: triangle groups of the colliders, in order; missing entries mean no groups.
[[nodiscard]] RunSummary summarize(const Simulation& simulation, const std::vector<TriangleGroups>& groups = {});
/// Returns the JSON text of summary.json. Numbers that are not finite become null.
[[nodiscard]] std::string summary_text(const RunSummary& summary);

/// Writes a header line and one line for each particle, in the order of the ids.
/// Columns: id, x, y, z, vx, vy, vz, radius, mass, age, contacts, resting, unsimulated_time, spin_x, spin_y, spin_z,
/// lifetime, then the attributes (vectors as name_x, name_y, name_z). Numbers have 17 significant digits, so that
/// reading them gives the same bits.
/// time: simulation time, in s.
/// Throws RunError or InputError like AtomicFile; an incomplete file never appears.
void write_state_csv(const std::filesystem::path& path, const Particles& particles, double time);
/// Writes the same table with the given attributes.
/// attributes: see Simulation::shown_attributes().
void write_state_csv(const std::filesystem::path& path, const Particles& particles, const AttributeTable& attributes,
                     double time);

}  // namespace ricochet
