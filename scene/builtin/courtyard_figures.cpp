// The people of the courtyard and what each of them does, over and over, every kLoopSeconds.

#include "scene/builtin/courtyard_figure.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtx/quaternion.hpp>

#include "scene/builtin/numbers.h"

namespace gnomon::renderer::courtyard {

glm::quat about(const glm::vec3& axis, float angle) {
    return glm::angleAxis(angle, glm::normalize(axis));
}

namespace {

const glm::vec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

// A wave that passes `times` times in one loop.
float wave(float at, int times, float offset = 0.0f) {
    return std::sin(kTau * (static_cast<float>(times) * at + offset));
}

// Puts the walking figure on its path; returns the phase of its steps. Whole cycles per loop, so that the loop closes.
float follow(Pose& pose, const ClosedPath& path, float at, Gait& gait, float height, float scale = 1.0f) {
    const float cycles = std::round(path.length() / (scale * gait.metresPerCycle));
    gait.metresPerCycle = path.length() / (scale * cycles);
    const glm::vec2 place = path.place(at);
    pose.translation[kRoot] = {place.x, height, place.y};
    pose.rotation[kRoot] = about(kY, path.heading(at));
    return cycles * at;
}

void standAt(Pose& pose, const glm::vec3& place, float turn) {
    pose.translation[kRoot] = place;
    pose.rotation[kRoot] = about(kY, turn);
}

// A weight that shifts from foot to foot, breath, a head that looks around.
void idle(Pose& pose, float at, float offset) {
    const float shift = wave(at, 2, offset);
    pose.translation[kHips] = {0.022f * shift, kHipHeight - 0.02f - 0.004f * wave(at, 4, offset), -0.01f};
    pose.rotation[kHips] = about(kZ, -0.03f * shift) * about(kY, 0.05f * wave(at, 1, offset));
    pose.rotation[kChest] = about(kZ, 0.035f * shift) * about(kX, 0.03f + 0.012f * wave(at, 4, offset + 0.1f));
    pose.rotation[kHead] =
        about(kY, 0.28f * wave(at, 1, offset + 0.3f)) * about(kX, 0.05f + 0.06f * wave(at, 3, offset));
    stand(pose, 0.04f, -0.05f);
    for (const bool left : {true, false}) {
        const std::uint32_t upper = left ? kUpperArmL : kUpperArmR;
        pose.rotation[upper] = about(kZ, left ? 0.09f : -0.09f) * about(kX, -0.04f + 0.03f * shift);
        pose.rotation[upper + 1] = about(kX, -0.22f);
    }
}

std::uint32_t carriedLanternMesh(Parts& parts) {
    ShapeBuilder iron(parts.materials.iron), flame(parts.materials.glow);
    const glm::vec3 handle[] = {{0, 0.03f, 0}, {0, -0.10f, 0}};
    iron.tube(handle, 0.006f, 6);
    const glm::vec2 roof[] = {{0.0f, -0.18f},  {0.10f, -0.18f},  {0.10f, -0.172f},
                              {0.05f, -0.13f}, {0.018f, -0.10f}, {0.0f, -0.09f}};
    iron.lathe(roof, 6, true);
    for (int i = 0; i < 4; ++i) {
        const float a = kTau * (static_cast<float>(i) + 0.5f) / 4.0f;
        const glm::vec3 post[] = {{0.085f * std::cos(a), -0.18f, 0.085f * std::sin(a)},
                                  {0.085f * std::cos(a), -0.415f, 0.085f * std::sin(a)}};
        iron.tube(post, 0.004f, 5);
    }
    const glm::vec2 foot[] = {{0.10f, -0.43f}, {0.10f, -0.41f}, {0.0f, -0.41f}};
    iron.lathe(foot, 6, true);
    const glm::vec2 under[] = {{0.0f, -0.431f}, {0.10f, -0.43f}};
    iron.lathe(under, 6, true);
    const glm::vec2 candle[] = {
        {0.024f, -0.412f}, {0.024f, -0.38f}, {0.018f, -0.365f}, {0.006f, -0.335f}, {0.0f, -0.33f}};
    flame.lathe(candle, 10);
    return parts.builder.mesh("carried lantern", {iron.take(), flame.take()});
}

// Walks up and down the northern arcade with a lantern whose light runs through the columns.
void addLanternBearer(Parts& parts) {
    const Materials& m = parts.materials;
    const ClosedPath path({{-8.9f, -10.95f},
                           {-7.4f, -11.05f},
                           {-5.2f, -11.05f},
                           {-3.5f, -10.95f},
                           {-3.1f, -10.60f},
                           {-3.5f, -10.25f},
                           {-5.2f, -10.2f},
                           {-7.4f, -10.2f},
                           {-8.9f, -10.25f},
                           {-9.3f, -10.60f}});
    Look look{m.wear[0], m.wear[2], m.skin[1], m.hair[1], m.leather, m.straw};
    look.head = Look::Head::Hood;
    look.shawl = true;
    const std::uint32_t first = addFigure(parts, "lantern bearer", look, 132, [&](float at) {
        Pose pose;
        Gait gait{1.10f, 0.64f, 0.07f, 0.22f, 0.04f};
        const float phase = follow(pose, path, at, gait, kArcadeFloor);
        walk(pose, gait, phase);
        const float bob = pose.translation[kHips].y - kHipHeight;
        reachWith(pose, false, {-0.40f, 1.16f + bob + 0.012f * std::sin(2.0f * kTau * phase), 0.34f},
                  {-0.6f, -1.0f, -0.3f});
        pose.translation[kProp] = glm::vec3(pose.figureFromJoint(kHandR) * glm::vec4(0, -0.09f, 0.01f, 1));
        pose.rotation[kProp] = about(kX, 0.10f * std::sin(kTau * phase)) * about(kZ, 0.05f * std::cos(kTau * phase));
        return pose;
    });
    placeOn(parts.builder, first + kProp, carriedLanternMesh(parts));
    SceneLight light;
    light.name = "carried lantern";
    light.position = glm::vec3(worldFromNode(parts.builder.scene, first + kProp) * glm::vec4(0, -0.285f, 0, 1));
    light.colour = {1.0f, 0.58f, 0.25f};
    light.intensity = 34.0f;
    light.rangeMetres = 8.0f;
    light.sourceRadius = 0.02f;
    light.node = first + kProp;
    parts.builder.scene.lights.push_back(light);
}

std::uint32_t parasolMesh(Parts& parts) {
    ShapeBuilder canopy(parts.materials.cloth[3]), stick(parts.materials.darkWood);
    const glm::vec3 pole[] = {{0, -0.22f, 0}, {0, 1.06f, 0}};
    stick.tube(pole, 0.011f, 6);
    constexpr int kRibs = 8;
    canopy.sheet(
        [](float u, float v) {
            const float a = -kTau * u, between = 0.5f - 0.5f * std::cos(kTau * u * kRibs);  // 0 on a rib
            const float r = 0.02f + 0.66f * v * (1.0f - 0.06f * between * v);
            return glm::vec3(r * std::cos(a), 1.03f - 0.28f * v * v - 0.03f * between * v, r * std::sin(a));
        },
        kRibs * 4, 8, 3.2f, 0.8f);
    return parts.builder.mesh("parasol", {canopy.take(), stick.take()});
}

void addLadyWithParasol(Parts& parts) {
    const Materials& m = parts.materials;
    const ClosedPath path(
        {{-6.6f, 2.7f}, {-5.6f, 2.3f}, {-4.4f, 3.0f}, {-3.7f, 4.2f}, {-4.3f, 5.3f}, {-5.7f, 5.5f}, {-6.7f, 4.3f}});
    Look look{m.wear[1], m.wear[3], m.skin[0], m.hair[0], m.leather, m.straw};
    look.shawl = true;
    const std::uint32_t first = addFigure(parts, "lady with a parasol", look, 120, [&](float at) {
        Pose pose;
        Gait gait{1.0f, 0.64f, 0.07f, 0.30f, 0.01f};
        const float phase = follow(pose, path, at + 0.40f, gait, 0.0f);
        walk(pose, gait, phase);
        reachWith(pose, false, {-0.20f, 1.13f + pose.translation[kHips].y - kHipHeight, 0.24f}, {-0.8f, -1.0f, -0.2f});
        pose.translation[kProp] = glm::vec3(pose.figureFromJoint(kHandR) * glm::vec4(0, -0.08f, 0, 1));
        pose.rotation[kProp] =
            about(kX, -0.36f + 0.02f * std::sin(kTau * phase)) * about(kZ, 0.10f) * about(kY, kTau * at);
        return pose;
    });
    placeOn(parts.builder, first + kProp, parasolMesh(parts));
}

std::uint32_t broomMesh(Parts& parts) {
    ShapeBuilder stick(parts.materials.wood), straw(parts.materials.straw);
    const glm::vec3 pole[] = {{0, 0.25f, 0}, {0, 1.50f, 0}};
    stick.tube(pole, 0.014f, 8);
    const ShapeBuilder::Ring rings[] = {{{0, 0.0f, 0}, {0.17f, 0, 0}, {0, 0, -0.05f}},
                                        {{0, 0.12f, 0}, {0.13f, 0, 0}, {0, 0, -0.045f}},
                                        {{0, 0.24f, 0}, {0.07f, 0, 0}, {0, 0, -0.04f}},
                                        {{0, 0.33f, 0}, {0.035f, 0, 0}, {0, 0, -0.03f}},
                                        {{0, 0.38f, 0}, {0.018f, 0, 0}, {0, 0, -0.018f}}};
    straw.loft(rings, 16);
    return parts.builder.mesh("broom", {stick.take(), straw.take()});
}

void addSweeper(Parts& parts) {
    const Materials& m = parts.materials;
    Look look{m.wear[2], m.wear[5], m.skin[1], m.hair[0], m.leather, m.straw};
    look.longRobe = false;
    look.head = Look::Head::StrawHat;
    const std::uint32_t first = addFigure(parts, "sweeper", look, 96, [](float at) {
        Pose pose;
        standAt(pose, {-1.9f, 0, 5.6f}, 2.5f + 0.12f * wave(at, 1));
        const float sweep = wave(at, 8);
        pose.translation[kHips] = {0.03f * sweep, kHipHeight - 0.05f, -0.03f};
        pose.rotation[kHips] = about(kY, 0.16f * sweep) * about(kX, 0.10f);
        pose.rotation[kChest] = about(kY, 0.20f * sweep) * about(kX, 0.22f);
        pose.rotation[kHead] = about(kX, 0.22f) * about(kY, -0.1f * sweep);
        stand(pose, 0.16f, -0.14f);
        const glm::vec3 foot(0.05f + 0.34f * sweep, 0.012f + 0.05f * std::max(0.0f, -std::cos(kTau * 8.0f * at)),
                             0.62f - 0.06f * sweep * sweep);
        const glm::vec3 top(-0.10f + 0.10f * sweep, 1.33f, 0.22f), along = glm::normalize(top - foot);
        pose.translation[kProp] = foot;
        pose.rotation[kProp] = glm::rotation(kY, along);
        reachWith(pose, true, foot + 0.90f * along + glm::vec3(0.02f, 0.05f, -0.05f), {1.0f, -0.6f, -0.4f});
        reachWith(pose, false, foot + 1.24f * along + glm::vec3(-0.02f, 0.05f, -0.05f), {-1.0f, -0.3f, -0.4f});
        return pose;
    });
    placeOn(parts.builder, first + kProp, broomMesh(parts));
}

// On a bench, asleep but for his head, which sinks and jerks up again.
void addSleeper(Parts& parts) {
    const Materials& m = parts.materials;
    Look look{m.wear[5], m.wear[2], m.skin[0], m.hair[2], m.leather, m.straw};
    look.longRobe = false;
    look.head = Look::Head::Cap;
    look.beard = true;
    const glm::vec3 bench = kBenches[1];
    const float turn = std::atan2(-bench.x, -bench.z);
    addFigure(parts, "sleeper", look, 120, [=](float at) {
        Pose pose;
        const glm::vec3 seat(placed(bench, turn) * glm::vec4(0.35f, 0, 0, 1));
        standAt(pose, seat, turn);
        const float sinking =
            at < 0.86f ? std::pow(at / 0.86f, 1.6f) : 0.5f + 0.5f * std::cos(0.5f * kTau * (at - 0.86f) / 0.14f);
        pose.translation[kHips] = {0, 0.595f, -0.06f};
        pose.rotation[kHips] = about(kX, -0.10f);
        pose.rotation[kChest] = about(kX, 0.16f + 0.16f * sinking + 0.012f * wave(at, 4)) * about(kZ, 0.05f * sinking);
        pose.rotation[kHead] = about(kX, 0.12f + 0.62f * sinking) * about(kZ, 0.14f * sinking);
        for (const std::uint32_t thigh : {std::uint32_t(kThighL), std::uint32_t(kThighR)}) {
            const bool left = thigh == kThighL;
            pose.rotation[thigh] =
                about(kX, 0.10f) * about(kY, left ? 0.16f : -0.12f) * about(kX, left ? -1.36f : -1.40f);
            pose.rotation[thigh + 1] = about(kX, left ? 1.42f : 1.30f);
            pose.rotation[thigh + 2] = about(kX, left ? -0.05f : 0.08f);
        }
        reachWith(pose, true, {0.13f, 0.70f, 0.24f}, {1.0f, -0.2f, -0.6f});
        reachWith(pose, false, {-0.12f, 0.70f, 0.25f}, {-1.0f, -0.2f, -0.6f});
        return pose;
    });
}

void addMerchant(Parts& parts) {
    const Materials& m = parts.materials;
    Look look{m.wear[4], m.wear[3], m.skin[2], m.hair[1], m.leather, m.straw};
    look.longRobe = true;
    look.head = Look::Head::Cap;
    look.beard = true;
    const glm::mat4 stall = placed(kRedStall, kRedStallTurn);
    const glm::vec3 place(stall * glm::vec4(-0.1f, 0, 0.52f, 1));
    addFigure(parts, "merchant", look, 72, [=](float at) {
        Pose pose;
        standAt(pose, place, kRedStallTurn + 0.1f * wave(at, 1));
        idle(pose, at, 0.2f);
        const float offer = 0.5f + 0.5f * wave(at, 2, 0.1f);
        reachWith(pose, true, {0.26f, 0.94f, 0.34f}, {1.0f, -0.5f, -0.6f});
        reachWith(pose, false, glm::mix(glm::vec3(-0.25f, 0.96f, 0.32f), glm::vec3(-0.34f, 1.22f, 0.36f), offer),
                  {-1.0f, -0.6f, -0.5f});
        return pose;
    });
}

void addTalkers(Parts& parts) {
    const Materials& m = parts.materials;
    Look tall{m.wear[3], m.wear[0], m.skin[0], m.hair[0], m.leather, m.straw},
        small{m.wear[2], m.wear[1], m.skin[2], m.hair[1], m.leather, m.straw};
    tall.longRobe = false;
    tall.second = m.wear[5];
    small.shawl = true;
    small.scale = 0.94f;
    addFigure(parts, "talking man", tall, 72, [](float at) {
        Pose pose;
        standAt(pose, {-1.05f, 0, -5.9f}, -1.25f);
        idle(pose, at, 0.0f);
        const float talk = 0.5f - 0.5f * std::cos(kTau * at);  // speaks in the first half of the loop, mostly
        reachWith(pose, false, {-0.26f - 0.10f * wave(at, 4), 1.02f + 0.22f * talk + 0.05f * wave(at, 6), 0.30f},
                  {-0.8f, -1.0f, -0.4f});
        return pose;
    });
    addFigure(parts, "talking woman", small, 72, [](float at) {
        Pose pose;
        standAt(pose, {-1.95f, 0, -5.6f}, 1.75f);
        idle(pose, at, 0.45f);
        reachWith(pose, true, {0.04f, 1.02f, 0.20f}, {1.0f, -0.6f, -0.3f});
        reachWith(pose, false, {-0.04f, 1.00f + 0.03f * wave(at, 3), 0.22f}, {-1.0f, -0.6f, -0.3f});
        return pose;
    });
}

// Leans on the gallery's rail and looks down into the court.
void addWatcher(Parts& parts) {
    const Materials& m = parts.materials;
    Look look{m.wear[4], m.wear[3], m.skin[1], m.hair[0], m.leather, m.straw};
    look.shawl = true;
    addFigure(parts, "watcher", look, 60, [](float at) {
        Pose pose;
        standAt(pose, {-7.15f, kGallery, -9.60f}, 0.22f);
        idle(pose, at, 0.6f);
        pose.rotation[kHips] = about(kX, 0.16f) * pose.rotation[kHips];
        pose.translation[kHips].z -= 0.05f;
        stand(pose, -0.10f, -0.04f);
        pose.rotation[kChest] = about(kX, 0.14f) * pose.rotation[kChest];
        pose.rotation[kHead] = about(kY, 0.55f * wave(at, 1)) * about(kX, 0.02f + 0.08f * wave(at, 2));
        reachWith(pose, true, {0.20f, 1.01f, 0.40f}, {1.0f, -0.3f, -0.6f});
        reachWith(pose, false, {-0.20f, 1.01f, 0.44f}, {-1.0f, -0.3f, -0.6f});
        return pose;
    });
}

// Runs around the fountain.
void addChild(Parts& parts) {
    const Materials& m = parts.materials;
    Look look{m.wear[1], m.wear[5], m.skin[0], m.hair[1], m.leather, m.straw};
    look.longRobe = false;
    look.scale = 0.64f;
    std::vector<glm::vec2> ring;
    for (int i = 0; i < 12; ++i) {
        const float a = kTau * static_cast<float>(i) / 12.0f;
        ring.emplace_back(3.68f * std::cos(a), 3.68f * std::sin(a));
    }
    const ClosedPath path(ring);
    addFigure(parts, "child", look, 216, [&](float at) {
        Pose pose;
        Gait gait{2.0f, 0.40f, 0.24f, 0.75f, 0.16f};
        const float phase = follow(pose, path, at + 0.61f, gait, 0.0f, 0.64f);
        walk(pose, gait, phase);
        return pose;
    });
}

}  // namespace

void addFigures(Parts& parts) {
    addLanternBearer(parts);
    addLadyWithParasol(parts);
    addSweeper(parts);
    addSleeper(parts);
    addMerchant(parts);
    addTalkers(parts);
    addWatcher(parts);
    addChild(parts);
}

}  // namespace gnomon::renderer::courtyard
