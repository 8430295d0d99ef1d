// See find_lights_accurate.h.
#include "reference/find_lights_accurate.h"

namespace gnomon::reference {
namespace {

/// Metres by which float arithmetic on this pair's coordinates may be off.
double pairError(const LightModel& light, const Pixel& pixel) {
    return pixel.positionError +
           4 * kFloatRoundoff * (sumOfMagnitudes(light.position) + sumOfMagnitudes(pixel.position));
}

/// A ball around the tile's pixels that are not background; radius below zero if there are none.
struct Ball {
    Vec3 centre;
    double radius = -1;
};
Ball boundingBall(const PixelGrid& grid, const std::vector<PixelGrid::Coordinates>& pixels) {
    Ball ball;
    for (const auto [x, y] : pixels) {
        const Pixel& pixel = grid.at(x, y);
        if (pixel.background) continue;
        if (ball.radius < 0) ball = {pixel.position, 0};
        ball.radius = std::max(ball.radius, length(pixel.position - ball.centre) + pixel.positionError);
    }
    return ball;
}

bool outOfReach(const LightModel& light, const Ball& ball) {
    if (ball.radius < 0) return true;
    if (light.type == LightType::Directional) return false;
    return length(light.position - ball.centre) > ball.radius + light.rangeMetres * 1.001 + 1e-3;
}

}  // namespace

Verdict inInfluence(const LightModel& light, const Pixel& pixel) {
    if (pixel.background || (light.mask & pixel.receiverMask) == 0) return Verdict::Never;
    if (light.type == LightType::Directional) return Verdict::Must;
    const double error = pairError(light, pixel);
    const Vec3 fromLight = pixel.position - light.position;
    const double distance = length(fromLight);
    const Verdict inRange =
        atLeastZero(light.rangeMetres - distance, error + 8 * kFloatRoundoff * (light.rangeMetres + distance));
    if (light.type == LightType::Point || inRange == Verdict::Never) return inRange;
    // Inside the cone: the angle to the axis is at most the outer angle, i.e. axis . v >= cos(outer) |v|.
    const double inside = dot(light.direction, fromLight) - std::cos(light.outerAngle) * distance;
    return both(inRange, atLeastZero(inside, 2 * error + 8 * kFloatRoundoff * distance));
}

Verdict facesLight(const LightModel& light, const Pixel& pixel) {
    if (!pixel.hasFaceNormal) return Verdict::May;
    constexpr double kNormalError = 8 * kFloatRoundoff;
    if (light.type == LightType::Directional) return atLeastZero(dot(pixel.faceNormal, -light.direction), kNormalError);
    const Vec3 toLight = light.position - pixel.position;
    return atLeastZero(dot(pixel.faceNormal, toLight), 2 * pairError(light, pixel) + kNormalError * length(toLight));
}

Verdict reaches(const LightModel& light, const Pixel& pixel, bool dropFacedAway) {
    const Verdict influence = inInfluence(light, pixel);
    // Where a shadow fades, a face that looks away still gets some light.
    const bool maySkip = dropFacedAway && light.casts && !light.shadowFades && !pixel.subsurface;
    if (influence == Verdict::Never || !maySkip) return influence;
    return both(influence, facesLight(light, pixel));
}

std::vector<TileLights> findLights(const PixelGrid& grid, const std::vector<LightModel>& lights, bool dropFacedAway) {
    std::vector<TileLights> result;
    for (std::uint32_t tileY = 0; tileY < grid.tilesY; ++tileY) {
        for (std::uint32_t tileX = 0; tileX < grid.tilesX; ++tileX) {
            const auto pixels = grid.tilePixels(tileX, tileY);
            const Ball ball = boundingBall(grid, pixels);
            TileLights tile;
            for (std::uint32_t i = 0; i < lights.size(); ++i) {
                if (outOfReach(lights[i], ball)) continue;
                Verdict verdict = Verdict::Never;
                for (const auto [x, y] : pixels) {
                    verdict = either(verdict, reaches(lights[i], grid.at(x, y), dropFacedAway));
                    if (verdict == Verdict::Must) break;
                }
                if (verdict == Verdict::Must) tile.must.push_back(i);
                if (verdict == Verdict::May) tile.may.push_back(i);
            }
            result.push_back(std::move(tile));
        }
    }
    return result;
}

EarlyListReport checkEarlyLists(const std::vector<TileLights>& expected, const std::vector<LightModel>& lights,
                                const ListBuffers& buffers) {
    EarlyListReport report;
    for (std::size_t tile = 0; tile < expected.size(); ++tile) {
        const TileLights& wanted = expected[tile];
        report.must += wanted.must.size();
        report.may += wanted.may.size();
        if (hasNoListSpace(buffers, tile)) {
            ++report.tilesWithoutSpace;
            continue;
        }
        const std::vector<std::uint32_t> listed = earlyLights(buffers, tile);
        report.listed += listed.size();
        const bool byPixel = buffers.lightLists == gpu::kListsByPixel;
        if (!byPixel && listed.size() != buffers.approximateCounts[tile])
            report.findings.add("tile %zu lists %zu lights instead of the %u that phase 2 counts", tile, listed.size(),
                                buffers.approximateCounts[tile]);
        std::size_t casting = 0;
        for (const std::uint32_t i : listed) {
            casting += i < lights.size() && lights[i].casts;
            if (byPixel && !std::binary_search(wanted.must.begin(), wanted.must.end(), i) &&
                !std::binary_search(wanted.may.begin(), wanted.may.end(), i))
                report.findings.add("tile %zu lists light %u, which reaches none of its pixels", tile, i);
        }
        for (const std::uint32_t i : wanted.must)
            if (std::find(listed.begin(), listed.end(), i) == listed.end())
                report.findings.add("tile %zu has lost light %u", tile, i);
        const std::uint32_t told = buffers.earlyCounts[tile] >> gpu::kEarlyCastingShift;
        if (told != casting)
            report.findings.add("tile %zu counts %u casting lights instead of %zu", tile, told, casting);
    }
    return report;
}

}  // namespace gnomon::reference
