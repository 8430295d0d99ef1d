// Lanterns, festoon ropes and lamps of the courtyard, each with its light. Every lamp mesh has the light's place as its
// origin and leaves at least 4 cm of air around it: the glowing part is a bulb or flame next to the light, since one
// that enclosed the light would shadow everything.

#include "renderer/builtin/courtyard.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::renderer::courtyard {
namespace {

const glm::vec3 kWarm(1.0f, 0.56f, 0.24f), kAmber(1.0f, 0.46f, 0.15f), kCool(0.45f, 0.68f, 1.0f),
    kTeal(0.25f, 0.85f, 0.9f);

void addPoint(Parts& parts, const char* name, const glm::vec3& at, const glm::vec3& colour, float candela, float range,
              float sourceRadius) {
    SceneLight light;
    light.name = name;
    light.position = at;
    light.colour = colour;
    light.intensity = candela;
    light.rangeMetres = range;
    light.sourceRadius = sourceRadius;
    parts.builder.scene.lights.push_back(light);
}

// Four posts, thin rings above and below, a pyramid roof; open to the sides.
void addCage(ShapeBuilder& cage, float low, float high) {
    constexpr float kHalf = 0.1f, kBar = 0.006f;
    for (const float x : {-kHalf, kHalf})
        for (const float z : {-kHalf, kHalf}) cage.box({x - kBar, low - 0.004f, z - kBar}, {x + kBar, high, z + kBar});
    for (const float y : {low, high - 0.05f}) {  // none at the light's own height: it would darken the horizon
        for (const float s : {-kHalf, kHalf}) {
            cage.box({-kHalf, y, s - 0.8f * kBar}, {kHalf, y + 0.012f, s + 0.8f * kBar});
            cage.box({s - 0.8f * kBar, y, -kHalf}, {s + 0.8f * kBar, y + 0.012f, kHalf});
        }
    }
    const glm::vec2 roof[] = {{0.0f, high - 0.005f}, {0.17f, high - 0.005f}, {0.17f, high + 0.012f},
                              {0.06f, high + 0.09f}, {0.03f, high + 0.10f},  {0.0f, high + 0.13f}};
    cage.setTransform(glm::rotate(glm::mat4(1.0f), 0.785398f, glm::vec3(0, 1, 0)));
    cage.lathe(roof, 4, true);
    cage.setTransform(glm::mat4(1.0f));
}

// Flat links along the y axis, alternately turned.
void addChain(ShapeBuilder& chain, float low, float high) {
    const int links = std::max(1, static_cast<int>((high - low) / 0.07f));
    const float step = (high - low) / static_cast<float>(links);
    for (int i = 0; i < links; ++i) {
        chain.setTransform(placed({0, low + step * (static_cast<float>(i) + 0.5f), 0}, (i & 1) != 0 ? 1.5708f : 0.0f));
        const float h = 0.62f * step, w = 0.012f, t = 0.003f;
        chain.box({-w, -h, -t}, {-w + 2 * t, h, t});
        chain.box({w - 2 * t, -h, -t}, {w, h, t});
        chain.box({-w + t, h - 2 * t, -0.9f * t}, {w - t, h - 0.1f * t, 0.9f * t});
    }
    chain.setTransform(glm::mat4(1.0f));
}

std::uint32_t hangingLantern(Parts& parts, float chainLength) {
    ShapeBuilder iron(parts.materials.iron), bulb(parts.materials.glow);
    addCage(iron, -0.16f, 0.14f);
    addChain(iron, 0.25f, 0.25f + chainLength);
    bulb.sphere({0, 0.1f, 0}, 0.05f, 8, 12);
    return parts.builder.mesh("hanging lantern", {iron.take(), bulb.take()});
}

// A cage around a candle on a post; the post's foot is `height` below the light.
std::uint32_t standingLantern(Parts& parts, float height, float postRadius) {
    ShapeBuilder iron(parts.materials.iron), flame(parts.materials.glow), foot(parts.materials.trim);
    addCage(iron, -0.16f, 0.2f);
    iron.box({-0.11f, -0.18f, -0.11f}, {0.11f, -0.159f, 0.11f});
    const float bottom = -height;
    const glm::vec2 post[] = {{2.2f * postRadius, bottom + 0.3f}, {postRadius, bottom + 0.42f},
                              {0.8f * postRadius, -0.4f},         {1.6f * postRadius, -0.36f},
                              {0.8f * postRadius, -0.32f},        {2.0f * postRadius, -0.175f}};
    iron.lathe(post, 10);
    const glm::vec2 base[] = {{3.6f * postRadius, bottom - 0.01f},
                              {3.6f * postRadius, bottom + 0.14f},
                              {2.6f * postRadius, bottom + 0.18f},
                              {2.4f * postRadius, bottom + 0.31f},
                              {0.0f, bottom + 0.31f}};
    foot.lathe(base, 8, true);
    const glm::vec2 candle[] = {{0.034f, -0.162f}, {0.034f, -0.09f}, {0.022f, -0.07f}, {0.0f, -0.045f}};
    flame.lathe(candle, 10);
    return parts.builder.mesh("standing lantern", {iron.take(), flame.take(), foot.take()});
}

// Under the middle of chosen bays of the lower arcade, hung from the beams.
void addArcadeLanterns(Parts& parts) {
    const float y = 2.72f, chain = 3.99f - y - 0.25f;
    const std::uint32_t mesh = hangingLantern(parts, chain);
    struct Place {
        std::size_t side;
        int bay;
        glm::vec3 colour;
        float candela;
    };
    const Place places[] = {{0, 1, kWarm, 62},  {0, 4, kWarm, 62}, {0, 8, kAmber, 62}, {2, 1, kWarm, 62},
                            {2, 4, kAmber, 62}, {1, 1, kWarm, 62}, {1, 6, kAmber, 62}, {3, 3, kWarm, 62}};
    for (const Place& p : places) {
        const Side& side = parts.sides[p.side];
        const glm::vec3 local(-side.halfLength + kBay * (static_cast<float>(p.bay) + 0.5f), y, -1.35f);
        parts.builder.place(mesh, side.worldFromSide * placed(local));
        addPoint(parts, "arcade lantern", glm::vec3(side.worldFromSide * glm::vec4(local, 1.0f)), p.colour, p.candela,
                 12.0f, 0.012f);
    }
}

// On the gallery floor behind the railing, whose balusters throw long stripes over the court.
void addGalleryLanterns(Parts& parts) {
    const float height = 0.85f;
    const std::uint32_t mesh = standingLantern(parts, height, 0.025f);
    struct Place {
        std::size_t side;
        float along;
    };
    for (const Place& p : {Place{0, -5.85f}, Place{1, 1.95f}}) {
        const Side& side = parts.sides[p.side];
        const glm::vec3 local(p.along, kGallery + height, -0.75f);
        parts.builder.place(mesh, side.worldFromSide * placed(local));
        addPoint(parts, "gallery lantern", glm::vec3(side.worldFromSide * glm::vec4(local, 1.0f)), kAmber, 140, 14.0f,
                 0.006f);
    }
}

void addPostLanterns(Parts& parts) {
    const std::uint32_t mesh = standingLantern(parts, 2.7f, 0.05f);
    for (const glm::vec2& p : {glm::vec2(6.5f, 4.2f), {-6.5f, 4.2f}, {6.5f, -4.2f}, {-6.5f, -4.2f}}) {
        const glm::vec3 at(p.x, 2.7f, p.y);
        parts.builder.place(mesh, placed(at));
        addPoint(parts, "post lantern", at, kWarm, 26, 9.0f, 0.012f);
    }
}

// Ropes between the galleries with small bulbs, and hanging banners; `lanterns` are places along z.
void addFestoon(Parts& parts, float x, std::initializer_list<float> lanterns, std::initializer_list<float> banners) {
    const float end = kHalfZ - 0.08f;
    const auto ropeAt = [=](float z) { return glm::vec3(x, 5.25f + 0.9f * (z / end) * (z / end), z); };
    ShapeBuilder rope(parts.materials.rope), bulbs(parts.materials.glow);
    std::vector<glm::vec3> path;
    for (int i = 0; i <= 36; ++i) path.push_back(ropeAt(end * (static_cast<float>(i) / 18.0f - 1.0f)));
    rope.tube(path, 0.012f, 5);
    for (int i = 1; i < 18; ++i)
        bulbs.sphere(ropeAt(end * (static_cast<float>(i) / 9.0f - 1.0f)) - glm::vec3(0, 0.045f, 0), 0.026f, 4, 6);
    parts.builder.place("festoon rope", rope);
    parts.builder.place("festoon bulbs", bulbs);
    const float chain = 0.3f;
    const std::uint32_t lantern = hangingLantern(parts, chain);
    for (const float z : lanterns) {
        const glm::vec3 at = ropeAt(z) - glm::vec3(0, 0.25f + chain, 0);
        parts.builder.place(lantern, placed(at, 0.3f));
        addPoint(parts, "festoon lantern", at, kWarm, 45, 11.0f, 0.012f);
    }
    std::size_t colour = static_cast<std::size_t>(x + 20.0f);
    for (const float z : banners) {
        ShapeBuilder cloth(parts.materials.cloth[colour++ % 4]);
        cloth.sheet(
            [&](float u, float v) {
                const glm::vec3 top = ropeAt(z + 1.0f * (u - 0.5f)) - glm::vec3(0, 0.012f, 0);
                return top + glm::vec3(0.12f * v * std::sin(6.0f * u + 2.5f * v + z), -1.9f * v, 0);
            },
            16, 20, 1.0f, 1.9f);
        parts.builder.place("rope banner", cloth);
    }
}

// A lamp under the eaves that throws a cone towards `target`.
void addSpot(Parts& parts, std::uint32_t lamp, const glm::vec3& at, const glm::vec3& target, const glm::vec3& colour,
             float candela, float outerAngle, float range = 14.0f, float sourceRadius = 0.02f) {
    const glm::mat4 frame = lookingAt(at, target);  // looks down its -z
    parts.builder.place(lamp, frame);
    SceneLight light;
    light.name = "spot";
    light.kind = LightKind::Spot;
    light.position = at;
    light.direction = glm::normalize(target - at);
    light.colour = colour;
    light.intensity = candela;
    light.rangeMetres = range;
    light.outerConeAngle = outerAngle;
    light.innerConeAngle = 0.7f * outerAngle;
    light.sourceRadius = sourceRadius;
    parts.builder.scene.lights.push_back(light);
}

void addSpots(Parts& parts) {
    ShapeBuilder body(parts.materials.iron), lens(parts.materials.coolGlow);
    const glm::mat4 backwards = glm::rotate(glm::mat4(1.0f), 1.5707963f, glm::vec3(1, 0, 0));  // y becomes +z: behind
    body.setTransform(backwards);
    const glm::vec2 can[] = {{0.09f, 0.05f}, {0.105f, 0.05f}, {0.11f, 0.25f}, {0.06f, 0.30f}, {0.0f, 0.31f}};
    body.lathe(can, 12);
    lens.setTransform(backwards);
    const glm::vec2 front[] = {{0.0f, 0.055f}, {0.1f, 0.055f}};
    lens.lathe(front, 12);
    body.setTransform(glm::mat4(1.0f));
    body.box({-0.015f, 0.08f, 0.13f}, {0.015f, 0.5f, 0.16f});
    const std::uint32_t lamp = parts.builder.mesh("eaves lamp", {body.take(), lens.take()});
    addSpot(parts, lamp, {-6.5f, 6.95f, -8.72f}, {0.2f, 0.8f, 0.2f}, kCool, 900, 0.42f);
    addSpot(parts, lamp, {7.15f, 6.95f, 8.72f}, {-0.2f, 0.8f, -0.2f}, kCool, 800, 0.45f);
    // From the gallery floors through the balusters, whose shadows run across the court.
    addSpot(parts, lamp, {4.55f, 5.35f, -10.0f}, {1.5f, 0.0f, 2.5f}, kWarm, 1500, 0.55f, 20.0f, 0.004f);
    addSpot(parts, lamp, {13.9f, 5.35f, 2.6f}, {2.0f, 0.0f, 3.0f}, kAmber, 1300, 0.55f, 20.0f, 0.004f);
    addSpot(parts, lamp, {-7.15f, 5.35f, 10.0f}, {-3.6f, 0.0f, 0.5f}, kCool, 1500, 0.55f, 20.0f, 0.004f);
}

// A lamp that floats in the basin, and the moon.
void addBasinLampAndMoon(Parts& parts) {
    ShapeBuilder lamp(parts.materials.coolGlow);
    lamp.sphere({0, -0.16f, 0}, 0.08f, 8, 12);
    const glm::vec3 at(1.15f, 1.02f, 0.75f);
    parts.builder.place("basin lamp", lamp, placed(at));
    addPoint(parts, "basin lamp", at, kTeal, 7, 6.0f, 0.04f);
    SceneLight moon;
    moon.name = "moon";
    moon.kind = LightKind::Directional;
    moon.direction = glm::normalize(glm::vec3(0.45f, -0.8f, -0.35f));
    moon.colour = {0.55f, 0.70f, 1.0f};
    moon.intensity = 0.22f;  // lux
    moon.sourceRadius = 0.0046f;
    moon.casts = false;
    parts.builder.scene.lights.push_back(moon);
}

}  // namespace

void addLights(Parts& parts) {
    addArcadeLanterns(parts);
    addGalleryLanterns(parts);
    addPostLanterns(parts);
    addFestoon(parts, -5.2f, {-1.4f}, {-6.0f, -3.9f});
    addFestoon(parts, 2.6f, {2.4f, -4.6f}, {-2.4f, 5.2f});
    addFestoon(parts, 9.1f, {0.0f}, {-4.0f, -1.9f, 3.0f});
    addSpots(parts);
    addBasinLampAndMoon(parts);
}

}  // namespace gnomon::renderer::courtyard
