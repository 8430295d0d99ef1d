#include "scene/builtin/bias_lab.h"

#include "scene/builtin/foliage_textures.h"
#include "scene/builtin/material_builders.h"
#include "scene/builtin/scenes.h"

#include <cmath>

namespace gnomon::renderer {
namespace lab {
namespace {

std::uint32_t pictured(SceneBuilder& b, const char* name, Image image, float metres, float roughness) {
    const std::uint32_t material = plainMaterial(b, name, glm::vec3(1.0f), roughness);
    TextureUse& use = b.scene.materials[material].baseColourTexture;
    use.image = b.image(std::move(image));
    use.uvTransform = glm::mat2(1.0f / metres);
    return material;
}

void makeMaterials(Lab& lab) {
    SceneBuilder& b = lab.builder;
    Materials& m = lab.m;
    m.floor = pictured(b, "floor", paintGrid(512), 1.0f, 0.7f);
    m.ground = texturedMaterial(b, "ground", paintClay(256, {0.70f, 0.67f, 0.62f}));
    m.wall = texturedMaterial(b, "wall", paintPlaster(512, {0.77f, 0.76f, 0.73f}), 0.25f);
    m.mat = plainMaterial(b, "mat", {0.055f, 0.075f, 0.085f}, 0.85f);
    m.wood = texturedMaterial(b, "wood", paintPlanks(256, {0.66f, 0.50f, 0.34f}), 0.5f);
    m.white = plainMaterial(b, "white", glm::vec3(0.68f), 0.6f);
    m.steel = plainMaterial(b, "steel", {0.50f, 0.52f, 0.55f}, 0.35f, 0.5f);
    m.black = plainMaterial(b, "lamp black", glm::vec3(0.03f), 0.5f);
    m.glow = plainMaterial(b, "glow", glm::vec3(0.0f), 1.0f);
    b.scene.materials[m.glow].emissive = {9.0f, 7.0f, 4.6f};
    m.accent = plainMaterial(b, "vermilion", {0.60f, 0.13f, 0.04f}, 0.5f);
    m.sand = texturedMaterial(b, "sand", paintClay(256, {0.82f, 0.70f, 0.52f}), 0.3f);
    m.clay = texturedMaterial(b, "clay", paintClay(256, {0.68f, 0.36f, 0.24f}));
    m.soil = plainMaterial(b, "soil", {0.06f, 0.04f, 0.025f}, 0.95f);
    m.lace = pictured(b, "lace", paintLace(1024), 0.4f, 0.9f);
    b.scene.materials[m.lace].alphaMode = AlphaMode::Mask;
    b.scene.materials[m.lace].alphaCutoff = 0.5f;
    m.paper = plainMaterial(b, "paper", {0.72f, 0.70f, 0.64f}, 0.9f);
    m.banner = texturedMaterial(b, "banner", paintStripes(256, {0.10f, 0.36f, 0.40f}, {0.84f, 0.80f, 0.70f}));
    m.leaf = pictured(b, "leaf", paintLeaf(256), 1.0f, 0.5f);
    for (const std::uint32_t thin : {m.lace, m.paper, m.banner, m.leaf}) b.scene.materials[thin].doubleSided = true;
    m.skin = plainMaterial(b, "skin", {0.70f, 0.42f, 0.31f}, 0.55f);
    b.scene.materials[m.skin].subsurface = b.scene.materials[m.leaf].subsurface = true;
}

// A floor on a low plinth, two walls, and open ground towards the sun with a row of bollards down to the horizon.
void addRoom(Lab& lab) {
    ShapeBuilder floor(lab.m.floor), ground(lab.m.ground), wall(lab.m.wall), white(lab.m.white);
    floor.box({-6.0f, -0.2f, -3.5f}, {6.2f, 0.0f, 2.75f}, ShapeBuilder::kAll & ~ShapeBuilder::kBottom);
    lab.place("floor", floor);
    ground.quad({-60, -0.2f, 60}, {60, -0.2f, 60}, {60, -0.2f, -60}, {-60, -0.2f, -60});
    lab.place("ground", ground);
    constexpr unsigned kStanding = ShapeBuilder::kAll & ~ShapeBuilder::kBottom;
    wall.box({kWallX - 0.2f, 0.0f, kWallZ - 0.2f}, {5.45f, 2.5f, kWallZ}, kStanding);
    wall.box({kWallX - 0.2f, 0.0f, kWallZ}, {kWallX, 2.5f, 0.1f}, kStanding & ~ShapeBuilder::kBack);
    lab.place("walls", wall);
    const glm::vec2 bollard[] = {{0.12f, -0.2f}, {0.10f, 0.65f}, {0.06f, 0.72f}, {0.0f, 0.74f}};
    for (int i = 0; i < 11; ++i) {
        const float away = 2.0f * std::pow(1.36f, static_cast<float>(i));
        white.setTransform(placed({5.6f + away, 0, -0.9f - 0.5f * away}));
        white.lathe(bollard, 24);
    }
    lab.place("bollards", white);
}

Scene build() {
    Lab lab;
    makeMaterials(lab);
    addRoom(lab);
    addReliefs(lab);
    addCloths(lab);
    addContacts(lab);
    addLiving(lab);
    addLights(lab);
    SceneBuilder& b = lab.builder;
    const auto camera = [&](const char* name, const glm::vec3& eye, const glm::vec3& target, float fieldOfView) {
        b.camera(name, kOrigin + eye, kOrigin + target, fieldOfView);
    };
    camera("overview", {1.3f, 2.75f, 6.6f}, {0.02f, 0.5f, -0.6f}, 0.72f);
    camera("sand", kSand + glm::vec3(0.5f, 0.8f, 1.35f), kSand + glm::vec3(-0.15f, 0.08f, -0.1f), 0.75f);
    camera("plates", kPlates + glm::vec3(0.45f, 0.95f, 2.0f), kPlates + glm::vec3(-0.1f, 0.18f, 0.05f), 0.72f);
    camera("contacts", kContacts + glm::vec3(0.35f, 0.55f, 1.3f), kContacts + glm::vec3(0.0f, 0.15f, 0.0f), 0.72f);
    camera("lace", kCurtain + glm::vec3(1.5f, 1.35f, 2.3f), kCurtain + glm::vec3(-0.1f, 0.95f, -0.5f), 0.85f);
    camera("cloth", kLaceCloth + glm::vec3(0.3f, 1.1f, 0.9f), kLaceCloth + glm::vec3(0, 0.60f, 0), 0.7f);
    camera("ears", kBust + glm::vec3(0.25f, 1.5f, 1.0f), kBust + glm::vec3(0, 1.33f, 0), 0.6f);
    camera("leaves", kPlant + glm::vec3(0.45f, 1.2f, 1.45f), kPlant + glm::vec3(0, 0.8f, 0), 0.72f);
    camera("sheets", kSheets + glm::vec3(0.7f, 1.25f, 1.5f), kSheets + glm::vec3(-0.12f, 0.55f, -0.1f), 0.75f);
    camera("grazing", kRamps + glm::vec3(0.55f, 0.62f, 2.2f), kRamps + glm::vec3(-0.35f, 0.3f, -0.5f), 0.8f);
    b.scene.skyColour = {0.26f, 0.36f, 0.60f};
    b.scene.groundColour = {0.15f, 0.125f, 0.10f};
    b.scene.exposureEv100 = 1.75f;
    return std::move(b.scene);
}

}  // namespace

void addTable(ShapeBuilder& wood, const glm::vec3& foot, float halfX, float halfZ, float height) {
    const float thickness = 0.035f, leg = 0.025f;
    wood.box(foot + glm::vec3(-halfX, height - thickness, -halfZ), foot + glm::vec3(halfX, height, halfZ));
    for (const float x : {-halfX + 0.06f, halfX - 0.06f})
        for (const float z : {-halfZ + 0.06f, halfZ - 0.06f})
            wood.box(foot + glm::vec3(x - leg, 0.0f, z - leg), foot + glm::vec3(x + leg, height - thickness, z + leg),
                     ShapeBuilder::kAll & ~(ShapeBuilder::kBottom | ShapeBuilder::kTop));
}

void addMat(Lab& lab, const glm::vec3& middle, float halfX, float halfZ) {
    ShapeBuilder mat(lab.m.mat);
    mat.box(middle - glm::vec3(halfX, 0, halfZ), middle + glm::vec3(halfX, kMat, halfZ),
            ShapeBuilder::kAll & ~ShapeBuilder::kBottom);
    lab.place("mat", mat);
}

}  // namespace lab

Scene makeBiasLab() {
    return lab::build();
}

}  // namespace gnomon::renderer
