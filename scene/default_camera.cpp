// The camera of a scene that has none.
//
// It looks from the front right and above, at the bulk of the scene (scene/bulk.h), through all of its animation. The
// eye stands where a picture of 4:3 with kField shows it. Then both sides are fitted exactly, vertex by vertex, and the
// camera states the shape of what it shows. So fittedCamera() makes it touch two edges of a picture of any shape.

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "scene/bulk.h"
#include "scene/outline.h"
#include "scene/pose.h"
#include "scene/scene.h"
#include "scene/things.h"

namespace gnomon::renderer {
namespace {

constexpr double kField = 0.9;  // radians, of the height
constexpr double kShape = 4.0 / 3.0;
constexpr double kMargin = 1.05;      // of what is seen, to what is framed
constexpr double kFurtherOff = 0.5;   // no nearer to the nearest point than so many depths of all
constexpr double kThinnest = 1.0e-3;  // of one side to the other, where all lies in a line
constexpr double kNearOfNearest = 0.01;
constexpr double kToAPoint = 3.0;  // a single point has no size

bool withinReach(const Bounds& box) {
    return std::max({std::abs(box.min.x), std::abs(box.min.y), std::abs(box.min.z), std::abs(box.max.x),
                     std::abs(box.max.y), std::abs(box.max.z)}) <= kFarthestMetres;
}

void append(std::vector<Thing>& things, std::vector<Thing> more, bool anywhere) {
    for (const Thing& thing : more)
        if (anywhere || withinReach(thing.box)) things.push_back(thing);
}

// All that is drawn, as playing begins, and what moves later: of what deforms the boxes alone.
struct Drawn {
    Pose pose;
    std::vector<Thing> first, later;
};

void addLater(std::vector<Thing> things, Drawn& drawn) {
    for (Thing& thing : things)
        if (thing.deforms) thing.positions = nullptr;  // gone with the pose
    append(drawn.later, std::move(things), false);
}

Drawn everythingDrawn(const Scene& scene, const std::vector<bool>& moves) {
    Drawn drawn;
    bool begun = false;
    forEachPose(scene, kExtentSamples, [&](const Pose& pose) {
        if (begun) return addLater(thingsOf(scene, pose, moves, true), drawn);
        begun = true;
        drawn.pose = pose;
        for (const bool moving : {false, true}) append(drawn.first, thingsOf(scene, drawn.pose, moves, moving), false);
    });
    if (!drawn.first.empty() || scene.instances.empty()) return drawn;
    drawn.pose = restPose(scene);
    for (const bool moving : {false, true}) append(drawn.first, thingsOf(scene, drawn.pose, moves, moving), true);
    return drawn;
}

std::vector<Thing> lightsAsThings(const Scene& scene) {
    const AnimatedExtent extent = animatedExtent(scene);
    std::vector<Thing> things;
    for (std::uint32_t i = 0; i < scene.lights.size(); ++i)
        if (scene.lights[i].kind != LightKind::Directional) things.push_back({extent.lights[i], i, 0, 1});
    return things;
}

// As seen along fixed axes from the middle of the bulk.
class Framing {
public:
    Framing(const Bulk& bulk, const glm::dmat3& axes) : bulk_(bulk), axes_(axes) {}

    void add(const Thing& thing) {
        if (thing.positions == nullptr) return addCorners(thing);
        if (bulk_.holdsAllOf(thing)) return addVertices(thing);
        bulk_.forEachHeld(thing, [&](const WorldTriangle& t) {
            for (const glm::dvec3& p : t) addPoint(p);
        });
    }
    // Of something that deforms: all of it or nothing, as its box is held by the bulk.
    void addDeformed(const Thing& thing) {
        if (bulk_.holdsBoxOf(thing)) addVertices(thing);
    }
    [[nodiscard]] const Outline& outline() const { return outline_; }

private:
    void addVertices(const Thing& thing) {
        for (const glm::vec3& p : *thing.positions)
            addPoint(glm::dvec3(thing.worldFromObject * glm::dvec4(glm::dvec3(p), 1.0)));
    }
    void addCorners(const Thing& thing) {
        if (!bulk_.holdsBoxOf(thing)) return;
        const auto& [low, high] = thing.box;
        for (int corner = 0; corner < 8; ++corner)
            addPoint(glm::dvec3(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z));
    }
    void addPoint(const glm::dvec3& p) { outline_.add((p - bulk_.middle()) * axes_); }

    const Bulk& bulk_;
    glm::dmat3 axes_;
    Outline outline_;
};

// Vertices that deform are there while their pose is.
void addDeformed(const Scene& scene, const std::vector<bool>& moves, Framing& framing) {
    forEachPose(scene, kExtentSamples, [&](const Pose& pose) {
        if (pose.deformed.empty()) return;
        for (const bool moving : {false, true})
            for (const Thing& thing : thingsOf(scene, pose, moves, moving))
                if (thing.deforms && withinReach(thing.box)) framing.addDeformed(thing);
    });
}

// The camera has its axes.
void fit(const Outline& outline, const glm::dvec3& middle, SceneCamera& camera) {
    const glm::dmat3 axes(camera.worldFromCamera);
    glm::dvec3 eye(0.0, 0.0, kToAPoint);
    double nearest = kToAPoint;
    const double depth = outline.nearestZ() - outline.farthestZ(), slope = std::tan(0.5 * kField) / kMargin;
    const double z = std::max(outline.eyeZ(kShape * slope, slope), outline.nearestZ() + kFurtherOff * depth);
    if (z > outline.nearestZ()) {
        const Span across = outline.across(z), up = outline.up(z);
        const double thinnest = kThinnest * std::max({across.slope, up.slope, slope});
        const double wide = std::max(across.slope, thinnest), high = std::max(up.slope, thinnest);
        camera.verticalFieldOfView = static_cast<float>(2.0 * std::atan(kMargin * high));
        camera.widthOverHeight = static_cast<float>(wide / high);
        eye = {across.centre, up.centre, z};
        nearest = z - outline.nearestZ();
    }
    camera.worldFromCamera[3] = glm::vec4(glm::vec3(middle + axes * eye), 1.0f);
    camera.nearMetres = static_cast<float>(kNearOfNearest * nearest);
}

}  // namespace

SceneCamera defaultCamera(const Scene& scene) {
    if (!scene.cameras.empty()) return scene.cameras.front();
    SceneCamera camera;
    camera.name = "default";
    camera.worldFromCamera = lookingAt(glm::vec3(0.75f, 0.5f, 1.0f), glm::vec3(0.0f));
    const std::vector<bool> moves = movingInstances(scene);
    Drawn drawn = everythingDrawn(scene, moves);
    const bool ofLights = drawn.first.empty();
    if (ofLights) drawn.first = lightsAsThings(scene);
    const Bulk bulk(drawn.first, drawn.later);
    Framing framing(bulk, glm::dmat3(camera.worldFromCamera));
    for (const std::vector<Thing>* things : {&drawn.first, &drawn.later})
        for (const Thing& thing : *things)
            if (!thing.deforms) framing.add(thing);
    if (!ofLights) addDeformed(scene, moves, framing);
    fit(framing.outline(), bulk.middle(), camera);
    if (bulk.leftOut() != 0)
        camera.note = fmt::format(
            "The default camera leaves {} of {} {} out of its frame, since they are far from the rest or around it.",
            bulk.leftOut(), bulk.size(), ofLights ? "lights" : "triangles");
    return camera;
}

}  // namespace gnomon::renderer
