/// \file
/// Tolerances of impacts between spheres, and of the islands that they form. See core/tolerances.h.
#pragma once

#include <cstdint>

namespace ricochet {

/// Size of a cell of the neighbour search, relative to the largest box in it. Reason: after rounding, a box must not be
/// longer than its cell. With 2^19 cells along an axis, the rounding is 2^-33 of a cell. Smaller: neighbours may be
/// missed. Larger: more candidates.
inline constexpr double kCellSlack = 1.0 + 0x1p-20;

/// Approach speed of two touching spheres that counts as zero, relative to their speeds. Reason: the limit covers the
/// rounding of an impact that has stopped the spheres. Smaller: such pairs collide repeatedly at one time. Larger:
/// spheres overlap more.
inline constexpr double kPairApproachRounding = 0x1p-48;

/// Overlap of two spheres, relative to the smaller radius, above which the spheres count as pressed together. The
/// overlap must also have grown in a step in which the spheres moved outside a contact island. A force then presses the
/// spheres together, and single impacts cannot separate them. Reason: the limit is far above the rounding of impacts
/// and far below visible overlap. Smaller: rounding alone turns event-driven islands into contact islands. Larger:
/// spheres overlap more.
inline constexpr double kPressedOverlap = 1e-7;

/// Difference of impact times, in ulp, up to which impacts are simultaneous. Reason: the times of symmetric pairs
/// differ by rounding. Smaller: symmetric pairs are resolved sequentially. Larger: sequential impacts are resolved
/// together.
inline constexpr double kSameImpactUlps = 16.0;

/// Relative difference of approach speeds up to which the speeds count as equal, and the impacts are solved as one
/// problem. Reason: the speeds of symmetric pairs differ by the rounding of several impacts. Smaller: symmetric pairs
/// are resolved sequentially. Larger: sequential impacts are resolved together.
inline constexpr double kSameApproach = 1e-9;

/// Size of the box that bounds the motion of a sphere in a step, relative to the necessary size. Reason: it covers the
/// rounding of the path and of lasting contact. Smaller: spheres leave their boxes by rounding, and are computed twice.
/// Larger: more candidates.
inline constexpr double kPairBoxSlack = 1.0 + 0x1p-20;

/// Gap between two spheres at a predicted impact, as a part of the distance of their centres, up to which the impact is
/// resolved. Reason: the limit is far above the rounding of predicted paths. It is far below the gap of spheres that an
/// obstacle has delayed. Smaller: impacts are predicted again without need. Larger: spheres that do not touch exchange
/// impulses.
inline constexpr double kMetGap = 1e-9;

/// Gap that is allowed in addition to kMetGap for spheres in contact with walls. It is a part of the smaller radius
/// plus their paths along walls in the step. Reason: such paths consist of arcs, which are planned again up to the time
/// of impact. Their usual error is 3e-7 of the path. Smaller: impacts are predicted again without need. Larger: spheres
/// that do not touch exchange impulses.
inline constexpr double kBoundMetGap = 1e-6;

/// Largest number of Gauss-Seidel sweeps over simultaneous impacts of spheres, and the change of velocity at which the
/// sweeps end. The change is relative to the fastest approach. Reason: this change is a quarter of the rounding.
/// Smaller change: more sweeps without effect. Larger change, or fewer sweeps: the impulses are less exact.
inline constexpr int kMostImpactSweeps = 20000;
inline constexpr double kImpactSolved = 0x1p-54;

/// Number of impacts of a pair, without parting by more than kPressedOverlap in between, beyond which their contact
/// lasts. Reason: only forces bring such a pair together again. Smaller: pairs in a tight rack may count as lasting
/// contacts. Larger: elastic spheres that forces press together take more time.
inline constexpr std::uint32_t kMostRepeatedImpacts = 32;
/// The same number for impacts without a rebound. Reason: after such an impact nothing but a force or a third sphere
/// moves the pair. Smaller: a third sphere may be the cause. Larger: each landing under a load makes more impacts.
inline constexpr std::uint32_t kMostDeadImpacts = 3;

/// Expected displacement of a sphere by a neighbour, as a part of the longest path of that neighbour. It extends the
/// search for contacts. Smaller: contact islands find further contacts only in a second plan. Larger: more candidates.
inline constexpr double kExpectedPush = 0.5;

/// Ratio of radii from which a sphere counts as large beside another sphere. The margin of its contact search then does
/// not count as an expected displacement of the other sphere. Smaller: expected displacements are too short. Larger:
/// small spheres get more candidates.
inline constexpr double kLargeSphere = 3.0;

/// Largest number of plans of a contact island in a step. Each plan searches for contacts in a wider neighbourhood.
/// Smaller: fast spheres may overlap neighbours that the search missed. Larger: islands that displace distant spheres
/// take more time.
inline constexpr int kMostNetworkPlans = 8;

/// Gap between two spheres, as a part of the smaller radius, up to which they count as touching. The gap decides which
/// spheres support each other. Smaller: spheres lose their supports by residual motion. Larger: spheres in flight
/// nearby count as supports.
inline constexpr double kTouchingGap = 0.01;

/// Distance within which a moving collider may disturb a sphere that walls support, as a part of the sphere's radius.
/// Smaller: disturbed spheres are found later and computed twice. Larger: resting spheres beside moving colliders take
/// more time.
inline constexpr double kDisturbed = 0.01;

}  // namespace ricochet
