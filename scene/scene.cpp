#include "scene/scene.h"

#include <algorithm>

#include "scene/pose.h"

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

Bounds posedBounds(const Scene& scene, const Pose& pose) {
    Bounds world;
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        for (const Primitive& primitive : scene.meshes[scene.instances[i].mesh].primitives)
            if (!deforms(scene.instances[i], primitive))
                addBox(primitive.bounds, glm::mat4(pose.worldFromObject[i]), world);
    for (const PosedPrimitive& posed : pose.deformed)
        addBox(posed.bounds, glm::mat4(pose.worldFromObject[posed.instance]), world);
    return world;
}
}  // namespace

Bounds worldBounds(const Scene& scene) {
    return posedBounds(scene, restPose(scene));
}

Bounds animatedBounds(const Scene& scene, std::uint32_t samples) {
    Bounds world = worldBounds(scene);
    if (!isAnimated(scene)) return world;
    float duration = 0.0f;
    for (const Animation& animation : scene.animations)
        if (animation.playing) duration = std::max(duration, animation.durationSeconds);
    Pose pose;
    for (std::uint32_t s = 0; s < samples; ++s) {
        poseAt(scene, static_cast<double>(duration) * s / samples, pose);
        const Bounds posed = posedBounds(scene, pose);
        world.add(posed.min);
        world.add(posed.max);
    }
    return world;
}

std::uint64_t triangleCount(const Scene& scene) {
    std::uint64_t count = 0;
    for (const Instance& instance : scene.instances)
        for (const Primitive& primitive : scene.meshes[instance.mesh].primitives) count += primitive.indices.size() / 3;
    return count;
}

}  // namespace gnomon::renderer
