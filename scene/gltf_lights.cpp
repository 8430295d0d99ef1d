#include "scene/gltf_lights.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>

#include "scene/filter_names.h"
#include "scene/pose.h"

namespace gnomon::renderer::gltf {
namespace {

void readCone(const tinygltf::Light& source, SceneLight& light, Document& document, const std::string& user) {
    const double inner = source.spot.innerConeAngle, outer = source.spot.outerConeAngle;
    // The specification wants 0 <= inner < outer <= pi/2.
    if (!(outer > 0.0) || !(outer <= glm::half_pi<double>() + 1.0e-4) || !(inner >= 0.0))
        refuse("{} has cone angles of {} and {} radians", user, inner, outer);
    light.outerConeAngle = std::min(static_cast<float>(outer), glm::half_pi<float>());
    light.innerConeAngle = static_cast<float>(inner);
    if (light.innerConeAngle >= light.outerConeAngle) {
        document.note(fmt::format("{} has an inner cone as wide as its outer one; it was narrowed.", user));
        light.innerConeAngle = light.outerConeAngle * 0.999f;
    }
}

}  // namespace

void addLight(Document& document, const PlacedNode& node, Scene& scene) {
    const tinygltf::Node& carrier = at(document.model().nodes, node.index, "node", "the scene");
    const tinygltf::Value* reference = extension(carrier.extensions, "KHR_lights_punctual");
    if (!reference) return;
    const std::string carrierName = nodeName(document, node.index);
    const int index = integer(*reference, "light", -1, carrierName);
    const tinygltf::Light& source = at(document.model().lights, index, "light", carrierName);
    const std::string user = fmt::format("light {} '{}'", index, source.name.substr(0, 60));

    SceneLight light;
    light.name = carrier.name.empty() ? source.name : carrier.name;
    if (source.type == "point") {
        light.kind = LightKind::Point;
    } else if (source.type == "spot") {
        light.kind = LightKind::Spot;
        readCone(source, light, document, user);
    } else if (source.type == "directional") {
        light.kind = LightKind::Directional;
    } else {
        refuse("{} has the unknown type '{}'", user, source.type.substr(0, 40));
    }
    light.position = glm::vec3(node.worldFromNode[3]);
    // A scale of zero along its axis hides the direction; the two other axes still tell it.
    const glm::dmat3 axes(node.worldFromNode);
    const glm::dvec3 backwards = axes[2] != glm::dvec3(0.0) ? axes[2] : glm::cross(axes[0], axes[1]);
    const double length = glm::length(backwards);
    if (light.kind != LightKind::Point && !(length > 0.0))
        refuse("{} has a scale of zero, so {} has no direction", carrierName, user);
    if (light.kind != LightKind::Point) light.direction = glm::vec3(-backwards / length);
    if (!source.color.empty()) {
        if (source.color.size() != 3) refuse("{} has a colour of {} numbers", user, source.color.size());
        for (int c = 0; c < 3; ++c) {
            light.colour[c] = toFloat(source.color[static_cast<std::size_t>(c)], user);
            if (light.colour[c] < 0.0f) refuse("{} has a negative colour", user);
        }
    }
    light.intensity = toFloat(source.intensity, user);
    if (light.intensity < 0.0f) refuse("{} has the intensity {}", user, light.intensity);
    light.rangeMetres = light.kind == LightKind::Directional ? 0.0f : toFloat(source.range, user);
    if (light.rangeMetres < 0.0f) refuse("{} has the range {}", user, light.rangeMetres);
    if (const tinygltf::Value* bias = member(source.extras, "shadowBiasMetres")) {
        light.biasMetres = toFloat(bias->GetNumberAsDouble(), user);
        if (!(light.biasMetres >= 0.0f && light.biasMetres <= 1000.0f))
            refuse("{} has a shadowBiasMetres that is no length of up to 1000 m", user);
    }
    if (const tinygltf::Value* radius = member(source.extras, "sourceRadius")) {
        light.sourceRadius = toFloat(radius->GetNumberAsDouble(), user);
        const float most = light.kind == LightKind::Directional ? 0.5f : kFarthestUnits;
        if (!(light.sourceRadius > 0.0f && light.sourceRadius <= most))
            refuse("{} has the sourceRadius {}", user, light.sourceRadius);
    }
    if (const tinygltf::Value* filter = member(source.extras, "shadowFilter")) {
        light.filter = filterNamed(filter->Get<std::string>());
    }
    scene.lights.push_back(std::move(light));
}

void addCamera(Document& document, const PlacedNode& node, Scene& scene) {
    const tinygltf::Node& carrier = at(document.model().nodes, node.index, "node", "the scene");
    if (carrier.camera == -1) return;
    const std::string carrierName = nodeName(document, node.index);
    try {
        const tinygltf::Camera& source = at(document.model().cameras, carrier.camera, "camera", carrierName);
        const std::string user = fmt::format("camera {}", carrier.camera);
        SceneCamera camera;
        camera.name = carrier.name.empty() ? source.name : carrier.name;
        // Scale and shear of the node do not belong to the view.
        const glm::dvec3 z(node.worldFromNode[2]), y(node.worldFromNode[1]);
        const glm::dvec3 x = glm::cross(y, z);
        if (!(glm::length(z) > 0.0) || !(glm::length(x) > 0.0))
            refuse("{} has a transform without an inverse", carrierName);
        const glm::dvec3 right = glm::normalize(x), back = glm::normalize(z);
        camera.worldFromCamera = glm::mat4(glm::dmat4(glm::dvec4(right, 0.0), glm::dvec4(glm::cross(back, right), 0.0),
                                                      glm::dvec4(back, 0.0), node.worldFromNode[3]));
        double nearest = source.perspective.znear, farthest = source.perspective.zfar;
        if (source.type == "orthographic") {
            camera.orthographic = true;
            nearest = source.orthographic.znear;
            farthest = source.orthographic.zfar;
            camera.orthographicHalfHeight = std::abs(toFloat(source.orthographic.ymag, user));
            if (!(camera.orthographicHalfHeight > 0.0f)) refuse("{} has a height of zero", user);
            const float halfWidth = std::abs(toFloat(source.orthographic.xmag, user));
            if (!(halfWidth > 0.0f)) refuse("{} has a width of zero", user);
            camera.widthOverHeight = halfWidth / camera.orthographicHalfHeight;
        } else if (source.type == "perspective") {
            camera.verticalFieldOfView = toFloat(source.perspective.yfov, user);
            if (!(camera.verticalFieldOfView > 0.0f && camera.verticalFieldOfView < glm::pi<float>()))
                refuse("{} has a field of view of {} radians", user, camera.verticalFieldOfView);
            camera.widthOverHeight = toFloat(source.perspective.aspectRatio, user);
            if (!(camera.widthOverHeight >= 0.0f)) refuse("{} has an aspect ratio of {}", user, camera.widthOverHeight);
        } else {
            refuse("{} has the unknown type '{}'", user, source.type.substr(0, 40));
        }
        camera.nearMetres = toFloat(nearest, user);
        if (farthest > 0.0) camera.farMetres = toFloat(farthest, user);
        const bool nearIsGood = camera.orthographic ? camera.nearMetres >= 0.0f : camera.nearMetres > 0.0f;
        if (!nearIsGood || !(camera.farMetres > camera.nearMetres))
            refuse("{} has the near and far distances {} and {}", user, camera.nearMetres, camera.farMetres);
        scene.cameras.push_back(std::move(camera));
    } catch (const Refusal& refusal) {
        document.note(fmt::format("A camera is left out: {}.", refusal.what()));  // a picture can be taken without it
    }
}

}  // namespace gnomon::renderer::gltf
