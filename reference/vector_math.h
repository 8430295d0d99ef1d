#pragma once
// Vectors and 4x4 matrices in double precision, as plain as can be: the oracle leans on nobody's mathematics but its
// own. Matrices are written m[row][column] and multiply column vectors; the library's float arrays are column-major.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace gnomon::reference {

/// Unit roundoff of a 32-bit float: one correctly rounded operation errs by at most this share of its result.
inline constexpr double kFloatRoundoff = 1.0 / 16777216.0;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kPi = 3.14159265358979323846;

struct Vec3 {
    double x = 0, y = 0, z = 0;
};
struct Vec4 {
    double x = 0, y = 0, z = 0, w = 0;
};

inline Vec3 operator+(Vec3 a, Vec3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3 operator-(Vec3 a, Vec3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3 operator-(Vec3 a) {
    return {-a.x, -a.y, -a.z};
}
inline Vec3 operator*(Vec3 a, double s) {
    return {a.x * s, a.y * s, a.z * s};
}
inline Vec3 operator*(double s, Vec3 a) {
    return a * s;
}
inline Vec3 operator/(Vec3 a, double s) {
    return {a.x / s, a.y / s, a.z / s};
}
inline double dot(Vec3 a, Vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vec3 a) {
    return std::sqrt(dot(a, a));
}
inline Vec3 normalize(Vec3 a) {
    return a / length(a);
}
/// Sum of magnitudes: an upper bound of what a float dot product's terms can add up to.
inline double sumOfMagnitudes(Vec3 a) {
    return std::abs(a.x) + std::abs(a.y) + std::abs(a.z);
}
inline double component(Vec3 a, int axis) {
    return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}
inline Vec3 vec3(const float* p) {
    return {p[0], p[1], p[2]};
}

struct Mat4 {
    double m[4][4] = {};
};

inline Mat4 fromColumnMajor(const float* values) {
    Mat4 result;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) result.m[row][column] = values[column * 4 + row];
    return result;
}

inline void toColumnMajor(const Mat4& a, float* values) {
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) values[column * 4 + row] = static_cast<float>(a.m[row][column]);
}

inline Vec4 operator*(const Mat4& a, Vec4 v) {
    const double in[4] = {v.x, v.y, v.z, v.w};
    double out[4] = {};
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) out[row] += a.m[row][column] * in[column];
    return {out[0], out[1], out[2], out[3]};
}

inline Mat4 operator*(const Mat4& a, const Mat4& b) {
    Mat4 result;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            for (int k = 0; k < 4; ++k) result.m[row][column] += a.m[row][k] * b.m[k][column];
    return result;
}

/// Image of a point; divides by w.
inline Vec3 transformPoint(const Mat4& a, Vec3 p) {
    const Vec4 h = a * Vec4{p.x, p.y, p.z, 1.0};
    return Vec3{h.x, h.y, h.z} / h.w;
}

/// Gauss-Jordan elimination with the largest pivot of the column. The matrix must be invertible.
inline Mat4 inverse(Mat4 a) {
    Mat4 result;
    for (int i = 0; i < 4; ++i) result.m[i][i] = 1.0;
    for (int column = 0; column < 4; ++column) {
        int pivot = column;
        for (int row = column + 1; row < 4; ++row)
            if (std::abs(a.m[row][column]) > std::abs(a.m[pivot][column])) pivot = row;
        std::swap(a.m[pivot], a.m[column]);
        std::swap(result.m[pivot], result.m[column]);
        const double scale = 1.0 / a.m[column][column];
        for (int k = 0; k < 4; ++k) {
            a.m[column][k] *= scale;
            result.m[column][k] *= scale;
        }
        for (int row = 0; row < 4; ++row) {
            if (row == column) continue;
            const double factor = a.m[row][column];
            for (int k = 0; k < 4; ++k) {
                a.m[row][k] -= factor * a.m[column][k];
                result.m[row][k] -= factor * result.m[column][k];
            }
        }
    }
    return result;
}

/// The first three elements of a row.
inline Vec3 rowOf(const Mat4& a, int row) {
    return {a.m[row][0], a.m[row][1], a.m[row][2]};
}

}  // namespace gnomon::reference
