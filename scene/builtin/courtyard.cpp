#include "scene/builtin/courtyard.h"
#include "scene/builtin/courtyard_figure.h"

#include "scene/builtin/foliage_textures.h"
#include "scene/builtin/material_builders.h"
#include "scene/builtin/scenes.h"

#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::renderer {
namespace courtyard {
namespace {

// Seen from both sides, and lit through.
std::uint32_t foliage(SceneBuilder& builder, const char* name, Image image, float roughness, bool thin = true) {
    Material material;
    material.name = name;
    material.metallic = 0.0f;
    material.roughness = roughness;
    material.alphaMode = AlphaMode::Mask;
    material.alphaCutoff = meanAlpha(image);
    material.doubleSided = true;
    material.subsurface = thin;
    material.baseColourTexture.image = builder.image(std::move(image));
    return builder.material(std::move(material));
}

// For plants, people and animals.
void makeLivingMaterials(Parts& parts) {
    SceneBuilder& b = parts.builder;
    Materials& m = parts.materials;
    m.soil = texturedMaterial(b, "soil", paintClay(128, {0.27f, 0.20f, 0.14f}));
    m.bark = texturedMaterial(b, "bark", paintPlanks(256, {0.44f, 0.36f, 0.27f}));
    m.leaves = foliage(b, "leaves", paintBroadLeaves(512), 0.5f);
    m.ivy = foliage(b, "ivy", paintIvy(512), 0.55f);
    m.blossom = foliage(b, "blossom", paintBlossom(512), 0.75f);
    m.frond = foliage(b, "frond", paintFrond(512), 0.5f);
    m.orange = plainMaterial(b, "orange", {0.85f, 0.30f, 0.03f}, 0.5f);
    m.straw = texturedMaterial(b, "straw", paintStripes(128, {0.80f, 0.66f, 0.38f}, {0.74f, 0.59f, 0.33f}));
    m.fur = plainMaterial(b, "fur", {0.42f, 0.19f, 0.06f}, 0.9f);
    m.feather = plainMaterial(b, "feather", {0.03f, 0.035f, 0.06f}, 0.6f);
    b.scene.materials[m.feather].doubleSided = true;
    m.sheetIron = plainMaterial(b, "sheet iron", {0.06f, 0.06f, 0.065f}, 0.5f, 0.5f);
    b.scene.materials[m.sheetIron].doubleSided = true;
    m.pierced = foliage(b, "pierced brass", paintStarCutouts(512, {0.80f, 0.60f, 0.30f}), 0.4f, false);
    b.scene.materials[m.pierced].alphaCutoff = 0.5f;
    b.scene.materials[m.pierced].metallic = 0.6f;
    const glm::vec3 wear[] = {{0.17f, 0.22f, 0.40f}, {0.66f, 0.16f, 0.13f}, {0.62f, 0.52f, 0.36f},
                              {0.86f, 0.80f, 0.68f}, {0.28f, 0.36f, 0.26f}, {0.36f, 0.26f, 0.20f}};
    for (std::size_t i = 0; i < m.wear.size(); ++i)
        m.wear[i] = texturedMaterial(b, "felted cloth", paintClay(256, wear[i]), 0.12f);
    const glm::vec3 skin[] = {{0.62f, 0.38f, 0.26f}, {0.40f, 0.22f, 0.14f}, {0.52f, 0.30f, 0.20f}};
    const glm::vec3 hair[] = {{0.09f, 0.05f, 0.03f}, {0.03f, 0.025f, 0.022f}, {0.55f, 0.53f, 0.50f}};
    const std::uint32_t glow = b.image(paintPaperGlow(128));
    const glm::vec3 paper[] = {{0.95f, 0.80f, 0.50f}, {0.95f, 0.45f, 0.40f}, {0.50f, 0.85f, 0.85f}};
    m.candle = plainMaterial(b, "wax", {0.80f, 0.72f, 0.55f}, 0.6f);
    m.leather = plainMaterial(b, "leather", {0.06f, 0.035f, 0.02f}, 0.5f);
    for (std::size_t i = 0; i < 3; ++i) {
        m.paper[i] = plainMaterial(b, "paper", paper[i], 0.9f);
        Material& lit = b.scene.materials[m.paper[i]];
        lit.doubleSided = true;
        lit.emissive = (parts.hour == Hour::Day ? 26.0f : 1.9f) * paper[i] * paper[i];
        lit.emissiveTexture.image = glow;
        lit.emissiveTexture.uvTransform = glm::mat2(1.0f, 0.0f, 0.0f, 2.0f);
        m.skin[i] = plainMaterial(b, "skin", skin[i], 0.55f);
        m.hair[i] = plainMaterial(b, "hair", hair[i], 0.6f);
    }
}

void makeMaterials(Parts& parts) {
    SceneBuilder& b = parts.builder;
    Materials& m = parts.materials;
    m.stone = texturedMaterial(b, "stone", paintBlocks(512, 2.0f, 4, 6, {0.74f, 0.68f, 0.58f}));
    m.trim = texturedMaterial(b, "trim", paintPlaster(256, {0.80f, 0.75f, 0.66f}), 0.6f);
    m.plaster = texturedMaterial(b, "plaster", paintPlaster(512, {0.80f, 0.62f, 0.47f}));
    m.cobbles = texturedMaterial(b, "cobbles", paintCobbles(512));
    m.flags = texturedMaterial(b, "flagstones", paintBlocks(512, 2.4f, 3, 4, {0.56f, 0.53f, 0.50f}));
    m.wood = texturedMaterial(b, "wood", paintPlanks(256, {0.58f, 0.41f, 0.27f}));
    m.darkWood = texturedMaterial(b, "dark wood", paintPlanks(256, {0.36f, 0.25f, 0.18f}));
    m.clay = texturedMaterial(b, "clay", paintClay(256, {0.68f, 0.36f, 0.24f}));
    m.tiles = texturedMaterial(b, "roof tiles", paintClay(256, {0.60f, 0.33f, 0.23f}));
    b.scene.materials[m.tiles].doubleSided = true;  // open below
    m.iron = plainMaterial(b, "iron", {0.05f, 0.05f, 0.055f}, 0.45f, 0.6f);
    m.rope = plainMaterial(b, "rope", {0.22f, 0.16f, 0.10f}, 0.95f);
    m.bronze = plainMaterial(b, "bronze", {0.30f, 0.36f, 0.27f}, 0.4f, 0.5f);
    m.water = plainMaterial(b, "water", {0.015f, 0.05f, 0.06f}, 0.08f);
    m.spray = plainMaterial(b, "spray", {0.55f, 0.66f, 0.70f}, 0.15f);
    m.glow = plainMaterial(b, "flame", {0.0f, 0.0f, 0.0f}, 1.0f);
    b.scene.materials[m.glow].emissive = glm::vec3(1.0f, 0.56f, 0.2f) * (parts.hour == Hour::Day ? 200.0f : 12.0f);
    m.coolGlow = plainMaterial(b, "cool lamp", {0.0f, 0.0f, 0.0f}, 1.0f);
    b.scene.materials[m.coolGlow].emissive = glm::vec3(0.35f, 0.65f, 1.0f) * 10.0f;
    const glm::vec3 cream(0.86f, 0.80f, 0.68f);
    m.cloth = {texturedMaterial(b, "cloth red", paintStripes(256, {0.66f, 0.10f, 0.09f}, cream)),
               texturedMaterial(b, "cloth blue", paintStripes(256, {0.10f, 0.22f, 0.50f}, cream)),
               texturedMaterial(b, "cloth ochre", paintStripes(256, {0.78f, 0.50f, 0.12f}, {0.45f, 0.12f, 0.10f})),
               texturedMaterial(b, "cloth green", paintStripes(256, {0.12f, 0.36f, 0.24f}, cream))};
    for (const std::uint32_t cloth : m.cloth)
        b.scene.materials[cloth].doubleSided = b.scene.materials[cloth].subsurface = true;
}

// Once around the fountain in a loop of the scene's animation: for films, and to look for what pops.
void addFlight(SceneBuilder& b) {
    constexpr int kKeys = 240;
    const auto view = [](float t) {
        const float angle = 6.28318530718f * t;
        const float height = 3.1f + 1.4f * std::sin(2.0f * angle + 0.6f);
        const glm::vec3 eye(-9.0f * std::cos(angle), height, 5.2f * std::sin(angle));
        return lookingAt(eye, {1.5f * std::cos(angle), 1.7f, -1.2f * std::sin(angle)});
    };
    const auto turn = [view](float t) { return glm::normalize(glm::quat_cast(glm::mat3(view(t)))); };
    const std::uint32_t node = addNode(b.scene, "flight", kNone, glm::vec3(view(0.0f)[3]), turn(0.0f));
    animatePlace(b.scene, node, kKeys, [view](float t) { return glm::vec3(view(t)[3]); });
    animateTurn(b.scene, node, kKeys, turn);
    SceneCamera camera = b.scene.cameras.back();
    camera.name = "flight";
    camera.worldFromCamera = worldFromNode(b.scene, node);
    camera.node = node;
    b.scene.cameras.push_back(camera);
}

Scene build(const char* name, Hour hour) {
    Parts parts;
    parts.builder.scene.name = name;
    parts.hour = hour;
    const auto side = [](const glm::vec3& middle, float turn, float halfLength) {
        return Side{placed(middle, turn), halfLength, static_cast<int>(2.0f * halfLength / kBay + 0.5f)};
    };
    constexpr float kQuarter = 1.57079632679f;
    parts.sides = {side({0, 0, -kHalfZ}, 0.0f, kHalfX), side({0, 0, kHalfZ}, 2.0f * kQuarter, kHalfX),
                   side({kHalfX, 0, 0}, -kQuarter, kHalfZ), side({-kHalfX, 0, 0}, kQuarter, kHalfZ)};
    makeMaterials(parts);
    makeLivingMaterials(parts);
    addArchitecture(parts);
    addFurniture(parts);
    addPlants(parts);
    addFigures(parts);
    addWildlife(parts);
    addLights(parts);
    SceneBuilder& b = parts.builder;
    b.camera("overview", {-11.7f, 5.3f, 5.6f}, {1.2f, 1.75f, -1.5f}, 0.93f);
    b.camera("arcade", {-12.2f, 1.75f, -10.7f}, {2.0f, 1.55f, -9.3f}, 0.95f);
    b.camera("fountain", {4.6f, 1.45f, 4.4f}, {-0.6f, 1.75f, -1.2f}, 0.9f);
    b.camera("gallery", {-11.2f, 6.15f, -10.9f}, {2.5f, 2.6f, 1.2f}, 0.95f);
    addFlight(b);
    if (hour == Hour::Day) {
        b.scene.skyColour = {7.6f, 11.0f, 17.0f};
        b.scene.groundColour = {3.0f, 2.3f, 1.6f};
        b.scene.exposureEv100 = 4.35f;
    } else {
        b.scene.skyColour = {0.030f, 0.048f, 0.105f};
        b.scene.groundColour = {0.022f, 0.020f, 0.022f};
        b.scene.exposureEv100 = -0.2f;
    }
    return std::move(b.scene);
}

}  // namespace
}  // namespace courtyard

Scene makeCourtyardNight() {
    return courtyard::build("courtyard", courtyard::Hour::Night);
}
Scene makeCourtyardDay() {
    return courtyard::build("courtyard-day", courtyard::Hour::Day);
}
Scene makeCourtyardBench() {
    return courtyard::build("courtyard-bench", courtyard::Hour::Bench);
}

}  // namespace gnomon::renderer
