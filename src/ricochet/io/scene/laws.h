/// \file
/// Flows and forces by their "type": the keys of each beside its maker, and the lines that several of these tables
/// share.
#pragma once

#include <algorithm>
#include <functional>
#include <string_view>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/io/scene/context.h"

namespace ricochet::detail {

/// The keys of a type, and its maker from an object of these keys.
template <class Made, class... Others>
struct Law {
    Variant variant;
    std::function<Made(const ObjectView&, const Others&...)> make;
};

template <class AnyLaw>
std::vector<Variant> variants_of(const std::vector<AnyLaw>& laws) {
    std::vector<Variant> variants;
    for (const AnyLaw& law : laws) variants.push_back(law.variant);
    return variants;
}

/// Null pointer for a type that was refused.
template <class AnyLaw>
const AnyLaw* law_of(const std::vector<AnyLaw>& laws, const ObjectView& view) {
    const auto found =
        std::find_if(laws.begin(), laws.end(), [&](const AnyLaw& law) { return law.variant.name == view.type(); });
    return found == laws.end() ? nullptr : &*found;
}

/// What a maker refuses is reported with its source location. Where values were refused before, defaults stand instead
/// of them, and what is said about those means nothing.
template <class Make>
auto made(const SceneContext& context, const ObjectView& view, const Make& make) -> decltype(make()) {
    try {
        return make();
    } catch (const InputError& problem) {
        if (!context.failed()) context.error(view, problem.what());
        return nullptr;
    }
}

template <class Struct>
Field<Struct> center(Vec3 Struct::*member) {
    return {"center", member, kCoordinate, "m", "Its centre."};
}
template <class Struct>
Field<Struct> axis_point(Vec3 Struct::*member) {
    return {"point", member, kCoordinate, "m", "A point of the axis."};
}
template <class Struct>
Field<Struct> axis(Vec3 Struct::*member) {
    constexpr std::string_view kMeaning = "Direction of the axis, of any length; right-hand rule.";
    return {"axis", member, kCoordinate, "", kMeaning, kRequired, kNotZero};
}

}  // namespace ricochet::detail
