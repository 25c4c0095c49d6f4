#include "ricochet/dynamics/life_curve.h"

#include <cmath>

namespace ricochet {

AttributeValue shown_value(std::span<const LifeCurve> curves, std::string_view name, const AttributeValue& value,
                           double age, double lifetime) {
    AttributeValue shown = value;
    for (const LifeCurve& curve : curves) {
        if (curve.name != name) continue;
        const double part = std::isfinite(lifetime) && lifetime > 0.0 ? age / lifetime : 0.0;
        const Vec3 factor = curve.factor.value(curve.of_lifetime ? part : age);
        for (int axis = 0; axis < 3; ++axis) shown[axis] *= factor[axis];
    }
    return shown;
}

}  // namespace ricochet
