/// \file
/// What particles carry besides place and motion: the part of the table of scene keys about attributes, looks and their
/// curves over life, and how these are read.
#pragma once

#include <string>
#include <vector>

#include "ricochet/dynamics/emitter.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/io/detail/object_view.h"
#include "ricochet/io/detail/scene_context.h"
#include "ricochet/io/detail/scene_keys.h"

namespace ricochet::detail {

/// A declared attribute: `{"components": ..., "default": ...}`.
[[nodiscard]] const ObjectSpec& attribute_spec();
/// color, opacity, particle_size, attributes, over_life and over_age of an emitter.
[[nodiscard]] std::vector<KeySpec> emitter_look_keys();
/// color, opacity, size and attributes of an explicit particle.
[[nodiscard]] std::vector<KeySpec> particle_look_keys();

/// The declared attributes, and those for looks that emitters and explicit particles use. Reports names and defaults
/// that cannot be.
void build_attributes(SceneContext& context, SimulationSetup& setup);
/// Sets an emitter's attributes and curves; reports those that are not declared or have other components.
void read_looks(const SceneContext& context, const SimulationSetup& setup, const ObjectView& view,
                EmitterDescription& emitter);
/// The values of an explicit particle, one a column; empty when the scene has no columns.
[[nodiscard]] std::vector<AttributeValue> particle_values(const SceneContext& context, const SimulationSetup& setup,
                                                          const ObjectView& view);

}  // namespace ricochet::detail
