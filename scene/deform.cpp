// Source: glTF 2.0 specification, sections 3.7.2.2 (morph targets) and 3.7.3 (skins).
#include "scene/deform.h"

#include <cmath>

namespace gnomon::renderer {
namespace {

template <class T>
void addScaled(std::vector<T>& to, const std::vector<glm::vec3>& offsets, float weight) {
    if (offsets.size() != to.size()) return;  // the target leaves this attribute alone
    for (std::size_t i = 0; i < to.size(); ++i) {
        to[i].x += weight * offsets[i].x;
        to[i].y += weight * offsets[i].y;
        to[i].z += weight * offsets[i].z;
    }
}

// `otherwise` where nothing is left of the direction.
glm::vec3 unit(const glm::vec3& v, const glm::vec3& otherwise) {
    const float length = glm::length(v);
    return length > 0.0f && std::isfinite(length) ? v / length : otherwise;
}

void morph(const Primitive& primitive, PosedPrimitive& out) {
    bool any = false;
    for (std::size_t t = 0; t < primitive.targets.size() && t < out.weights.size(); ++t) {
        if (out.weights[t] == 0.0f) continue;
        any = true;
        addScaled(out.positions, primitive.targets[t].positions, out.weights[t]);
        addScaled(out.normals, primitive.targets[t].normals, out.weights[t]);
        addScaled(out.tangents, primitive.targets[t].tangents, out.weights[t]);
    }
    if (!any) return;
    for (std::size_t i = 0; i < out.normals.size(); ++i) out.normals[i] = unit(out.normals[i], primitive.normals[i]);
    for (std::size_t i = 0; i < out.tangents.size(); ++i) {
        const glm::vec4& rest = primitive.tangents[i];
        out.tangents[i] = glm::vec4(unit(glm::vec3(out.tangents[i]), glm::vec3(rest)), rest.w);
    }
}

void skin(const Primitive& primitive, PosedPrimitive& out) {
    for (std::size_t i = 0; i < out.positions.size(); ++i) {
        glm::mat4 blend(0.0f);
        for (int c = 0; c < 4; ++c) {
            const float weight = primitive.weights[i][c];
            if (weight != 0.0f) blend += weight * out.objectFromMesh[primitive.joints[i][c]];
        }
        out.positions[i] = glm::vec3(blend * glm::vec4(out.positions[i], 1.0f));
        if (out.normals.empty()) continue;
        // Cofactors: the inverse transpose up to a factor, and defined for every matrix. Its sign is the determinant's:
        // a mirroring blend turns the winding around, and with it the face, so the normal must stay on its side.
        const glm::mat3 m(blend);
        const glm::mat3 cofactor(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
        out.normals[i] = unit(cofactor * out.normals[i], out.normals[i]);
        if (!out.tangents.empty()) {
            const glm::vec3 tangent(out.tangents[i]);
            out.tangents[i] = glm::vec4(unit(m * tangent, tangent), out.tangents[i].w);
        }
    }
}

}  // namespace

bool deformPrimitive(const Primitive& primitive, PosedPrimitive& out) {
    out.positions = primitive.positions;
    out.normals = primitive.normals;
    out.tangents = primitive.tangents;
    morph(primitive, out);
    if (!out.objectFromMesh.empty() && !primitive.joints.empty()) skin(primitive, out);
    out.bounds = Bounds();
    bool near = true;
    for (const glm::vec3& p : out.positions) {
        out.bounds.add(p);
        near = near && glm::length(p) < kFarthestUnits;
    }
    return near;
}

}  // namespace gnomon::renderer
