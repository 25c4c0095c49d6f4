#include "ricochet/queries/mesh_queries.h"

#include <utility>

#include "ricochet/queries/mesh_index.h"

namespace ricochet {

MeshQueries::MeshQueries(TriangleMesh mesh) : index_(std::make_shared<const MeshIndex>(std::move(mesh))) {}

const TriangleMesh& MeshQueries::mesh() const { return index_->mesh(); }

void MeshQueries::set_vertices(std::span<const Vec3> vertices) {
    index_ = std::make_shared<const MeshIndex>(*index_, vertices);
}

bool MeshQueries::is_closed() const { return index_->is_closed(); }

}  // namespace ricochet
