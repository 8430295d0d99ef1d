#pragma once
// Does a light's volume meet a convex piece of the view?
//
// Problem: phase 1 must mark every mask tile and zBin that a light's volume touches. The oracle has to say so surely.
//
// Source: the specification, Phase 1. A light's volume is its ball of range, for a spot cut with its cone; a mask tile
// between two view depths is a polyhedron of at most six planes.
//
// What: a ball meets a polyhedron iff the polyhedron's nearest point to the centre lies within the radius. The nearest
// point is found the plain way: project the centre onto every plane, every pair's line and every triple's corner, and
// take the nearest of those that lie inside. Spots: a point common to ball, cone and polyhedron, all slightly shrunken,
// is looked for by projecting onto each in turn; a point that is found *is* the proof.
//
// Limits: not finding a point proves nothing, so spots are `Must`, `May`, or `Never` by the ball alone or where the
// projections stay far apart. Half-angles are below a right angle. Tens of microseconds per spot and polyhedron.

#include <vector>

#include "reference/camera.h"
#include "reference/findings.h"
#include "reference/lights.h"

namespace gnomon::reference {

/// Inside where dot(normal, p) + offset >= 0.
struct Plane {
    Vec3 normal;  ///< unit
    double offset = 0;
};
using Polyhedron = std::vector<Plane>;

/// The part of the view within the pixel rectangle [x0, x1] x [y0, y1] (continuous coordinates) and between two view
/// depths. far may be infinite.
Polyhedron viewPiece(const CameraModel& camera, double x0, double y0, double x1, double y1, double nearMetres,
                     double farMetres);
/// All of the view, from its near to its far plane.
Polyhedron viewFrustum(const CameraModel& camera);

/// The polyhedron's point nearest to p. It must not be empty.
Vec3 nearestPoint(const Polyhedron& polyhedron, Vec3 p);

/// Does the light's volume meet the polyhedron? Point and spot lights only. `margin` in metres: `Must` needs a common
/// point at least that deep in each; `Never` that they are farther apart than that.
Verdict meets(const LightModel& light, const Polyhedron& polyhedron, double margin);

}  // namespace gnomon::reference
