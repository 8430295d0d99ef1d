// Octahedral unit vectors in two 16-bit components of an R16G16_UINT image: component = round((e * 0.5 + 0.5) * 65535).
// Source: Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit Vectors", section 3.
#ifndef GNOMON_SHADING_OCTAHEDRAL_GLSL
#define GNOMON_SHADING_OCTAHEDRAL_GLSL

vec2 octahedralWrap(vec2 e) {
    return (1.0 - abs(e.yx)) * vec2(e.x >= 0.0 ? 1.0 : -1.0, e.y >= 0.0 ? 1.0 : -1.0);
}

uvec2 encodeOctahedral(vec3 n) {
    vec2 e = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    if (n.z < 0.0) e = octahedralWrap(e);
    return uvec2(round(clamp(e * 0.5 + 0.5, 0.0, 1.0) * 65535.0));
}

// Unit vector. Precise: shadows are decided with it in more than one pipeline, which must agree.
vec3 decodeOctahedral(uvec2 stored) {
    precise vec2 e = vec2(stored) * (2.0 / 65535.0) - 1.0;
    precise float z = 1.0 - abs(e.x) - abs(e.y);
    precise vec2 xy = z < 0.0 ? octahedralWrap(e) : e;
    precise vec3 n = vec3(xy, z) * inversesqrt(dot(xy, xy) + z * z);
    return n;
}

#endif
