#include "truth/traced_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace gnomon::renderer {
namespace {

// What float rounding does to a hit, as a share of the coordinates: a few steps of 2^-24 each for the corners, the
// ray's start, its direction and the intersection.
constexpr double kFloatError = 1e-6;
// Nearer to the ray's start than so many float errors, a triangle is not enlarged: there an edge that is too long would
// stand above the point's own surface.
constexpr double kStrictNear = 1e3;

double largest(const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

double largestCoordinate(const std::vector<glm::vec3>& positions) {
    float most = 0.0f;
    for (const glm::vec3& p : positions) most = std::max({most, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return static_cast<double>(most);
}

struct Meeting {
    double t = 0.0;  // of the way from start to end
    glm::dvec3 barycentrics{0.0};
};

// Möller and Trumbore 1997; false for a ray in the triangle's plane.
bool meets(const std::array<glm::dvec3, 3>& c, const glm::dvec3& from, const glm::dvec3& way, Meeting& meeting) {
    const glm::dvec3 ab = c[1] - c[0], ac = c[2] - c[0];
    const glm::dvec3 p = glm::cross(way, ac);
    const double determinant = glm::dot(ab, p);
    if (determinant == 0.0) return false;
    const glm::dvec3 s = from - c[0];
    const glm::dvec3 q = glm::cross(s, ab);
    const double u = glm::dot(s, p) / determinant, v = glm::dot(way, q) / determinant;
    meeting = {glm::dot(ac, q) / determinant, {1.0 - u - v, u, v}};
    return true;
}

// How far outside of the triangle a point of its plane is, at most, in metres; 0 or less: inside.
double outsideMetres(const std::array<glm::dvec3, 3>& c, const glm::dvec3& barycentrics) {
    const double twiceArea = glm::length(glm::cross(c[1] - c[0], c[2] - c[0]));
    double most = -std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i)
        most = std::max(most, -barycentrics[i] * twiceArea / glm::length(c[(i + 1) % 3] - c[(i + 2) % 3]));
    return most;
}

double texel(const Image& image, const TextureUse& use, long x, long y) {
    const auto wrapped = [](long i, long size, bool repeats) {
        return repeats ? (i % size + size) % size : std::clamp(i, 0l, size - 1);
    };
    const long column = wrapped(x, image.width, use.repeatU), row = wrapped(y, image.height, use.repeatV);
    return image.rgba8[4 * (static_cast<std::size_t>(row) * image.width + static_cast<std::size_t>(column)) + 3] /
           255.0;
}

// As a sampler reads the finest mip.
double sampledAlpha(const Image& image, const TextureUse& use, const glm::dvec2& uv) {
    if (!(largest(glm::dvec3(uv, 0.0)) < 1e9)) return 1.0;
    const glm::dvec2 at = uv * glm::dvec2(image.width, image.height) - (use.linear ? 0.5 : 0.0);
    const glm::dvec2 first = glm::floor(at), share = at - first;
    const long x = static_cast<long>(first.x), y = static_cast<long>(first.y);
    if (!use.linear) return texel(image, use, x, y);
    return glm::mix(glm::mix(texel(image, use, x, y), texel(image, use, x + 1, y), share.x),
                    glm::mix(texel(image, use, x, y + 1), texel(image, use, x + 1, y + 1), share.x), share.y);
}

void throwEmbreeError(RTCDevice device, const char* what) {
    const auto code = static_cast<int>(rtcGetDeviceError(device));
    throw std::runtime_error(std::string("Embree could not ") + what + " (error " + std::to_string(code) + ").");
}

#if RTC_VERSION_MAJOR >= 4
using QueryContext = RTCRayQueryContext;
#else
using QueryContext = RTCIntersectContext;
#endif

}  // namespace

struct TracedScene::Embree {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    ~Embree() {
        if (scene != nullptr) rtcReleaseScene(scene);
        if (device != nullptr) rtcReleaseDevice(device);
    }
};

// One ray on its way through Embree, which hands the context back to the filter.
struct TracedScene::Query {
    QueryContext context;  // first: Embree knows this part
    const TracedScene* scene = nullptr;
    glm::dvec3 from{0.0}, way{0.0};
    double length = 0.0, freeMetres = 0.0;
    std::uint32_t own = kNone;
    double nearest = std::numeric_limits<double>::infinity();

    Query(const TracedScene& traced, const ShadowRay& ray)
        : scene(&traced), from(ray.from), way(ray.to - ray.from), length(glm::length(way)), own(ray.own) {
#if RTC_VERSION_MAJOR >= 4
        rtcInitRayQueryContext(&context);
#else
        rtcInitIntersectContext(&context);
#endif
        // Double itself errs, and so may whoever computed the start.
        freeMetres = std::max(ray.freeMetres, 1e-11 * (1.0 + largest(from) + length));
        if (ray.fromSubsurface && traced.rule_.frontsBlock) freeMetres = std::max(freeMetres, traced.rule_.freeMetres);
    }

    [[nodiscard]] double floatError(const glm::dvec3& at) const {
        return kFloatError * (1.0 + std::max(largest(from), largest(at)));
    }

    bool accepts(std::uint32_t index) {
        if (index == own) return false;
        const Triangle& triangle = scene->triangles_[index];
        if (!triangle.drawn || scene->leavesThrough(triangle, way)) return false;
        Meeting meeting;
        if (!meets(triangle.corners, from, way, meeting)) return false;
        const double distance = meeting.t * length;
        if (!(distance > freeMetres && distance < length)) return false;
        const glm::dvec3& b = meeting.barycentrics;
        if (b.x < 0.0 || b.y < 0.0 || b.z < 0.0) {
            const double error = floatError(from + meeting.t * way);
            if (distance < kStrictNear * error || outsideMetres(triangle.corners, b) > error) return false;
        }
        if (triangle.mask != kNone && scene->isCutOut(triangle, b)) return false;
        nearest = std::min(nearest, distance);
        return true;
    }

    static void filter(const RTCFilterFunctionNArguments* arguments) {
        auto* query = reinterpret_cast<Query*>(const_cast<QueryContext*>(arguments->context));
        if (!query->accepts(RTCHitN_primID(arguments->hit, arguments->N, 0))) arguments->valid[0] = 0;
    }

    [[nodiscard]] RTCRay ray() const {
        const double back = 4.0 * floatError(from + way);
        const glm::dvec3 direction = way / length, start = from - back * direction;
        RTCRay out = {};
        out.org_x = static_cast<float>(start.x);
        out.org_y = static_cast<float>(start.y);
        out.org_z = static_cast<float>(start.z);
        out.dir_x = static_cast<float>(direction.x);
        out.dir_y = static_cast<float>(direction.y);
        out.dir_z = static_cast<float>(direction.z);
        out.tfar = static_cast<float>(length + 2.0 * back);
        out.mask = ~0u;
        return out;
    }
};

TracedScene::TracedScene(const Scene& scene, const Pose& pose, const glm::dvec3& origin, const SubsurfaceRule& rule)
    : scene_(scene), origin_(origin), rule_(rule), embree_(std::make_unique<Embree>()) {
    triangles_.reserve(triangleCount(scene));
    std::size_t deformed = 0;
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const std::vector<Primitive>& primitives = scene.meshes[instance.mesh].primitives;
        for (std::uint32_t p = 0; p < primitives.size(); ++p) {
            const bool posed = deformed < pose.deformed.size() && pose.deformed[deformed].instance == i &&
                               pose.deformed[deformed].primitive == p;
            append(primitives[p], posed ? pose.deformed[deformed].positions : primitives[p].positions,
                   pose.worldFromObject[i]);
            deformed += posed ? 1 : 0;
        }
    }
    build();
}

TracedScene::~TracedScene() = default;

void TracedScene::append(const Primitive& primitive, const std::vector<glm::vec3>& positions,
                         const glm::dmat4& worldFromObject) {
    const Material& material = scene_.materials[primitive.material];
    const TextureUse& use = material.baseColourTexture;
    const bool masked = material.alphaMode != AlphaMode::Opaque;
    const glm::dmat3 linear(worldFromObject);
    const bool drawn = hasArea(linear), mirrored = turnsWinding(linear);
    const double meshMetres = largestCoordinate(positions) *
                              std::max({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])});
    for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
        Triangle triangle;
        triangle.material = primitive.material;
        triangle.drawn = drawn;
        triangle.mirrored = mirrored;
        triangle.meshMetres = static_cast<float>(meshMetres);
        MaskCorners mask;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = primitive.indices[i + k];
            triangle.corners[k] = glm::dvec3(worldFromObject * glm::dvec4(glm::dvec3(positions[v]), 1.0)) - origin_;
            if (!masked) continue;
            const std::vector<glm::vec2>& texcoords = primitive.texcoords[use.texcoord == 1 ? 1 : 0];
            if (!texcoords.empty())
                mask.uv[k] = glm::dmat2(use.uvTransform) * glm::dvec2(texcoords[v]) + glm::dvec2(use.uvOffset);
            if (!primitive.colours.empty()) mask.alpha[k] = primitive.colours[v].a;
        }
        if (masked) {
            triangle.mask = static_cast<std::uint32_t>(masks_.size());
            masks_.push_back(mask);
        }
        triangles_.push_back(triangle);
    }
}

void TracedScene::build() {
    glm::dvec3 low(0.0), high(0.0);
    if (!triangles_.empty()) low = high = triangles_.front().corners[0];
    embree_->device = rtcNewDevice(nullptr);
    if (embree_->device == nullptr) throwEmbreeError(nullptr, "be started");
    embree_->scene = rtcNewScene(embree_->device);
    rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    const std::size_t count = std::max<std::size_t>(triangles_.size(), 1);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * count));
    auto* indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(float), count));
    if (vertices == nullptr || indices == nullptr) {
        rtcReleaseGeometry(geometry);
        throwEmbreeError(embree_->device, "hold the scene's triangles");
    }
    std::fill_n(vertices, 9 * count, 0.0f);
    for (std::uint32_t i = 0; i < 3 * count; ++i) indices[i] = i;
    for (const Triangle& triangle : triangles_) {
        for (const glm::dvec3& corner : triangle.corners) {
            for (int axis = 0; axis < 3; ++axis) *vertices++ = static_cast<float>(corner[axis]);
            low = glm::min(low, corner);
            high = glm::max(high, corner);
        }
    }
    reachMetres_ = glm::length(high - low);
    rtcSetGeometryIntersectFilterFunction(geometry, &Query::filter);
    rtcSetGeometryOccludedFilterFunction(geometry, &Query::filter);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(embree_->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(embree_->scene);
    if (rtcGetDeviceError(embree_->device) != RTC_ERROR_NONE)
        throw std::runtime_error("Embree could not take the scene's triangles.");
}

bool TracedScene::isSubsurface(std::uint32_t triangle) const {
    return scene_.materials[triangles_[triangle].material].subsurface;
}

// Shadowmaps are drawn without these fronts.
bool TracedScene::leavesThrough(const Triangle& triangle, const glm::dvec3& way) const {
    const Material& material = scene_.materials[triangle.material];
    if (rule_.frontsBlock || !material.subsurface || material.doubleSided) return false;
    const std::array<glm::dvec3, 3>& c = triangle.corners;
    const double along = glm::dot(glm::cross(c[1] - c[0], c[2] - c[0]), way);
    return triangle.mirrored ? along < 0.0 : along > 0.0;
}

// The rule of the G-buffer's and the shadowmaps' alpha test.
bool TracedScene::isCutOut(const Triangle& triangle, const glm::dvec3& barycentrics) const {
    const Material& material = scene_.materials[triangle.material];
    const MaskCorners& corners = masks_[triangle.mask];
    glm::dvec2 uv(0.0);
    double alpha = 0.0;
    for (int k = 0; k < 3; ++k) {
        uv += barycentrics[k] * corners.uv[static_cast<std::size_t>(k)];
        alpha += barycentrics[k] * corners.alpha[static_cast<std::size_t>(k)];
    }
    alpha *= static_cast<double>(material.baseColour.a);
    const TextureUse& use = material.baseColourTexture;
    if (use.image != kNone) alpha *= sampledAlpha(scene_.images[use.image], use, uv);
    return alpha < static_cast<double>(leastOpaqueAlpha(material));
}

bool TracedScene::blocked(const ShadowRay& ray) const {
    Query query(*this, ray);
    if (!(query.length > 0.0)) return false;
    RTCRay embreeRay = query.ray();
#if RTC_VERSION_MAJOR >= 4
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &query.context;
    rtcOccluded1(embree_->scene, &embreeRay, &arguments);
#else
    rtcOccluded1(embree_->scene, &query.context, &embreeRay);
#endif
    return std::isfinite(query.nearest);
}

double TracedScene::nearestBlocker(const ShadowRay& ray) const {
    Query query(*this, ray);
    if (!(query.length > 0.0)) return query.nearest;
    RTCRayHit hit = {};
    hit.ray = query.ray();
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &query.context;
    rtcIntersect1(embree_->scene, &hit, &arguments);
#else
    rtcIntersect1(embree_->scene, &query.context, &hit);
#endif
    return query.nearest;
}

}  // namespace gnomon::renderer
