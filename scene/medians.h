#pragma once
// Middles that a few far things do not move.

#include <algorithm>
#include <glm/glm.hpp>
#include <vector>

namespace gnomon::renderer {

struct Ball {
    glm::dvec3 centre{0.0};
    double radius = 0.0;
};

/// The upper one of an even number; there must be one.
[[nodiscard]] inline double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Per axis.
[[nodiscard]] inline glm::dvec3 medianCentre(const std::vector<Ball>& balls) {
    glm::dvec3 middle(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> along;
        along.reserve(balls.size());
        for (const Ball& ball : balls) along.push_back(ball.centre[axis]);
        middle[axis] = median(std::move(along));
    }
    return middle;
}

/// From `middle` to the far ends of the balls.
[[nodiscard]] inline double medianReach(const std::vector<Ball>& balls, const glm::dvec3& middle) {
    std::vector<double> reaches;
    reaches.reserve(balls.size());
    for (const Ball& ball : balls) reaches.push_back(glm::length(ball.centre - middle) + ball.radius);
    return median(std::move(reaches));
}

}  // namespace gnomon::renderer
