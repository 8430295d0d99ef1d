#pragma once
// Building blocks of the built-in scenes: each appends closed, outward-wound (counter-clockwise front), textured
// geometry to a primitive. Texture coordinates are in metres, u to the right and v downwards as seen from outside;
// a material's uvTransform turns metres into repeats.

#include "scene/scene.h"

#include <functional>
#include <span>

namespace gnomon::renderer {

class ShapeBuilder {
public:
    explicit ShapeBuilder(std::uint32_t material) { primitive_.material = material; }

    // Everything added from now on is transformed by this matrix (rotation, uniform scale, translation).
    void setTransform(const glm::mat4& primitiveFromShape) { transform_ = primitiveFromShape; }

    // A convex flat polygon, counter-clockwise as seen from its front; texture by box projection.
    void polygon(std::span<const glm::vec3> corners);
    void quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d);

    enum Face : unsigned { kLeft = 1, kRight = 2, kBottom = 4, kTop = 8, kBack = 16, kFront = 32, kAll = 63 };
    // Axis-aligned; left/right are x, bottom/top y, back/front z.
    void box(const glm::vec3& min, const glm::vec3& max, unsigned faces = kAll);

    // Turned around the y axis. The profile of (radius, y) runs with the solid on its left: upwards on an outer wall,
    // downwards on an inner one. Corners sharper than 40 degrees stay sharp. `faceted` keeps the sides flat.
    void lathe(std::span<const glm::vec2> profile, int sides, bool faceted = false);
    void sphere(const glm::vec3& centre, float radius, int rings, int sides);

    // Round bar along a path of at least two points, with end caps.
    void tube(std::span<const glm::vec3> path, float radius, int sides);

    // Zero-thickness curved grid: position(u, v) for u, v in [0, 1]; uv = (u * widthMetres, v * heightMetres).
    void sheet(const std::function<glm::vec3(float, float)>& position, int columns, int rows, float widthMetres,
               float heightMetres);

    // A closed tube over rings of elliptic section, capped at both ends. At angle a a ring's point is
    // centre + across * cos a + forward * sin a; rings run towards cross(across, forward). Folds widen and narrow it
    // by that share, kLoftFolds times around.
    struct Ring {
        glm::vec3 centre, across, forward;
        float folds = 0.0f;
    };
    static constexpr int kLoftFolds = 9;
    void loft(std::span<const Ring> rings, int sides);
    // A round bar whose radius changes along its path.
    void branch(std::span<const glm::vec3> path, std::span<const float> radii, int sides);

    // A flat card whose texture is the whole image: from the middle of its lower edge along `up`, `side` to the right.
    // Its normals are the face's, bent towards `outward`: a crown of cards is then shaded as one body.
    void card(const glm::vec3& root, const glm::vec3& up, const glm::vec3& side, const glm::vec3& outward);

    // Wall of `thickness` around z = 0 with a round-arched opening whose springing line is the wall's lower edge.
    // No top, and no sides: walls stand in rows. `relief` raises a ring of `ringWidth` around the arch on both faces.
    struct Arch {
        float width, springing, top, radius, thickness;
        int segments;
        float ringWidth = 0.0f, relief = 0.0f;
    };
    void arch(const Arch& arch);

    // One side of a square ring: a prism along x between z = front and z = back whose ends are mitred at 45 degrees,
    // at |x| = halfLength - z. Heights are given at front and back. Left out: the mitred ends, which meet the next
    // side.
    struct Mitred {
        float halfLength, front, back, bottomFront, bottomBack, topFront, topBack;
        bool bottom = true;
    };
    void mitred(const Mitred& side);

    [[nodiscard]] Primitive take();

    [[nodiscard]] std::size_t vertexCount() const { return primitive_.positions.size(); }
    // Object-space places of the vertices added so far.
    [[nodiscard]] std::span<const glm::vec3> positions() const { return primitive_.positions; }

private:
    std::uint32_t vertex(const glm::vec3& position, const glm::vec3& normal, const glm::vec2& uv);
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
    void smoothQuad(const glm::vec3 (&p)[4], const glm::vec3 (&n)[4], const glm::vec2 (&uv)[4]);
    void latheBand(glm::vec2 low, glm::vec2 high, glm::vec2 normalLow, glm::vec2 normalHigh, float arcLow,
                   float arcHigh, float girth, int sides, bool faceted);
    void archFace(const Arch& arch, float z);
    void archRing(const Arch& arch, float direction);

    Primitive primitive_;
    glm::mat4 transform_{1.0f};
};

// worldFromObject for things that stand upright: turned about y, then moved.
glm::mat4 placed(const glm::vec3& position, float turnRadians = 0.0f, float scale = 1.0f);

// Collects a scene; keeps the indices right.
class SceneBuilder {
public:
    explicit SceneBuilder(std::string name) { scene.name = std::move(name); }

    std::uint32_t image(Image image);
    std::uint32_t material(Material material);
    std::uint32_t mesh(std::string name, std::vector<Primitive> primitives);
    void place(std::uint32_t mesh, const glm::mat4& worldFromObject);
    // A mesh of one shape, placed where it was built.
    void place(std::string name, ShapeBuilder& shape, const glm::mat4& worldFromObject = glm::mat4(1.0f));
    void camera(std::string name, const glm::vec3& eye, const glm::vec3& target, float verticalFieldOfView);

    Scene scene;
};

}  // namespace gnomon::renderer
