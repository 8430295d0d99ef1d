// Structs and flags that cross from the renderer's CPU code to its shaders. Compiled as C++ and as GLSL.
#ifndef GNOMON_RENDERER_SCENE_DATA_H
#define GNOMON_RENDERER_SCENE_DATA_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
#define GNOMON_CONSTANT inline constexpr
#define GNOMON_UINT std::uint32_t
namespace gnomon::renderer {
using glm::vec4;
#else
#define GNOMON_CONSTANT const
#define GNOMON_UINT uint
#endif

// Flags of a draw item.
GNOMON_CONSTANT GNOMON_UINT kItemNormalsBit = 1u;   // the primitive has normals
GNOMON_CONSTANT GNOMON_UINT kItemTangentsBit = 2u;  // and tangents
GNOMON_CONSTANT GNOMON_UINT kItemExtrasBit = 4u;    // second texture coordinates or colours
GNOMON_CONSTANT GNOMON_UINT kItemMirroredBit = 8u;  // the matrix turns the winding around
// Words per vertex: normal (octahedral snorm16x2), tangent (the same; lowest bit of y: handedness), uv0 (2 floats).
GNOMON_CONSTANT GNOMON_UINT kAttributeWords = 4u;
// Words per vertex that has them: uv1 (2 floats), colour (4 halves).
GNOMON_CONSTANT GNOMON_UINT kExtraWords = 4u;

// Flags of a material.
GNOMON_CONSTANT GNOMON_UINT kMaterialSubsurfaceBit = 1u;

// One draw item. Rows of worldFromObject, relative to the frame's origin.
struct GpuDrawItem {
    vec4 row0, row1, row2;
    GNOMON_UINT triangleIdOffset;  // triangle id = scene-wide triangle + this, modulo 2^32
    GNOMON_UINT flags;
    GNOMON_UINT extraOffset;  // record of the extras = vertex + this, modulo 2^32
    GNOMON_UINT material;
};

// One texture of a material: uv' = (m.xy . uv, m.zw . uv) + offset.
struct GpuTextureUse {
    vec4 matrix;
    vec4 offsetTexcoordPresent;  // xy offset, z texture coordinates 0 or 1, w 1 if there is a texture
};

struct GpuMaterial {
    vec4 baseColour;           // linear
    vec4 emissiveAlphaCutoff;  // xyz emissive, w the least alpha that is opaque
    vec4 metallicRoughness;    // x metallic, y roughness, z normal scale, w unused
    GpuTextureUse baseColourUse, metallicRoughnessUse, normalUse, emissiveUse;
    GNOMON_UINT flags, reserved0, reserved1, reserved2;
};

#ifdef __cplusplus
static_assert(sizeof(GpuDrawItem) == 64);
static_assert(sizeof(GpuMaterial) == 192);
}  // namespace gnomon::renderer
#endif
#undef GNOMON_CONSTANT
#undef GNOMON_UINT
#endif  // GNOMON_RENDERER_SCENE_DATA_H
