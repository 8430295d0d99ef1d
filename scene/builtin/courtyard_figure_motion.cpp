// How the people of the courtyard move. Feet stand still on the ground while they carry: a standing foot runs back
// under the body at exactly the speed of the path, and legs follow by two-bone inverse kinematics.

#include "scene/builtin/courtyard_figure.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtx/quaternion.hpp>

#include "scene/builtin/numbers.h"

namespace gnomon::renderer::courtyard {
namespace {

constexpr int kSamplesPerCorner = 32;

glm::quat aboutX(float angle) {
    return glm::angleAxis(angle, glm::vec3(1, 0, 0));
}
glm::quat aboutY(float angle) {
    return glm::angleAxis(angle, glm::vec3(0, 1, 0));
}

float smooth(float t) {
    return t * t * (3.0f - 2.0f * t);
}

// The ankle relative to the ground under the hips, and how far the toe points down.
struct Foot {
    float forward, height, pitch;
};

Foot footAt(const Gait& gait, float phase) {
    const float travel = gait.metresPerCycle * gait.stance;  // of the body while the foot stands
    if (phase < gait.stance) {
        const float t = phase / gait.stance, heel = std::max(0.0f, (t - 0.7f) / 0.3f),
                    strike = std::max(0.0f, 1.0f - t / 0.12f);
        return {travel * (0.5f - t), kAnkleHeight + 0.055f * heel * heel, 0.55f * heel * heel - 0.28f * strike};
    }
    const float t = (phase - gait.stance) / (1.0f - gait.stance), back = 1.0f - smooth(t);
    return {travel * (smooth(t) - 0.5f), kAnkleHeight + 0.055f * back * back + gait.lift * std::sin(0.5f * kTau * t),
            0.55f * back * (1.0f + 0.6f * std::sin(0.5f * kTau * t)) - 0.28f * smooth(t) * t};
}

void placeLeg(Pose& pose, std::uint32_t thigh, const Foot& foot) {
    // In the plane of the leg, from the hip joint; the pelvis' own small turns are left out.
    const float hipHeight = pose.translation[kHips].y + bindTranslation(thigh).y;
    const float down = hipHeight - foot.height, ahead = foot.forward - pose.translation[kHips].z;
    const float distance = std::min(std::sqrt(down * down + ahead * ahead), kThighLength + kShinLength - 0.004f);
    const auto angleOpposite = [](float opposite, float a, float b) {
        return std::acos(std::clamp((a * a + b * b - opposite * opposite) / (2.0f * a * b), -1.0f, 1.0f));
    };
    const float forward = std::atan2(ahead, down) + angleOpposite(kShinLength, kThighLength, distance);
    const float bend = 0.5f * kTau - angleOpposite(distance, kThighLength, kShinLength);
    pose.rotation[thigh] = glm::inverse(pose.rotation[kHips]) * aboutX(-forward);
    pose.rotation[thigh + 1] = aboutX(bend);
    pose.rotation[thigh + 2] = aboutX(forward - bend + foot.pitch);
}

}  // namespace

glm::vec3 bindTranslation(std::uint32_t joint) {
    constexpr float kArm = 0.205f, kLeg = 0.095f;
    switch (joint) {
        case kHips:
            return {0, kHipHeight, 0};
        case kChest:
            return {0, 0.22f, 0};
        case kHead:
            return {0, 0.33f, 0};
        case kUpperArmL:
            return {kArm, 0.25f, 0};
        case kUpperArmR:
            return {-kArm, 0.25f, 0};
        case kForearmL:
        case kForearmR:
            return {0, -kUpperArmLength, 0};
        case kHandL:
        case kHandR:
            return {0, -kForearmLength, 0};
        case kThighL:
            return {kLeg, -0.03f, 0};
        case kThighR:
            return {-kLeg, -0.03f, 0};
        case kShinL:
        case kShinR:
            return {0, -kThighLength, 0};
        case kFootL:
        case kFootR:
            return {0, -kShinLength, 0};
        default:
            return glm::vec3(0.0f);
    }
}

std::uint32_t parentOf(std::uint32_t joint) {
    switch (joint) {
        case kRoot:
            return kNone;
        case kHips:
        case kProp:
            return kRoot;
        case kChest:
        case kThighL:
        case kThighR:
            return kHips;
        case kHead:
        case kUpperArmL:
        case kUpperArmR:
            return kChest;
        default:
            return joint - 1;
    }
}

Pose::Pose() {
    for (std::uint32_t j = 0; j < kJointCount; ++j) {
        translation[j] = bindTranslation(j);
        rotation[j] = glm::quat(1.0f, 0.0f, 0.0f, 0.0f);
    }
}

glm::mat4 Pose::figureFromJoint(std::uint32_t joint) const {
    if (joint == kRoot) return glm::mat4(1.0f);
    const glm::mat4 local = glm::translate(glm::mat4(1.0f), translation[joint]) * glm::mat4_cast(rotation[joint]);
    return figureFromJoint(parentOf(joint)) * local;
}

void reachWith(Pose& pose, bool left, const glm::vec3& target, const glm::vec3& pole) {
    const std::uint32_t upper = left ? kUpperArmL : kUpperArmR;
    const glm::mat4 figureFromChest = pose.figureFromJoint(kChest);
    const glm::vec3 shoulder(figureFromChest * glm::vec4(bindTranslation(upper), 1.0f));
    const float a = kUpperArmLength, b = kForearmLength;
    const float distance = std::clamp(glm::length(target - shoulder), 0.06f, a + b - 0.004f);
    const glm::vec3 towards = glm::normalize(target - shoulder);
    const glm::vec3 bendTo = glm::normalize(pole - towards * glm::dot(pole, towards));
    const float along = (a * a + distance * distance - b * b) / (2.0f * distance);
    const glm::vec3 elbow = towards * along + bendTo * std::sqrt(std::max(a * a - along * along, 0.0f));
    const glm::vec3 wrist = towards * distance;
    const glm::quat chest = glm::quat_cast(glm::mat3(figureFromChest));
    const glm::vec3 hanging(0, -1, 0);
    const glm::quat upperTurn = glm::rotation(hanging, glm::normalize(glm::inverse(chest) * elbow));
    pose.rotation[upper] = upperTurn;
    pose.rotation[upper + 1] =
        glm::rotation(hanging, glm::normalize(glm::inverse(chest * upperTurn) * (wrist - elbow)));
}

void walk(Pose& pose, const Gait& gait, float phase) {
    const float left = phase - std::floor(phase), right = left + 0.5f - std::floor(left + 0.5f);
    const float swing = std::cos(kTau * left);  // 1: the left foot is ahead
    pose.translation[kHips] =
        glm::vec3(0.0f, kHipHeight - 0.035f - 0.02f * std::cos(2.0f * kTau * (left + 0.03f)), 0.0f);
    pose.rotation[kHips] = aboutY(-0.10f * swing) * aboutX(gait.lean);
    pose.rotation[kChest] = aboutY(0.17f * swing) * aboutX(0.5f * gait.lean);
    pose.rotation[kHead] = aboutY(-0.07f * swing) * aboutX(-gait.lean);
    placeLeg(pose, kThighL, footAt(gait, left));
    placeLeg(pose, kThighR, footAt(gait, right));
    for (const bool isLeft : {true, false}) {
        const std::uint32_t upper = isLeft ? kUpperArmL : kUpperArmR;
        const float arm = (isLeft ? 1.0f : -1.0f) * gait.armSwing * swing;  // positive: backwards
        pose.rotation[upper] = glm::angleAxis(isLeft ? 0.17f : -0.17f, glm::vec3(0, 0, 1)) * aboutX(arm);
        pose.rotation[upper + 1] = aboutX(-0.28f - 0.5f * std::max(0.0f, -arm));
    }
}

void stand(Pose& pose, float leftAhead, float rightAhead) {
    placeLeg(pose, kThighL, {leftAhead, kAnkleHeight, 0.0f});
    placeLeg(pose, kThighR, {rightAhead, kAnkleHeight, 0.0f});
}

ClosedPath::ClosedPath(std::vector<glm::vec2> corners) : corners_(std::move(corners)), lengths_{0.0f} {
    const int samples = static_cast<int>(corners_.size()) * kSamplesPerCorner;
    glm::vec2 before = curve(0.0f);
    for (int i = 1; i <= samples; ++i) {
        const glm::vec2 p = curve(static_cast<float>(i) / kSamplesPerCorner);
        lengths_.push_back(lengths_.back() + glm::length(p - before));
        before = p;
    }
}

glm::vec2 ClosedPath::curve(float corner) const {
    const auto n = static_cast<int>(corners_.size()), i = static_cast<int>(std::floor(corner));
    const float t = corner - static_cast<float>(i);
    const auto at = [&](int k) { return corners_[static_cast<std::size_t>(((k % n) + n) % n)]; };
    const glm::vec2 a = at(i - 1), b = at(i), c = at(i + 1), d = at(i + 2);
    return b + 0.5f * t * (c - a + t * (2.0f * a - 5.0f * b + 4.0f * c - d + t * (3.0f * (b - c) + d - a)));
}

glm::vec2 ClosedPath::place(float at) const {
    const float wanted = (at - std::floor(at)) * length();
    const auto next = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, wanted);
    const auto i = static_cast<std::size_t>(next - lengths_.begin());
    const float t = (wanted - lengths_[i - 1]) / (lengths_[i] - lengths_[i - 1]);
    return curve((static_cast<float>(i - 1) + t) / kSamplesPerCorner);
}

float ClosedPath::heading(float at) const {
    const glm::vec2 along = place(at + 0.004f) - place(at - 0.004f);
    return std::atan2(along.x, along.y);
}

}  // namespace gnomon::renderer::courtyard
