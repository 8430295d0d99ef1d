// Bodies and clothes: lofted tubes whose vertices follow the bones by a function of their place.

#include "scene/builtin/courtyard_figure.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::renderer::courtyard {
namespace {

struct Influence {
    glm::u16vec4 joints{0};
    glm::vec4 weights{0.0f};
};

Influence influences(std::initializer_list<std::pair<std::uint32_t, float>> pairs) {
    Influence out;
    float sum = 0.0f;
    for (const auto& pair : pairs) sum += pair.second;
    int k = 0;
    for (const auto& [joint, weight] : pairs) {
        out.joints[k] = static_cast<std::uint16_t>(weight > 0.0f ? joint : 0u);
        out.weights[k++] = weight / sum;
    }
    return out;
}

float ramp(float low, float high, float v) {
    const float t = std::clamp((v - low) / (high - low), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

// A shape, and what its vertices follow.
class Garment {
public:
    explicit Garment(std::uint32_t material) : shape(material) {}
    template <class Follow>
    void bind(Follow follow) {  // the vertices added since the last call
        for (std::size_t i = joints_.size(); i < shape.vertexCount(); ++i) {
            const Influence of = follow(shape.positions()[i]);
            joints_.push_back(of.joints);
            weights_.push_back(of.weights);
        }
    }
    void bindTo(std::uint32_t joint) {
        bind([=](const glm::vec3&) { return influences({{joint, 1.0f}}); });
    }
    void takeInto(std::vector<Primitive>& all) {
        if (shape.vertexCount() == 0) return;
        Primitive p = shape.take();
        p.joints = std::move(joints_);
        p.weights = std::move(weights_);
        all.push_back(std::move(p));
    }
    ShapeBuilder shape;

private:
    std::vector<glm::u16vec4> joints_;
    std::vector<glm::vec4> weights_;
};

// Upright sections from below: height, half-width, half-depth, offset to the front. Rounded between the stations.
struct Station {
    float y, wide, deep, front = 0.0f, folds = 0.0f;
};

void upright(ShapeBuilder& shape, std::span<const Station> s, int sides, float x = 0.0f, int steps = 3) {
    std::vector<ShapeBuilder::Ring> rings;
    const auto count = static_cast<int>(s.size());
    for (int i = 0; i + 1 < count; ++i) {
        const auto at = [&](int k) { return s[static_cast<std::size_t>(std::clamp(k, 0, count - 1))]; };
        for (int step = 0; step < steps + (i + 2 == count ? 1 : 0); ++step) {
            const float t = static_cast<float>(step) / static_cast<float>(steps);
            const auto blend = [&](float Station::*m) {  // Catmull and Rom
                const float a = at(i - 1).*m, b = at(i).*m, c = at(i + 1).*m, d = at(i + 2).*m;
                return b + 0.5f * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
            };
            const float wide = std::max(blend(&Station::wide), 0.004f), deep = std::max(blend(&Station::deep), 0.004f);
            rings.push_back({{x, glm::mix(at(i).y, at(i + 1).y, t), blend(&Station::front)},
                             {wide, 0, 0},
                             {0, 0, -deep},
                             blend(&Station::folds)});
        }
    }
    shape.loft(rings, sides);
}

Influence followTorso(const glm::vec3& p) {
    const float chest = ramp(1.00f, 1.24f, p.y);
    return influences({{kChest, chest}, {kHips, 1.0f - chest}});
}

// Below the hips cloth follows both legs: a gown by half, a tunic nearly all the way; the left of it rather the left
// one.
Influence followSkirt(const glm::vec3& p, bool longRobe) {
    if (p.y > 0.97f) return followTorso(p);
    const float legs = longRobe ? 0.5f * ramp(0.97f, 0.62f, p.y) : 0.95f * ramp(0.97f, 0.76f, p.y);
    const float width = longRobe ? 0.16f : 0.10f, left = ramp(-width, width, p.x);
    return influences({{kHips, 1.0f - legs}, {kThighL, legs * left}, {kThighR, legs * (1.0f - left)}});
}

void addGown(Garment& cloth, bool longRobe) {
    const Station robe[] = {{0.045f, 0.285f, 0.27f, 0, 0.07f}, {0.10f, 0.272f, 0.258f, 0, 0.068f},
                            {0.45f, 0.225f, 0.20f, 0, 0.05f},  {0.78f, 0.185f, 0.152f, 0, 0.02f},
                            {0.93f, 0.168f, 0.137f},           {1.06f, 0.140f, 0.114f},
                            {1.20f, 0.156f, 0.126f, 0.01f},    {1.33f, 0.182f, 0.128f, 0.01f},
                            {1.41f, 0.190f, 0.110f},           {1.45f, 0.150f, 0.086f},
                            {1.482f, 0.082f, 0.068f},          {1.50f, 0.056f, 0.056f}};
    const Station tunic[] = {
        {0.58f, 0.232f, 0.20f, 0, 0.06f}, {0.66f, 0.222f, 0.19f, 0, 0.05f}, {0.80f, 0.195f, 0.162f, 0, 0.02f},
        {0.93f, 0.172f, 0.138f},          {1.06f, 0.146f, 0.117f},          {1.20f, 0.162f, 0.127f, 0.01f},
        {1.33f, 0.190f, 0.130f, 0.01f},   {1.41f, 0.194f, 0.112f},          {1.45f, 0.152f, 0.087f},
        {1.482f, 0.082f, 0.068f},         {1.50f, 0.056f, 0.056f}};
    longRobe ? upright(cloth.shape, robe, 54, 0.0f, 5) : upright(cloth.shape, tunic, 54, 0.0f, 4);
    cloth.bind([=](const glm::vec3& p) { return followSkirt(p, longRobe); });
}

void addArms(Garment& cloth, Garment& skin, bool wideSleeves) {
    for (const float side : {1.0f, -1.0f}) {
        const std::uint32_t upper = side > 0.0f ? kUpperArmL : kUpperArmR;
        const float x = 0.205f * side, w = wideSleeves ? 0.028f : 0.0f;
        const Station sleeve[] = {{0.955f, 0.042f + w, 0.044f + 1.4f * w},
                                  {0.975f, 0.045f + w, 0.047f + 1.4f * w},
                                  {1.05f, 0.045f + 0.6f * w, 0.047f + 0.7f * w},
                                  {1.16f, 0.048f, 0.05f},
                                  {1.28f, 0.053f, 0.056f},
                                  {1.37f, 0.051f, 0.056f},
                                  {1.415f, 0.041f, 0.048f},
                                  {1.442f, 0.02f, 0.024f}};
        upright(cloth.shape, sleeve, 12, x);
        cloth.bind([=](const glm::vec3& p) {
            const float fore = ramp(1.23f, 1.09f, p.y), chest = 0.5f * ramp(1.38f, 1.45f, p.y);
            return influences(
                {{upper, (1.0f - fore) * (1.0f - chest)}, {upper + 1, fore}, {kChest, chest * (1.0f - fore)}});
        });
        const Station hand[] = {{0.80f, 0.010f, 0.020f, 0.012f}, {0.83f, 0.016f, 0.034f, 0.010f},
                                {0.88f, 0.019f, 0.042f, 0.006f}, {0.92f, 0.021f, 0.034f},
                                {0.95f, 0.024f, 0.026f},         {1.00f, 0.028f, 0.029f}};
        upright(skin.shape, hand, 10, x, 2);
        skin.bindTo(upper + 2);
    }
}

void addLegs(Garment& trousers, Garment& shoes, bool longRobe) {
    for (const float side : {1.0f, -1.0f}) {
        const std::uint32_t thigh = side > 0.0f ? kThighL : kThighR;
        const float x = 0.095f * side;
        if (!longRobe) {
            const Station leg[] = {{0.11f, 0.046f, 0.05f},  {0.16f, 0.052f, 0.056f}, {0.33f, 0.062f, 0.066f},
                                   {0.50f, 0.062f, 0.066f}, {0.70f, 0.078f, 0.084f}, {0.86f, 0.086f, 0.094f},
                                   {0.92f, 0.07f, 0.08f}};
            upright(trousers.shape, leg, 12, x);
            trousers.bind([=](const glm::vec3& p) {
                const float shin = ramp(0.57f, 0.43f, p.y), hips = 0.6f * ramp(0.84f, 0.95f, p.y);
                return influences(
                    {{thigh, (1.0f - shin) * (1.0f - hips)}, {thigh + 1, shin}, {kHips, hips * (1.0f - shin)}});
            });
        }
        const Station boot[] = {
            {0.06f, 0.04f, 0.044f}, {0.12f, 0.046f, 0.05f}, {0.22f, 0.052f, 0.056f}, {0.25f, 0.05f, 0.054f}};
        upright(shoes.shape, boot, 12, x, 2);
        shoes.bind([=](const glm::vec3& p) {
            const float shin = ramp(0.08f, 0.15f, p.y);
            return influences({{thigh + 1, shin}, {thigh + 2, 1.0f - shin}});
        });
        // The shoe: sections along +z.
        std::vector<ShapeBuilder::Ring> rings;
        for (const glm::vec4& s : {glm::vec4(-0.082f, 0.022f, 0.018f, 0.036f),
                                   {-0.07f, 0.036f, 0.033f, 0.04f},
                                   {-0.03f, 0.042f, 0.042f, 0.044f},
                                   {0.03f, 0.043f, 0.040f, 0.042f},
                                   {0.09f, 0.047f, 0.031f, 0.033f},
                                   {0.14f, 0.042f, 0.024f, 0.027f},
                                   {0.168f, 0.025f, 0.014f, 0.022f},
                                   {0.176f, 0.01f, 0.006f, 0.02f}})
            rings.push_back({{x, s.w, s.x}, {s.y, 0, 0}, {0, s.z, 0}});
        shoes.shape.loft(rings, 12);
        shoes.bindTo(thigh + 2);
    }
}

void addHead(Garment& skin, Garment& hair, Garment& cloth, const Look& look) {
    const Station neck[] = {{1.44f, 0.052f, 0.054f}, {1.50f, 0.046f, 0.048f}, {1.56f, 0.047f, 0.05f}};
    upright(skin.shape, neck, 12, 0.0f, 2);
    skin.bind([](const glm::vec3& p) {
        const float head = ramp(1.46f, 1.55f, p.y);
        return influences({{kHead, head}, {kChest, 1.0f - head}});
    });
    // The head in its own frame, a little larger than life: figures are seen from afar.
    const glm::mat4 larger = glm::scale(glm::translate(glm::mat4(1.0f), glm::vec3(0, -0.185f, 0)), glm::vec3(1.11f));
    for (Garment* garment : {&skin, &hair, &cloth}) garment->shape.setTransform(larger);
    const Station face[] = {
        {1.522f, 0.008f, 0.010f, 0.052f},  {1.530f, 0.028f, 0.030f, 0.040f}, {1.552f, 0.048f, 0.060f, 0.026f},
        {1.60f, 0.066f, 0.084f, 0.012f},   {1.66f, 0.074f, 0.092f, 0.004f},  {1.71f, 0.070f, 0.086f, 0.0f},
        {1.745f, 0.050f, 0.062f, -0.002f}, {1.762f, 0.02f, 0.026f, -0.004f}, {1.766f, 0.006f, 0.008f, -0.004f}};
    upright(skin.shape, face, 18);
    skin.shape.sphere({0, 1.628f, 0.094f}, 0.015f, 6, 8);  // nose
    skin.bindTo(kHead);
    const Station scalp[] = {{1.575f, 0.050f, 0.052f, -0.036f}, {1.60f, 0.068f, 0.074f, -0.022f},
                             {1.66f, 0.079f, 0.088f, -0.012f},  {1.70f, 0.079f, 0.092f, -0.004f},
                             {1.735f, 0.066f, 0.078f, -0.003f}, {1.765f, 0.038f, 0.046f, -0.004f},
                             {1.776f, 0.01f, 0.012f, -0.004f}};
    if (look.head != Look::Head::Hood) {
        upright(hair.shape, scalp, 16);
        if (look.longRobe && look.head == Look::Head::Hair)
            hair.shape.sphere({0, 1.66f, -0.108f}, 0.046f, 8, 12);  // a bun
    }
    if (look.beard) {
        const Station beard[] = {{1.42f, 0.012f, 0.012f, 0.075f},
                                 {1.46f, 0.034f, 0.026f, 0.07f},
                                 {1.53f, 0.052f, 0.04f, 0.052f},
                                 {1.585f, 0.06f, 0.05f, 0.042f},
                                 {1.60f, 0.052f, 0.04f, 0.038f}};
        upright(hair.shape, beard, 14);
    }
    hair.bindTo(kHead);
    if (look.head == Look::Head::Cap) {
        const glm::vec2 cap[] = {{0.092f, 1.695f}, {0.098f, 1.71f},  {0.104f, 1.75f},
                                 {0.088f, 1.79f},  {0.045f, 1.805f}, {0.0f, 1.808f}};
        cloth.shape.lathe(cap, 18);
        const glm::vec2 under[] = {{0.0f, 1.692f}, {0.092f, 1.695f}};
        cloth.shape.lathe(under, 18);
        cloth.bindTo(kHead);
    }
    if (look.head == Look::Head::Hood) {
        cloth.shape.setTransform(glm::mat4(1.0f));
        const Station hood[] = {{1.36f, 0.20f, 0.128f, -0.004f},  {1.43f, 0.165f, 0.11f, -0.010f},
                                {1.49f, 0.104f, 0.09f, -0.028f},  {1.58f, 0.100f, 0.098f, -0.034f},
                                {1.68f, 0.106f, 0.118f, -0.02f},  {1.745f, 0.092f, 0.110f, -0.012f},
                                {1.80f, 0.055f, 0.072f, -0.020f}, {1.828f, 0.012f, 0.016f, -0.034f}};
        upright(cloth.shape, hood, 18);
        cloth.bind([](const glm::vec3& p) {
            const float head = ramp(1.44f, 1.56f, p.y);
            return influences({{kHead, head}, {kChest, 1.0f - head}});
        });
    }
}

void addStrawHat(Garment& straw) {
    straw.shape.setTransform(glm::scale(glm::translate(glm::mat4(1.0f), glm::vec3(0, -0.185f, 0)), glm::vec3(1.11f)));
    const glm::vec2 hat[] = {{0.085f, 1.705f}, {0.235f, 1.685f}, {0.24f, 1.692f}, {0.112f, 1.722f},
                             {0.10f, 1.775f},  {0.08f, 1.815f},  {0.03f, 1.826f}, {0.0f, 1.827f}};
    straw.shape.lathe(hat, 24);
    const glm::vec2 under[] = {{0.0f, 1.705f}, {0.085f, 1.705f}};
    straw.shape.lathe(under, 24);
    straw.bindTo(kHead);
}

void addBeltAndShawl(Garment& second, bool shawl) {
    const Station belt[] = {
        {1.035f, 0.139f, 0.114f}, {1.04f, 0.145f, 0.12f}, {1.08f, 0.146f, 0.121f}, {1.085f, 0.140f, 0.115f}};
    upright(second.shape, belt, 24, 0.0f, 2);
    second.bind(followTorso);
    if (!shawl) return;
    const Station cape[] = {{1.18f, 0.268f, 0.172f, -0.012f}, {1.20f, 0.268f, 0.170f, -0.012f},
                            {1.30f, 0.262f, 0.152f, -0.004f}, {1.39f, 0.240f, 0.128f},
                            {1.44f, 0.19f, 0.102f},           {1.475f, 0.10f, 0.075f},
                            {1.492f, 0.068f, 0.064f}};
    upright(second.shape, cape, 32, 0.0f, 4);
    second.bind([](const glm::vec3& p) {  // its ends swing with the arms, a little
        const float left = 0.45f * ramp(0.12f, 0.28f, p.x) * ramp(1.44f, 1.30f, p.y);
        const float right = 0.45f * ramp(0.12f, 0.28f, -p.x) * ramp(1.44f, 1.30f, p.y);
        return influences({{kChest, 1.0f - left - right}, {kUpperArmL, left}, {kUpperArmR, right}});
    });
}

}  // namespace

std::vector<Primitive> figureBody(const Look& look) {
    Garment cloth(look.robe), second(look.second), skin(look.skin), hair(look.hair), shoes(look.leather);
    addGown(cloth, look.longRobe);
    addArms(cloth, skin, look.longRobe);
    addLegs(second, shoes, look.longRobe);
    addHead(skin, hair, look.shawl ? second : cloth, look);
    second.shape.setTransform(glm::mat4(1.0f));
    addBeltAndShawl(second, look.shawl);
    Garment straw(look.straw);
    if (look.head == Look::Head::StrawHat) addStrawHat(straw);
    std::vector<Primitive> all;
    for (Garment* garment : {&cloth, &second, &skin, &hair, &shoes, &straw}) garment->takeInto(all);
    return all;
}

}  // namespace gnomon::renderer::courtyard
