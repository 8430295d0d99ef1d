// See shapes.h.
#include "reference/shapes.h"

namespace gnomon::reference {
namespace {

struct Crossing {
    double distance = 0;
    Vec3 normal;
};

std::vector<Crossing> crossPlane(const Shape& shape, Vec3 origin, Vec3 direction) {
    const double speed = dot(shape.b, direction);
    if (speed == 0.0) return {};
    return {{dot(shape.b, shape.a - origin) / speed, shape.b}};
}

std::vector<Crossing> crossBall(const Shape& shape, Vec3 origin, Vec3 direction) {
    // |origin + t direction - centre|^2 = radius^2
    const Vec3 v = origin - shape.a;
    const double a = dot(direction, direction), b = dot(v, direction), c = dot(v, v) - shape.radius * shape.radius;
    const double discriminant = b * b - a * c;
    if (discriminant < 0) return {};
    std::vector<Crossing> result;
    for (const double root : {-std::sqrt(discriminant), std::sqrt(discriminant)}) {
        const double t = (-b + root) / a;
        result.push_back({t, normalize(v + direction * t)});
    }
    return result;
}

std::vector<Crossing> crossBox(const Shape& shape, Vec3 origin, Vec3 direction) {
    std::vector<Crossing> result;
    for (int axis = 0; axis < 3; ++axis) {
        if (component(direction, axis) == 0.0) continue;
        for (const Vec3 corner : {shape.a, shape.b}) {
            const double t = (component(corner, axis) - component(origin, axis)) / component(direction, axis);
            const Vec3 p = origin + direction * t;
            bool inside = true;
            for (int other = 0; other < 3; ++other)
                if (other != axis)
                    inside = inside && component(p, other) >= component(shape.a, other) &&
                             component(p, other) <= component(shape.b, other);
            if (inside) result.push_back({t, {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0}});
        }
    }
    return result;
}

}  // namespace

Shape plane(Vec3 point, Vec3 normal) {
    Shape shape;
    shape.a = point;
    shape.b = normalize(normal);
    return shape;
}

Shape ball(Vec3 centre, double radius) {
    Shape shape;
    shape.kind = Shape::Kind::Ball;
    shape.a = centre;
    shape.radius = radius;
    return shape;
}

Shape box(Vec3 smallest, Vec3 largest) {
    Shape shape;
    shape.kind = Shape::Kind::Box;
    shape.a = smallest;
    shape.b = largest;
    return shape;
}

std::optional<Hit> trace(const Shapes& shapes, Vec3 origin, Vec3 direction, double from, double to) {
    std::optional<Hit> best;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        const Shape& shape = shapes[i];
        const std::vector<Crossing> crossings = shape.kind == Shape::Kind::Plane  ? crossPlane(shape, origin, direction)
                                                : shape.kind == Shape::Kind::Ball ? crossBall(shape, origin, direction)
                                                                                  : crossBox(shape, origin, direction);
        for (const Crossing& crossing : crossings) {
            if (crossing.distance < from || crossing.distance > to) continue;
            if (best && best->distance <= crossing.distance) continue;
            const Vec3 normal = dot(crossing.normal, direction) > 0 ? -crossing.normal : crossing.normal;
            best = Hit{crossing.distance, origin + direction * crossing.distance, normal, i};
        }
    }
    return best;
}

}  // namespace gnomon::reference
