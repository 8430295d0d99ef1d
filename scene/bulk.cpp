#include "scene/bulk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scene/triangle_distance.h"

namespace gnomon::renderer {
namespace {

constexpr double kGap = 4.0;  // reaches of empty space that part the bulk from what is far
// Reaches. A floor below a ball may be 40 times as long as the ball is high, and still belongs to it.
constexpr double kLong = 64.0;
// The size of what is below a sky, to the sky's: a ball just around a square is 1.7 times as large as the square.
constexpr double kSmallerThanSky = 0.6;
// The size of what stands on a plate, to the plate's: what is larger may be a building of its own.
constexpr double kSmallerThanPlate = 0.25;
constexpr double kFlat = 0.125;          // least side to diagonal: hills may be so high
constexpr double kHollow = 0.25;         // nearest to farthest point of what is around all else, with a gap
constexpr double kRound = 0.7;           // without a gap: a cube has 0.58
constexpr double kMostOfMedian = 256.0;  // areas; 16 times as long
constexpr double kLeastParts = 6.0;      // of all weight, to one triangle
constexpr std::size_t kMostSamples = 1u << 12;
constexpr std::size_t kMostLookedAt = 16;  // things, the largest

struct Middle {
    glm::dvec3 at{0.0};
    double reach = 0.0;
};

double diagonal(const Bounds& box) {
    return glm::length(glm::dvec3(box.max) - glm::dvec3(box.min));
}

double nearest(const Bounds& box, const glm::dvec3& p) {
    return glm::length(glm::max(glm::max(glm::dvec3(box.min) - p, p - glm::dvec3(box.max)), glm::dvec3(0.0)));
}

double farthest(const Bounds& box, const glm::dvec3& p) {
    return glm::length(glm::max(glm::dvec3(box.max) - p, p - glm::dvec3(box.min)));
}

double nearest(const WorldTriangle& t, const glm::dvec3& p) {
    return distanceToTriangle(t[0] - p, t[1] - p, t[2] - p);
}

double farthest(const WorldTriangle& t, const glm::dvec3& p) {
    return std::max({glm::length(t[0] - p), glm::length(t[1] - p), glm::length(t[2] - p)});
}

double longestEdge(const WorldTriangle& t) {
    return std::max({glm::length(t[1] - t[0]), glm::length(t[2] - t[1]), glm::length(t[0] - t[2])});
}

bool joins(const WorldTriangle& t, const Middle& m) {
    return longestEdge(t) <= kLong * m.reach && nearest(t, m.at) <= kGap * m.reach;
}

bool joins(const Bounds& box, const Middle& m) {
    return diagonal(box) <= kLong * m.reach && nearest(box, m.at) <= kGap * m.reach;
}

struct Sample {
    glm::dvec3 centre{0.0};
    double radius = 0.0, weight = 0.0;
};

Sample sampleOf(const Thing& thing, std::size_t triangle) {
    if (thing.positions == nullptr)
        return {0.5 * (glm::dvec3(thing.box.min) + glm::dvec3(thing.box.max)), 0.5 * diagonal(thing.box), 0.0};
    const WorldTriangle t = triangleOf(thing, triangle);
    const glm::dvec3 centre = (t[0] + t[1] + t[2]) / 3.0;
    return {centre, farthest(t, centre), 0.5 * glm::length(glm::cross(t[1] - t[0], t[2] - t[0]))};
}

// Of values with weights: with as much below it as above.
double weightedMedian(std::vector<std::pair<double, double>> values) {
    std::ranges::sort(values);
    double half = 0.0;
    for (const auto& [value, weight] : values) half += 0.5 * weight;
    for (const auto& [value, weight] : values)
        if ((half -= weight) < 0.0) return value;
    return values.back().first;
}

// The most that one of these may have so that it has at most one of `parts` parts of all.
double mostOfOne(std::vector<double> areas, double parts) {
    std::ranges::sort(areas, std::greater<>());
    double rest = 0.0;
    for (const double area : areas) rest += area;
    for (const double area : areas) {
        if (parts <= 1.0 || area <= rest / parts) break;
        rest -= area;
        parts -= 1.0;
    }
    return rest / std::max(parts, 1.0);
}

// What has no area counts only where there is nothing else.
void weigh(std::vector<Sample>& samples) {
    std::vector<double> areas;
    for (const Sample& s : samples)
        if (s.weight > 0.0) areas.push_back(s.weight);
    if (areas.empty()) {
        for (Sample& s : samples) s.weight = 1.0;
        return;
    }
    const auto middle = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
    std::ranges::nth_element(areas, middle);
    const double ofMedian = kMostOfMedian * *middle;
    for (double& area : areas) area = std::min(area, ofMedian);
    const double most = mostOfOne(areas, std::min(kLeastParts, 0.5 * static_cast<double>(areas.size())));
    for (Sample& s : samples) s.weight = std::min({s.weight, ofMedian, most});
}

// Evenly over the triangles.
std::vector<Sample> samplesOf(const std::vector<const Thing*>& things) {
    std::size_t triangles = 0;
    for (const Thing* thing : things) triangles += thing->triangles;
    const std::size_t stride = triangles / kMostSamples + 1;
    std::vector<Sample> samples;
    std::size_t next = 0;  // counted from the first triangle of the thing
    for (const Thing* thing : things) {
        for (; next < thing->triangles; next += stride) samples.push_back(sampleOf(*thing, next));
        next -= thing->triangles;
    }
    weigh(samples);
    return samples;
}

Middle medianOf(const std::vector<const Thing*>& things) {
    const std::vector<Sample> samples = samplesOf(things);
    Middle m;
    if (samples.empty()) return m;
    const auto median = [&](auto&& valueOf) {
        std::vector<std::pair<double, double>> values;
        values.reserve(samples.size());
        for (const Sample& s : samples) values.emplace_back(valueOf(s), s.weight);
        return weightedMedian(std::move(values));
    };
    for (int axis = 0; axis < 3; ++axis) m.at[axis] = median([&](const Sample& s) { return s.centre[axis]; });
    m.reach = median([&](const Sample& s) { return glm::length(s.centre - m.at) + s.radius; });
    return m;
}

// How far the middle reaches with what joins of the thing.
double reachWith(const Thing& thing, const Middle& m) {
    const double most = farthest(thing.box, m.at);
    if (most <= m.reach || nearest(thing.box, m.at) > kGap * m.reach) return m.reach;
    if (thing.positions == nullptr) return joins(thing.box, m) ? most : m.reach;
    double reach = m.reach;
    for (std::size_t i = 0; i < thing.triangles; ++i) {
        const WorldTriangle t = triangleOf(thing, i);
        const double far = farthest(t, m.at);
        if (far > reach && joins(t, m)) reach = far;
    }
    return reach;
}

Middle grown(const std::vector<const Thing*>& things, Middle m) {
    for (double before = -1.0; m.reach > before;) {
        before = m.reach;
        double reach = m.reach;
        for (const Thing* thing : things) reach = std::max(reach, reachWith(*thing, m));
        m.reach = reach;
    }
    return m;
}

bool isSky(const Thing& thing, const Middle& m) {
    if (nearest(thing.box, m.at) > m.reach || thing.positions == nullptr) return false;
    double least = farthest(thing.box, m.at), most = 0.0;
    for (std::size_t i = 0; i < thing.triangles; ++i) {
        const WorldTriangle t = triangleOf(thing, i);
        least = std::min(least, nearest(t, m.at));
        most = std::max(most, farthest(t, m.at));
        if (!(least > m.reach)) return false;
    }
    return least >= (least > kGap * m.reach ? kHollow : kRound) * most;
}

bool isPlate(const Thing& thing, const Middle& m) {
    const glm::dvec3 size = glm::dvec3(thing.box.max) - glm::dvec3(thing.box.min);
    return diagonal(thing.box) > kLong * m.reach && std::min({size.x, size.y, size.z}) <= kFlat * diagonal(thing.box);
}

// Judged by the things smaller than `ofItsSize` times the thing, if they are at least half of all.
template <class Fits>
bool isAround(const Thing& thing, const std::vector<const Thing*>& things, double ofItsSize, Fits fits) {
    std::vector<const Thing*> smaller;
    std::size_t triangles = 0;
    for (const Thing* other : things) {
        if (!(diagonal(other->box) < ofItsSize * diagonal(thing.box))) continue;
        smaller.push_back(other);
        triangles += other->triangles;
    }
    if (smaller.empty() || 2 * smaller.size() < things.size()) return false;
    const Middle m = medianOf(smaller);
    return fits(m, triangles) && fits(grown(smaller, m), triangles);
}

// `things` with the largest first.
void dropWhatIsAround(std::vector<const Thing*>& things) {
    for (std::size_t i = 0, looked = 0; i < things.size() && looked < kMostLookedAt; ++looked) {
        const Thing& thing = *things[i];
        const auto sky = [&](const Middle& m, std::size_t) { return isSky(thing, m); };
        const auto plate = [&](const Middle& m, std::size_t triangles) {
            return thing.triangles <= triangles && isPlate(thing, m);
        };
        if (isAround(thing, things, kSmallerThanSky, sky) || isAround(thing, things, kSmallerThanPlate, plate))
            things.erase(things.begin() + static_cast<std::ptrdiff_t>(i));
        else
            ++i;
    }
}

}  // namespace

Bulk::Bulk(std::span<const Thing> have, std::span<const Thing> more) {
    std::vector<const Thing*> things;
    for (const Thing& thing : have) things.push_back(&thing);
    std::ranges::stable_sort(things, std::greater<>(), [](const Thing* thing) { return diagonal(thing->box); });
    for (const Thing& thing : have) leftOutThings_.emplace(thing.instance, thing.primitive);
    dropWhatIsAround(things);
    for (const Thing* thing : things) leftOutThings_.erase({thing->instance, thing->primitive});
    Middle m = medianOf(things);
    for (const Thing& thing : more)
        if (!isLeftOut(thing)) things.push_back(&thing);
    m = grown(things, m);
    middle_ = m.at;
    reach_ = m.reach;
    for (const Thing& thing : have) {
        size_ += thing.triangles;
        std::size_t held = 0;
        if (holdsAllOf(thing) || (thing.positions == nullptr && holdsBoxOf(thing)))
            held = thing.triangles;
        else if (thing.positions != nullptr)
            forEachHeld(thing, [&](const WorldTriangle&) { ++held; });
        leftOut_ += thing.triangles - held;
    }
}

bool Bulk::isLeftOut(const Thing& thing) const {
    return leftOutThings_.contains({thing.instance, thing.primitive});
}

bool Bulk::isBeyond(const Thing& thing) const {
    return nearest(thing.box, middle_) > kGap * reach_;
}

bool Bulk::holdsAllOf(const Thing& thing) const {
    return !isLeftOut(thing) && farthest(thing.box, middle_) <= reach_;
}

bool Bulk::holdsBoxOf(const Thing& thing) const {
    return !isLeftOut(thing) && joins(thing.box, {middle_, reach_});
}

bool Bulk::holds(const Thing& thing, const WorldTriangle& triangle) const {
    return !isLeftOut(thing) && joins(triangle, {middle_, reach_});
}

}  // namespace gnomon::renderer
