// Lights of the bias lab: a sun that grazes floor, ramps and back wall, a spot 52 m away, lamps at arm's length of what
// they light, and the usual ones between.

#include "scene/builtin/bias_lab.h"

#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::renderer::lab {
namespace {

const glm::vec3 kWarm(1.0f, 0.70f, 0.42f), kWhite(1.0f, 0.93f, 0.84f), kCool(0.62f, 0.80f, 1.0f);

// A place in lab space.
SceneLight& addPoint(Lab& lab, const char* name, const glm::vec3& at, const glm::vec3& colour, float candela,
                     float range, float sourceRadius) {
    SceneLight light;
    light.name = name;
    light.position = kOrigin + at;
    light.colour = colour;
    light.intensity = candela;
    light.rangeMetres = range;
    light.sourceRadius = sourceRadius;
    lab.builder.scene.lights.push_back(light);
    return lab.builder.scene.lights.back();
}

struct Spot {
    glm::vec3 at, target;
    float candela, outerAngle, range, sourceRadius;
};

void addSpot(Lab& lab, const char* name, const Spot& spot, const glm::vec3& colour) {
    SceneLight& light = addPoint(lab, name, spot.at, colour, spot.candela, spot.range, spot.sourceRadius);
    light.kind = LightKind::Spot;
    light.direction = glm::normalize(spot.target - spot.at);
    light.outerConeAngle = spot.outerAngle;
    light.innerConeAngle = 0.75f * spot.outerAngle;
}

// A stem from `foot` that bows over the light; a bulb 5 cm above it, so that nothing but the light's zenith is shaded.
void addDeskLamp(Lab& lab, const glm::vec3& light, const glm::vec3& foot) {
    ShapeBuilder black(lab.m.black), bulb(lab.m.glow);
    black.setTransform(placed(foot));
    const glm::vec2 base[] = {{0.06f, 0.0f}, {0.06f, 0.012f}, {0.008f, 0.018f}, {0.0f, 0.018f}};
    black.lathe(base, 28);
    black.setTransform(glm::mat4(1.0f));
    const glm::vec3 top = light + glm::vec3(0, 0.10f, 0);
    const glm::vec3 bow(foot.x, top.y + 0.04f, foot.z);
    const glm::vec3 path[] = {foot + glm::vec3(0, 0.01f, 0),
                              glm::mix(foot, bow, 0.8f),
                              glm::mix(bow, top, 0.12f) + glm::vec3(0, 0.01f, 0),
                              glm::mix(bow, top, 0.5f) + glm::vec3(0, 0.03f, 0),
                              glm::mix(bow, top, 0.9f) + glm::vec3(0, 0.012f, 0),
                              top - glm::vec3(0, 0.01f, 0)};
    black.tube(path, 0.005f, 10);
    black.setTransform(placed(light));
    const glm::vec2 socket[] = {{0.0f, 0.066f}, {0.022f, 0.066f}, {0.022f, 0.072f}, {0.012f, 0.098f}, {0.0f, 0.1f}};
    black.lathe(socket, 20);
    lab.place("desk lamp", black);
    bulb.sphere(light + glm::vec3(0, 0.052f, 0), 0.012f, 12, 18);
    lab.place("bulb", bulb);
}

// A can behind the light on a stand; its lens glows.
void addStudioLamp(Lab& lab, const glm::vec3& at, const glm::vec3& target, float floor) {
    ShapeBuilder black(lab.m.black), lens(lab.m.glow);
    // lookingAt's -z is the light's axis; the can's own axis is y.
    const glm::mat4 can = lookingAt(at, target) * glm::rotate(glm::mat4(1.0f), 1.5707963f, glm::vec3(1, 0, 0));
    black.setTransform(can);
    const glm::vec2 body[] = {{0.055f, 0.045f}, {0.06f, 0.04f}, {0.06f, 0.17f}, {0.03f, 0.20f}, {0.0f, 0.20f}};
    black.lathe(body, 28);
    lens.setTransform(can);
    const glm::vec2 glass[] = {{0.0f, 0.045f}, {0.055f, 0.045f}};
    lens.lathe(glass, 28);
    const glm::vec3 grip(can * glm::vec4(0, 0.12f, 0, 1));
    const glm::vec3 foot(grip.x, floor, grip.z);
    black.setTransform(glm::mat4(1.0f));
    const glm::vec3 stem[] = {grip - glm::vec3(0, 0.05f, 0), foot + glm::vec3(0, 0.01f, 0)};
    black.tube(stem, 0.012f, 12);
    black.setTransform(placed(foot));
    const glm::vec2 base[] = {{0.15f, 0.0f}, {0.15f, 0.012f}, {0.02f, 0.02f}, {0.0f, 0.02f}};
    black.lathe(base, 32);
    lab.place("studio lamp", black);
    lab.place("lens", lens);
}

void addStudioSpot(Lab& lab, const char* name, const Spot& spot, const glm::vec3& colour) {
    addSpot(lab, name, spot, colour);
    addStudioLamp(lab, spot.at, spot.target, 0.0f);
}

void addFarLights(Lab& lab) {
    SceneLight& sun = addPoint(lab, "sun", {0, 0, 0}, {1.0f, 0.74f, 0.48f}, 22.0f, 0.0f, 0.00465f);
    sun.kind = LightKind::Directional;
    sun.position = glm::vec3(0.0f);
    // 9.2 degrees above the floor, 3.5 degrees off the back wall.
    sun.direction = glm::normalize(glm::vec3(-0.98f, -0.16f, -0.06f));
    addSpot(lab, "far spot", {{-22.0f, 38.0f, -28.0f}, {0.2f, 0.0f, 0.4f}, 19000.0f, 0.125f, 75.0f, 0.05f}, kCool);
}

}  // namespace

void addLights(Lab& lab) {
    addFarLights(lab);
    addStudioSpot(
        lab, "curtain spot",
        {kCurtain + glm::vec3(1.15f, 1.75f, 2.3f), kCurtain + glm::vec3(0, 1.0f, -0.2f), 60.0f, 0.55f, 7.0f, 0.01f},
        kWarm);
    addStudioSpot(
        lab, "bust spot",
        {kBust + glm::vec3(-0.75f, 1.75f, -1.25f), kBust + glm::vec3(0.02f, 1.38f, 0), 44.0f, 0.42f, 6.0f, 0.015f},
        kWhite);
    addStudioSpot(
        lab, "plate spot",
        {kPlates + glm::vec3(1.75f, 2.3f, 1.1f), kPlates + glm::vec3(-0.1f, 0.1f, 0), 85.0f, 0.5f, 7.0f, 0.02f},
        kWhite);
    addStudioSpot(
        lab, "cloth spot",
        {kLaceCloth + glm::vec3(-0.75f, 2.1f, -1.1f), kLaceCloth + glm::vec3(0, kTable, 0), 52.0f, 0.42f, 6.0f, 0.01f},
        kWarm);

    const glm::vec3 plant = kPlant + glm::vec3(-0.35f, 1.15f, -0.75f);
    addPoint(lab, "plant lamp", plant, kWarm, 11.0f, 4.5f, 0.02f);
    addDeskLamp(lab, plant, {plant.x - 0.25f, 0.0f, plant.z - 0.2f});
    const glm::vec3 sand = kSand + glm::vec3(-0.62f, kSandLevel + 0.30f, -0.42f);
    addPoint(lab, "sand lamp", sand, kWarm, 3.6f, 4.0f, 0.008f);
    addDeskLamp(lab, sand, {sand.x - 0.02f, 0.0f, sand.z - 0.45f});
    const glm::vec3 wall = glm::vec3(1.45f, 1.48f, kWallZ + 0.30f);
    addPoint(lab, "wall lamp", wall, kWarm, 4.2f, 5.0f, 0.01f);
    addDeskLamp(lab, wall, {wall.x - 0.3f, 0.0f, wall.z + 0.1f});
    const glm::vec3 contact = kContacts + glm::vec3(-0.42f, 0.33f, 0.10f);
    addPoint(lab, "contact lamp", contact, kWhite, 4.0f, 3.5f, 0.006f);
    addDeskLamp(lab, contact, {contact.x - 0.34f, kMat, contact.z - 0.06f});
    const glm::vec3 cards = kSheets + glm::vec3(-0.1f, kTable + 0.42f, -0.28f);
    addPoint(lab, "card lamp", cards, kWhite, 4.4f, 4.0f, 0.012f);
    addDeskLamp(lab, cards, {cards.x + 0.18f, kTable, cards.z - 0.06f});
}

}  // namespace gnomon::renderer::lab
