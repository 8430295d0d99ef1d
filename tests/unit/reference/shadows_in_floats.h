#pragma once
// The rules of generate_shadows.h in plain 32-bit floats, decided one way each, as a shader would.

#include <cmath>

#include "reference/generate_shadows.h"

namespace gnomon::reference {

struct F3 {
    float x, y, z;
};
inline F3 f3(Vec3 v) {
    return {float(v.x), float(v.y), float(v.z)};
}
inline F3 operator+(F3 a, F3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline F3 operator-(F3 a, F3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline F3 operator*(F3 a, float s) {
    return {a.x * s, a.y * s, a.z * s};
}
inline float dot(F3 a, F3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline float length(F3 a) {
    return std::sqrt(dot(a, a));
}
inline F3 cross(F3 a, F3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Steps 1 to 4 for a pixel at `position`.
float visibilityInFloats(const LightModel& light, const Pixel& pixel, F3 position, const ShadowInput& input);
/// All steps.
int storedInFloats(const LightModel& light, const Pixel& pixel, F3 position, F3 eye, const ShadowInput& input);

}  // namespace gnomon::reference
