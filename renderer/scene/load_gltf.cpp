#include "renderer/scene/load_gltf.h"

#include <algorithm>
#include <map>
#include <new>

#include "renderer/scene/gltf_accessor.h"
#include "renderer/scene/gltf_geometry.h"
#include "renderer/scene/gltf_lights.h"
#include "renderer/scene/gltf_material.h"
#include "renderer/scene/gltf_nodes.h"

namespace gnomon::renderer {
namespace gltf {
namespace {

// A skinned mesh is copied per node that places it; this bounds what a small file can ask for (2 GiB of vertices).
constexpr std::size_t kMaxSkinnedVertices = 1u << 25;
constexpr std::size_t kMaxVertices = 1u << 28;

class SceneBuilder {
public:
    SceneBuilder(Document& document, Scene& scene)
        : document_(document), scene_(scene), materials_(document, scene), transforms_(document) {}

    void build() {
        const std::vector<PlacedNode> placed = placeNodes(document_);
        for (const PlacedNode& node : placed) {
            addLight(document_, node, scene_);
            addCamera(document_, node, scene_);
            addMesh(node);
        }
        if (document_.model().nodes.empty()) placeAllMeshes();
        if (scene_.instances.empty() && scene_.lights.empty())
            refuse("the scene is empty: it holds neither triangles nor lights");
        noteDarkLights();
        if (scene_.materials.empty()) materials_.use(-1, "the scene");
        materials_.decodeImages();
        for (LoadedMesh& mesh : loaded_) finishMesh(mesh);
    }

private:
    struct LoadedMesh {
        std::string name;
        std::vector<LoadedPrimitive> primitives;
        std::uint32_t sceneMesh = kNone;  // its slot once an instance draws it without a skin
    };

    // Index in loaded_.
    std::size_t loadMesh(int index, const std::string& user) {
        if (const auto known = meshSlots_.find(index); known != meshSlots_.end()) return known->second;
        const tinygltf::Mesh& source = at(document_.model().meshes, index, "mesh", user);
        LoadedMesh mesh;
        mesh.name = source.name;
        for (std::size_t i = 0; i < source.primitives.size(); ++i) {
            const std::string name = fmt::format("primitive {} of mesh {} '{}'", i, index, source.name.substr(0, 60));
            auto primitive = loadPrimitive(document_, source.primitives[i], name);
            if (!primitive) continue;
            primitive->primitive.material = materials_.use(source.primitives[i].material, name);
            vertices_ += primitive->primitive.positions.size();
            if (vertices_ > kMaxVertices) refuse("the scene has more than {} vertices", kMaxVertices);
            mesh.primitives.push_back(std::move(*primitive));
        }
        loaded_.push_back(std::move(mesh));
        return meshSlots_.emplace(index, loaded_.size() - 1).first->second;
    }

    void addMesh(const PlacedNode& node) {
        const tinygltf::Node& source = document_.model().nodes[static_cast<std::size_t>(node.index)];
        if (source.mesh == -1) return;
        const std::string user = nodeName(document_, node.index);
        const std::size_t slot = loadMesh(source.mesh, user);
        if (loaded_[slot].primitives.empty()) return;
        const bool skinned = source.skin != -1 && !loaded_[slot].primitives.front().joints.empty();
        if (source.skin != -1 && !skinned)
            document_.note(fmt::format("{} has a skin, but its mesh has no joints; it is drawn rigid.", user));
        if (skinned) return addSkinned(source, loaded_[slot], user);
        addInstance(slot, source.name, node.worldFromNode, user);
    }

    void addInstance(std::size_t slot, const std::string& name, const glm::mat4& worldFromObject,
                     const std::string& user) {
        LoadedMesh& mesh = loaded_[slot];
        if (!(std::abs(glm::determinant(glm::mat3(worldFromObject))) > 1.0e-30f)) {
            document_.note(fmt::format("{} has a scale of zero and is not drawn.", user));
            return;
        }
        for (const LoadedPrimitive& primitive : mesh.primitives) {
            const Bounds& b = primitive.primitive.bounds;
            for (int corner = 0; corner < 8; ++corner) {
                const glm::vec3 p(corner & 1 ? b.max.x : b.min.x, corner & 2 ? b.max.y : b.min.y,
                                  corner & 4 ? b.max.z : b.min.z);
                if (!(glm::length(glm::vec3(worldFromObject * glm::vec4(p, 1.0f))) < 1.0e15f))
                    refuse("{} is placed beyond 1e15 units from the origin", user);
            }
        }
        if (mesh.sceneMesh == kNone) {
            mesh.sceneMesh = static_cast<std::uint32_t>(scene_.meshes.size());
            scene_.meshes.emplace_back();
        }
        scene_.instances.push_back({name, mesh.sceneMesh, worldFromObject});
    }

    std::vector<glm::mat4> jointMatrices(int index, const std::string& user) {
        const tinygltf::Skin& skin = at(document_.model().skins, index, "skin", user);
        const std::string name = fmt::format("the inverse bind matrices of skin {}", index);
        std::vector<glm::mat4> bind(skin.joints.size(), glm::mat4(1.0f));
        if (skin.inverseBindMatrices != -1) {
            auto read = readMatrices(document_, skin.inverseBindMatrices, name);
            if (read.size() < skin.joints.size())
                refuse("{} are {} for {} joints", name, read.size(), skin.joints.size());
            bind = std::move(read);
        }
        for (std::size_t i = 0; i < skin.joints.size(); ++i)
            bind[i] = transforms_.worldFromNode(skin.joints[i], fmt::format("skin {}", index)) * bind[i];
        bind.resize(skin.joints.size());
        return bind;
    }

    // The pose that the nodes store, applied once: world-space vertices under an identity instance (the node's own
    // transform does not count for a skinned mesh, glTF 2.0 section 3.7.3.3).
    void addSkinned(const tinygltf::Node& node, const LoadedMesh& source, const std::string& user) {
        const std::vector<glm::mat4> joints = jointMatrices(node.skin, user);
        Mesh mesh{source.name, {}};
        for (const LoadedPrimitive& loaded : source.primitives) {
            if (loaded.joints.empty()) refuse("{} has a skin, but a primitive of its mesh has no joints", user);
            skinnedVertices_ += loaded.joints.size();
            if (skinnedVertices_ > kMaxSkinnedVertices)
                refuse("the scene has more than {} skinned vertices", kMaxSkinnedVertices);
            Primitive posed = loaded.primitive;
            for (std::size_t i = 0; i < posed.positions.size(); ++i) {
                glm::mat4 blend(0.0f);
                for (int c = 0; c < 4; ++c) {
                    if (loaded.weights[i][c] == 0.0f) continue;
                    const std::size_t joint = loaded.joints[i][c];
                    if (joint >= joints.size())
                        refuse("a vertex of {} refers to joint {} of {}", user, joint, joints.size());
                    blend += loaded.weights[i][c] * joints[joint];
                }
                posed.positions[i] = glm::vec3(blend * glm::vec4(posed.positions[i], 1.0f));
                if (!(glm::length(posed.positions[i]) < 1.0e15f))
                    refuse("{} is posed beyond 1e15 units from the origin", user);
                turnDirections(posed, i, glm::mat3(blend));
            }
            computeBounds(posed);
            mesh.primitives.push_back(std::move(posed));
        }
        document_.note("Skinned meshes stand still, in the pose that the nodes store.");
        scene_.instances.push_back({node.name, static_cast<std::uint32_t>(scene_.meshes.size()), glm::mat4(1.0f)});
        scene_.meshes.push_back(std::move(mesh));
    }

    static void turnDirections(Primitive& primitive, std::size_t vertex, const glm::mat3& blend) {
        const auto turned = [](const glm::vec3& from, const glm::mat3& by) {
            const glm::vec3 to = by * from;
            const float length = glm::length(to);
            return length > 0.0f && std::isfinite(length) ? to / length : from;
        };
        // Cofactors: the inverse transpose up to a factor, and defined for every matrix.
        const glm::mat3 cofactor(glm::cross(blend[1], blend[2]), glm::cross(blend[2], blend[0]),
                                 glm::cross(blend[0], blend[1]));
        if (!primitive.normals.empty()) primitive.normals[vertex] = turned(primitive.normals[vertex], cofactor);
        if (!primitive.tangents.empty()) {
            glm::vec4& tangent = primitive.tangents[vertex];
            tangent = glm::vec4(turned(glm::vec3(tangent), blend), tangent.w);
        }
    }

    void placeAllMeshes() {
        for (std::size_t i = 0; i < document_.model().meshes.size(); ++i) {
            const std::size_t slot = loadMesh(static_cast<int>(i), "the file");
            if (!loaded_[slot].primitives.empty()) addInstance(slot, loaded_[slot].name, glm::mat4(1.0f), "the file");
        }
        if (!scene_.instances.empty())
            document_.note("The file has no nodes; every mesh is drawn once, where it was modelled.");
    }

    void noteDarkLights() {
        const auto dark = std::count_if(scene_.lights.begin(), scene_.lights.end(),
                                        [](const SceneLight& l) { return l.intensity == 0.0f; });
        if (dark > 0)
            document_.note(fmt::format("{} of {} lights have an intensity of zero.", dark, scene_.lights.size()));
    }

    void finishMesh(LoadedMesh& source) {
        if (source.sceneMesh == kNone) return;
        Mesh& mesh = scene_.meshes[source.sceneMesh];
        mesh.name = source.name;
        for (LoadedPrimitive& loaded : source.primitives) mesh.primitives.push_back(std::move(loaded.primitive));
    }

    Document& document_;
    Scene& scene_;
    MaterialLoader materials_;
    NodeTransforms transforms_;
    std::vector<LoadedMesh> loaded_;
    std::map<int, std::size_t> meshSlots_;
    std::size_t vertices_ = 0, skinnedVertices_ = 0;
};

}  // namespace
}  // namespace gltf

Result loadGltf(const std::filesystem::path& path, Scene& out) {
    const std::string name = path.filename().string().substr(0, 60);
    try {
        Scene scene;
        scene.name = path.stem().string();
        gltf::Document document(path);
        gltf::SceneBuilder(document, scene).build();
        scene.notes = document.takeNotes();
        out = std::move(scene);
        return {};
    } catch (const gltf::Refusal& refusal) {
        return Result::failure(Status::BadArgument, "%s: %s.", name.c_str(), refusal.what());
    } catch (const std::bad_alloc&) {
        return Result::failure(Status::OutOfMemory, "%s: there is not enough memory to load it.", name.c_str());
    } catch (const std::exception& error) {
        return Result::failure(Status::BadArgument, "%s: it cannot be read (%s).", name.c_str(), error.what());
    }
}

}  // namespace gnomon::renderer
