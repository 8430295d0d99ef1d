// The lights of the courtyard, each with its lantern or lamp, for every hour. Sources have plausible sizes: flames 1 to
// 2 cm, paper shades 12 cm, sun and moon half a degree across.

#include "scene/builtin/courtyard_figure.h"
#include "scene/builtin/courtyard_lamps.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::renderer::courtyard {
namespace {

const glm::vec3 kWarm(1.0f, 0.56f, 0.24f), kAmber(1.0f, 0.46f, 0.15f), kCool(0.45f, 0.68f, 1.0f),
    kTeal(0.25f, 0.85f, 0.9f), kRose(1.0f, 0.30f, 0.34f), kGold(1.0f, 0.70f, 0.32f);

constexpr float kBenchReach = 0.615f;  // of the night's ranges: gives 3 shadowed lights per tile, the moon among them

SceneLight& addPoint(Parts& parts, const char* name, const glm::vec3& at, const glm::vec3& colour, float candela,
                     float range, float sourceRadius) {
    SceneLight light;
    light.name = name;
    light.position = at;
    light.colour = colour;
    const bool bench = parts.hour == Hour::Bench;
    light.intensity = candela * (parts.hour == Hour::Day ? 2.5f : bench ? 1.7f : 1.0f);
    light.rangeMetres = bench ? kBenchReach * range : range;
    light.sourceRadius = sourceRadius;
    parts.builder.scene.lights.push_back(light);
    return parts.builder.scene.lights.back();
}

void addSpot(Parts& parts, const char* name, const glm::vec3& at, const glm::vec3& direction, const glm::vec3& colour,
             float candela, float outerAngle, float range, float sourceRadius) {
    SceneLight& light = addPoint(parts, name, at, colour, candela, range, sourceRadius);
    light.kind = LightKind::Spot;
    light.direction = glm::normalize(direction);
    light.outerConeAngle = outerAngle;
    light.innerConeAngle = 0.7f * outerAngle;
}

glm::vec3 inWorld(const Side& side, const glm::vec3& local) {
    return glm::vec3(side.worldFromSide * glm::vec4(local, 1.0f));
}

// In the middle of chosen bays of the lower arcade, hung from the beams. The first one is a turning drum of pierced
// brass, whose stars wander over walls and floor.
void addArcadeLanterns(Parts& parts) {
    const float y = 2.72f, chain = 3.99f - y - 0.25f;
    const std::uint32_t mesh = hangingLantern(parts, chain);
    struct Place {
        std::size_t side;
        int bay;
        glm::vec3 colour;
    };
    const Place places[] = {{0, 1, kGold},  {0, 4, kWarm}, {0, 8, kAmber}, {2, 1, kWarm},
                            {2, 4, kAmber}, {1, 1, kWarm}, {1, 6, kAmber}, {3, 3, kWarm}};
    bool first = true;
    for (const Place& p : places) {
        const Side& side = parts.sides[p.side];
        const glm::vec3 local(-side.halfLength + kBay * (static_cast<float>(p.bay) + 0.5f), y, -1.35f);
        const glm::vec3 at = inWorld(side, local);
        if (!first) {
            parts.builder.place(mesh, side.worldFromSide * placed(local));
            addPoint(parts, "arcade lantern", at, p.colour, 62.0f, 8.5f, 0.015f);
            continue;
        }
        first = false;
        SceneBuilder& b = parts.builder;
        b.place(drumChain(parts, chain - 0.03f), placed(at));
        const auto turn = [](float share) -> glm::quat {
            return glm::angleAxis(6.28318530718f * share, glm::vec3(0, 1, 0));
        };
        const std::uint32_t node = addNode(b.scene, "pierced drum", kNone, at);
        placeOn(b, node, piercedDrum(parts));
        animateTurn(b.scene, node, 24, turn);
        addPoint(parts, "pierced drum", at, p.colour, 130.0f, 8.5f, 0.004f);
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
        addPoint(parts, "gallery lantern", inWorld(side, local), kAmber, 140.0f, 12.0f, 0.01f);
    }
}

void addPostLanterns(Parts& parts) {
    const std::uint32_t mesh = standingLantern(parts, 2.7f, 0.05f);
    for (const glm::vec2& p : {glm::vec2(6.1f, 2.5f), {0.6f, 6.9f}, {6.5f, -6.4f}, {-6.9f, -4.2f}}) {
        const glm::vec3 at(p.x, 2.7f, p.y);
        parts.builder.place(mesh, placed(at));
        addPoint(parts, "post lantern", at, kWarm, 46.0f, 7.5f, 0.015f);
    }
}

// Beside the doors of both storeys: hooded lamps that throw a wide cone down the wall.
void addWallLamps(Parts& parts) {
    const std::uint32_t mesh = wallLamp(parts);
    const glm::vec3 colours[] = {kWarm, kAmber, kGold, kWarm, kRose};
    std::size_t next = 0;
    for (const Side& side : parts.sides) {
        for (int bay = 1; bay < side.bays - 1; bay += 2) {
            for (const float floor : {kArcadeFloor, kGallery}) {
                const float x = -side.halfLength + kBay * (static_cast<float>(bay) + 0.5f) + 1.15f;
                const glm::vec3 local(x, floor + 2.05f, -kDepth + 0.3f);
                const glm::vec3 down = inWorld(side, local + glm::vec3(0, -1.0f, 0.28f)) - inWorld(side, local);
                parts.builder.place(mesh, side.worldFromSide * placed(local));
                const float candela = floor > 1.0f ? 44.0f : 24.0f;
                addSpot(parts, "wall lamp", inWorld(side, local), down, colours[next++ % 5], candela, 1.05f, 4.2f,
                        0.02f);
            }
        }
    }
}

// On the fountain's upper step, and at the feet of every other column, on the side of the court.
void addCandles(Parts& parts) {
    const std::uint32_t mesh = thickCandle(parts);
    const auto put = [&](const glm::vec3& at, float candela, float range) {
        parts.builder.place(mesh, placed(at, at.x));
        addPoint(parts, "candle", at, kAmber, candela, range, 0.01f);
    };
    for (int i = 0; i < 8; ++i) {
        const float a = 0.785398f * static_cast<float>(i);
        put({2.47f * std::cos(a), 0.32f + 0.152f, 2.47f * std::sin(a)}, 2.0f, 2.4f);
    }
    for (const Side& side : parts.sides)
        for (int bay = 2; bay < side.bays; bay += 2)
            put(inWorld(side, {-side.halfLength + kBay * static_cast<float>(bay) + 0.42f, 0.152f, 0.72f}), 3.2f, 2.8f);
}

// A rope between the galleries with small bulbs; `at` and `hang` put lanterns and banners along z.
class Festoon {
public:
    Festoon(Parts& parts, float x) : parts_(parts), x_(x) {
        ShapeBuilder rope(parts.materials.rope), bulbs(parts.materials.glow);
        std::vector<glm::vec3> path;
        for (int i = 0; i <= 36; ++i) path.push_back(ropeAt(kEnd * (static_cast<float>(i) / 18.0f - 1.0f)));
        rope.tube(path, 0.012f, 5);
        for (int i = 1; i < 18; ++i)
            bulbs.sphere(ropeAt(kEnd * (static_cast<float>(i) / 9.0f - 1.0f)) - glm::vec3(0, 0.045f, 0), 0.026f, 4, 6);
        parts.builder.place("festoon rope", rope);
        parts.builder.place("festoon bulbs", bulbs);
    }
    void lanterns(std::uint32_t mesh, float drop, std::initializer_list<float> along, const glm::vec3& colour,
                  float candela, float range, float sourceRadius) {
        for (const float z : along) {
            const glm::vec3 at = ropeAt(z) - glm::vec3(0, drop, 0);
            parts_.builder.place(mesh, placed(at, 0.3f + z));
            addPoint(parts_, "festoon lantern", at, colour, candela, range, sourceRadius);
        }
    }
    void banners(std::initializer_list<float> along) {
        auto colour = static_cast<std::size_t>(x_ + 20.0f);
        for (const float z : along) {
            ShapeBuilder cloth(parts_.materials.cloth[colour++ % 4]);
            cloth.sheet(
                [&](float u, float v) {
                    const glm::vec3 top = ropeAt(z + 1.0f * (u - 0.5f)) - glm::vec3(0, 0.012f, 0);
                    return top + glm::vec3(0.12f * v * std::sin(6.0f * u + 2.5f * v + z), -1.9f * v, 0);
                },
                16, 20, 1.0f, 1.9f);
            parts_.builder.place("rope banner", cloth);
        }
    }

private:
    static constexpr float kEnd = kHalfZ - 0.08f;
    [[nodiscard]] glm::vec3 ropeAt(float z) const { return {x_, 5.25f + 0.9f * (z / kEnd) * (z / kEnd), z}; }
    Parts& parts_;
    float x_;
};

void addFestoons(Parts& parts) {
    const Materials& m = parts.materials;
    const float chain = 0.3f, cord = 0.35f, drop = 0.27f + cord;
    const std::uint32_t iron = hangingLantern(parts, chain);
    const std::uint32_t gold = paperLantern(parts, m.paper[0], cord), rose = paperLantern(parts, m.paper[1], cord),
                        teal = paperLantern(parts, m.paper[2], cord);
    Festoon west(parts, -5.2f), middle(parts, 2.6f), east(parts, 11.7f);
    west.lanterns(iron, 0.25f + chain, {-1.4f}, kWarm, 45.0f, 8.0f, 0.015f);
    west.lanterns(rose, drop, {1.6f}, kRose, 26.0f, 6.0f, 0.12f);
    west.lanterns(gold, drop, {5.4f}, kGold, 34.0f, 6.5f, 0.12f);
    west.banners({-6.0f, -3.9f});
    middle.lanterns(iron, 0.25f + chain, {-4.6f}, kWarm, 45.0f, 8.0f, 0.015f);
    middle.lanterns(gold, drop, {-1.9f, 2.4f}, kGold, 34.0f, 6.5f, 0.12f);
    middle.lanterns(teal, drop, {0.2f}, kTeal, 18.0f, 5.5f, 0.12f);
    middle.lanterns(rose, drop, {6.0f}, kRose, 26.0f, 6.0f, 0.12f);
    middle.banners({-6.6f});
    east.lanterns(gold, drop, {0.0f}, kGold, 34.0f, 6.5f, 0.12f);
    east.lanterns(teal, drop, {-7.0f}, kTeal, 18.0f, 5.5f, 0.12f);
    east.banners({-2.0f, 2.0f, 6.9f});
}

void addSpots(Parts& parts) {
    const std::uint32_t lamp = eavesLamp(parts);
    struct Place {
        glm::vec3 at, target, colour;
        float candela, outerAngle, range, sourceRadius;
    };
    // The last three shine from the gallery floors through the balusters, whose shadows run across the court.
    for (const Place& p : {Place{{-6.5f, 6.95f, -8.72f}, {0.2f, 0.8f, 0.2f}, kCool, 900, 0.42f, 14, 0.02f},
                           {{7.15f, 6.95f, 8.72f}, {-0.2f, 0.8f, -0.2f}, kCool, 800, 0.45f, 14, 0.02f},
                           {{4.55f, 5.35f, -10.0f}, {1.5f, 0.0f, 2.5f}, kWarm, 1500, 0.55f, 20, 0.01f},
                           {{13.9f, 5.35f, 2.6f}, {2.0f, 0.0f, 3.0f}, kAmber, 1300, 0.55f, 20, 0.01f},
                           {{-7.15f, 5.35f, 10.0f}, {-3.6f, 0.0f, 0.5f}, kCool, 1500, 0.55f, 20, 0.01f}}) {
        parts.builder.place(lamp, lookingAt(p.at, p.target));
        addSpot(parts, "spot", p.at, p.target - p.at, p.colour, p.candela, p.outerAngle, p.range, p.sourceRadius);
    }
}

// A lamp that floats in the basin, one under each stall's awning, and what stands in the sky.
void addOtherLights(Parts& parts) {
    ShapeBuilder lamp(parts.materials.coolGlow);
    lamp.sphere({0, -0.16f, 0}, 0.08f, 8, 12);
    const glm::vec3 at(1.15f, 1.02f, 0.75f);
    parts.builder.place("basin lamp", lamp, placed(at));
    addPoint(parts, "basin lamp", at, kTeal, 7.0f, 5.0f, 0.04f);
    const std::uint32_t lantern = hangingLantern(parts, 0.08f);
    for (const glm::mat4& stall : {placed(kRedStall, kRedStallTurn), placed(kBlueStall, kBlueStallTurn)}) {
        const glm::mat4 place = stall * placed({0.35f, 1.95f, 1.35f});
        parts.builder.place(lantern, place);
        addPoint(parts, "stall lantern", glm::vec3(place[3]), kGold, 16.0f, 5.0f, 0.015f);
    }
    const bool day = parts.hour == Hour::Day;
    SceneLight sky;
    sky.name = day ? "sun" : "moon";
    sky.kind = LightKind::Directional;
    sky.direction = glm::normalize(day ? glm::vec3(0.68f, -0.62f, -0.40f) : glm::vec3(0.45f, -0.8f, -0.35f));
    sky.colour = day ? glm::vec3(1.0f, 0.77f, 0.50f) : glm::vec3(0.55f, 0.70f, 1.0f);
    sky.intensity = day ? 480.0f : 0.55f;  // lux
    sky.sourceRadius = 0.00465f;
    parts.builder.scene.lights.push_back(sky);
}

}  // namespace

void addLights(Parts& parts) {
    addArcadeLanterns(parts);
    addGalleryLanterns(parts);
    addPostLanterns(parts);
    addWallLamps(parts);
    addCandles(parts);
    addFestoons(parts);
    addSpots(parts);
    addOtherLights(parts);
}

}  // namespace gnomon::renderer::courtyard
