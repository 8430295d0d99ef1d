#pragma once
// A few analytic shapes and the ray caster that makes test images of them.
//
// What: planes, balls and axis-aligned boxes, hit by the closed form, from both sides. Double precision.
//
// Limits: for tests; a scene is a list of shapes and every ray tries all of them.

#include <cstdint>
#include <optional>
#include <vector>

#include "reference/vector_math.h"

namespace gnomon::reference {

struct Shape {
    enum class Kind { Plane, Ball, Box } kind = Kind::Plane;
    Vec3 a;           ///< plane: a point; ball: centre; box: smallest corner
    Vec3 b{0, 1, 0};  ///< plane: unit normal; box: largest corner
    double radius = 1;
    std::uint8_t receiverMask = 0xFF;
    bool subsurface = false;
};

Shape plane(Vec3 point, Vec3 normal);
Shape ball(Vec3 centre, double radius);
Shape box(Vec3 smallest, Vec3 largest);

using Shapes = std::vector<Shape>;

struct Hit {
    double distance = 0;  ///< along the ray, in lengths of its direction
    Vec3 position;
    Vec3 normal;  ///< unit, on the side that the ray comes from
    std::size_t shape = 0;
};

/// The first hit with distance in [from, to].
std::optional<Hit> trace(const Shapes& shapes, Vec3 origin, Vec3 direction, double from = 0, double to = kInfinity);

}  // namespace gnomon::reference
