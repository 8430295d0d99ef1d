#include "scene/things.h"

#include <algorithm>

namespace gnomon::renderer {
namespace {

Bounds boxInWorld(const Bounds& box, const glm::dmat4& worldFromObject) {
    Bounds world;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 p(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                           corner & 4 ? box.max.z : box.min.z, 1.0);
        world.add(glm::vec3(worldFromObject * p));
    }
    return world;
}

}  // namespace

WorldTriangle triangleOf(const Thing& thing, std::size_t triangle) {
    const auto corner = [&](std::size_t k) {
        return glm::dvec3(thing.worldFromObject *
                          glm::dvec4(glm::dvec3((*thing.positions)[(*thing.indices)[3 * triangle + k]]), 1.0));
    };
    return {corner(0), corner(1), corner(2)};
}

std::vector<bool> movingInstances(const Scene& scene) {
    std::vector<bool> moves(scene.instances.size());
    if (!isAnimated(scene)) return moves;
    for (std::size_t i = 0; i < moves.size(); ++i) {
        const Instance& instance = scene.instances[i];
        moves[i] =
            instance.node != kNone || std::ranges::any_of(scene.meshes[instance.mesh].primitives,
                                                          [&](const Primitive& p) { return deforms(instance, p); });
    }
    return moves;
}

std::vector<Thing> thingsOf(const Scene& scene, const Pose& pose, const std::vector<bool>& moves, bool moving) {
    std::vector<Thing> things;
    auto posed = pose.deformed.begin();
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        const std::vector<Primitive>& primitives = scene.meshes[scene.instances[i].mesh].primitives;
        for (std::uint32_t k = 0; k < primitives.size(); ++k) {
            const bool bent = deforms(scene.instances[i], primitives[k]);
            const PosedPrimitive* shape = bent ? &*posed++ : nullptr;
            const Bounds& box = bent ? shape->bounds : primitives[k].bounds;
            if (moves[i] != moving || box.empty()) continue;
            things.push_back({boxInWorld(box, pose.worldFromObject[i]), i, k, primitives[k].indices.size() / 3,
                              bent ? &shape->positions : &primitives[k].positions, &primitives[k].indices,
                              pose.worldFromObject[i], bent});
        }
    }
    return things;
}

}  // namespace gnomon::renderer
