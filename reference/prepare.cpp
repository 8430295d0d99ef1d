// See prepare.h.
#include "reference/prepare.h"

#include "reference/convex.h"

namespace gnomon::reference {
namespace {

/// Room for the float arithmetic of phase 1, in metres.
double marginOf(const LightModel& light, const CameraModel& camera) {
    return 1e-5 * (1.0 + light.rangeMetres + length(light.position - camera.eye) + sumOfMagnitudes(camera.eye));
}

/// Room for the cosine of a cone in floats, which cannot tell angles nearer than this apart: metres of depth.
double coneMarginOf(const LightModel& light) {
    if (light.type != LightType::Spot) return 0.0;
    return light.rangeMetres * (1e-5 + 1e-6 / std::max(std::sin(light.outerAngle), 1e-3));
}

/// Smallest view depth in the light's volume; of the ball alone, or cut with the cone of a spot.
double nearestViewDepth(const LightModel& light, const CameraModel& camera, bool exact) {
    const double centre = viewDepth(camera, light.position);
    if (!exact || light.type != LightType::Spot) return centre - light.rangeMetres;
    // Toward the camera, the sector reaches farthest with its cap if the cone holds that direction, else with the rim
    // of the cap nearest to that direction, or its apex.
    const double cosine = dot(light.direction, -camera.forward);
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
    if (angle <= light.outerAngle) return centre - light.rangeMetres;
    return centre - std::max(0.0, light.rangeMetres * std::cos(angle - light.outerAngle));
}

/// Then phase 1, whatever its roundings, must see a tie.
bool sameVolume(const LightModel& a, const LightModel& b) {
    return a.type == b.type && length(a.position - b.position) == 0 && length(a.direction - b.direction) == 0 &&
           a.rangeMetres == b.rangeMetres && a.outerAngle == b.outerAngle;
}

/// Number of places where the order contradicts one key.
std::size_t outOfOrder(const std::vector<LightModel>& lights, const CameraModel& camera, bool exact, bool clamped) {
    std::size_t errors = 0;
    for (std::size_t i = 1; i < lights.size(); ++i) {
        if (lights[i - 1].type == LightType::Directional) continue;
        double before = nearestViewDepth(lights[i - 1], camera, exact);
        double after = nearestViewDepth(lights[i], camera, exact);
        if (clamped) {
            before = std::max(before, camera.nearMetres);
            after = std::max(after, camera.nearMetres);
        }
        const double tolerance = marginOf(lights[i - 1], camera) + marginOf(lights[i], camera) +
                                 coneMarginOf(lights[i - 1]) + coneMarginOf(lights[i]);
        if (before > after + tolerance) ++errors;
        if (sameVolume(lights[i - 1], lights[i]) && lights[i - 1].hostIndex > lights[i].hostIndex) ++errors;
    }
    return errors;
}

double binStart(double nearMetres, double binsPerMetre, std::uint32_t bin) {
    return nearMetres + bin / binsPerMetre;
}

Verdict meetsBins(const LightModel& light, const CameraModel& camera, double from, double to) {
    const double nearMetres = std::max(from, camera.nearMetres);
    const double farMetres = std::min(to, camera.farMetres);
    if (!(nearMetres < farMetres)) return Verdict::Never;
    return meets(light, viewPiece(camera, 0, 0, camera.widthPx, camera.heightPx, nearMetres, farMetres),
                 marginOf(light, camera));
}

/// First and last bin that the light must be in: its depths inside the view form one interval (its volume and the view
/// are convex), so both ends are found by bisection on "does it reach at or before / at or beyond bin b".
struct BinRange {
    int first = 1, last = 0;
};
BinRange requiredBins(const LightModel& light, const CameraModel& camera, double nearMetres, double binsPerMetre) {
    const int count = static_cast<int>(gpu::kZBinCount);
    const auto reaches = [&](int fromBin, int toBin) {
        const double from = binStart(nearMetres, binsPerMetre, fromBin);
        const double to = binStart(nearMetres, binsPerMetre, toBin + 1);
        return meetsBins(light, camera, from, to) == Verdict::Must;
    };
    if (!reaches(0, count - 1)) return {};
    int low = 0, high = count - 1;
    while (low < high) {  // smallest b with "reaches [0, b]"
        const int middle = (low + high) / 2;
        if (reaches(0, middle))
            high = middle;
        else
            low = middle + 1;
    }
    BinRange range;
    range.first = low;
    high = count - 1;
    while (low < high) {  // largest b with "reaches [b, last]"
        const int middle = (low + high + 1) / 2;
        if (reaches(middle, count - 1))
            low = middle;
        else
            high = middle - 1;
    }
    range.last = low;
    return range;
}

void checkRangedZBins(Findings& findings, std::span<const std::uint32_t> words) {
    for (std::uint32_t bin = 0; bin < gpu::kZBinCount; ++bin) {
        std::uint32_t lowest = 0xFFFFu, highest = 0;
        for (std::uint32_t b = bin; b < gpu::kZBinCount; ++b) lowest = std::min(lowest, gpu::zBinMin(words[b]));
        for (std::uint32_t b = 0; b <= bin; ++b) highest = std::max(highest, gpu::zBinMax(words[b]));
        const std::uint32_t ranged = words[gpu::kZBinCount + bin];
        if (gpu::zBinMin(ranged) != lowest || gpu::zBinMax(ranged) != highest)
            findings.add("ranged zBin %u is [%u, %u] instead of [%u, %u]", bin, gpu::zBinMin(ranged),
                         gpu::zBinMax(ranged), lowest, highest);
    }
}

std::uint32_t directionalCount(const std::vector<LightModel>& lights) {
    std::uint32_t count = 0;
    for (const LightModel& light : lights) count += light.type == LightType::Directional;
    return count;
}

void checkStrayBits(Findings& findings, std::span<const std::uint32_t> entry, std::size_t tile, std::uint32_t first,
                    std::uint32_t end) {
    for (std::uint32_t i = 0; i < gpu::kMaxLightsPerView; ++i)
        if ((i < first || i >= end) && maskHas(entry, i))
            findings.add("mask tile %zu has bit %u, but ranged lights are %u to %u", tile, i, first, end);
    for (std::uint32_t group = 0; group < gpu::kLightGroupCount; ++group)
        if (((entry[0] >> group) & 1u) != 0 && entry[1 + group] == 0)
            findings.add("mask tile %zu has the bit of empty light group %u", tile, group);
}

}  // namespace

Verdict isVisible(const LightModel& light, const CameraModel& camera) {
    if (light.mask == 0) return Verdict::Never;
    if (light.type == LightType::Directional) return Verdict::Must;
    if (light.lightFade <= 0.0 || light.rangeMetres <= 0.0) return Verdict::Never;
    const Verdict verdict = meets(light, viewFrustum(camera), marginOf(light, camera));
    return light.lightFade < 1e-4 ? both(verdict, Verdict::May) : verdict;
}

VisibleReport checkVisibleLights(const std::vector<LightModel>& all, const std::vector<LightModel>& ordered,
                                 const CameraModel& camera) {
    VisibleReport report;
    std::vector<bool> listed(all.size(), false);
    for (const LightModel& light : ordered)
        if (light.hostIndex < all.size()) listed[light.hostIndex] = true;
    const bool full = ordered.size() == gpu::kMaxLightsPerView;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Verdict verdict = isVisible(all[i], camera);
        report.must += verdict == Verdict::Must;
        report.may += verdict == Verdict::May;
        if (verdict == Verdict::Must && !listed[i] && !full)
            report.findings.add("visible host light %zu is missing", i);
        if (verdict == Verdict::Never && listed[i]) {
            ++report.surplus;
            if (all[i].lightFade <= 0.0) report.findings.add("host light %zu has faded away but is in the list", i);
        }
    }
    for (std::size_t i = 1; i < ordered.size(); ++i)
        if (ordered[i].type == LightType::Directional && ordered[i - 1].type != LightType::Directional)
            report.findings.add("directional light at index %zu after a ranged one", i);
    std::size_t best = ordered.size();
    for (const bool exact : {false, true})
        for (const bool clamped : {false, true}) best = std::min(best, outOfOrder(ordered, camera, exact, clamped));
    if (best > 0 && ordered.size() > 1)
        report.findings.add("no sort key explains the order: %zu places out of order", best);
    return report;
}

CoverReport checkZBins(const std::vector<LightModel>& lights, const CameraModel& camera,
                       std::span<const std::uint32_t> words, double nearMetres, double binsPerMetre) {
    CoverReport report;
    if (words.size() < gpu::kZBinWords) {
        report.findings.add("%zu zBin words instead of %u", words.size(), gpu::kZBinWords);
        return report;
    }
    const std::uint32_t firstRanged = directionalCount(lights);
    for (std::uint32_t bin = 0; bin < gpu::kZBinCount; ++bin) {
        const std::uint32_t lowest = gpu::zBinMin(words[bin]), highest = gpu::zBinMax(words[bin]);
        if (words[bin] == gpu::kZBinEmpty) continue;
        if (lowest > highest || lowest < firstRanged || highest >= lights.size())
            report.findings.add("zBin %u is [%u, %u] with %zu lights", bin, lowest, highest, lights.size());
        else
            report.marked += highest - lowest + 1;
    }
    for (std::uint32_t i = firstRanged; i < lights.size(); ++i) {
        const BinRange range = requiredBins(lights[i], camera, nearMetres, binsPerMetre);
        for (int bin = range.first; bin <= range.last; ++bin) {
            ++report.required;
            if (gpu::zBinMin(words[bin]) > i || gpu::zBinMax(words[bin]) < i)
                report.findings.add("light %u is missing in zBin %d [%u, %u]", i, bin, gpu::zBinMin(words[bin]),
                                    gpu::zBinMax(words[bin]));
        }
    }
    report.surplus = report.marked > report.required ? report.marked - report.required : 0;
    checkRangedZBins(report.findings, words);
    return report;
}

IndexRange candidatesInDepthRange(std::span<const std::uint32_t> zBinWords, double nearMetres, double binsPerMetre,
                                  double minDepthMetres, double maxDepthMetres) {
    const auto binOf = [&](double depth) {
        const double bin = std::floor((depth - nearMetres) * binsPerMetre);
        return static_cast<std::uint32_t>(std::clamp(bin, 0.0, gpu::kZBinCount - 1.0));
    };
    const std::uint32_t first = binOf(minDepthMetres), last = binOf(maxDepthMetres);
    std::uint32_t lowest = 0, highest = 0;
    if (last - first <= 1) {
        lowest = std::min(gpu::zBinMin(zBinWords[first]), gpu::zBinMin(zBinWords[last]));
        highest = std::max(gpu::zBinMax(zBinWords[first]), gpu::zBinMax(zBinWords[last]));
    } else {
        lowest = gpu::zBinMin(zBinWords[gpu::kZBinCount + first]);
        highest = gpu::zBinMax(zBinWords[gpu::kZBinCount + last]);
    }
    return {lowest, highest};
}

CoverReport checkTileLightMasks(const std::vector<LightModel>& lights, const CameraModel& camera,
                                std::span<const std::uint32_t> words, std::uint32_t tilesX, std::uint32_t tilesY) {
    CoverReport report;
    const double size = gpu::kMaskTileSizePx;
    if (tilesX * size < camera.widthPx || tilesY * size < camera.heightPx)
        report.findings.add("%u x %u mask tiles do not cover the view", tilesX, tilesY);
    if (words.size() < std::size_t(tilesX) * tilesY * gpu::kLightMaskEntryWords) {
        report.findings.add("%zu words are too few for %u x %u mask tiles", words.size(), tilesX, tilesY);
        return report;
    }
    const std::uint32_t firstRanged = directionalCount(lights);
    for (std::uint32_t y = 0; y < tilesY; ++y) {
        for (std::uint32_t x = 0; x < tilesX; ++x) {
            const std::size_t tile = std::size_t(y) * tilesX + x;
            const auto entry = words.subspan(tile * gpu::kLightMaskEntryWords, gpu::kLightMaskEntryWords);
            const Polyhedron piece =
                viewPiece(camera, x * size, y * size, std::min<double>((x + 1) * size, camera.widthPx),
                          std::min<double>((y + 1) * size, camera.heightPx), camera.nearMetres, camera.farMetres);
            checkStrayBits(report.findings, entry, tile, firstRanged, static_cast<std::uint32_t>(lights.size()));
            for (std::uint32_t i = firstRanged; i < lights.size(); ++i) {
                const Verdict verdict = meets(lights[i], piece, marginOf(lights[i], camera));
                const bool marked = maskHas(entry, i);
                report.required += verdict == Verdict::Must;
                report.marked += marked;
                report.surplus += marked && verdict == Verdict::Never;
                if (verdict == Verdict::Must && !marked)
                    report.findings.add("light %u is missing in mask tile (%u, %u)", i, x, y);
            }
        }
    }
    return report;
}

bool maskHas(std::span<const std::uint32_t> entry, std::uint32_t lightIndex) {
    const std::uint32_t group = lightIndex / gpu::kLightGroupSize;
    if (((entry[0] >> group) & 1u) == 0) return false;
    return ((entry[1 + group] >> (lightIndex % gpu::kLightGroupSize)) & 1u) != 0;
}

}  // namespace gnomon::reference
