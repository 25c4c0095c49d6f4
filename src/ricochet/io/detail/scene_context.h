/// \file
/// What all parts of the scene builder need: where the document and its files are, and where to report.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/core/transform.h"
#include "ricochet/dynamics/frame_tree.h"
#include "ricochet/io/detail/diagnostics.h"
#include "ricochet/io/detail/object_view.h"
#include "ricochet/io/detail/scene_files.h"
#include "ricochet/io/scene.h"

namespace ricochet::detail {

class SceneContext {
public:
    SceneContext(const JsonNode& root, std::filesystem::path folder, Diagnostics& diagnostics);

    [[nodiscard]] const ObjectView& root() const { return root_; }
    [[nodiscard]] Diagnostics& diagnostics() const { return diagnostics_; }

    /// The objects of one of the scene's lists, with the paths that messages give them.
    [[nodiscard]] std::vector<ObjectView> objects(std::string_view list) const;

    void error(const ObjectView& view, std::string_view key, const std::string& what) const;
    void warn(const ObjectView& view, std::string_view key, const std::string& what) const;

    /// The path that a key of type file means.
    [[nodiscard]] std::filesystem::path file_of(const ObjectView& view) const;
    /// The mesh that the key "file" names; null pointer after reporting why there is none.
    [[nodiscard]] std::shared_ptr<const TriangleMesh> load_mesh(const ObjectView& view);
    /// The groups of the mesh that the key "file" names; null pointer where load_mesh() gives one.
    [[nodiscard]] const MeshGroups* load_groups(const ObjectView& view);
    /// position, rotation and scale.
    [[nodiscard]] static Placement placement_of(const ObjectView& view);

    /// The name given, or one made from the type and the place in the list; reports a name that is taken.
    [[nodiscard]] std::string unique_name(const ObjectView& view, std::size_t index, std::string_view kind,
                                          std::set<std::string>& taken) const;

private:
    ObjectView root_;
    std::filesystem::path folder_;
    Diagnostics& diagnostics_;
    MeshLibrary meshes_;
};

/// `there is no material "ruber"; did you mean "rubber"?`
[[nodiscard]] std::string unknown_name(std::string_view kind, const std::string& name,
                                       const std::vector<std::string_view>& known);

/// The parts of a scene, in the order in which they are built.
void build_forces(const SceneContext& context, SimulationSetup& setup);
/// The scene's frames; without errors so far only, their parents too.
[[nodiscard]] std::shared_ptr<const FrameTree> frames_of(const SceneContext& context);
void build_colliders(SceneContext& context, SimulationSetup& setup);
void build_emitters(SceneContext& context, SimulationSetup& setup);
void build_particles(SceneContext& context, SimulationSetup& setup);
/// After the particles: adds those of ropes, chains and cloth behind them.
void build_springs(SceneContext& context, SimulationSetup& setup);
/// Forces that grow with a particle's radius, in a scene of points only.
void warn_of_forces_without_radius(const SceneContext& context, const SimulationSetup& setup);

}  // namespace ricochet::detail
