#include "scene/builtin/implicit_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace gnomon::renderer {
namespace {

using GridIndex = std::array<std::uint32_t, 3>;

// Samples on a grid, and the vertex of every cell between them.
struct Grid {
    glm::vec3 origin{0.0f};
    float cell = 0.0f;
    GridIndex samples{};
    std::vector<float> values;
    std::vector<std::uint32_t> vertexOfCell;

    [[nodiscard]] std::size_t index(const GridIndex& p) const {
        return (std::size_t(p[2]) * samples[1] + p[1]) * samples[0] + p[0];
    }
    [[nodiscard]] bool inside(const GridIndex& p) const { return values[index(p)] < 0.0f; }
};

GridIndex stepped(GridIndex p, std::size_t axis, int by) {
    p[axis] += static_cast<std::uint32_t>(by);
    return p;
}

Grid sampled(const SolidField& solid, const Bounds& box, float cell) {
    Grid grid;
    grid.origin = box.min;
    grid.cell = cell;
    for (int k = 0; k < 3; ++k)
        grid.samples[static_cast<std::size_t>(k)] =
            static_cast<std::uint32_t>(std::ceil((box.max[k] - box.min[k]) / cell)) + 1;
    for (std::uint32_t z = 0; z < grid.samples[2]; ++z)
        for (std::uint32_t y = 0; y < grid.samples[1]; ++y)
            for (std::uint32_t x = 0; x < grid.samples[0]; ++x)
                grid.values.push_back(solid(grid.origin + cell * glm::vec3(x, y, z)));
    grid.vertexOfCell.assign(grid.values.size(), kNone);
    return grid;
}

// The mean of the places where the surface crosses the cell's edges, in cells from its low corner. Empty where it
// crosses none.
std::optional<glm::vec3> vertexIn(const Grid& grid, const GridIndex& cell) {
    glm::vec3 sum(0.0f);
    int crossings = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (int corner = 0; corner < 4; ++corner) {
            const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
            const GridIndex from = stepped(stepped(cell, b, corner & 1), c, corner >> 1), to = stepped(from, axis, 1);
            if (grid.inside(from) == grid.inside(to)) continue;
            const float low = grid.values[grid.index(from)], high = grid.values[grid.index(to)];
            glm::vec3 at(0.0f);
            at[static_cast<int>(axis)] = low / (low - high);
            at[static_cast<int>(b)] = static_cast<float>(corner & 1);
            at[static_cast<int>(c)] = static_cast<float>(corner >> 1);
            sum += at;
            ++crossings;
        }
    }
    if (crossings == 0) return std::nullopt;
    return sum / static_cast<float>(crossings);
}

glm::vec3 gradient(const SolidField& solid, const glm::vec3& p, float step) {
    glm::vec3 slope(0.0f);
    for (int axis = 0; axis < 3; ++axis) {
        glm::vec3 by(0.0f);
        by[axis] = step;
        slope[axis] = (solid(p + by) - solid(p - by)) / (2.0f * step);
    }
    return slope;
}

// One step of Newton's onto the surface, kept within the cell and off its faces: no two vertices of a quad meet.
glm::vec3 settled(const SolidField& solid, const glm::vec3& mean, const glm::vec3& cellLow, float cell) {
    const glm::vec3 slope = gradient(solid, mean, 0.25f * cell);
    const float steep = glm::dot(slope, slope);
    const glm::vec3 onSurface = steep > 0.0f ? mean - slope * (solid(mean) / steep) : mean;
    return glm::clamp(onSurface, cellLow + 0.04f * cell, cellLow + 0.96f * cell);
}

void addVertices(const SolidField& solid, Grid& grid, Primitive& mesh) {
    for (std::uint32_t z = 0; z + 1 < grid.samples[2]; ++z) {
        for (std::uint32_t y = 0; y + 1 < grid.samples[1]; ++y) {
            for (std::uint32_t x = 0; x + 1 < grid.samples[0]; ++x) {
                const std::optional<glm::vec3> at = vertexIn(grid, {x, y, z});
                if (!at) continue;
                grid.vertexOfCell[grid.index({x, y, z})] = static_cast<std::uint32_t>(mesh.positions.size());
                const glm::vec3 low = grid.origin + grid.cell * glm::vec3(x, y, z);
                const glm::vec3 vertex = settled(solid, low + grid.cell * *at, low, grid.cell);
                mesh.positions.push_back(vertex);
                const glm::vec3 slope = gradient(solid, vertex, 0.5f * grid.cell);
                mesh.normals.push_back(glm::length(slope) > 0.0f ? glm::normalize(slope) : glm::vec3(0, 1, 0));
            }
        }
    }
}

// Split along the diagonal whose smaller triangle is the larger one: no slivers.
void addQuad(Primitive& mesh, const std::array<std::uint32_t, 4>& q) {
    const auto area = [&](std::size_t i, std::size_t j, std::size_t k) {
        const glm::vec3 a = mesh.positions[q[i]];
        return glm::length(glm::cross(mesh.positions[q[j]] - a, mesh.positions[q[k]] - a));
    };
    if (std::min(area(0, 1, 2), area(0, 2, 3)) >= std::min(area(1, 2, 3), area(1, 3, 0)))
        mesh.indices.insert(mesh.indices.end(), {q[0], q[1], q[2], q[0], q[2], q[3]});
    else
        mesh.indices.insert(mesh.indices.end(), {q[1], q[2], q[3], q[1], q[3], q[0]});
}

void addQuads(const Grid& grid, Primitive& mesh) {
    for (std::uint32_t z = 1; z + 1 < grid.samples[2]; ++z) {
        for (std::uint32_t y = 1; y + 1 < grid.samples[1]; ++y) {
            for (std::uint32_t x = 1; x + 1 < grid.samples[0]; ++x) {
                const GridIndex here{x, y, z};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const bool in = grid.inside(here);
                    if (in == grid.inside(stepped(here, axis, 1))) continue;
                    const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
                    const auto vertex = [&](int db, int dc) {
                        return grid.vertexOfCell[grid.index(stepped(stepped(here, b, db), c, dc))];
                    };
                    // Counter-clockwise as seen from the axis' far end, which is outside when `here` is inside.
                    std::array<std::uint32_t, 4> q{vertex(0, 0), vertex(-1, 0), vertex(-1, -1), vertex(0, -1)};
                    if (!in) std::swap(q[1], q[3]);
                    addQuad(mesh, q);
                }
            }
        }
    }
}

// Corners whose face is turned far away from the vertex' normal are given the face's own.
void sharpenSeams(Primitive& mesh) {
    constexpr float kSharpCosine = 0.5f;  // 60 degrees
    const auto faceAt = [&](std::size_t i) {
        const glm::vec3 a = mesh.positions[mesh.indices[i]];
        return glm::cross(mesh.positions[mesh.indices[i + 1]] - a, mesh.positions[mesh.indices[i + 2]] - a);
    };
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::vec3 face = glm::normalize(faceAt(i));
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t shared = mesh.indices[i + k];
            if (glm::dot(face, mesh.normals[shared]) >= kSharpCosine) continue;
            mesh.indices[i + k] = static_cast<std::uint32_t>(mesh.positions.size());
            mesh.positions.push_back(glm::vec3(mesh.positions[shared]));
            mesh.normals.push_back(face);
            mesh.texcoords[0].push_back(glm::vec2(mesh.texcoords[0][shared]));
        }
    }
}

}  // namespace

float smoothUnion(float a, float b, float radius) {
    const float h = std::max(radius - std::abs(a - b), 0.0f) / radius;
    return std::min(a, b) - 0.25f * radius * h * h;
}

float smoothCut(float a, float b, float radius) {
    return -smoothUnion(-a, b, radius);
}

float ellipsoid(const glm::vec3& p, const glm::vec3& centre, const glm::vec3& radii) {
    const glm::vec3 q = (p - centre) / radii;
    const float far = glm::length(q), slope = glm::length(q / radii);
    return slope > 0.0f ? far * (far - 1.0f) / slope : -std::min({radii.x, radii.y, radii.z});
}

float roundCone(const glm::vec3& p, const glm::vec3& from, const glm::vec3& to, float radiusFrom, float radiusTo) {
    const glm::vec3 along = to - from;
    const float t = std::clamp(glm::dot(p - from, along) / glm::dot(along, along), 0.0f, 1.0f);
    return glm::length(p - from - t * along) - glm::mix(radiusFrom, radiusTo, t);
}

Primitive surfaceOf(const SolidField& solid, const Bounds& box, float cellMetres, std::uint32_t material,
                    const glm::mat4& primitiveFromSolid) {
    Grid grid = sampled(solid, box, cellMetres);
    Primitive mesh;
    mesh.material = material;
    addVertices(solid, grid, mesh);
    addQuads(grid, mesh);
    for (glm::vec3& p : mesh.positions) {
        mesh.texcoords[0].emplace_back(p.x, -p.y);
        p = glm::vec3(primitiveFromSolid * glm::vec4(p, 1.0f));
    }
    for (glm::vec3& n : mesh.normals) n = glm::normalize(glm::mat3(primitiveFromSolid) * n);
    sharpenSeams(mesh);
    for (const std::uint32_t i : mesh.indices) mesh.bounds.add(mesh.positions[i]);
    return mesh;
}

}  // namespace gnomon::renderer
