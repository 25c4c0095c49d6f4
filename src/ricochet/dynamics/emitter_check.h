/// \file
/// Check of an emitter's description.
#pragma once

#include "ricochet/dynamics/emitter.h"

namespace ricochet {

/// Throws an InputError with the name of the emitter and the demand, unless the condition holds.
void require(bool condition, const EmitterDescription& emitter, const char* demand);
/// Throws an InputError that names the emitter and the member if a member is outside the ranges that EmitterDescription
/// states. Rates that exclude each other and the shape are checked by the class Emitter.
void check_emitter(const EmitterDescription& emitter);

}  // namespace ricochet
