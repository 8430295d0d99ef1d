// See convex.h.
#include "reference/convex.h"

#include <array>

namespace gnomon::reference {
namespace {

Plane planeThrough(Vec3 a, Vec3 b, Vec3 c, Vec3 inside) {
    Plane plane;
    plane.normal = normalize(cross(b - a, c - a));
    plane.offset = -dot(plane.normal, a);
    if (dot(plane.normal, inside) + plane.offset < 0) plane = {-plane.normal, -plane.offset};
    return plane;
}

double signedDistance(const Plane& plane, Vec3 p) {
    return dot(plane.normal, p) + plane.offset;
}

/// Nearest point to p on the common flat of one to three planes; false if they have none (parallel planes).
bool projectOnto(const Plane* const* planes, int count, Vec3 p, Vec3& out) {
    // p - sum(l_i n_i) with (n_i . n_j) l = distances: Gaussian elimination on up to 3x3.
    double a[3][4] = {};
    for (int i = 0; i < count; ++i) {
        for (int j = 0; j < count; ++j) a[i][j] = dot(planes[i]->normal, planes[j]->normal);
        a[i][3] = signedDistance(*planes[i], p);
    }
    for (int column = 0; column < count; ++column) {
        if (a[column][column] < 1e-14) return false;
        for (int row = 0; row < count; ++row) {
            if (row == column) continue;
            const double factor = a[row][column] / a[column][column];
            for (int k = 0; k < 4; ++k) a[row][k] -= factor * a[column][k];
        }
    }
    out = p;
    for (int i = 0; i < count; ++i) out = out - planes[i]->normal * (a[i][3] / a[i][i]);
    return true;
}

double deepestViolation(const Polyhedron& polyhedron, Vec3 p) {
    double worst = -kInfinity;
    for (const Plane& plane : polyhedron) worst = std::max(worst, -signedDistance(plane, p));
    return worst;
}

struct Cone {
    Vec3 apex, axis;
    double cosine = 1, sine = 0;
};

/// Nearest point of the solid cone (half-angle below a right angle).
Vec3 nearestPoint(const Cone& cone, Vec3 p) {
    const Vec3 v = p - cone.apex;
    const double along = dot(v, cone.axis);
    const Vec3 across = v - cone.axis * along;
    const double radius = length(across);
    if (along * cone.sine >= radius * cone.cosine) return p;
    const double onSide = along * cone.cosine + radius * cone.sine;
    if (onSide <= 0) return cone.apex;
    return cone.apex + cone.axis * (onSide * cone.cosine) + across / radius * (onSide * cone.sine);
}

Vec3 nearestPoint(Vec3 centre, double radius, Vec3 p) {
    const Vec3 v = p - centre;
    const double distance = length(v);
    return distance <= radius ? p : centre + v * (radius / distance);
}

Polyhedron shrunken(Polyhedron polyhedron, double margin) {
    for (Plane& plane : polyhedron) plane.offset -= margin;
    return polyhedron;
}

/// Projects onto cone, ball and polyhedron in turn. Returns the largest distance between the last polyhedron point and
/// the other two sets: zero or below if a common point was found.
double gapAfterProjections(const Cone& cone, Vec3 centre, double radius, const Polyhedron& polyhedron) {
    Vec3 p = centre + cone.axis * (0.5 * radius);
    double gap = kInfinity;
    for (int i = 0; i < 200; ++i) {
        const Vec3 previous = p;
        p = nearestPoint(polyhedron, nearestPoint(centre, radius, nearestPoint(cone, p)));
        gap = std::max(length(p - nearestPoint(cone, p)), length(p - nearestPoint(centre, radius, p)));
        // Also refuses a "nearest point" of a polyhedron that shrinking has emptied.
        gap = std::max(gap, deepestViolation(polyhedron, p));
        if (gap <= 1e-9 * (1.0 + radius)) return 0.0;
        if (length(p - previous) < 1e-7 * radius) break;
    }
    return gap;
}

Verdict spotMeets(const LightModel& light, const Polyhedron& polyhedron, double margin) {
    const double radius = light.rangeMetres;
    const Cone cone = {light.position, light.direction, std::cos(light.outerAngle), std::sin(light.outerAngle)};
    Cone inner = cone;
    inner.apex = inner.apex + inner.axis * (margin / inner.sine);  // its sides move inward by the margin
    if (gapAfterProjections(inner, light.position, radius - 2 * margin, shrunken(polyhedron, margin)) <= 0.0)
        return Verdict::Must;
    return gapAfterProjections(cone, light.position, radius, polyhedron) > 0.01 * radius + margin ? Verdict::Never
                                                                                                  : Verdict::May;
}

}  // namespace

Polyhedron viewPiece(const CameraModel& camera, double x0, double y0, double x1, double y1, double nearMetres,
                     double farMetres) {
    const double d0 = nearMetres;
    const double d1 = std::isfinite(farMetres) ? farMetres : 2.0 * std::abs(nearMetres) + 1.0;
    const double middle = 0.5 * (d0 + d1);
    const Vec3 inside = worldAtViewDepth(camera, 0.5 * (x0 + x1), 0.5 * (y0 + y1), middle);
    const std::array<std::array<double, 2>, 5> corners = {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}, {x0, y0}}};
    Polyhedron result;
    for (int i = 0; i < 4; ++i) {
        const Vec3 a = worldAtViewDepth(camera, corners[i][0], corners[i][1], middle);
        const Vec3 b = worldAtViewDepth(camera, corners[i][0], corners[i][1], d1 + 1.0);
        const Vec3 c = worldAtViewDepth(camera, corners[i + 1][0], corners[i + 1][1], middle);
        result.push_back(planeThrough(a, b, c, inside));
    }
    const double eyeDepth = dot(camera.forward, camera.eye);
    result.push_back({camera.forward, -eyeDepth - nearMetres});
    if (std::isfinite(farMetres)) result.push_back({-camera.forward, eyeDepth + farMetres});
    return result;
}

Polyhedron viewFrustum(const CameraModel& camera) {
    return viewPiece(camera, 0, 0, camera.widthPx, camera.heightPx, camera.nearMetres, camera.farMetres);
}

Vec3 nearestPoint(const Polyhedron& polyhedron, Vec3 p) {
    const double slack = 1e-9 * (1.0 + sumOfMagnitudes(p));
    if (deepestViolation(polyhedron, p) <= 0.0) return p;
    Vec3 best = p;
    double bestDistance = kInfinity, leastViolation = kInfinity;
    const int count = static_cast<int>(polyhedron.size());
    const auto consider = [&](std::array<int, 3> which, int n) {
        const Plane* planes[3] = {};
        for (int i = 0; i < n; ++i) planes[i] = &polyhedron[which[i]];
        Vec3 q;
        if (!projectOnto(planes, n, p, q)) return;
        const double violation = deepestViolation(polyhedron, q);
        if (violation <= slack) {
            if (length(q - p) < bestDistance) {
                bestDistance = length(q - p);
                best = q;
            }
        } else if (!(bestDistance < kInfinity) && violation < leastViolation) {
            leastViolation = violation;
            best = q;
        }
    };
    for (int i = 0; i < count; ++i) {
        consider({i, 0, 0}, 1);
        for (int j = i + 1; j < count; ++j) {
            consider({i, j, 0}, 2);
            for (int k = j + 1; k < count; ++k) consider({i, j, k}, 3);
        }
    }
    return best;
}

Verdict meets(const LightModel& light, const Polyhedron& polyhedron, double margin) {
    const double radius = light.rangeMetres;
    const double apart = length(nearestPoint(polyhedron, light.position) - light.position) - radius;
    if (apart > margin) return Verdict::Never;
    if (light.type == LightType::Spot) return spotMeets(light, polyhedron, margin);
    const Polyhedron inner = shrunken(polyhedron, margin);
    const Vec3 q = nearestPoint(inner, light.position);
    const bool found = deepestViolation(inner, q) <= 1e-8 * (1.0 + sumOfMagnitudes(q));
    return found && length(q - light.position) <= radius - margin ? Verdict::Must : Verdict::May;
}

}  // namespace gnomon::reference
