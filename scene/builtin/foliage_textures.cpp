#include "scene/builtin/foliage_textures.h"

#include "scene/builtin/numbers.h"
#include "scene/random.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace gnomon::renderer {
namespace {

// Paints shapes over each other, back to front; the unit square, y upwards.
class Card {
public:
    Card(std::uint32_t size, const glm::vec3& background) : size_(size) {
        image_.width = image_.height = size;
        image_.rgba8.resize(std::size_t(size) * size * 4);
        for (std::size_t i = 0; i < image_.rgba8.size(); i += 4) store(i, background, 0.0f);
    }

    // A shape in a frame of its own: x along it from 0 to 1, y across. `outline` is positive inside, in units of
    // `length`; `colour` gets x, y and the signed distance.
    using Outline = std::function<float(float, float)>;
    using Colour = std::function<glm::vec3(float, float)>;
    void stamp(glm::vec2 root, glm::vec2 along, float length, const Outline& outline, const Colour& colour) {
        along = glm::normalize(along);
        const glm::vec2 across(-along.y, along.x);
        const float texel = 1.0f / (static_cast<float>(size_) * length);
        const auto clampTexel = [&](float v) {
            return static_cast<int>(std::clamp(v, 0.0f, 1.0f) * static_cast<float>(size_));
        };
        const int x0 = clampTexel(root.x - 1.1f * length), x1 = clampTexel(root.x + 1.1f * length);
        const int y0 = clampTexel(root.y - 1.1f * length), y1 = clampTexel(root.y + 1.1f * length);
        for (int y = y0; y < y1; ++y) {
            for (int x = x0; x < x1; ++x) {
                const glm::vec2 p((static_cast<float>(x) + 0.5f) / static_cast<float>(size_),
                                  (static_cast<float>(y) + 0.5f) / static_cast<float>(size_));
                const float s = glm::dot(p - root, along) / length, t = glm::dot(p - root, across) / length;
                const float inside = outline(s, t);
                const float cover = smooth(-0.75f * texel, 0.75f * texel, inside);
                if (cover <= 0.0f) continue;
                const std::size_t i =
                    (std::size_t(size_ - 1 - static_cast<std::uint32_t>(y)) * size_ + static_cast<std::uint32_t>(x)) *
                    4;
                const float before = static_cast<float>(image_.rgba8[i + 3]) / 255.0f;
                glm::vec3 under;
                for (int c = 0; c < 3; ++c) under[c] = static_cast<float>(image_.rgba8[i + std::size_t(c)]) / 255.0f;
                store(i, glm::mix(under, colour(s, t), cover), std::max(before, cover));
            }
        }
    }

    Image take() { return std::move(image_); }

private:
    void store(std::size_t i, const glm::vec3& colour, float alpha) {
        const auto byte = [](float v) { return static_cast<std::uint8_t>(std::clamp(v, 0.0f, 1.0f) * 255.0f + 0.5f); };
        for (int c = 0; c < 3; ++c) image_.rgba8[i + std::size_t(c)] = byte(colour[c]);
        image_.rgba8[i + 3] = byte(alpha);
    }

    std::uint32_t size_;
    Image image_;
};

// A pointed leaf of `width` (of its length), its ribs lighter, one half a little darker than the other.
void leaf(Card& card, glm::vec2 root, glm::vec2 along, float length, float width, const glm::vec3& tint) {
    const auto half = [=](float s) { return 0.5f * width * std::pow(std::sin(kPi * std::pow(s, 0.8f)), 0.85f); };
    card.stamp(
        root, along, length, [=](float s, float t) { return s <= 0.0f || s >= 1.0f ? -1.0f : half(s) - std::abs(t); },
        [=](float s, float t) {
            const float rib = 1.0f - smooth(0.008f, 0.03f, std::abs(t));
            const float vein = 0.5f + 0.5f * std::sin((s - 1.2f * std::abs(t)) * 42.0f);
            const float shade = (t > 0.0f ? 1.0f : 0.84f) * (0.86f + 0.14f * smooth(0.0f, 0.5f, s)) + 0.06f * vein;
            return tint * shade + glm::vec3(0.10f, 0.12f, 0.05f) * rib;
        });
}

// Five pointed lobes around the end of the stalk.
void lobedLeaf(Card& card, glm::vec2 root, glm::vec2 along, float length, const glm::vec3& tint) {
    const auto reach = [](float angle) {
        const float lobe = std::abs(std::cos(2.5f * angle * 0.72f));
        return (0.30f + 0.26f * std::pow(lobe, 1.4f)) * (1.0f - 0.25f * smooth(1.2f, 3.0f, std::abs(angle)));
    };
    card.stamp(
        root, along, length,
        [=](float s, float t) {
            const float x = s - 0.42f;
            return reach(std::atan2(t, x)) - std::sqrt(x * x + t * t);
        },
        [=](float s, float t) {
            const float x = s - 0.12f, angle = std::atan2(t, x), around = std::sqrt(x * x + t * t);
            const float toRib = std::min(
                {std::abs(t), std::abs(std::sin(angle - 0.75f)) * around, std::abs(std::sin(angle + 0.75f)) * around});
            const float rib = 1.0f - smooth(0.006f, 0.028f, toRib);
            return tint * (0.82f + 0.3f * around) + glm::vec3(0.13f, 0.14f, 0.08f) * rib;
        });
}

void stalk(Card& card, glm::vec2 from, glm::vec2 to, float width, const glm::vec3& tint) {
    const float length = glm::length(to - from), half = 0.5f * width / length;
    card.stamp(
        from, to - from, length,
        [=](float s, float t) { return s < 0.0f || s > 1.0f ? -1.0f : half * (1.0f - 0.5f * s) - std::abs(t); },
        [=](float, float t) { return tint * (1.0f + 0.25f * t / half); });
}

glm::vec3 varied(Random& random, const glm::vec3& tint, float amount) {
    const float light = 1.0f + amount * random.between(-1.0f, 1.0f), warm = amount * random.between(-0.5f, 0.9f);
    return tint * light * glm::vec3(1.0f + warm, 1.0f, 1.0f - 0.5f * warm);
}

}  // namespace

float meanAlpha(const Image& image) {
    double sum = 0.0;
    for (std::size_t i = 3; i < image.rgba8.size(); i += 4) sum += image.rgba8[i];
    return static_cast<float>(sum / 255.0 / (static_cast<double>(image.width) * image.height));
}

Image paintBroadLeaves(std::uint32_t size) {
    const glm::vec3 green(0.30f, 0.43f, 0.15f), bark(0.33f, 0.27f, 0.16f);
    Card card(size, green);
    Random random(401);
    const auto twig = [&](glm::vec2 from, glm::vec2 to, int pairs, float length) {
        stalk(card, from, to, 0.014f, bark);
        const glm::vec2 along = glm::normalize(to - from), across(-along.y, along.x);
        for (int i = 0; i < pairs; ++i) {
            const float t = (static_cast<float>(i) + 0.6f) / static_cast<float>(pairs);
            const glm::vec2 root = from + t * (to - from);
            for (const float side : {-1.0f, 1.0f}) {
                const glm::vec2 out = along * random.between(0.35f, 0.9f) + side * across;
                leaf(card, root, out, length * random.between(0.8f, 1.15f), random.between(0.42f, 0.52f),
                     varied(random, green * (0.75f + 0.35f * t), 0.16f));
            }
        }
        leaf(card, to, along, length, 0.45f, varied(random, green * 1.15f, 0.12f));
    };
    twig({0.47f, 0.28f}, {0.20f, 0.60f}, 3, 0.19f);
    twig({0.52f, 0.30f}, {0.80f, 0.58f}, 3, 0.19f);
    twig({0.50f, 0.02f}, {0.51f, 0.78f}, 5, 0.21f);
    return card.take();
}

Image paintIvy(std::uint32_t size) {
    const glm::vec3 green(0.20f, 0.35f, 0.13f), stem(0.30f, 0.22f, 0.13f);
    Card card(size, green);
    Random random(409);
    glm::vec2 at(0.5f, 0.02f);
    for (int i = 0; i < 8; ++i) {
        const glm::vec2 next = at + glm::vec2(0.09f * std::sin(1.9f * static_cast<float>(i)), 0.105f);
        stalk(card, at, next, 0.013f, stem);
        at = next;
    }
    for (int i = 0; i < 30; ++i) {
        const float up = (static_cast<float>(i) + 0.5f) / 30.0f, spread = 0.33f * std::sin(kPi * (0.12f + 0.8f * up));
        const glm::vec2 root(0.5f + spread * random.between(-1.0f, 1.0f), 0.03f + 0.78f * up);
        const glm::vec2 along(1.6f * (root.x - 0.5f) + random.between(-0.35f, 0.35f),
                              random.between(0.1f, 0.8f) - 0.25f);
        lobedLeaf(card, root, along, random.between(0.19f, 0.27f),
                  varied(random, green * (0.72f + 0.5f * random.unit()), 0.14f));
    }
    return card.take();
}

Image paintBlossom(std::uint32_t size) {
    const glm::vec3 pink(0.80f, 0.16f, 0.42f), green(0.27f, 0.40f, 0.16f);
    Card card(size, 0.8f * pink);
    Random random(419);
    for (int i = 0; i < 9; ++i) {
        const float angle = 0.7f * static_cast<float>(i);
        const glm::vec2 root(0.5f + 0.16f * std::cos(angle), 0.48f + 0.16f * std::sin(angle));
        leaf(card, root, {std::cos(angle), std::sin(angle)}, 0.26f, 0.5f, varied(random, green, 0.15f));
    }
    for (int i = 0; i < 20; ++i) {
        const float angle = 2.39996f * static_cast<float>(i), away = 0.36f * std::sqrt(static_cast<float>(i) / 20.0f);
        const glm::vec2 centre(0.5f + away * std::cos(angle), 0.5f + away * std::sin(angle));
        const float turn = 6.28f * random.unit();
        const glm::vec3 tint = varied(random, pink, 0.14f);
        for (int petal = 0; petal < 3; ++petal) {
            const float a = turn + 2.0944f * static_cast<float>(petal);
            leaf(card, centre, {std::cos(a), std::sin(a)}, random.between(0.10f, 0.125f), 0.72f,
                 tint * (0.9f + 0.1f * static_cast<float>(petal)));
        }
        card.stamp(
            centre, {1, 0}, 0.014f, [](float s, float t) { return 0.7f - std::sqrt(s * s + t * t); },
            [](float, float) { return glm::vec3(0.95f, 0.9f, 0.62f); });
    }
    return card.take();
}

Image paintFrond(std::uint32_t size) {
    const glm::vec3 green(0.28f, 0.44f, 0.17f);
    Card card(size, green);
    Random random(431);
    stalk(card, {0.5f, 0.0f}, {0.5f, 0.97f}, 0.03f, glm::vec3(0.38f, 0.46f, 0.2f));
    constexpr int kPinnae = 17;
    for (int i = 0; i < kPinnae; ++i) {
        const float t = static_cast<float>(i) / kPinnae, y = 0.07f + 0.85f * t;
        const float length = 0.47f * std::pow(std::sin(kPi * (0.2f + 0.76f * t)), 0.7f);
        for (const float side : {-1.0f, 1.0f})
            leaf(card, {0.5f, y}, {side, 0.5f + 0.5f * t}, length, 0.12f + 0.05f * t,
                 varied(random, green * (0.85f + 0.3f * t), 0.1f));
    }
    return card.take();
}

Image paintStarCutouts(std::uint32_t size, const glm::vec3& tint) {
    Image image;
    image.width = image.height = size;
    constexpr int kAcross = 4;
    for (std::uint32_t y = 0; y < size; ++y) {
        for (std::uint32_t x = 0; x < size; ++x) {
            const float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(size) * kAcross;
            const float v = (static_cast<float>(y) + 0.5f) / static_cast<float>(size) * kAcross;
            const float shift = (static_cast<int>(v) & 1) != 0 ? 0.5f : 0.0f;
            const float px = u + shift - std::floor(u + shift) - 0.5f, py = v - std::floor(v) - 0.5f;
            // An eight-pointed star: two squares, one turned by 45 degrees.
            const float square = std::max(std::abs(px), std::abs(py));
            const float turned = 0.70710678f * (std::abs(px) + std::abs(py));
            const float star = 0.235f - std::min(square, turned);
            // Small round holes between the stars.
            const float qx = 0.5f - std::abs(px), qy = 0.5f - std::abs(py);
            const float hole = std::max(0.05f - std::sqrt(qx * qx + py * py), 0.03f - std::sqrt(px * px + qy * qy));
            const float texel = static_cast<float>(kAcross) / static_cast<float>(size);
            const float open = smooth(-0.75f * texel, 0.75f * texel, std::max(star, hole));
            const float hammered = 0.9f + 0.1f * hashUnit(x / 6, y / 6, 7);
            for (int c = 0; c < 3; ++c)
                image.rgba8.push_back(static_cast<std::uint8_t>(std::clamp(tint[c] * hammered, 0.0f, 1.0f) * 255.0f));
            image.rgba8.push_back(static_cast<std::uint8_t>(255.0f * (1.0f - open) + 0.5f));
        }
    }
    return image;
}

Image paintPaperGlow(std::uint32_t size) {
    Image image;
    image.width = 4;
    image.height = size;
    for (std::uint32_t y = 0; y < size; ++y) {
        const float v = (static_cast<float>(y) + 0.5f) / static_cast<float>(size);
        const float glow = std::exp(-6.0f * (v - 0.55f) * (v - 0.55f)), hoop = std::abs(std::sin(9.0f * kPi * v));
        const float value = (0.45f + 0.55f * glow) * (0.72f + 0.28f * std::pow(hoop, 0.35f));
        for (int x = 0; x < 4; ++x)
            for (int c = 0; c < 4; ++c)
                image.rgba8.push_back(c == 3 ? std::uint8_t{255} : static_cast<std::uint8_t>(255.0f * value));
    }
    return image;
}

}  // namespace gnomon::renderer
