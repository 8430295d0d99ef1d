#pragma once
// Organic bodies: a closed mesh around the places where a function of space is negative.

#include "scene/scene.h"

#include <functional>

namespace gnomon::renderer {

// Negative inside. It need not be a true distance, only continuous.
using SolidField = std::function<float(const glm::vec3&)>;

// Union and cut with rounded seams: `radius` is how far from the seam they differ from the sharp ones.
float smoothUnion(float a, float b, float radius);
float smoothCut(float a, float b, float radius);  // a without b

float ellipsoid(const glm::vec3& p, const glm::vec3& centre, const glm::vec3& radii);
// A bar between two round ends of different radii.
float roundCone(const glm::vec3& p, const glm::vec3& from, const glm::vec3& to, float radiusFrom, float radiusTo);

// Surface nets (Gibson 1998): one vertex per cell that the surface crosses, one quad per crossed edge; closed as long
// as the solid stays within `box`. Then moved by `primitiveFromSolid`, a rotation, uniform scale and translation.
Primitive surfaceOf(const SolidField& solid, const Bounds& box, float cellMetres, std::uint32_t material,
                    const glm::mat4& primitiveFromSolid);

}  // namespace gnomon::renderer
