// G-buffer, fragments: material textures, normal mapping, packing. GNOMON_MASKED: alpha test (kept apart, because a
// discard costs the early depth test).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "renderer/gpu/material.glsl"

layout(location = 0) in vec3 positionWs;
layout(location = 1) in vec3 normalWs;
layout(location = 2) in vec4 tangentWs;
layout(location = 3) in vec4 texcoords;
layout(location = 4) in vec4 colour;
layout(location = 5) flat in vec3 faceNormalWs;
layout(location = 6) flat in uint triangleId;
layout(location = 7) flat in uint seesBack;

layout(location = 0) out vec4 outBaseColour;
layout(location = 1) out uvec2 outNormal;
layout(location = 2) out vec4 outMaterial;
layout(location = 3) out vec3 outEmissive;
layout(location = 4) out uvec2 outFaceNormal;
layout(location = 5) out uvec2 outReceiver;
layout(location = 6) out uint outTriangleId;

uvec2 packOctahedral(vec3 n) {
    n /= abs(n.x) + abs(n.y) + abs(n.z);
    vec2 e = n.xy;
    if (n.z < 0.0) e = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    return uvec2(round(clamp(e * 0.5 + 0.5, 0.0, 1.0) * 65535.0));
}

// Tangent and bitangent of a texture's coordinates from derivatives (Mikkelsen 2010, "Bump mapping unparametrized
// surfaces on the GPU"), for geometry without tangents.
vec3 perturbByDerivatives(vec3 n, vec3 mapped, vec2 uv, vec3 dpx, vec3 dpy, vec2 duvx, vec2 duvy) {
    const vec3 r1 = cross(dpy, n);
    const vec3 r2 = cross(n, dpx);
    const vec3 t = r1 * duvx.x + r2 * duvy.x;
    const vec3 b = r1 * duvx.y + r2 * duvy.y;
    const float longest = max(dot(t, t), dot(b, b));
    if (!(longest > 0.0)) return n;
    // The determinant's sign makes the frame independent of how the screen looks at the surface.
    const float s = (dot(dpx, r1) < 0.0 ? -1.0 : 1.0) * inversesqrt(longest);
    return t * s * mapped.x + b * s * mapped.y + n * mapped.z;
}

// Of the front, whichever side is seen: tangent, bitangent and normal belong to the front, and a back has them all
// negated.
vec3 frontNormal(vec3 dpx, vec3 dpy, vec2 uv, vec2 duvx, vec2 duvy) {
    vec3 n = normalize(normalWs);
    if (!(dot(n, n) > 0.5)) n = seesBack != 0u ? -faceNormalWs : faceNormalWs;  // not a number, or zero
    if (!(dot(n, n) > 0.5)) n = vec3(0.0, 0.0, 1.0);
    if (!hasTexture(material.normalUse)) return n;
    vec3 mapped = texture(normalTexture, uv).xyz * 2.0 - 1.0;
    mapped.xy *= material.metallicRoughness.z;
    vec3 result;
    if (tangentWs.w != 0.0) {
        const vec3 t = normalize(tangentWs.xyz - n * dot(n, tangentWs.xyz));
        result = t * mapped.x + cross(n, t) * sign(tangentWs.w) * mapped.y + n * mapped.z;
    } else {
        // glTF's v grows downwards in the image while the map's y grows with -v.
        result = perturbByDerivatives(n, vec3(mapped.x, -mapped.y, mapped.z), uv, dpx, dpy, duvx, duvy);
    }
    result = normalize(result);
    return dot(result, result) > 0.5 ? result : n;
}

void main() {
    // Derivatives before any discard, where every lane of the quad still counts.
    const vec2 uv0 = texcoords.xy, uv1 = texcoords.zw;
    const vec2 normalUv = textureUv(material.normalUse, uv0, uv1);
    const vec3 dpx = dFdx(positionWs), dpy = dFdy(positionWs);
    const vec2 duvx = dFdx(normalUv), duvy = dFdy(normalUv);
    const vec2 baseUv = textureUv(material.baseColourUse, uv0, uv1);
    const vec4 base = material.baseColour * colour * texture(baseColourTexture, baseUv);
    const vec3 front = frontNormal(dpx, dpy, normalUv, duvx, duvy);
    const vec3 n = seesBack != 0u ? -front : front;
    const vec4 mr = texture(metallicRoughnessTexture, textureUv(material.metallicRoughnessUse, uv0, uv1));
    const vec3 emissive = texture(emissiveTexture, textureUv(material.emissiveUse, uv0, uv1)).rgb;
#ifdef GNOMON_MASKED
    if (isCutOut(base.a)) discard;
#endif
    const bool subsurface = (material.flags & kMaterialSubsurfaceBit) != 0u;
    outBaseColour = vec4(base.rgb, 1.0);
    outNormal = packOctahedral(n);
    outMaterial =
        vec4(material.metallicRoughness.x * mr.b, material.metallicRoughness.y * mr.g, subsurface ? 1.0 : 0.0, 0.0);
    outEmissive = material.emissiveAlphaCutoff.xyz * emissive;
    outFaceNormal = packOctahedral(dot(faceNormalWs, faceNormalWs) > 0.5 ? faceNormalWs : n);
    outReceiver = uvec2(255u, subsurface ? 1u : 0u);
    outTriangleId = triangleId;
}
