#include "renderer/scene/scene.h"

#include "renderer/scene/pose.h"

namespace gnomon::renderer {

namespace {
void addBox(const Bounds& box, const glm::mat4& worldFromObject, Bounds& world) {
    if (box.empty()) return;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 p(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                          corner & 4 ? box.max.z : box.min.z);
        world.add(glm::vec3(worldFromObject * glm::vec4(p, 1.0f)));
    }
}
}  // namespace

Bounds worldBounds(const Scene& scene) {
    Bounds world;
    bool anyDeforms = false;
    for (const Instance& instance : scene.instances)
        for (const Primitive& primitive : scene.meshes[instance.mesh].primitives) {
            if (deforms(instance, primitive))
                anyDeforms = true;
            else
                addBox(primitive.bounds, instance.worldFromObject, world);
        }
    if (!anyDeforms) return world;
    const Pose rest = restPose(scene);
    for (const PosedPrimitive& posed : rest.deformed)
        addBox(posed.bounds, glm::mat4(rest.worldFromObject[posed.instance]), world);
    return world;
}

std::uint64_t triangleCount(const Scene& scene) {
    std::uint64_t count = 0;
    for (const Instance& instance : scene.instances)
        for (const Primitive& primitive : scene.meshes[instance.mesh].primitives) count += primitive.indices.size() / 3;
    return count;
}

}  // namespace gnomon::renderer
