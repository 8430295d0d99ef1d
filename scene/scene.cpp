#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <set>

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

bool isReachable(const glm::vec3& p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= kFarthestMetres;
}

// Even steps over the longest animation that plays, and key times, where whatever moves turns around: all of them, or
// an even choice of four per step.
std::vector<double> sampleTimes(const Scene& scene, std::uint32_t samples) {
    std::set<float> keys;
    float duration = 0.0f;
    for (const Animation& animation : scene.animations) {
        if (!animation.playing) continue;
        duration = std::max(duration, animation.durationSeconds);
        for (const AnimationChannel& channel : animation.channels)
            keys.insert(channel.times.begin(), channel.times.end());
    }
    std::vector<double> times;
    for (std::uint32_t s = 0; s < samples; ++s) times.push_back(static_cast<double>(duration) * s / samples);
    const std::size_t step = keys.size() / (4 * std::size_t{samples} + 1) + 1;
    std::size_t k = 0;
    for (float key : keys)
        if (k++ % step == 0 && key < duration) times.push_back(static_cast<double>(key));
    // The last key: at the duration itself the loop begins anew.
    times.push_back(static_cast<double>(std::nextafter(duration, 0.0f)));
    return times;
}
}  // namespace

Bounds worldBounds(const Scene& scene) {
    return posedBounds(scene, restPose(scene));
}

void forEachPose(const Scene& scene, std::uint32_t samples, const std::function<void(const Pose&)>& work) {
    Pose pose;
    bool posed = false;
    for (double seconds : isAnimated(scene) ? sampleTimes(scene, samples) : std::vector<double>()) {
        try {
            poseAt(scene, seconds, pose);
        } catch (const PoseError&) {  // said when that time is drawn
            pose = {};
            continue;
        }
        work(pose);
        posed = true;
    }
    if (!posed) work(restPose(scene));
}

AnimatedExtent animatedExtent(const Scene& scene, std::uint32_t samples) {
    AnimatedExtent extent;
    extent.lights.resize(scene.lights.size());
    const auto add = [&](const Pose& pose) {
        const Bounds posed = posedBounds(scene, pose);
        if (!posed.empty() && isReachable(posed.min) && isReachable(posed.max)) {
            extent.drawn.add(posed.min);
            extent.drawn.add(posed.max);
        }
        for (std::size_t i = 0; i < pose.lights.size(); ++i)
            if (isReachable(pose.lights[i].position)) extent.lights[i].add(pose.lights[i].position);
    };
    forEachPose(scene, samples, add);
    if (isAnimated(scene) && extent.drawn.empty() && !scene.instances.empty()) add(restPose(scene));
    for (std::size_t i = 0; i < extent.lights.size(); ++i)
        if (extent.lights[i].empty()) extent.lights[i].add(scene.lights[i].position);
    return extent;
}

std::uint64_t triangleCount(const Scene& scene) {
    std::uint64_t count = 0;
    for (const Instance& instance : scene.instances)
        for (const Primitive& primitive : scene.meshes[instance.mesh].primitives) count += primitive.indices.size() / 3;
    return count;
}

float leastOpaqueAlpha(const Material& material) {
    constexpr float kGranted = 1.0f / (8.0f * 255.0f);
    if (material.alphaMode == AlphaMode::Opaque) return -1.0f;
    const float cutoff = material.alphaMode == AlphaMode::Blend ? 0.5f : material.alphaCutoff;
    return cutoff > 1.0f ? cutoff : cutoff - kGranted;  // above 1 all is cut out, by definition
}

}  // namespace gnomon::renderer
