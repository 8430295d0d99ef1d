// See receiver_plane.h.
#include "reference/receiver_plane.h"

namespace gnomon::reference {
namespace {

constexpr double kMaxPositionErrorPx = 2.0;
constexpr double kNearestOfNear = 1e-3;
constexpr double kNormalError = 8 * kFloatRoundoff;

Interval3 normalOf(const Pixel& pixel) {
    const Vec3 n = pixel.faceNormal;
    return {within(n.x, kNormalError), within(n.y, kNormalError), within(n.z, kNormalError)};
}

/// Device depth of the pixel itself, moved toward the light by the bias; the slack not yet.
Interval biasedDepth(const ShadowViewModel& view, Interval linearDepth, Interval biasMetres) {
    const Interval a = rounded(view.depth.a), b = rounded(view.depth.b);
    const Interval nearer = linearDepth - biasMetres;
    if (view.orthographic) return a + b * nearer;
    return a + b / max(nearer, kNearestOfNear * abs(b));
}

Interval limitedBias(const ShadowViewModel& view, Interval linearDepth, const Bias& bias) {
    if (bias.none) return 0.0;
    const Interval reach = view.orthographic ? Interval(1.0) : max(linearDepth, 0.0);
    const Interval most = rounded(view.mostBias) * reach, least = rounded(view.leastBias) * reach;
    return max(min(max(rounded(bias.metres), least), most), rounded(bias.leastMetres));
}

/// k raised to the least tilt, its sign kept: one interval, or two where the sign is open.
std::vector<Interval> tilted(Interval k, Interval least) {
    std::vector<Interval> result;
    if (k.hi >= 0) result.push_back(max({std::max(k.lo, 0.0), k.hi}, least));
    if (k.lo <= 0) result.push_back(-max({std::max(-k.hi, 0.0), -k.lo}, least));
    return result;
}

}  // namespace

ReceiverInView receiverIn(const ShadowViewModel& view, const Pixel& pixel, DepthMode mode, const Bias& bias,
                          bool toward) {
    ReceiverInView result;
    const ShadowPosition at = project(view, pixel.position, pixel.positionError);
    if (!view.orthographic) {
        result.mayBeBehind = at.clipW <= at.clipWError;
        if (at.clipW < -at.clipWError) return result;
    }
    result.unknown = at.clipW <= at.clipWError || !(std::max(at.xErrorPx, at.yErrorPx) <= kMaxPositionErrorPx);
    if (result.unknown) return result;

    ReceiverPlane plane;
    plane.xPx = within(at.xPx, at.xErrorPx);
    plane.yPx = within(at.yPx, at.yErrorPx);
    plane.linearDepth = within(at.linearDepth, at.linearDepthError);
    const double scaleX = 0.5 * view.widthPx, scaleY = 0.5 * view.heightPx;
    const Interval ndcX = (plane.xPx - (view.xPx + scaleX)) / scaleX, ndcY = (plane.yPx - (view.yPx + scaleY)) / scaleY;
    if (!view.orthographic) {
        plane.tangentX = ndcX * scaleX / rounded(view.pxPerMetreX);
        plane.tangentY = ndcY * scaleY / rounded(view.pxPerMetreY);
        plane.ray = squareRoot(1.0 + plane.tangentX * plane.tangentX + plane.tangentY * plane.tangentY);
    }

    const double sign = toward ? 1 : -1;
    const Interval biasMetres = limitedBias(view, plane.linearDepth, bias);
    if (mode == DepthMode::Constant) {
        plane.slopeX = plane.slopeY = 0.0;
        plane.depth = biasedDepth(view, plane.linearDepth, sign * biasMetres);
        result.planes.push_back(plane);
        return result;
    }
    const Interval a = rounded(view.depth.a), b = rounded(view.depth.b);
    const Interval3 r0(rowOf(view.clipFromWorld, 0)), r1(rowOf(view.clipFromWorld, 1));
    const Interval3 axis = view.orthographic ? Interval3(rowOf(view.clipFromWorld, 2)) * (Interval(1.0) / b)
                                             : Interval3(rowOf(view.clipFromWorld, 3));
    const Interval3 normal = normalOf(pixel), across = cross(r0, r1);
    const Interval alpha = dot(normal, cross(r1, axis)), beta = dot(normal, cross(axis, r0));
    const Interval gamma = dot(normal, across);
    const Interval k = view.orthographic ? gamma : dot({alpha, beta, gamma}, {ndcX, ndcY, 1.0});
    const Interval area = squareRoot(dot(across, across)), least = kLeastCosine * area * plane.ray;
    for (const Interval tilt : tilted(k, least)) {
        const Interval offPlane = within(pixel.offPlaneMetres, pixel.offPlaneError) * area / abs(tilt);
        const Interval depth = biasedDepth(view, plane.linearDepth, sign * (biasMetres + offPlane));
        const Interval perNdc = view.orthographic ? -(b / tilt) : b / (plane.linearDepth * tilt);
        plane.slopeX = perNdc * alpha / scaleX;
        plane.slopeY = perNdc * beta / scaleY;
        const Interval slack = 1e-6 * (abs(a) + abs(depth - a)) + rounded(view.depthStep) +
                               (abs(plane.slopeX) + abs(plane.slopeY)) * (1.0 / 16);
        plane.depth = depth + slack * (view.reversed ? sign : -sign);
        result.planes.push_back(plane);
    }
    return result;
}

Interval depthOfPlane(const ShadowViewModel& view, const ReceiverPlane& plane, Interval xPx, Interval yPx,
                      bool limited) {
    Interval rise = plane.slopeX * (xPx - plane.xPx) + plane.slopeY * (yPx - plane.yPx);
    if (limited) {
        const Interval most = abs(plane.slopeX) + abs(plane.slopeY);
        rise = view.reversed ? max(rise, -most) : min(rise, most);
    }
    // The same may be summed up from the texel next to it.
    const Interval depth = plane.depth + rise;
    const double error = 2 * kFloatRoundoff * (plane.slopeX.magnitude() + plane.slopeY.magnitude());
    return clamp({depth.lo - error, depth.hi + error}, 0.0, 1.0);
}

Verdict isLit(const ShadowViewModel& view, double stored, Interval depth) {
    if (view.reversed) return stored <= depth.lo ? Verdict::Must : stored > depth.hi ? Verdict::Never : Verdict::May;
    return stored >= depth.hi ? Verdict::Must : stored < depth.lo ? Verdict::Never : Verdict::May;
}

}  // namespace gnomon::reference
