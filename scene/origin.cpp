#include "scene/origin.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "scene/pose.h"

namespace gnomon::renderer {
namespace {

constexpr double kReaches = 4.0;      // nearer than so many reaches of the content, another origin gains nothing
constexpr double kLightRadius = 1.0;  // a lamp and its housing, so that one lamp near zero is not far
constexpr double kSizes = 1024.0;     // beyond so many sizes, a float step shows on what has that size

struct Ball {
    glm::dvec3 centre{0.0};
    double radius = 0.0;
};

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

Ball ballOf(const Bounds& box, const glm::dmat4& worldFromObject) {
    const glm::dvec3 low(box.min), high(box.max);
    const glm::dmat3 linear(worldFromObject);
    const double scale = std::max({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])});
    return {glm::dvec3(worldFromObject * glm::dvec4(0.5 * (low + high), 1.0)), 0.5 * scale * glm::length(high - low)};
}

// As playing begins: a file may store anything as its pose at rest.
Pose firstPose(const Scene& scene) {
    if (isAnimated(scene)) {
        try {
            return poseAt(scene, 0.0);
        } catch (const PoseError&) {  // said when that time is drawn
        }
    }
    return restPose(scene);
}

// One per instance: its primitives are one thing.
std::vector<Ball> drawnBalls(const Scene& scene) {
    const Pose pose = firstPose(scene);
    std::vector<Bounds> boxes(scene.instances.size());
    const auto add = [&](std::size_t instance, const Bounds& box) {
        if (box.empty()) return;
        boxes[instance].add(box.min);
        boxes[instance].add(box.max);
    };
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        for (const Primitive& primitive : scene.meshes[scene.instances[i].mesh].primitives)
            if (!deforms(scene.instances[i], primitive)) add(i, primitive.bounds);
    for (const PosedPrimitive& posed : pose.deformed) add(posed.instance, posed.bounds);
    std::vector<Ball> balls;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (boxes[i].empty()) continue;
        const Ball ball = ballOf(boxes[i], pose.worldFromObject[i]);
        if (ball.radius > 0.0) balls.push_back(ball);  // a point shows nothing
    }
    return balls;
}

glm::dvec3 medianCentre(const std::vector<Ball>& balls) {
    glm::dvec3 middle(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> along;
        for (const Ball& ball : balls) along.push_back(ball.centre[axis]);
        middle[axis] = median(std::move(along));
    }
    return middle;
}

}  // namespace

glm::dvec3 originFor(const Scene& scene, std::span<const glm::dvec3> nodes, std::span<const glm::dvec3> lights) {
    std::vector<Ball> balls = drawnBalls(scene);
    if (balls.empty())
        for (const glm::dvec3& light : lights) balls.push_back({light, kLightRadius});
    if (balls.empty()) return glm::dvec3(0.0);
    const glm::dvec3 middle = medianCentre(balls);
    std::vector<double> reaches, radii;
    for (const Ball& ball : balls) {
        reaches.push_back(glm::length(ball.centre - middle) + ball.radius);
        radii.push_back(ball.radius);
    }
    const double reach = median(std::move(reaches)), far = glm::length(middle);
    if (!(far > kReaches * reach) || !(far > kSizes * median(std::move(radii)))) return glm::dvec3(0.0);
    for (const glm::dvec3& node : nodes)
        if (glm::length(node - middle) <= kReaches * reach) return node;
    const double grid = std::exp2(std::ceil(std::log2(std::max(reach, far * 0x1p-40))));
    return glm::round(middle / grid) * grid;
}

}  // namespace gnomon::renderer
