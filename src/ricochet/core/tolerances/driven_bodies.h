/// \file
/// Tolerances of dynamic bodies: their substeps and their loads. See core/tolerances.h.
#pragma once

namespace ricochet {

/// Largest relative change of an impact by earlier impacts of the same substep, which have moved the body. It limits
/// the change of the relative velocity, as a fraction of the impact's velocity change. It also limits the energy
/// difference from a joint solution of the impacts, as a fraction of the energy that the impacts dissipate. Larger:
/// impacts ignore that light bodies have already moved; from 1 on energy grows. Smaller: more substeps.
inline constexpr double kMostBodyChange = 0.1;

/// Mass of the load on a body, relative to the body's effective mass. Above this limit the substep is planned again
/// until the planned load agrees with the actual one. Larger: from 1 on energy grows. Smaller: more plans for loads
/// that would converge from step to step without them.
inline constexpr double kHeavyLoad = 0.5;

/// Allowed difference between the planned and the actual load on a body. It is measured as a velocity change, relative
/// to the largest velocity change by the load in a substep. Larger: energy is gained or lost. Smaller: the substep is
/// planned more often.
inline constexpr double kLoadResidual = 1e-3;

/// Largest number of plans of a substep of the same duration. Smaller: substeps get shorter if loads begin and end
/// within them. Larger: such substeps are planned more often before they get shorter.
inline constexpr int kMostLoadRounds = 8;
/// Largest number of plans of a substep that cannot be shortened.
inline constexpr int kFewLoadRounds = 3;

/// Fraction of the time to the next impact, or to the step's end, after which a substep ends and bodies receive their
/// impulses. If impacts dissipate little energy, the square or cube of this fraction applies. Larger: bodies continue
/// longer without the impulses. Much smaller: grains that settle on a body cause many substeps.
inline constexpr double kPartAfterImpact = 1e-3;

/// Least duration of a substep, as a fraction of the time step. Smaller: bodies that many particles hit need more
/// substeps. Larger: more impacts are treated as simultaneous, which can add energy.
inline constexpr double kShortestPart = 1e-4;

/// Rounding of sums of exchanged energies, relative to these energies. Smaller: substeps end at every impact. Larger:
/// bodies gain energy.
inline constexpr double kImpactEnergyRounding = 1e-14;

/// After this many substeps in one step, each further substep lasts at least kShortestPart of the step. Smaller: the
/// motion of bodies among hundreds of particles of equal mass is less exact. Larger: such steps take longer.
inline constexpr int kManyParts = 1000;

/// Duration, as a part of the shortest substep, below which an impulse does not count as a lasting load. Smaller: an
/// impulse in a very short substep becomes an excessive load. Larger: lasting loads are planned too small in short
/// substeps.
inline constexpr double kShortestLoad = 0.01;

/// Margin at both ends of a substep, as a part of its duration. The end of a load within a margin does not shorten the
/// substep. Smaller: very short substeps occur. Larger: a load that ends within the margin acts too long or too short.
inline constexpr double kLoadEndMargin = 0.1;

/// Energy that a body may gain in a substep beyond the energy that the particles lose. It is a fraction of the body's
/// kinetic energies before and after. Reason: a planned load that adds more energy is wrong. Smaller: more plans.
/// Larger: energy may grow by a larger fraction.
inline constexpr double kMostLoadGain = 0.1;

/// Impulse of a load that is ignored when the end time of the load is determined. It is a fraction of all loads on the
/// body in a substep. Smaller: remaining small impulses extend loads. Larger: small lasting loads end too early.
inline constexpr double kNegligibleLoad = 1e-3;

/// Shortest time from an impact to the end of its substep, in ulp of the time. Reason: the end must certainly be later
/// than the impact. Smaller: a substep may have no duration. Larger: bodies receive their impulses later.
inline constexpr double kSoonUlps = 16.0;

/// Largest power of kPartAfterImpact that is tried. The second constant is the factor by which each further power
/// reduces the shortest duration of a substep. Smaller power or larger factor: impacts that dissipate little energy can
/// add energy. Larger power or smaller factor: more substeps.
inline constexpr int kMostPartPowers = 3;
inline constexpr double kShorterPart = 0.1;

/// Approach speed of a particle in contact, above which its impact changes the body's velocity. It is a multiple of the
/// velocity change of the body since the start of the contact. Reason: a slower particle only follows the receding
/// body. Smaller: more substeps. Larger: real impacts are treated as loads.
inline constexpr double kFollowingApproach = 2.0;

}  // namespace ricochet
