/// \file
/// When particles give birth to particles.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "ricochet/dynamics/mean_spread.h"

namespace ricochet {

/// What a particle gives birth at.
enum class BirthEvent {
    life,    ///< all its life long, at a rate
    death,   ///< at the end of its lifetime, or when a surface absorbs it
    impact,  ///< at an impact whose impulse reaches the threshold
};

[[nodiscard]] std::optional<BirthEvent> birth_event_from_name(std::string_view name);

/// The rule by which an emitter's particles come from other particles.
struct ParentRule {
    std::uint32_t emitter = 0;  ///< whose particles are the parents, as its number in the scene
    bool recursive = false;     ///< the children are parents in the same way too
    BirthEvent on = BirthEvent::life;
    MeanSpread count{1.0, 0.0};      ///< children of a death or impact; rounded, negative draws count as 0
    double threshold_impulse = 0.0;  ///< N s, >= 0: least impulse of an impact that gives birth
    /// The parent ends and its children share its mass and momentum: description.mass is the weight of a share, radii
    /// follow from masses at the parent's density. Not for life.
    bool share = false;
    double inherit_velocity = 1.0;  ///< part of the parent's velocity that a child begins with; 1 when sharing
    double inherit_color = 0.0;     ///< 0..1, part of the parent's colour in the child's own
};

}  // namespace ricochet
