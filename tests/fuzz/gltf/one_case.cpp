#include "fuzz/gltf/one_case.h"

#include <cmath>
#include <cstring>
#include <exception>
#include <vector>

#include "scene/load_gltf.h"
#include "scene/pose.h"
#include "truth/figures.h"
#include "truth/light_truth.h"

namespace gnomon::fuzz {
namespace {

using namespace renderer;

constexpr TruthExtent kExtent = {8, 8};
constexpr std::size_t kMostTriangles = 20'000;  // more say nothing new, and take long

bool isOneSentence(const std::string& text) {
    return text.size() > 10 && text.back() == '.' && text.find('\n') == std::string::npos;
}

bool finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::string faultOf(const Scene& scene) {
    for (const Instance& instance : scene.instances)
        if (instance.mesh >= scene.meshes.size()) return "an instance names a mesh that is not there";
    for (const Mesh& mesh : scene.meshes)
        for (const Primitive& p : mesh.primitives) {
            if (p.material >= scene.materials.size()) return "a primitive names a material that is not there";
            if (p.indices.size() % 3 != 0) return "indices form no whole triangles";
            for (const std::uint32_t index : p.indices)
                if (index >= p.positions.size()) return "an index is beyond the vertices";
            for (const glm::vec3& v : p.positions)
                if (!finite(v)) return "a position is not finite";
        }
    for (const SceneLight& light : scene.lights) {
        if (!finite(light.position) || !finite(light.direction) || !std::isfinite(light.intensity))
            return "a light is not finite";
        if (light.kind != LightKind::Directional && !(light.rangeMetres > 0.0f)) return "a light has no range";
    }
    for (const std::string& note : scene.notes)
        if (!isOneSentence(note)) return "this note is no sentence: " + note;
    return {};
}

// A few points of the scene against its lights.
std::string trace(const Scene& scene, const Pose& pose, std::uint64_t seed) {
    const SceneCamera camera = posedCamera(scene, pose, defaultCamera(scene));
    const TracedScene traced(scene, pose, glm::dvec3(camera.worldFromCamera[3]));
    if (traced.triangles().empty()) return {};
    std::vector<std::uint32_t> ids(std::size_t{kExtent.widthPx} * kExtent.heightPx);
    for (std::size_t i = 0; i < ids.size(); ++i)
        ids[i] = i % 5 == 4 ? kNone : static_cast<std::uint32_t>((seed + i * 7) % traced.triangles().size());
    const std::vector<TruthReceiver> receivers = receiversOf(traced, camera, kExtent.widthPx, kExtent.heightPx, ids);
    for (std::size_t i = 0; i < pose.lights.size() && i < 2; ++i) {
        LightTruthDesc desc;
        desc.light = pose.lights[i];
        desc.subsetOf = 1;
        LightTruth truth = traceLight(traced, receivers, kExtent, desc);
        const std::vector<float> result(ids.size(), 0.5f);
        completeSoftTruth(truth, traced, receivers, desc, result);
        const Figures figures = figuresOf(truth, result, true).opaque;
        if (!std::isfinite(figures.visibilityError()) || figures.visibilityError() > 1.0)
            return "a figure is impossible";
    }
    return {};
}

}  // namespace

Outcome runCase(const std::filesystem::path& file) {
    Outcome out;
    try {
        Scene scene;
        const Result loaded = loadGltf(file, scene);
        out.loaded = loaded.ok();
        if (!out.loaded) {
            if (!isOneSentence(loaded.message())) out.fault = std::string("no sentence: ") + loaded.message();
            return out;
        }
        if (triangleCount(scene) > kMostTriangles) return out;
        lightIfDark(scene);
        completeLights(scene);
        out.fault = faultOf(scene);
        for (const double seconds : {0.0, 0.3, 1.7, 1.0e6}) {
            if (!out.fault.empty()) return out;
            const Pose pose = poseAt(scene, seconds);
            out.posed = true;
            out.fault = trace(scene, pose, static_cast<std::uint64_t>(seconds * 10.0));
            out.traced = true;
        }
    } catch (const PoseError& error) {
        if (!isOneSentence(error.what())) out.fault = std::string("no sentence: ") + error.what();
    } catch (const std::exception& error) {
        out.fault = std::string("thrown: ") + error.what();
    }
    return out;
}

}  // namespace gnomon::fuzz
