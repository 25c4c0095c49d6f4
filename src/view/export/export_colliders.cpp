#include "view/export/export_colliders.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ricochet/core/error.h"
#include "run/vtp_reader.h"
#include "view/export/moving_meshes.h"

namespace ricochet {
namespace {

std::string in_small_letters(std::string text) {
    for (char& c : text) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return text;
}

ExportCollider collider_of(const RunFolder& folder, const std::filesystem::path& file) {
    const std::string name = file.filename().string();
    const ColliderInfo* const info = folder.info.find(name);
    ExportCollider collider;
    collider.name = info == nullptr ? file.stem().string() : info->name;
    collider.number = static_cast<std::uint32_t>(index_of_collider_file(name).value_or(0));
    collider.moves = info != nullptr && info->moves;
    if (info != nullptr) collider.looks = info->looks;
    // ExportColliders takes the mesh of a moving collider from the first frame, because the collider's file uses local
    // coordinates.
    if (collider.moves) return collider;
    VtkPolyData data = read_vtp(file);
    collider.mesh = {std::move(data.points), std::move(data.triangles)};
    return collider;
}

}  // namespace

ExportColliders::ExportColliders(const RunFolder& folder) {
    for (const std::filesystem::path& file : folder.colliders) colliders_.push_back(collider_of(folder, file));
    any_moves_ = std::any_of(colliders_.begin(), colliders_.end(), [](const auto& one) { return one.moves; });
    for (const FrameFile& frame : folder.frames) {
        if (!any_moves_ || !frame.moving.empty()) frames_.push_back(frame);
    }
    if (frames_.empty()) {
        throw InputError(
            fmt::format("{}: the run has moving colliders, but no frame has their positions (moving_NNNNNN.vtp)",
                        folder.frames.front().path.parent_path().string()));
    }
    if (!any_moves_) return;
    std::map<std::uint32_t, TriangleMesh> first = read_moving_meshes(frames_.front());
    for (ExportCollider& collider : colliders_) {
        if (collider.moves) collider.mesh = std::move(first[collider.number]);
        if (collider.mesh.triangles.empty() && collider.moves) {
            throw InputError(fmt::format("{}: lacks the collider {}", frames_.front().moving.string(), collider.name));
        }
    }
}

std::map<std::uint32_t, TriangleMesh> ExportColliders::moving(const FrameFile& frame) const {
    if (!any_moves_) return {};
    std::map<std::uint32_t, TriangleMesh> meshes = read_moving_meshes(frame);
    for (const ExportCollider& collider : colliders_) {
        if (!collider.moves) continue;
        const auto found = meshes.find(collider.number);
        if (found == meshes.end() || found->second.triangles != collider.mesh.triangles ||
            found->second.vertices.size() != collider.mesh.vertices.size()) {
            throw InputError(fmt::format("{}: the collider {} has other triangles than in the run's first frame",
                                         frame.moving.string(), collider.name));
        }
    }
    return meshes;
}

std::string ExportNames::take(const std::string& name, const std::vector<std::string>& endings) {
    std::string base = plain_file_name(name);
    if (base.empty()) base = "collider";
    std::string stem = base;
    const auto is_taken = [&](const std::string& ending) { return used_.contains(in_small_letters(stem + ending)); };
    for (int k = 2; std::any_of(endings.begin(), endings.end(), is_taken); ++k) stem = fmt::format("{}_{}", base, k);
    for (const std::string& ending : endings) {
        used_.insert(in_small_letters(stem + ending));
        files_.push_back(stem + ending);
    }
    return stem;
}

}  // namespace ricochet
