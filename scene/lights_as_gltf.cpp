#include "scene/lights_as_gltf.h"
#include "scene/filter_names.h"

#include <algorithm>
#include <charconv>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <iterator>
#include <nlohmann/json.hpp>

namespace gnomon::renderer {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMostConeAngle = glm::half_pi<double>();  // the nearest float is above it
constexpr const char* kExtension = "KHR_lights_punctual";

// The shortest decimal that a float reads as this one.
double shortDecimal(float value) {
    char text[32] = {};
    double out = 0.0;
    std::from_chars(text, std::to_chars(text, std::end(text), value).ptr, out);
    return out;
}

Json threeOf(const glm::vec3& v) {
    return {shortDecimal(v.x), shortDecimal(v.y), shortDecimal(v.z)};
}

// Turns -z, the way a glTF light shines, to the direction. From there to its opposite any axis will do.
glm::dquat rotationTo(const glm::vec3& direction) {
    const glm::dvec3 from(0.0, 0.0, -1.0), to = glm::normalize(glm::dvec3(direction));
    const glm::dvec3 axis = glm::cross(from, to);
    const double w = 1.0 + glm::dot(from, to);
    if (w < 1.0e-12) return {0.0, 0.0, 1.0, 0.0};
    return glm::normalize(glm::dquat(w, axis.x, axis.y, axis.z));
}

Json definitionOf(const SceneLight& light) {
    const float brightest = std::max({light.colour.r, light.colour.g, light.colour.b, 1.0f});
    Json out = {{"name", light.name},
                {"type", light.kind == LightKind::Point  ? "point"
                         : light.kind == LightKind::Spot ? "spot"
                                                         : "directional"},
                {"color", threeOf(light.colour / brightest)},
                {"intensity", shortDecimal(light.intensity * brightest)}};
    if (light.kind == LightKind::Spot)
        out["spot"] = {{"innerConeAngle", shortDecimal(light.innerConeAngle)},
                       {"outerConeAngle", std::min(shortDecimal(light.outerConeAngle), kMostConeAngle)}};
    if (light.kind != LightKind::Directional && light.rangeMetres > 0.0f && !light.rangeIsGuessed)
        out["range"] = shortDecimal(light.rangeMetres);
    Json extras = Json::object();
    if (light.sourceRadius > 0.0f) extras["sourceRadius"] = shortDecimal(light.sourceRadius);
    if (light.biasMetres >= 0.0f) extras["shadowBiasMetres"] = shortDecimal(light.biasMetres);
    if (light.filter) extras["shadowFilter"] = nameOf(*light.filter);
    if (!extras.empty()) out["extras"] = std::move(extras);
    return out;
}

Json nodeOf(const SceneLight& light, const glm::dvec3& origin, std::size_t index) {
    Json out = {{"name", light.name}};
    const glm::dvec3 place = origin + glm::dvec3(light.position);
    if (light.kind != LightKind::Directional || place != glm::dvec3(0.0))
        out["translation"] = origin == glm::dvec3(0.0) ? threeOf(light.position) : Json{place.x, place.y, place.z};
    if (light.kind != LightKind::Point) {
        const glm::dquat q = rotationTo(light.direction);
        out["rotation"] = {q.x, q.y, q.z, q.w};
    }
    out["extensions"] = {{kExtension, {{"light", index}}}};
    return out;
}

}  // namespace

std::string lightsAsGltf(std::span<const SceneLight> lights, const glm::dvec3& origin) {
    Json definitions = Json::array(), nodes = Json::array(), roots = Json::array();
    for (std::size_t i = 0; i < lights.size(); ++i) {
        definitions.push_back(definitionOf(lights[i]));
        nodes.push_back(nodeOf(lights[i], origin, i));
        roots.push_back(i);
    }
    const Json out = {{"asset", {{"version", "2.0"}, {"generator", "gnomon"}}},
                      {"extensionsUsed", Json::array({kExtension})},
                      {"extensions", {{kExtension, {{"lights", std::move(definitions)}}}}},
                      {"scene", 0},
                      {"scenes", Json::array({Json{{"nodes", std::move(roots)}}})},
                      {"nodes", std::move(nodes)}};
    return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace gnomon::renderer
