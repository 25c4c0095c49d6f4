// Frames of reference of a scene.
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "ricochet/dynamics/frame_tree.h"
#include "ricochet/io/detail/curve_keys.h"
#include "ricochet/io/detail/scene_context.h"

namespace ricochet::detail {
namespace {

FrameDescription frame_of(const ObjectView& view, Diagnostics& diagnostics) {
    FrameDescription frame;
    frame.parent = view.text("parent");
    frame.translation = view.vector("translation");
    if (view.has("rotation")) {
        const ObjectView rotation = view.object("rotation");
        if (rotation.has("axis")) frame.rotation_axis = rotation.vector("axis");
        frame.rotation_degrees = rotation.number("degrees");
    }
    for (const ObjectView& motion : view.objects("motions")) {
        if (motion.type() == "rotation") {
            const Vec3 axis = motion.has("axis") ? motion.vector("axis") : Vec3{0, 0, 1};
            frame.motions.emplace_back(KeyedRotation{axis, number_curve_of(motion.object("angle"), diagnostics)});
        } else if (motion.type() == "translation") {
            frame.motions.emplace_back(KeyedTranslation{vector_curve_of(motion.object("way"), diagnostics)});
        }
    }
    return frame;
}

// Reports parents that are not there or lead back.
bool are_good_parents(const SceneContext& context, const std::vector<FrameDescription>& frames,
                      const std::vector<ObjectView>& views) {
    std::vector<std::string_view> names;
    for (const FrameDescription& frame : frames) names.push_back(frame.name);
    bool good = true;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const std::string& parent = frames[i].parent;
        if (parent.empty() || std::find(names.begin(), names.end(), parent) != names.end()) continue;
        context.error(views[i], "parent", unknown_name("frame", parent, names));
        good = false;
    }
    if (const auto circle = frame_in_circle(frames)) {
        context.error(views[*circle], "parent",
                      "the frame's parents lead back to it, expected one that stands in the world in the end");
        good = false;
    }
    return good;
}

}  // namespace

std::shared_ptr<const FrameTree> frames_of(const SceneContext& context) {
    const JsonNode::Object* members = context.root().node("frames").object();
    if (members == nullptr) return std::make_shared<const FrameTree>();
    const ObjectSpec& spec = *find_key(scene_spec(), nullptr, "frames")->content;
    std::vector<FrameDescription> frames;
    std::vector<ObjectView> views;
    for (const JsonMember& member : *members) {
        views.emplace_back(member.value, spec, path_of_key("frames", member.key));
        frames.push_back(frame_of(views.back(), context.diagnostics()));
        frames.back().name = member.key;
    }
    if (!are_good_parents(context, frames, views) || context.diagnostics().failed()) {
        for (FrameDescription& frame : frames) frame.parent.clear();  // the names are still good
    }
    if (context.diagnostics().failed()) std::erase_if(frames, [](const auto& frame) { return frame.name.empty(); });
    return std::make_shared<const FrameTree>(std::move(frames));
}

}  // namespace ricochet::detail
