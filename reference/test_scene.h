#pragma once
// Seeded input for tests: cameras, lights and receivers of small analytic scenes.
//
// What: cameras of every kind that the library accepts, lights strewn around one, and depth, face-normal and receiver-
// flag images made by casting a ray per pixel in double precision and storing what a host would.
//
// Limits: the same seed gives the same input on every machine up to the last bit of the mathematics library.

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "gnomon/scene.h"
#include "reference/receivers.h"
#include "reference/shapes.h"

namespace gnomon::reference {

/// Uniform numbers, defined here so that every standard library gives the same ones.
class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double uniform() { return static_cast<double>(engine_() >> 11) / 9007199254740992.0; }  ///< [0, 1)
    double uniform(double from, double to) { return from + (to - from) * uniform(); }
    std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(uniform() * count); }
    bool chance(double share) { return uniform() < share; }
    Vec3 inBox(Vec3 from, Vec3 to) { return {uniform(from.x, to.x), uniform(from.y, to.y), uniform(from.z, to.z)}; }
    Vec3 unitVector();

private:
    std::mt19937_64 engine_;
};

struct CameraSetup {
    Vec3 eye{0, 1.7, 6};
    Vec3 target{0, 1, 0};
    bool orthographic = false;
    bool reversed = true;
    bool infiniteFar = true;  ///< perspective only
    bool looksDownPlusZ = false;
    double jitterXPx = 0, jitterYPx = 0;
    double offCentre = 0;  ///< shifts the projection sideways by this much of its half-width
    double verticalFieldOfView = 1.0;
    double orthographicHalfHeight = 5;
    double nearMetres = 0.05;
    double farMetres = 200;  ///< unused where infinite
    std::string name = "perspective reversed infinite";
};

Camera makeCamera(const CameraSetup& setup, std::uint32_t widthPx, std::uint32_t heightPx);
/// One of every kind: {perspective, orthographic} x {reversed, standard} x {finite, infinite}, some of them jittered,
/// off-centre or looking down +z; each named.
std::vector<CameraSetup> allCameraKinds();
/// A random kind at a random place in the room of makeRoom(), looking into it.
CameraSetup randomCamera(Random& random);

/// A floor, a back wall, balls and boxes within about 12 m of the origin; some shapes subsurface, some with other
/// receiver masks.
Shapes makeRoom(Random& random, std::uint32_t objects = 12);

struct LightSetup {
    std::uint32_t count = 50;
    double castingShare = 0.5;  ///< of points and spots
    double spotShare = 0.5;
    double directionalShare = 0.02;
    double maxRangeMetres = 6;
    double spreadMetres = 14;               ///< half the side of the cube, around the eye and the room, that holds them
    double maxOuterAngle = 1.2;             ///< radians
    double fadingShare = 0.2;               ///< with distance fades that matter
    std::uint32_t suns = 0;                 ///< of `count`, the last ones: directional lights that cast
    double maxSourceRadius = 0.1;           ///< metres; suns: a tenth of that in radians
    FilterSet filters = only(Filter::Pcf);  ///< the lights take turns
    std::uint32_t pcssPresets = 1;          ///< likewise
};
/// Random ones, and some on purpose: at the eye, crossing the near plane, touching the view's side, behind the camera,
/// with a range derived from intensity, with a tiny range, with a very large one.
std::vector<Light> makeLights(Random& random, const CameraSetup& camera, const LightSetup& setup);

/// What a host would render of the shapes. Pixels with no hit between near and far plane are background.
Receivers renderReceivers(const Shapes& shapes, const Camera& camera, std::uint32_t widthPx, std::uint32_t heightPx);

}  // namespace gnomon::reference
