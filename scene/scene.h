#pragma once
// A scene on the CPU: what the loaders and the built-in scenes make, and what the reference renderer uploads.
// World space is right-handed, y up, in metres. Every index in a Scene has been checked by whoever made it.
// Places count from Scene::origin, so that floats are fine wherever a file puts its things. Nodes alone are as the file
// has them.

#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_precision.hpp>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gnomon/result.h"
#include "gnomon/settings.h"
#include "scene/animation.h"
#include "scene/flatness.h"

namespace gnomon::renderer {

inline constexpr std::uint32_t kNone = 0xFFFFFFFFu;

struct Bounds {
    glm::vec3 min{std::numeric_limits<float>::infinity()};
    glm::vec3 max{-std::numeric_limits<float>::infinity()};
    void add(const glm::vec3& p) {
        min = glm::min(min, p);
        max = glm::max(max, p);
    }
    [[nodiscard]] bool empty() const { return min.x > max.x; }
    [[nodiscard]] glm::vec3 centre() const { return 0.5f * (min + max); }
    [[nodiscard]] float radius() const { return empty() ? 0.0f : 0.5f * glm::length(max - min); }
};

struct Image {
    std::uint32_t width = 1, height = 1;
    std::vector<std::uint8_t> rgba8;  // width * height * 4, rows from the top
};

// KHR_texture_transform folded into a 2x3 matrix: uv' = (m00 m01; m10 m11) * uv + offset.
struct TextureUse {
    std::uint32_t image = kNone;
    std::uint32_t texcoord = 0;           // 0 or 1
    bool repeatU = true, repeatV = true;  // else clamped (mirrored repeat is baked into the image)
    bool linear = true;
    glm::mat2 uvTransform{1.0f};
    glm::vec2 uvOffset{0.0f};
};

enum class AlphaMode : std::uint8_t { Opaque, Mask, Blend };

struct Material {
    std::string name;
    glm::vec4 baseColour{1.0f};    // linear
    TextureUse baseColourTexture;  // sRGB
    float metallic = 1.0f, roughness = 1.0f;
    TextureUse metallicRoughnessTexture;  // linear; green roughness, blue metallic
    TextureUse normalTexture;             // linear
    float normalScale = 1.0f;
    glm::vec3 emissive{0.0f};                 // linear, factor times KHR_materials_emissive_strength
    TextureUse emissiveTexture;               // sRGB
    AlphaMode alphaMode = AlphaMode::Opaque;  // Blend is drawn as Mask with a cut-off of 0.5 by the reference renderer
    float alphaCutoff = 0.5f;
    bool doubleSided = false;
    bool subsurface = false;
};

/// The least alpha that is opaque; what is below is cut out. Equal to the cut-off is opaque (glTF 2.0, section 3.9.4).
/// Interpolated and half-precision alphas miss a constant by a few roundings, so an eighth of a step of eight bits is
/// granted: more than any rounding, less than a texture can tell apart.
[[nodiscard]] float leastOpaqueAlpha(const Material& material);

// One indexed triangle list with one material. All attribute arrays have the length of positions or are empty.
struct Primitive {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;   // empty: flat
    std::vector<glm::vec4> tangents;  // w: handedness; empty: derived from uv by the shader
    std::vector<glm::vec2> texcoords[2];
    std::vector<glm::vec4> colours;      // linear; empty: white
    std::vector<glm::u16vec4> joints;    // per vertex, into the instance's skin; empty: rigid
    std::vector<glm::vec4> weights;      // of the joints, sum 1; same length
    std::vector<MorphTarget> targets;    // as many in every primitive of a mesh
    std::vector<std::uint32_t> indices;  // multiple of three, each below positions.size()
    std::uint32_t material = 0;
    Bounds bounds;  // of the positions that indices use, object space
};

struct Mesh {
    std::string name;
    std::vector<Primitive> primitives;
    std::vector<float> weights;  // of the morph targets, where no node gives others
};

struct Instance {
    std::string name;
    std::uint32_t mesh = 0;
    glm::dmat4 worldFromObject{1.0};  // at rest; of a skinned instance: identity
    std::uint32_t node = kNone;       // moves with this node
    std::uint32_t skin = kNone;       // posed in world space by this skin's joints; the node's place does not count
};

/// True when the instance turns clockwise triangles into counter-clockwise ones: swap the front face when drawing it.
[[nodiscard]] inline bool isMirrored(const Instance& instance) {
    return turnsWinding(glm::dmat3(instance.worldFromObject));
}

enum class LightKind : std::uint8_t { Point, Spot, Directional };

// Radiometry as in KHR_lights_punctual: candela for point and spot, lux for directional.
struct SceneLight {
    std::string name;
    LightKind kind = LightKind::Point;
    glm::vec3 position{0.0f};
    glm::vec3 direction{0.0f, -1.0f, 0.0f};  // unit, the way the light travels
    glm::vec3 colour{1.0f};                  // linear
    float intensity = 1.0f;
    float rangeMetres = 0.0f;                                    // 0: none given
    float innerConeAngle = 0.0f, outerConeAngle = 0.785398163f;  // half-angles, radians
    float sourceRadius = 0.0f;                                   // metres, directional: radians; 0: none given
    bool rangeIsGuessed = false, sourceIsGuessed = false;        // by completeLights(); a guessed range only culls
    bool casts = true;
    float biasMetres = -1.0f;      // depth bias; below 0: the renderer's default
    std::optional<Filter> filter;  // of its shadow; none: the renderer's choice
    std::uint32_t node = kNone;    // moves with this node; position and direction are those at rest
};

struct SceneCamera {
    std::string name;
    glm::mat4 worldFromCamera{1.0f};  // looks down its -z
    bool orthographic = false;
    float verticalFieldOfView = 0.9f;     // radians
    float orthographicHalfHeight = 1.0f;  // metres
    float nearMetres = 0.05f;
    float farMetres = std::numeric_limits<float>::infinity();
    float widthOverHeight = 0.0f;  // of what it shows at least; 0: as wide as the picture
    std::uint32_t node = kNone;    // moves with this node
    std::string note;              // what it leaves out, one sentence; empty: nothing
};

struct Scene {
    std::string name;
    glm::dvec3 origin{0.0};  // in the file's coordinates; zero unless everything is far from there
    std::vector<Image> images;
    std::vector<Material> materials;  // at least one
    std::vector<Mesh> meshes;
    std::vector<Instance> instances;
    std::vector<SceneLight> lights;
    std::vector<SceneCamera> cameras;
    std::vector<Node> nodes;  // only those that something hangs on; parents first
    std::vector<Skin> skins;
    std::vector<Animation> animations;            // those that play do so at once, each in its own loop
    glm::vec3 skyColour{0.02f, 0.03f, 0.05f};     // ambient from above and background, W/(m^2 sr) up to exposure
    glm::vec3 groundColour{0.01f, 0.01f, 0.01f};  // ambient from below
    std::optional<float> exposureEv100;           // empty: from the picture
    std::vector<std::string> notes;               // what a loader left out or repaired, one sentence each
};

/// The camera for a picture of so many pixels. A picture that is narrower than the camera's own shape shows its whole
/// width and more above and below; a wider one shows more at the sides. Nothing that the camera sees is cropped.
[[nodiscard]] SceneCamera fittedCamera(const SceneCamera& camera, std::uint32_t widthPx, std::uint32_t heightPx);

/// World bounds of everything that is drawn, at rest; empty for a scene without geometry.
Bounds worldBounds(const Scene& scene);

/// Triangles drawn, every instance counted.
std::uint64_t triangleCount(const Scene& scene);

/// Gives every light that lacks them a range and a source size, by the rules that docs/scenes.md states, with a note
/// for local lights.
void completeLights(Scene& scene);

/// A scene that has geometry and no light at all gets a sun, so that something is seen, and a note that says so. It
/// comes from the left and above of defaultCamera(), and is five to ten times as strong as the scene's ambient light.
void lightIfDark(Scene& scene);

/// The scene's first camera. Without one, a camera from the front right and above that frames the bulk of the scene
/// (scene/bulk.h) in a picture of any shape; its note says what is outside.
SceneCamera defaultCamera(const Scene& scene);

/// World from camera, for one that looks from `eye` at `target` with y up, or looks along y with -z up.
[[nodiscard]] glm::mat4 lookingAt(const glm::vec3& eye, const glm::vec3& target);

/// Reads "eye:target", each "x,y,z" in the file's coordinates, and after it, each behind a colon and each once:
/// "degrees" (vertical field of view, 60 without it) or "height=units" (orthographic, so high), and "roll=degrees"
/// (clockwise, as one behind the camera sees it turn). Or "#index" or the name of one of the scene's cameras, or
/// "default". Changes `camera` on success only.
Result parseCamera(std::string_view text, const Scene& scene, SceneCamera& camera);

}  // namespace gnomon::renderer
