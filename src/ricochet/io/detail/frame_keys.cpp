#include "ricochet/io/detail/frame_keys.h"

#include <utility>

#include "ricochet/io/detail/curve_keys.h"
#include "ricochet/io/detail/key_ranges.h"

namespace ricochet::detail {
namespace {

const ObjectSpec& motion_spec() {
    static const ObjectSpec spec = [] {
        KeySpec angle = number_curve_key("angle", "The angle: a curve.", "degrees");
        angle.required = true;
        KeySpec way = vector_curve_key("way", "Where the origin goes: a curve of [x, y, z].", "m");
        way.required = true;
        return ObjectSpec{
            .title = "frame motion",
            .description = "How a frame moves, in the axes that the motions before it have led to.",
            .keys = {},
            .variants = {{.name = "rotation",
                          .description = "A turn about an axis through the frame's origin, by the right-hand rule.",
                          .keys = {{.name = "axis",
                                    .type = ValueType::vector,
                                    .description = "Direction of the axis, of any length.",
                                    .range = kCoordinate,
                                    .required = true,
                                    .not_zero = true},
                                   std::move(angle)}},
                         {.name = "translation", .description = "A way along a curve.", .keys = {std::move(way)}}}};
    }();
    return spec;
}

}  // namespace

const ObjectSpec& frame_spec() {
    static const ObjectSpec spec{
        .title = "frame",
        .description =
            "A moving frame of reference, for emitters. It stands in its parent like this: translation, "
            "rotation, then the motions in their order.",
        .keys = {{.name = "parent",
                  .type = ValueType::text,
                  .description = "One of the names in `frames`: what it stands in.",
                  .without = "the world"},
                 {.name = "translation",
                  .type = ValueType::vector,
                  .description = "Where its origin is in the parent's axes.",
                  .unit = "m",
                  .range = kCoordinate,
                  .fallback = "[0, 0, 0]"},
                 {.name = "rotation",
                  .type = ValueType::object,
                  .description = "Turns it.",
                  .without = "not turned",
                  .content = &rotation_spec()},
                 {.name = "motions",
                  .type = ValueType::list,
                  .description = "How it moves: rotations and translations keyed in time.",
                  .fallback = "[]",
                  .content = &motion_spec()}}};
    return spec;
}

}  // namespace ricochet::detail
