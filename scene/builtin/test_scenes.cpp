// Small scenes for tests: plain colours, few triangles, known distances.

#include "scene/builtin/material_builders.h"
#include "scene/builtin/scenes.h"
#include "scene/builtin/shapes.h"
#include "scene/random.h"

#include <cmath>

namespace gnomon::renderer {
namespace {

void floorPlane(SceneBuilder& builder, std::uint32_t material, float half) {
    ShapeBuilder plane(material);
    plane.quad({-half, 0, half}, {half, 0, half}, {half, 0, -half}, {-half, 0, -half});
    builder.place("floor", plane);
}

SceneLight& addPoint(SceneBuilder& builder, const glm::vec3& at, const glm::vec3& colour, float candela, float range) {
    SceneLight light;
    light.name = "point";
    light.position = at;
    light.colour = colour;
    light.intensity = candela;
    light.rangeMetres = range;
    light.sourceRadius = 0.05f;
    builder.scene.lights.push_back(light);
    return builder.scene.lights.back();
}

SceneLight& addSpot(SceneBuilder& builder, const glm::vec3& at, const glm::vec3& target, const glm::vec3& colour,
                    float candela, float range, float outerAngle) {
    SceneLight& light = addPoint(builder, at, colour, candela, range);
    light.name = "spot";
    light.kind = LightKind::Spot;
    light.direction = glm::normalize(target - at);
    light.outerConeAngle = outerAngle;
    light.innerConeAngle = 0.8f * outerAngle;
    return light;
}

Scene finished(SceneBuilder& builder, float ev100 = 2.0f) {
    builder.scene.exposureEv100 = ev100;
    return std::move(builder.scene);
}

}  // namespace

Scene makeEmptyPlane() {
    SceneBuilder b("empty-plane");
    floorPlane(b, plainMaterial(b, "grey", glm::vec3(0.5f)), 10.0f);
    addSpot(b, {0, 4, 0}, {0, 0, 0}, glm::vec3(1.0f), 100.0f, 12.0f, 0.6f);
    b.camera("default", {0, 3, 8}, {0, 0, 0}, 0.9f);
    return finished(b);
}

Scene makeSphereOnPlane() {
    SceneBuilder b("sphere-on-plane");
    floorPlane(b, plainMaterial(b, "grey", glm::vec3(0.5f)), 10.0f);
    ShapeBuilder ball(plainMaterial(b, "red", {0.7f, 0.2f, 0.15f}));
    ball.sphere({0, 1, 0}, 0.5f, 48, 96);
    b.place("sphere", ball);
    addPoint(b, {0, 4, 0}, glm::vec3(1.0f), 120.0f, 14.0f).sourceRadius = 0.2f;
    b.camera("default", {3, 3, 5}, {0, 0.5f, 0}, 0.8f);
    return finished(b);
}

// The measures of the Cornell box, in units of half its width.
Scene makeBoxes() {
    SceneBuilder b("boxes");
    ShapeBuilder white(plainMaterial(b, "white", glm::vec3(0.73f))),
        red(plainMaterial(b, "red", {0.63f, 0.06f, 0.05f}));
    ShapeBuilder green(plainMaterial(b, "green", {0.14f, 0.45f, 0.09f})), box(plainMaterial(b, "box", glm::vec3(0.7f)));
    white.quad({-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2});
    white.quad({-2, 4, -2}, {2, 4, -2}, {2, 4, 2}, {-2, 4, 2});
    white.quad({-2, 0, -2}, {2, 0, -2}, {2, 4, -2}, {-2, 4, -2});
    white.quad({2, 0, 2}, {-2, 0, 2}, {-2, 4, 2}, {2, 4, 2});
    red.quad({-2, 0, 2}, {-2, 0, -2}, {-2, 4, -2}, {-2, 4, 2});
    green.quad({2, 0, -2}, {2, 0, 2}, {2, 4, 2}, {2, 4, -2});
    b.place("white walls", white);
    b.place("red wall", red);
    b.place("green wall", green);
    box.box({-0.6f, 0, -0.6f}, {0.6f, 1.2f, 0.6f}, ShapeBuilder::kAll & ~ShapeBuilder::kBottom);
    b.place("low box", box, placed({0.65f, 0, 0.6f}, 0.3f));
    box.box({-0.6f, 0, -0.6f}, {0.6f, 2.4f, 0.6f}, ShapeBuilder::kAll & ~ShapeBuilder::kBottom);
    b.place("high box", box, placed({-0.7f, 0, -0.5f}, -0.35f));
    addPoint(b, {0, 3.6f, 0}, {1.0f, 0.9f, 0.75f}, 30.0f, 7.0f);
    addPoint(b, {1.5f, 2.0f, -1.3f}, {0.4f, 0.6f, 1.0f}, 12.0f, 5.0f);
    addPoint(b, {-1.5f, 0.5f, 1.2f}, {1.0f, 0.5f, 0.3f}, 8.0f, 4.0f);
    b.camera("default", {0, 2, 1.95f}, {0, 1.6f, -2}, 1.5f);
    return finished(b);
}

Scene makeColumns(const BuiltinOptions& options) {
    SceneBuilder b("columns");
    floorPlane(b, plainMaterial(b, "grey", glm::vec3(0.5f)), 12.0f);
    ShapeBuilder column(plainMaterial(b, "column", {0.7f, 0.66f, 0.6f}));
    const glm::vec2 profile[] = {{0.06f, 0.0f}, {0.06f, 2.5f}, {0.0f, 2.5f}};
    column.lathe(profile, 16);
    std::vector<Primitive> primitives;
    primitives.push_back(column.take());
    const std::uint32_t mesh = b.mesh("column", std::move(primitives));
    for (int z = -5; z <= 5; ++z)
        for (int x = -5; x <= 5; ++x)
            b.place(mesh, placed({2.0f * static_cast<float>(x), 0, 2.0f * static_cast<float>(z)}));
    Random random(options.seed);
    const std::uint32_t count = options.lightCount != 0 ? options.lightCount : 12;
    for (std::uint32_t i = 0; i < count; ++i) {
        // In the middle half of a square between four columns: at least 0.4 m from any.
        const float x = 2.0f * std::floor(random.between(-5.0f, 5.0f)) + random.between(0.5f, 1.5f);
        const float z = 2.0f * std::floor(random.between(-5.0f, 5.0f)) + random.between(0.5f, 1.5f);
        const glm::vec3 at(x, random.between(0.5f, 2.4f), z);
        const glm::vec3 colour(random.between(0.3f, 1.0f), random.between(0.3f, 1.0f), random.between(0.3f, 1.0f));
        if (i % 3 == 2)
            addSpot(b, at, {x + random.between(-1, 1), 0, z + random.between(-1, 1)}, colour, 40.0f, 6.0f, 0.8f);
        else
            addPoint(b, at, colour, 15.0f, 5.0f);
    }
    b.camera("default", {-11, 6, 11}, {0, 0, 0}, 0.8f);
    return finished(b);
}

Scene makeCloth() {
    SceneBuilder b("cloth");
    floorPlane(b, plainMaterial(b, "grey", glm::vec3(0.5f)), 8.0f);
    const std::uint32_t material = plainMaterial(b, "cloth", {0.6f, 0.15f, 0.12f});
    b.scene.materials[material].doubleSided = true;
    for (int i = -2; i <= 2; ++i) {
        ShapeBuilder sheet(material);
        const float phase = static_cast<float>(i);
        sheet.sheet(
            [=](float u, float v) {
                return glm::vec3(1.6f * (u - 0.5f), 2.6f - 2.2f * v, 0.15f * std::sin(8.0f * u + phase) * (0.3f + v));
            },
            24, 24, 1.6f, 2.2f);
        b.place("sheet", sheet, placed({2.0f * phase, 0, -0.5f * phase}, 0.3f * phase));
    }
    addPoint(b, {0.5f, 2.2f, -3.0f}, {1.0f, 0.7f, 0.4f}, 60.0f, 10.0f);
    addSpot(b, {-3, 4, 4}, {0, 0.8f, 0}, {0.5f, 0.7f, 1.0f}, 150.0f, 12.0f, 0.6f);
    b.camera("default", {3, 2.6f, 6}, {0, 1, 0}, 0.9f);
    return finished(b);
}

Scene makeMasked() {
    SceneBuilder b("masked");
    floorPlane(b, plainMaterial(b, "grey", glm::vec3(0.5f)), 8.0f);
    Image holes;  // round holes on an 8 x 8 grid; alpha 0 inside
    holes.width = holes.height = 256;
    for (std::uint32_t y = 0; y < 256; ++y) {
        for (std::uint32_t x = 0; x < 256; ++x) {
            const int dx = static_cast<int>(x % 32) - 16, dy = static_cast<int>(y % 32) - 16;
            const auto alpha = static_cast<std::uint8_t>(dx * dx + dy * dy < 100 ? 0 : 255);
            holes.rgba8.insert(holes.rgba8.end(), {150, 170, 90, alpha});
        }
    }
    const std::uint32_t material = plainMaterial(b, "perforated", glm::vec3(1.0f));
    Material& m = b.scene.materials[material];
    m.alphaMode = AlphaMode::Mask;
    m.doubleSided = true;
    m.baseColourTexture.image = b.image(std::move(holes));
    for (const float turn : {-0.7f, 0.0f, 0.7f}) {
        ShapeBuilder panel(material);
        panel.sheet([](float u, float v) { return glm::vec3(2.0f * (u - 0.5f), 2.2f - 2.0f * v, 0); }, 1, 1, 1.0f,
                    1.0f);
        b.place("panel", panel, placed({3.0f * turn, 0, -1.2f * std::abs(turn)}, -turn));
    }
    addPoint(b, {0.3f, 2.0f, -2.5f}, {1.0f, 0.75f, 0.5f}, 60.0f, 10.0f);
    addSpot(b, {3, 4, 3}, {0, 0.5f, 0}, {0.6f, 0.8f, 1.0f}, 150.0f, 12.0f, 0.6f);
    b.camera("default", {0, 2.6f, 5.5f}, {0, 0.8f, 0}, 0.9f);
    return finished(b);
}

// Obelisks along a line of sight from 3 m to 150 m, and a leaning gnomon on a dial in front: one sun, every cascade.
Scene makeSundial() {
    SceneBuilder b("sundial");
    floorPlane(b, plainMaterial(b, "sand", {0.62f, 0.55f, 0.42f}), 200.0f);
    const std::uint32_t stone = plainMaterial(b, "stone", {0.72f, 0.68f, 0.62f});
    ShapeBuilder dial(stone), obelisk(stone);
    const glm::vec2 disk[] = {{1.1f, 0.0f}, {1.1f, 0.35f}, {1.0f, 0.40f}, {0.0f, 0.40f}};
    dial.lathe(disk, 48);
    const glm::vec3 rod[] = {{0, 0.35f, 0.2f}, {0, 1.15f, -0.75f}};
    dial.tube(rod, 0.025f, 12);
    for (int hour = -6; hour <= 6; ++hour) {
        dial.setTransform(placed({0, 0, 0}, 0.2618f * static_cast<float>(hour)));
        dial.box({-0.012f, 0.39f, -0.93f}, {0.012f, 0.425f, -0.78f});
    }
    b.place("dial", dial);
    const glm::vec2 shaft[] = {{0.45f, 0.0f}, {0.30f, 4.6f}, {0.0f, 5.2f}};
    obelisk.lathe(shaft, 4, true);
    std::vector<Primitive> primitives;
    primitives.push_back(obelisk.take());
    const std::uint32_t mesh = b.mesh("obelisk", std::move(primitives));
    for (int i = 0; i < 14; ++i) {
        const float away = 4.0f * std::pow(1.32f, static_cast<float>(i)), side = (i & 1) != 0 ? 1.0f : -1.0f;
        b.place(mesh, placed({side * (1.6f + 0.16f * away), 0, -away}, 0.4f * static_cast<float>(i)));
    }
    SceneLight sun;
    sun.name = "sun";
    sun.kind = LightKind::Directional;
    sun.direction = glm::normalize(glm::vec3(-0.62f, -0.55f, -0.35f));
    sun.colour = {1.0f, 0.93f, 0.82f};
    sun.intensity = 60.0f;
    sun.sourceRadius = 0.00465f;
    b.scene.lights.push_back(sun);
    addPoint(b, {-1.6f, 0.9f, 0.9f}, {1.0f, 0.55f, 0.25f}, 6.0f, 4.0f);
    b.camera("default", {1.3f, 2.1f, 2.9f}, {-0.1f, 0.9f, -1.5f}, 0.9f);
    b.camera("grazing", {0.2f, 0.35f, 6.0f}, {0, 0.9f, -20.0f}, 0.7f);
    b.scene.skyColour = {2.4f, 3.6f, 6.0f};
    b.scene.groundColour = {1.2f, 1.0f, 0.8f};
    return finished(b, 3.7f);
}

Scene makeSingleTriangle() {
    SceneBuilder b("single-triangle");
    const std::uint32_t material = plainMaterial(b, "grey", glm::vec3(0.5f));
    b.scene.materials[material].doubleSided = true;
    ShapeBuilder shape(material);
    const glm::vec3 corners[] = {{-1, 0, 0}, {1, 0, 0}, {0, 1.5f, 0}};
    shape.polygon(corners);
    b.place("triangle", shape);
    addPoint(b, {0.5f, 1.5f, 2}, glm::vec3(1.0f), 20.0f, 8.0f);
    b.camera("default", {0, 0.8f, 4}, {0, 0.7f, 0}, 0.7f);
    return finished(b);
}

Scene makeLightsOnly() {
    SceneBuilder b("lights-only");
    plainMaterial(b, "unused", glm::vec3(0.5f));
    addPoint(b, {0, 1, 0}, glm::vec3(1.0f), 20.0f, 5.0f);
    addPoint(b, {2, 1, -1}, {1.0f, 0.5f, 0.2f}, 20.0f, 5.0f);
    addSpot(b, {-2, 3, 0}, {0, 0, 0}, {0.3f, 0.6f, 1.0f}, 60.0f, 8.0f, 0.5f);
    b.camera("default", {0, 1.5f, 5}, {0, 1, 0}, 0.9f);
    return finished(b);
}

}  // namespace gnomon::renderer
