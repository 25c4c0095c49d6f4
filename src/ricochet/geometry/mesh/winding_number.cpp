#include "ricochet/geometry/mesh/winding_number.h"

#include <cmath>
#include <numbers>

namespace ricochet {

double winding_number(const TriangleMesh& mesh, const Vec3& p) {
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3 a = mesh.vertices[t[0]] - p;
        const Vec3 b = mesh.vertices[t[1]] - p;
        const Vec3 c = mesh.vertices[t[2]] - p;
        const double la = length(a);
        const double lb = length(b);
        const double lc = length(c);
        sum += std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
    }
    return sum / (2.0 * std::numbers::pi);
}

}  // namespace ricochet
