#pragma once
// What a matrix leaves of an area, and which way round. Whoever draws a scene and whoever traces it ask here, so that
// both have the same triangles.
//
// A scale of zero along one axis makes an instance flat: it is drawn. Along two it becomes a line, along three a point:
// they have no area. Matrices are products of float rotations, so that nothing is zero to the last bit. All thresholds
// are relative: a small scale is not a flat one.

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace gnomon::renderer {

/// False where every triangle becomes a line or a point. `linear`: the 3x3 part of a transform.
[[nodiscard]] inline bool hasArea(const glm::dmat3& linear) {
    constexpr double kThinnest = 1e-9;  // width to length, far below a pixel of any picture
    const double longest = std::max({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])});
    if (!(longest > 0.0)) return false;
    const glm::dmat3 m = linear / longest;
    return std::max({glm::length(glm::cross(m[0], m[1])), glm::length(glm::cross(m[1], m[2])),
                     glm::length(glm::cross(m[2], m[0]))}) > kThinnest;
}

/// True where clockwise triangles become counter-clockwise ones: swap the front face. Never for a flat matrix, whose
/// determinant is nothing but rounding.
[[nodiscard]] inline bool turnsWinding(const glm::dmat3& linear) {
    constexpr double kRounding = 1e-6;  // of a product of floats, as a share of the columns' lengths
    const glm::dvec3 lengths(glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2]));
    if (!(std::min({lengths.x, lengths.y, lengths.z}) > 0.0)) return false;
    return glm::determinant(glm::dmat3(linear[0] / lengths.x, linear[1] / lengths.y, linear[2] / lengths.z)) <
           -kRounding;
}

}  // namespace gnomon::renderer
