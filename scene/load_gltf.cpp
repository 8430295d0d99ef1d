#include "scene/load_gltf.h"

#include <algorithm>
#include <map>
#include <new>

#include "scene/gltf_geometry.h"
#include "scene/gltf_lights.h"
#include "scene/gltf_material.h"
#include "scene/gltf_motion.h"
#include "scene/gltf_nodes.h"
#include "scene/origin.h"
#include "scene/pose.h"

namespace gnomon::renderer {
namespace gltf {
namespace {

// What deforms is copied per node that places it; this bounds what a small file can ask for (2 GiB of vertices).
constexpr std::size_t kMaxDeformedVertices = 1u << 25;
constexpr std::size_t kMaxVertices = 1u << 28;

class SceneBuilder {
public:
    SceneBuilder(Document& document, Scene& scene)
        : document_(document),
          scene_(scene),
          placed_(placeNodes(document)),
          materials_(document, scene),
          motion_(document, placed_, scene) {}

    void build() {
        for (const PlacedNode& node : placed_) {
            addLightAndCamera(node);
            addMesh(node);
        }
        if (document_.model().nodes.empty()) placeAllMeshes();
        if (scene_.instances.empty() && scene_.lights.empty())
            refuse("the scene is empty: it holds neither triangles nor lights");
        noteDarkLights();
        if (scene_.materials.empty()) materials_.use(-1, "the scene");
        materials_.decodeImages();
        materials_.noteBlended();
        for (LoadedMesh& mesh : loaded_) finishMesh(mesh);
        motion_.loadAnimations();
        checkRestPose();
        moveToOrigin();
    }

private:
    struct LoadedMesh {
        std::string name;
        std::vector<Primitive> primitives;
        std::vector<float> weights;
        std::uint32_t sceneMesh = kNone;  // its slot once an instance draws it
        bool morphs = false;              // some instance has weights that are not zero for ever
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
            primitive->material = materials_.use(source.primitives[i].material, name);
            vertices_ += primitive->positions.size();
            if (vertices_ > kMaxVertices) refuse("the scene has more than {} vertices", kMaxVertices);
            if (!mesh.primitives.empty() && mesh.primitives.front().targets.size() != primitive->targets.size())
                refuse("{} has {} morph targets, the first primitive has {}", name, primitive->targets.size(),
                       mesh.primitives.front().targets.size());
            mesh.primitives.push_back(std::move(*primitive));
        }
        if (!mesh.primitives.empty())
            mesh.weights = weightsOf(source.weights, mesh.primitives.front().targets.size(), "mesh " + source.name);
        loaded_.push_back(std::move(mesh));
        return meshSlots_.emplace(index, loaded_.size() - 1).first->second;
    }

    static std::vector<float> weightsOf(const std::vector<double>& weights, std::size_t targets,
                                        const std::string& user) {
        if (targets == 0 || weights.empty()) return {};
        if (weights.size() != targets) refuse("{} has {} weights for {} morph targets", user, weights.size(), targets);
        std::vector<float> out;
        for (double weight : weights) {
            out.push_back(toFloat(weight, "a weight of " + user));
            if (!(std::abs(out.back()) < kFarthestUnits)) refuse("{} has a weight of {}", user, weight);
        }
        return out;
    }

    void addLightAndCamera(const PlacedNode& node) {
        const std::size_t lights = scene_.lights.size(), cameras = scene_.cameras.size();
        addLight(document_, node, scene_);
        addCamera(document_, node, scene_);
        if (scene_.lights.size() > lights) {
            scene_.lights.back().node = motion_.useIfMoving(node.index, "a light");
            lightPlaces_.emplace_back(node.worldFromNode[3]);
        }
        if (scene_.cameras.size() > cameras) {
            scene_.cameras.back().node = motion_.useIfMoving(node.index, "a camera");
            cameraPlaces_.emplace_back(node.worldFromNode[3]);
        }
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
        Instance instance;
        instance.name = source.name;
        if (skinned) {
            addSkin(source.skin, loaded_[slot], user, instance);
        } else {
            instance.worldFromObject = node.worldFromNode;
            if (!canPlace(loaded_[slot], instance.worldFromObject, motion_.canMove(node.index), user)) return;
            instance.node = motion_.useIfMoving(node.index, user);
        }
        const bool morphs = addWeights(node.index, source, loaded_[slot], user, instance);
        if (skinned || morphs)
            for (const Primitive& primitive : loaded_[slot].primitives) countDeformed(primitive);
        addInstance(slot, std::move(instance));
    }

    void countDeformed(const Primitive& primitive) {
        deformedVertices_ += std::max(primitive.positions.size(), primitive.indices.size() / 3);
        if (deformedVertices_ > kMaxDeformedVertices)
            refuse("the scene has more than {} vertices that deform", kMaxDeformedVertices);
    }

    void addInstance(std::size_t slot, Instance instance) {
        LoadedMesh& mesh = loaded_[slot];
        if (mesh.sceneMesh == kNone) {
            mesh.sceneMesh = static_cast<std::uint32_t>(scene_.meshes.size());
            scene_.meshes.emplace_back();
        }
        instance.mesh = mesh.sceneMesh;
        scene_.instances.push_back(std::move(instance));
    }

    // False, with a note, for what will never be seen.
    bool canPlace(const LoadedMesh& mesh, const glm::dmat4& worldFromObject, bool moves, const std::string& user) {
        const glm::dmat3 linear(worldFromObject);
        if (!moves && linear == glm::dmat3(0.0)) {
            document_.note(fmt::format("{} has a scale of zero on all axes and is not drawn.", user));
            return false;
        }
        for (const Primitive& primitive : mesh.primitives) {
            const Bounds& b = primitive.bounds;
            for (int corner = 0; corner < 8; ++corner) {
                const glm::dvec3 p(corner & 1 ? b.max.x : b.min.x, corner & 2 ? b.max.y : b.min.y,
                                   corner & 4 ? b.max.z : b.min.z);
                const glm::dvec3 placed(worldFromObject * glm::dvec4(p, 1.0));
                if (!(glm::length(placed) < static_cast<double>(kFarthestUnits)))
                    refuse("{} is placed beyond 1e15 units from the origin", user);
            }
        }
        return true;
    }

    void addSkin(int skin, const LoadedMesh& mesh, const std::string& user, Instance& instance) {
        instance.skin = motion_.useSkin(skin, user);
        const std::size_t joints = scene_.skins[instance.skin].joints.size();
        for (const Primitive& primitive : mesh.primitives) {
            if (primitive.joints.empty()) refuse("{} has a skin, but a primitive of its mesh has no joints", user);
            for (const glm::u16vec4& of : primitive.joints)
                for (int c = 0; c < 4; ++c)
                    if (of[c] >= joints) refuse("a vertex of {} refers to joint {} of {}", user, of[c], joints);
        }
    }

    // True where the instance's morph targets show.
    bool addWeights(int node, const tinygltf::Node& source, LoadedMesh& mesh, const std::string& user,
                    Instance& instance) {
        const std::size_t targets = mesh.primitives.front().targets.size();
        if (targets == 0) return false;
        const std::vector<float> own = weightsOf(source.weights, targets, user);
        const bool moves = motion_.hasWeightChannel(node);
        if (moves) motion_.expectWeights(node, targets);
        if (moves || !own.empty()) {
            instance.node = motion_.use(node, user);
            scene_.nodes[instance.node].weights = own;
        }
        const std::vector<float>& shown = own.empty() ? mesh.weights : own;
        const bool morphs = moves || std::any_of(shown.begin(), shown.end(), [](float w) { return w != 0.0f; });
        mesh.morphs = mesh.morphs || morphs;
        return morphs;
    }

    void placeAllMeshes() {
        for (std::size_t i = 0; i < document_.model().meshes.size(); ++i) {
            const std::size_t slot = loadMesh(static_cast<int>(i), "the file");
            LoadedMesh& mesh = loaded_[slot];
            if (mesh.primitives.empty()) continue;
            mesh.morphs = std::any_of(mesh.weights.begin(), mesh.weights.end(), [](float w) { return w != 0.0f; });
            Instance instance;
            instance.name = mesh.name;
            addInstance(slot, std::move(instance));
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
        mesh.primitives = std::move(source.primitives);
        if (source.morphs)
            mesh.weights = std::move(source.weights);
        else
            for (Primitive& primitive : mesh.primitives) primitive.targets.clear();
    }

    // Everything later takes for granted that the scene at rest is within a float's range.
    void checkRestPose() {
        try {
            (void)restPose(scene_);
        } catch (const PoseError& error) {
            std::string sentence = error.what();
            sentence.pop_back();
            refuse("{}", sentence);
        }
    }

    // Last, because the origin depends on everything that is drawn.
    void moveToOrigin() {
        std::vector<glm::dvec3> nodes;
        for (const PlacedNode& node : placed_) nodes.emplace_back(node.worldFromNode[3]);
        scene_.origin = originFor(scene_, nodes, lightPlaces_);
        if (scene_.origin == glm::dvec3(0.0)) return;
        for (Instance& instance : scene_.instances)
            if (instance.skin == kNone) instance.worldFromObject[3] -= glm::dvec4(scene_.origin, 0.0);
        for (std::size_t i = 0; i < lightPlaces_.size(); ++i)
            scene_.lights[i].position = glm::vec3(lightPlaces_[i] - scene_.origin);
        for (std::size_t i = 0; i < cameraPlaces_.size(); ++i)
            scene_.cameras[i].worldFromCamera[3] = glm::vec4(glm::vec3(cameraPlaces_[i] - scene_.origin), 1.0f);
        document_.note(fmt::format("The scene is drawn relative to {}, {}, {}.", scene_.origin.x, scene_.origin.y,
                                   scene_.origin.z));
        checkRestPose();
    }

    Document& document_;
    Scene& scene_;
    std::vector<PlacedNode> placed_;
    std::vector<glm::dvec3> lightPlaces_, cameraPlaces_;  // as in the scene, in the file's coordinates
    MaterialLoader materials_;
    MotionLoader motion_;
    std::vector<LoadedMesh> loaded_;
    std::map<int, std::size_t> meshSlots_;
    std::size_t vertices_ = 0, deformedVertices_ = 0;
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
