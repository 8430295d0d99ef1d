// See test_scene.h.
#include "reference/test_scene.h"

#include "gpu_interface/numbers.h"
#include "reference/shadow_views.h"

namespace gnomon::reference {
namespace {

void store(Vec3 v, float out[3]) {
    out[0] = static_cast<float>(v.x);
    out[1] = static_cast<float>(v.y);
    out[2] = static_cast<float>(v.z);
}

/// Rows are the axes of the view: right, up or down, and the one that keeps it a rotation.
Mat4 viewMatrix(const CameraSetup& setup) {
    const Vec3 forward = normalize(setup.target - setup.eye);
    const Vec3 helper = std::abs(forward.y) > 0.99 ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
    const Vec3 right = normalize(cross(forward, helper));
    const Vec3 up = cross(right, forward);
    const Vec3 rows[3] = {right, setup.looksDownPlusZ ? -up : up, setup.looksDownPlusZ ? forward : -forward};
    Mat4 view;
    for (int i = 0; i < 3; ++i) {
        view.m[i][0] = rows[i].x;
        view.m[i][1] = rows[i].y;
        view.m[i][2] = rows[i].z;
        view.m[i][3] = -dot(rows[i], setup.eye);
    }
    view.m[3][3] = 1;
    return view;
}

Light randomLight(Random& random, const CameraSetup& camera, const LightSetup& setup) {
    Light light;
    const double kind = random.uniform();
    light.type = kind < setup.directionalShare                     ? LightType::Directional
                 : kind < setup.directionalShare + setup.spotShare ? LightType::Spot
                                                                   : LightType::Point;
    const Vec3 middle = random.chance(0.5) ? camera.eye : Vec3{0, 1.5, 0};
    const Vec3 half = {setup.spreadMetres, random.chance(0.5) ? 2.0 : setup.spreadMetres, setup.spreadMetres};
    store(random.inBox(middle - half, middle + half), light.position);
    store(random.unitVector(), light.direction);
    light.rangeMetres = static_cast<float>(random.uniform(0.2, setup.maxRangeMetres));
    light.outerConeAngle = static_cast<float>(random.uniform(0.05, setup.maxOuterAngle));
    light.sourceRadius = static_cast<float>(random.uniform(0.0, setup.maxSourceRadius));
    light.intensity = static_cast<float>(random.uniform(0.1, 100.0));
    light.mask = random.chance(0.8) ? 0xFF : static_cast<std::uint8_t>(random.below(256));
    light.casts = light.type != LightType::Directional && random.chance(setup.castingShare);
    if (random.chance(setup.fadingShare)) {
        light.fadeStartMetres = static_cast<float>(random.uniform(2, 15));
        light.fadeEndMetres = light.fadeStartMetres + static_cast<float>(random.uniform(0.5, 10));
        light.shadowFadeStartMetres = static_cast<float>(random.uniform(1, 10));
        light.shadowFadeEndMetres = light.shadowFadeStartMetres + static_cast<float>(random.uniform(0.5, 10));
    }
    return light;
}

/// In turn, so that the random numbers are the same whatever the filters.
void takeFilter(Light& light, std::uint32_t index, const LightSetup& setup) {
    std::vector<Filter> filters;
    for (const Filter filter : {Filter::Hard, Filter::Pcf, Filter::Pcss, Filter::Host, Filter::PcssShared})
        if ((setup.filters & only(filter)) != 0) filters.push_back(filter);
    if (filters.empty()) return;
    const auto count = static_cast<std::uint32_t>(filters.size());
    light.filter = filters[index % count];
    light.pcssPreset = static_cast<std::uint8_t>(index / count % setup.pcssPresets);
}

}  // namespace

Vec3 Random::unitVector() {
    const double z = uniform(-1, 1), angle = uniform(0, 2 * kPi), radius = std::sqrt(1 - z * z);
    return {radius * std::cos(angle), radius * std::sin(angle), z};
}

Camera makeCamera(const CameraSetup& setup, std::uint32_t widthPx, std::uint32_t heightPx) {
    Camera camera;
    camera.deviceDepth = setup.reversed ? DeviceDepth::ReversedZ : DeviceDepth::StandardZ;
    toColumnMajor(viewMatrix(setup), camera.viewFromWorld);
    // In terms of depth = sign * z: perspective clip.w = depth, clip.z = a depth + b; orthographic clip.z = a + b
    // depth.
    const double sign = setup.looksDownPlusZ ? 1.0 : -1.0;
    const double down = setup.looksDownPlusZ ? 1.0 : -1.0;  // view y points down or up; clip y points down
    const double farMetres = setup.infiniteFar && !setup.orthographic ? kInfinity : setup.farMetres;
    const auto [a, b] = depthFromLinear(setup.nearMetres, farMetres, setup.orthographic, setup.reversed);
    const double aspect = static_cast<double>(widthPx) / heightPx;
    const double halfHeight =
        setup.orthographic ? setup.orthographicHalfHeight : std::tan(0.5 * setup.verticalFieldOfView);
    const double shiftX = setup.offCentre + 2.0 * setup.jitterXPx / widthPx;
    const double shiftY = 2.0 * setup.jitterYPx / heightPx;
    Mat4 clip;
    clip.m[0][0] = 1.0 / (halfHeight * aspect);
    clip.m[1][1] = down / halfHeight;
    if (setup.orthographic) {
        clip.m[0][3] = shiftX;
        clip.m[1][3] = shiftY;
        clip.m[2][2] = b * sign;
        clip.m[2][3] = a;
        clip.m[3][3] = 1;
    } else {
        clip.m[0][2] = shiftX * sign;
        clip.m[1][2] = shiftY * sign;
        clip.m[2][2] = a * sign;
        clip.m[2][3] = b;
        clip.m[3][2] = sign;
    }
    toColumnMajor(clip, camera.clipFromView);
    return camera;
}

std::vector<CameraSetup> allCameraKinds() {
    std::vector<CameraSetup> result;
    for (const bool orthographic : {false, true}) {
        for (const bool reversed : {true, false}) {
            for (const bool infinite : {true, false}) {
                if (orthographic && infinite) continue;
                CameraSetup setup;
                setup.orthographic = orthographic;
                setup.reversed = reversed;
                setup.infiniteFar = infinite;
                // Jitter and off-centre shifts alternate, so that each depth kind is seen with and without.
                if (infinite != reversed) {
                    setup.jitterXPx = 0.37;
                    setup.jitterYPx = -0.21;
                }
                setup.looksDownPlusZ = !reversed;
                setup.offCentre = infinite ? 0.0 : 0.3;
                setup.name = std::string(orthographic ? "orthographic" : "perspective") +
                             (reversed ? " reversed" : " standard") + (infinite ? " infinite" : " finite");
                result.push_back(setup);
            }
        }
    }
    return result;
}

CameraSetup randomCamera(Random& random) {
    const std::vector<CameraSetup> kinds = allCameraKinds();
    CameraSetup setup = kinds[random.below(static_cast<std::uint32_t>(kinds.size()))];
    setup.eye = random.inBox({-6, 0.5, 2}, {6, 5, 9});
    setup.target = random.inBox({-3, 0, -4}, {3, 2, 0});
    setup.verticalFieldOfView = random.uniform(0.4, 1.8);
    setup.orthographicHalfHeight = random.uniform(1, 8);
    setup.jitterXPx = random.uniform(-0.5, 0.5);
    setup.jitterYPx = random.uniform(-0.5, 0.5);
    setup.nearMetres = random.chance(0.3) ? random.uniform(0.5, 2.0) : random.uniform(0.05, 0.2);
    return setup;
}

Shapes makeRoom(Random& random, std::uint32_t objects) {
    Shapes shapes = {plane({0, 0, 0}, {0, 1, 0}), plane({0, 0, -8}, {0, 0, 1})};
    for (std::uint32_t i = 0; i < objects; ++i) {
        const Vec3 at = random.inBox({-6, 0.2, -7}, {6, 3, 2});
        if (random.chance(0.5)) {
            shapes.push_back(ball(at, random.uniform(0.15, 0.9)));
        } else {
            const Vec3 half = random.inBox({0.1, 0.1, 0.1}, {0.8, 0.8, 0.8});
            shapes.push_back(box(at - half, at + half));
        }
        if (random.chance(0.3)) shapes.back().receiverMask = static_cast<std::uint8_t>(random.below(256));
        shapes.back().subsurface = random.chance(0.25);
    }
    return shapes;
}

std::vector<Light> makeLights(Random& random, const CameraSetup& camera, const LightSetup& setup) {
    std::vector<Light> lights;
    for (std::uint32_t i = 0; i < setup.count; ++i) {
        Light light = randomLight(random, camera, setup);
        const Vec3 forward = normalize(camera.target - camera.eye);
        switch (i) {  // the ones on purpose
            case 0:
                store(camera.eye, light.position);
                break;
            case 1:
                store(camera.eye + forward * camera.nearMetres, light.position);
                break;
            case 2:
                store(camera.eye - forward * (0.9 * light.rangeMetres), light.position);
                break;
            case 3:
                store(camera.eye - forward * (1.5 * light.rangeMetres), light.position);
                break;
            case 4:
                light.rangeMetres = 0;
                light.intensity = 0.3f;
                break;
            case 5:
                light.rangeMetres = 0.01f;
                break;
            case 6:
                light.rangeMetres = 300;
                break;
            default:
                break;
        }
        if (i + setup.suns >= setup.count) {
            light.type = LightType::Directional;
            light.casts = true;
            light.sourceRadius *= 0.1f;
            store(normalize(random.inBox({-1, -1.5, -1}, {1, -0.3, 1})), light.direction);
        }
        takeFilter(light, i, setup);
        lights.push_back(light);
    }
    return lights;
}

Receivers renderReceivers(const Shapes& shapes, const Camera& camera, std::uint32_t widthPx, std::uint32_t heightPx) {
    const CameraModel model = makeCameraModel(camera, widthPx, heightPx);
    Receivers receivers;
    receivers.widthPx = widthPx;
    receivers.heightPx = heightPx;
    for (std::uint32_t y = 0; y < heightPx; ++y) {
        for (std::uint32_t x = 0; x < widthPx; ++x) {
            // The pixel's ray, from the near plane on; one length of its direction is one metre of view depth.
            const Vec3 origin = worldAtViewDepth(model, x + 0.5, y + 0.5, model.nearMetres);
            const Vec3 direction = worldAtViewDepth(model, x + 0.5, y + 0.5, model.nearMetres + 1.0) - origin;
            const auto hit = trace(shapes, origin, direction, 0.0, model.farMetres - model.nearMetres);
            std::uint16_t normal[2] = {};
            if (hit) encodeOctahedral(hit->normal, normal);
            receivers.faceNormals.insert(receivers.faceNormals.end(), {normal[0], normal[1]});
            const double depth = hit ? pixelFromWorld(model, hit->position).deviceDepth : model.backgroundDepth;
            receivers.depth.push_back(static_cast<float>(depth));
            const std::uint8_t bits =
                hit && shapes[hit->shape].subsurface ? static_cast<std::uint8_t>(gpu::kReceiverSubsurfaceBit) : 0;
            receivers.receiverFlags.push_back(hit ? shapes[hit->shape].receiverMask : 0xFF);
            receivers.receiverFlags.push_back(bits);
        }
    }
    return receivers;
}

}  // namespace gnomon::reference
