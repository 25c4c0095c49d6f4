/// \file
/// Tolerances of impacts between spheres, and of the islands that they form. See core/tolerances.h.
#pragma once

#include <cstddef>

namespace ricochet {

/// Size of a cell of the neighbour search, relative to the boxes in it. Reason: a box must not be longer than its cell
/// after rounding, and 2^19 cells along an axis leave 2^-33. Smaller: neighbours may be missed. Larger: more
/// candidates.
inline constexpr double kCellSlack = 1.0 + 0x1p-20;

/// Approach of two touching spheres that counts as zero, relative to their speeds. Reason: some roundings of an impact
/// that has stopped them. Smaller: such pairs collide repeatedly at one time. Larger: spheres overlap more.
inline constexpr double kPairApproachRounding = 0x1p-48;

/// Overlap of two spheres, relative to the smaller radius, from which they press on each other. The overlap must have
/// grown in a step without a common plan. Then a force presses the spheres together, and impacts alone cannot resolve
/// that. Reason: far above the rounding of impacts, far below visible overlap. Smaller: rounding alone turns
/// event-driven islands into contact islands. Larger: spheres overlap by as much.
inline constexpr double kPressedOverlap = 1e-7;

/// Difference of impact times, in ulp, up to which impacts are simultaneous. Reason: roundings of the times of
/// symmetric pairs. Smaller: symmetric pairs are resolved sequentially. Larger: sequential impacts are resolved
/// together.
inline constexpr double kSameImpactUlps = 16.0;

/// Relative difference of approach speeds up to which they are equal and the impacts are solved as one problem. Reason:
/// as for kSameImpactUlps, after some rounds. Smaller and larger: as for kSameImpactUlps.
inline constexpr double kSameApproach = 1e-9;

/// Size of the box in which a sphere declares to stay, relative to the necessary size. Reason: roundings of its path,
/// and of lasting contact. Smaller: spheres leave their boxes by rounding, and are processed twice. Larger: more
/// candidates.
inline constexpr double kPairBoxSlack = 1.0 + 0x1p-20;

/// Gap between two spheres at a predicted impact, as a part of the distance of their centres, up to which the impact is
/// resolved. Reason: far above the rounding of predicted paths, far below the path in the time lost on the way.
/// Smaller: impacts are predicted again without need. Larger: spheres that do not touch exchange impulses.
inline constexpr double kMetGap = 1e-9;

/// The same as a part of the paths along walls in the step, and of the smaller radius. Reason: such paths consist of
/// arcs, which are planned again up to the time of impact; 3e-7 of the path is usual. Smaller and larger: as for
/// kMetGap.
inline constexpr double kBoundMetGap = 1e-6;

/// Most Gauss-Seidel sweeps over simultaneous impacts of spheres, and the change of velocity, relative to the fastest
/// approach, that ends them. Reason: a quarter of the rounding. Smaller change: sweeps without effect. Larger change,
/// or fewer sweeps: the impulses are less exact.
inline constexpr int kMostImpactSweeps = 20000;
inline constexpr double kImpactSolved = 0x1p-54;

/// Impacts per sphere and step beyond which an island is time-stepped as a contact island: if impacts lose energy, and
/// if none does. Reason: a contact island loses the energy that elastic impacts would keep. Smaller: sparse islands are
/// time-stepped. Larger: dense islands cost more.
inline constexpr std::size_t kMostImpactsPerSphere = 4;
inline constexpr std::size_t kMostElasticImpactsPerSphere = 64;

/// The limit of impacts for a single sphere, if impacts lose energy. Reason: such a sphere is pressed between its
/// neighbours, however few impacts the rest of the island has. Smaller and larger: as before.
inline constexpr std::size_t kMostImpactsOfSphere = 100;

/// Expected displacement of a sphere by a neighbour, as a part of the longest path of that neighbour. It enlarges the
/// search for contacts. Smaller: contact islands find further contacts only in a second plan. Larger: more candidates.
inline constexpr double kExpectedPush = 0.5;

/// Ratio of radii from which a sphere counts as large beside another. The margin of its contact search then does not
/// count as a push. Smaller: real pushes are expected to be shorter. Larger: small spheres get more candidates.
inline constexpr double kLargeSphere = 3.0;

/// Most plans of a contact island in a step, each with a wider search for contacts. Smaller: fast spheres may overlap
/// neighbours that the search missed. Larger: islands that push far cost more.
inline constexpr int kMostNetworkPlans = 8;

/// Gap between two spheres, as a part of the smaller radius, up to which they count as touching. It decides which
/// spheres support each other. Smaller: spheres lose their supports by residual motion. Larger: spheres that fly past
/// count as supports.
inline constexpr double kTouchingGap = 0.01;

/// Distance of a moving collider from a sphere that walls support, as a part of its radius, within which it may disturb
/// the sphere. Smaller: disturbed spheres are found later and moved twice. Larger: resting spheres beside machines cost
/// more.
inline constexpr double kDisturbed = 0.01;

}  // namespace ricochet
