// The only file that uses Assimp. Meshes from Assimp are checked like meshes from other readers. The time and memory
// that Assimp itself uses are not bounded.
#include <assimp/config.h>
#include <assimp/scene.h>
#include <assimp/version.h>
#include <fmt/format.h>

#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <utility>
#include <vector>

#include "ricochet/core/printable.h"
#include "ricochet/geometry/mesh/mesh_source.h"
#include "ricochet/geometry/mesh/placed_mesh_builder.h"

namespace ricochet {
namespace {

/// File system that opens no files. Without it Assimp would open textures, materials and other scenes that a mesh file
/// names.
class NoFiles final : public Assimp::IOSystem {
public:
    bool Exists(const char* /*file*/) const override { return false; }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* /*file*/, const char* /*mode*/) override { return nullptr; }
    void Close(Assimp::IOStream* /*file*/) override {}
};

AffineMap map_of(const aiMatrix4x4& m) {
    return {{m.a1, m.a2, m.a3}, {m.b1, m.b2, m.b3}, {m.c1, m.c2, m.c3}, {m.a4, m.b4, m.c4}};
}

std::string text_of(const aiString& text) { return {text.data, text.length}; }

class AssimpReader {
public:
    AssimpReader(const MeshSource& source, const aiScene& scene) : source_(source), scene_(scene) {}

    ImportedMesh read(std::string format) {
        std::vector<Open> open = {{scene_.mRootNode, {}}};
        while (!open.empty()) {
            const Open at = open.back();
            open.pop_back();
            const AffineMap world = joined(at.world_from_parent, map_of(at.node->mTransformation));
            for (unsigned m = 0; m < at.node->mNumMeshes; ++m) add(*at.node, mesh_at(at.node->mMeshes[m]), world);
            for (unsigned c = at.node->mNumChildren; c-- > 0;) open.push_back({at.node->mChildren[c], world});
        }
        ImportedMesh result = builder_.finish(std::move(format));
        result.notes = notes();
        return result;
    }

private:
    struct Open {
        const aiNode* node = nullptr;
        AffineMap world_from_parent;
    };

    const aiMesh& mesh_at(unsigned number) const {
        if (number >= scene_.mNumMeshes) source_.fail("a node of it names a mesh that is not there");
        return *scene_.mMeshes[number];
    }

    void add(const aiNode& node, const aiMesh& mesh, const AffineMap& world) {
        const std::string name = text_of(mesh.mName);
        if (mesh.mNumBones > 0) {
            source_.fail(
                fmt::format("the mesh {} is posed by the bones of an armature, which are not followed: apply "
                            "the armature before exporting",
                            in_quotes(name)));
        }
        builder_.begin(world, text_of(node.mName), name);
        if (mesh.mMaterialIndex < scene_.mNumMaterials) {
            builder_.set_material(text_of(scene_.mMaterials[mesh.mMaterialIndex]->GetName()));
        }
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) add(mesh, mesh.mFaces[f]);
        builder_.end();
    }

    void add(const aiMesh& mesh, const aiFace& face) {
        if (face.mNumIndices < 3) {
            ++left_out_;
            return;
        }
        corners_ += face.mNumIndices;
        if (corners_ > kLargestIndexCount) source_.fail(fmt::format("more than {} corners", kLargestIndexCount));
        for (unsigned k = 0; k < face.mNumIndices; ++k) {
            const unsigned index = face.mIndices[k];
            if (index >= mesh.mNumVertices) {
                source_.fail(fmt::format("vertex {} of the mesh {}, but it has {}", index,
                                         in_quotes(text_of(mesh.mName)), mesh.mNumVertices));
            }
            const aiVector3D& p = mesh.mVertices[index];
            if (const auto wrong = builder_.add_corner({p.x, p.y, p.z})) source_.fail(misplaced_point(index, *wrong));
        }
        builder_.end_face();
    }

    [[nodiscard]] std::vector<std::string> notes() const {
        std::vector<std::string> notes = {
            "read by Assimp: coordinates have single precision and the file's own unit of length, and time and memory "
            "are not bounded by the file's size"};
        if (left_out_ > 0) {
            notes.push_back(fmt::format("points and lines left out ({}): particles do not hit them", left_out_));
        }
        if (scene_.mNumAnimations > 0) {
            notes.emplace_back("animations are not played: everything stands as the nodes of the file say");
        }
        return notes;
    }

    const MeshSource& source_;
    const aiScene& scene_;
    PlacedMeshBuilder builder_;
    std::uint64_t corners_ = 0;
    std::size_t left_out_ = 0;
};

}  // namespace

ImportedMesh read_foreign(const MeshSource& source, const std::string& extension) {
    Assimp::Importer importer;
    importer.SetIOHandler(new NoFiles);                                          // the importer takes ownership
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);  // names instead of ids
    const std::string hint = extension.substr(std::min<std::size_t>(1, extension.size()));
    const aiScene* const scene = importer.ReadFileFromMemory(source.bytes.data(), source.bytes.size(), 0, hint.c_str());
    constexpr std::size_t kLongest = 200;
    if (scene == nullptr || scene->mRootNode == nullptr) {
        source.fail(fmt::format("Assimp cannot read it ({})", printable(importer.GetErrorString(), kLongest)));
    }
    if ((scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE) != 0) source.fail("Assimp could not read it to its end");
    std::string name = hint;
    for (char& c : name) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    return AssimpReader(source, *scene)
        .read(
            fmt::format("{}, by Assimp {}.{}.{}", name, aiGetVersionMajor(), aiGetVersionMinor(), aiGetVersionPatch()));
}

bool reads_foreign() { return true; }

}  // namespace ricochet
