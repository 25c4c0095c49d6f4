/// \file
/// Private to first-order motion: one particle on its way with the flow through one step.
#pragma once

#include <optional>
#include <span>

#include "ricochet/dynamics/flow_path.h"
#include "ricochet/response/bounce.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/impact.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// A flow without its part into surfaces.
class FlowAlong final : public FlowField {
public:
    FlowAlong(const FlowField& flow, std::span<const Vec3> normals) : flow_(flow), normals_(normals) {}
    [[nodiscard]] Vec3 velocity(const Vec3& position, double time) const override {
        const Vec3 free = flow_.velocity(position, time);
        return normals_.empty() ? free : project_off(free, normals_);
    }
    [[nodiscard]] bool is_steady() const override { return flow_.is_steady(); }

private:
    const FlowField& flow_;
    std::span<const Vec3> normals_;
};

class Advector {
public:
    Advector(const ResponseRules& rules, MovingParticle& particle, double duration, MoveScratch& scratch)
        : rules_(rules),
          flow_(*rules.settings.flow),
          particle_(particle),
          state_(particle.state),
          scratch_(scratch),
          geometry_(rules.world, scratch.contacts.plane_cache),
          impact_(rules, particle, scratch, outcome_),
          manifold_(geometry_, state_),
          remaining_(duration) {}

    MoveOutcome run();

private:
    // On the way (advect.cpp).
    void go_on();
    [[nodiscard]] Path held_down(const Path& path, const Vec3& normal, const FlowField& along) const;
    void wait();
    [[nodiscard]] double time_to_release() const;
    [[nodiscard]] bool is_pressed_at(double time) const;
    std::optional<Contact> follow(const Path& path);
    void leave_surface(const NearSurfaces& near);
    void accept_chain();
    void answer(const Contact& contact);
    void finish();

    // Along surfaces (advect_surface.cpp).
    [[nodiscard]] std::optional<std::size_t> hardest_pressed() const;
    [[nodiscard]] Path stretch_on(const ContactSurface& support, Path path) const;
    [[nodiscard]] Path stretch_on_flat(const ContactSurface& support, Path path) const;
    [[nodiscard]] Path stretch_on_curved(const ContactSurface& support, Path path) const;
    [[nodiscard]] TouchRule touch_rule() const;
    [[nodiscard]] Vec3 flow_now() const { return flow_.velocity(state_.position, state_.time); }

    const ResponseRules& rules_;
    const FlowField& flow_;
    MovingParticle& particle_;
    ForceInput& state_;
    MoveScratch& scratch_;
    SurfaceGeometry geometry_;
    MoveOutcome outcome_;
    ImpactAnswer impact_;
    ContactManifold manifold_;
    double remaining_;
    double next_duration_ = 0.0;   // s, of an adaptive method
    std::uint32_t stretches_ = 0;  // along surfaces; they share the budget with the impacts
};

}  // namespace ricochet
