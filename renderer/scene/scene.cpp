#include "renderer/scene/scene.h"

namespace gnomon::renderer {

Bounds worldBounds(const Scene& scene) {
    Bounds world;
    for (const Instance& instance : scene.instances)
        for (const Primitive& primitive : scene.meshes[instance.mesh].primitives) {
            const Bounds& b = primitive.bounds;
            if (b.empty()) continue;
            for (int corner = 0; corner < 8; ++corner) {
                const glm::vec3 p(corner & 1 ? b.max.x : b.min.x, corner & 2 ? b.max.y : b.min.y,
                                  corner & 4 ? b.max.z : b.min.z);
                world.add(glm::vec3(instance.worldFromObject * glm::vec4(p, 1.0f)));
            }
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
