// Soft shadows and cascades against closed forms.
#include <gtest/gtest.h>

#include "reference/cascades.h"
#include "reference/generate_shadows.h"
#include "reference/pcss_quad.h"
#include "reference/test_scene.h"
#include "reference/test_shadows.h"

namespace gnomon::reference {
namespace {

constexpr int kPatterns = 48;  // over which means are taken

/// One light, its views and atlases, and receivers that look where the test wants.
struct Stage {
    Light light;
    LightModel model;
    ShadowInput input;

    Stage(const Shapes& shapes, const Light& given, const ShadowSetup& setup) : light(given) {
        light.rangeMetres = 50;
        TestShadows shadows = buildShadows(shapes, std::span(&light, 1), setup);
        input.pcssPresets[0] = {32, 64};
        input.views = makeShadowViewModels(shadows.views);
        input.atlases = std::move(shadows.atlases);
        CameraSetup camera;
        model = makeLightModels(std::span(&light, 1), shadows.lightViews,
                                makeCameraModel(makeCamera(camera, 64, 64), 64, 64))[0];
    }
    [[nodiscard]] Visibility at(Vec3 position, Vec3 normal, std::uint32_t pattern = 0) const {
        Pixel pixel;
        pixel.x = pattern % 8;
        pixel.y = pattern / 8;
        pixel.background = false;
        pixel.position = position;
        pixel.positionError = 1e-7;
        pixel.hasFaceNormal = true;
        pixel.faceNormal = normal;
        return visibility(model, pixel, input);
    }
    [[nodiscard]] Visibility onFloor(double x, double z, std::uint32_t pattern = 0) const {
        return at({x, 0, z}, {0, 1, 0}, pattern);
    }
    /// Middle of the interval, mean over patterns.
    [[nodiscard]] double mean(Vec3 position, Vec3 normal) const {
        double sum = 0;
        for (std::uint32_t i = 0; i < kPatterns; ++i) {
            const Visibility v = at(position, normal, i);
            sum += 0.5 * (v.min + v.max);
        }
        return sum / kPatterns;
    }
};

Light lamp(LightType type, Vec3 position, Vec3 direction, double sourceRadius) {
    Light light;
    light.type = type;
    const double p[3] = {position.x, position.y, position.z}, d[3] = {direction.x, direction.y, direction.z};
    for (int i = 0; i < 3; ++i) {
        light.position[i] = static_cast<float>(p[i]);
        light.direction[i] = static_cast<float>(d[i]);
    }
    light.sourceRadius = static_cast<float>(sourceRadius);
    return light;
}

/// Share of a disk of radius 1 on one side of a line at distance t from its middle.
double shareOfDisk(double t) {
    t = std::clamp(t, -1.0, 1.0);
    return 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / kPi;
}

/// A floor, and at some height a thin board over all x < 0.
Shapes boardOverFloor(double height) {
    return {plane({0, 0, 0}, {0, 1, 0}), box({-4, height - 0.001, -4}, {0, height, 4})};
}

/// Visibility across the shadow's edge, whose penumbra should reach `half` metres to both sides.
void expectPenumbra(const Stage& stage, double half) {
    for (double t = -0.9; t <= 0.91; t += 0.15)
        EXPECT_NEAR(stage.mean({t * half, 0, 0.1}, {0, 1, 0}), shareOfDisk(t), 0.05) << "at " << t << " of " << half;
    for (const double t : {-3.0, -1.6}) EXPECT_EQ(stage.onFloor(t * half, 0.1).max, 0.0) << t << " of " << half;
    for (const double t : {1.6, 3.0}) EXPECT_EQ(stage.onFloor(t * half, 0.1).min, 1.0) << t << " of " << half;
}

// Similar triangles: a disk of radius R at 4 m, an edge at h: the penumbra is 2 R h / (4 - h) wide.
TEST(SoftShadows, PenumbraOfAnEdgeUnderALamp) {
    for (const bool reversed : {true, false}) {
        for (const double height : {0.5, 1.0, 1.5}) {
            ShadowSetup setup;
            setup.viewSizePx = 400;
            setup.reversed = reversed;
            setup.infiniteFar = reversed;
            const double radius = 0.3;
            Stage stage(boardOverFloor(height), lamp(LightType::Spot, {0, 4, 0}, {0, -1, 0}, radius), setup);
            for (const Filter filter : {Filter::Pcss, Filter::PcssShared}) {
                stage.model.filter = filter;
                expectPenumbra(stage, radius * height / (4 - height));
            }
        }
    }
}

// A sun of angular radius a: tan(a) h to each side of the edge, whatever the distance of the sun.
TEST(SoftShadows, PenumbraOfAnEdgeUnderTheSun) {
    for (const bool reversed : {true, false}) {
        for (const double height : {0.5, 1.5}) {
            ShadowSetup setup;
            setup.viewSizePx = 400;
            setup.reversed = reversed;
            setup.cascadeCentre = {0, 0, 0};
            setup.cascadeHalfExtentMetres = 2;
            Light sun = lamp(LightType::Directional, {}, {0, -1, 0}, 0.1);
            setup.cascades = 1;
            expectPenumbra(Stage(boardOverFloor(height), sun, setup), std::tan(0.1) * height);
        }
    }
}

// Off the view's axis the source is seen at a slant, and the penumbra on the floor is wider across than along.
TEST(SoftShadows, SourceIsADiskOffTheAxis) {
    ShadowSetup setup;
    setup.viewSizePx = 600;
    // The lamp shines along a diagonal; the floor point below the edge is far off the axis.
    const Light light = lamp(LightType::Spot, {0, 4, 0}, normalize(Vec3{0, -1, 0.9}), 0.3);
    const Stage stage(boardOverFloor(1.0), light, setup);
    // Seen from below the edge the source is a disk facing along the view's axis: its extent across x is its radius.
    for (double t = -0.75; t <= 0.76; t += 0.25)
        EXPECT_NEAR(stage.mean({0.1 * t, 0, 0.1}, {0, 1, 0}), shareOfDisk(t), 0.07) << t;
}

// A ball of radius r at height c: the floor's umbra reaches r H / (H - c) - R c / (H - c) at most, and at least what a
// disk at the ball's top leaves; likewise the penumbra's end.
TEST(SoftShadows, UmbraAndPenumbraOfABall) {
    const double lampHeight = 4, ballHeight = 1, ballRadius = 0.4, source = 0.25;
    ShadowSetup setup;
    setup.viewSizePx = 400;
    const Shapes shapes = {plane({0, 0, 0}, {0, 1, 0}), ball({0, ballHeight, 0}, ballRadius)};
    for (const LightType type : {LightType::Spot, LightType::Point}) {
        const Stage stage(shapes, lamp(type, {0, lampHeight, 0}, {0, -1, 0}, source), setup);
        const double edge = lampHeight * std::tan(std::asin(ballRadius / (lampHeight - ballHeight)));
        const auto half = [&](double height) { return source * height / (lampHeight - height); };
        const double top = ballHeight + ballRadius;
        Random random(3);
        int partial = 0;
        for (std::uint32_t i = 0; i < 400; ++i) {
            const double distance = random.uniform(0, 2), angle = random.uniform(0, 2 * kPi);
            const Visibility v = stage.onFloor(distance * std::cos(angle), distance * std::sin(angle), i);
            if (distance < edge - half(top) - 0.03) {
                EXPECT_EQ(v.max, 0.0) << distance;
            } else if (distance > edge + half(top) + 0.03) {
                EXPECT_EQ(v.min, 1.0) << distance;
            } else if (std::abs(distance - edge) < 0.5 * half(ballHeight)) {
                EXPECT_GT(v.max, 0.0) << distance;
                EXPECT_LT(v.min, 1.0) << distance;
                ++partial;
            }
        }
        EXPECT_GT(partial, 10);
    }
}

// A point light's penumbra across the seam of two faces is what a spot sees that has no seam there.
TEST(SoftShadows, SeamOfFacesIsNotSeen) {
    const Shapes shapes = {plane({0, 0, 0}, {0, 1, 0}), box({0.5, 1.0, -0.1}, {4, 1.001, 4})};
    ShadowSetup setup;
    setup.viewSizePx = 300;
    const Stage faces(shapes, lamp(LightType::Point, {0, 3, 0}, {}, 0.3), setup);
    const Stage whole(shapes, lamp(LightType::Spot, {0, 3, 0}, normalize(Vec3{1, -1, 0}), 0.3), setup);
    // Along x = 3 lies the seam of the faces +X and -Y; the shadow's edge crosses it.
    double least = 1, most = 0;
    for (const double x : {2.9, 2.97, 3.0, 3.03, 3.1}) {
        for (double z = -0.5; z <= 0.3; z += 0.1) {
            const double seamed = faces.mean({x, 0, z}, {0, 1, 0}), seamless = whole.mean({x, 0, z}, {0, 1, 0});
            EXPECT_NEAR(seamed, seamless, 0.12) << x << ' ' << z;
            least = std::min(least, seamed);
            most = std::max(most, seamed);
        }
    }
    EXPECT_LT(least, 0.1);
    EXPECT_GT(most, 0.9);
}

Stage sunOverFloor(const Shapes& shapes, double angle, std::uint32_t cascades, bool reversed = true) {
    ShadowSetup setup;
    setup.viewSizePx = 200;
    setup.reversed = reversed;
    setup.cascadeCentre = {0.3, 0, 0.2};
    setup.cascadeHalfExtentMetres = 2;
    Light sun = lamp(LightType::Directional, {}, normalize(Vec3{0.5, -1, 0.3}), angle);
    setup.cascades = cascades;
    return Stage(shapes, sun, setup);
}

// A bare floor is lit in and between all cascades, by every filter: neither acne nor seams.
TEST(Cascades, FloorIsLit) {
    for (const bool reversed : {true, false}) {
        Stage stage = sunOverFloor({plane({0, 0, 0}, {0, 1, 0})}, 0.02, 3, reversed);
        Random random(4);
        for (const Filter filter : {Filter::Hard, Filter::Pcf, Filter::Pcss}) {
            stage.model.filter = filter;
            stage.input.pcfRadius = 3;
            stage.input.pcssPresets[0] = {8, 12};
            for (std::uint32_t i = 0; i < 400; ++i) {
                const Visibility v = stage.onFloor(random.uniform(-25, 25), random.uniform(-25, 25), i);
                EXPECT_NEAR(v.min, 1, 1e-12);
                EXPECT_NEAR(v.max, 1, 1e-12);
            }
        }
    }
}

// Along the middle of a wide penumbra visibility stays one half, through three cascades of very different texels.
TEST(Cascades, PenumbraGoesOnThroughTheSeams) {
    // A board 3 m up whose edge runs along x; the sun throws it 0.9 m along z.
    const Shapes shapes = {plane({0, 0, 0}, {0, 1, 0}), box({-60, 2.999, -60}, {60, 3, 0})};
    const Stage stage = sunOverFloor(shapes, 0.1, 3);
    std::size_t used[3] = {};
    for (double x = -12; x <= 12; x += 0.5) {
        const Vec3 p = {x, 0, 0.9};
        EXPECT_NEAR(stage.mean(p, {0, 1, 0}), 0.5, 0.1) << x;
        Pixel pixel;
        pixel.position = p;
        for (std::size_t i = 0; i < 3; ++i)
            if (fitIn(stage.input.views[i], pixel).holds == Verdict::Must) {
                ++used[i];
                break;
            }
    }
    for (const std::size_t count : used) EXPECT_GT(count, 3u);
}

// In a shadow that covers everything: dark, toward the last cascade's border ever lighter, and lit outside.
TEST(Cascades, LastOneFadesAway) {
    const Shapes shapes = {plane({0, 0, 0}, {0, 1, 0}), box({-90, 2.999, -90}, {90, 3, 90})};
    for (const std::uint32_t cascades : {1u, 3u}) {
        const Stage stage = sunOverFloor(shapes, 0.01, cascades);
        int dark = 0, between = 0, lit = 0;
        for (double x = 0; x < 30; x += 0.0625) {
            Pixel pixel;
            pixel.position = {x, 0, 0.2};
            const Visibility v = stage.onFloor(x, 0.2);
            const CascadeFit fit = fitIn(stage.input.views[cascades - 1], pixel);
            if (fit.holds == Verdict::May) continue;
            const double expected = fit.holds == Verdict::Never ? 1.0 : fit.blend.middle();
            EXPECT_NEAR(v.min, expected, 1e-4) << x;
            EXPECT_NEAR(v.max, expected, 1e-4) << x;
            ++(expected == 0 ? dark : expected == 1 ? lit : between);
        }
        EXPECT_GT(dark, 20);
        EXPECT_GT(between, 1);
        EXPECT_GT(lit, 20);
    }
}

TEST(Cascades, MarginAndBlend) {
    ShadowView view = makeShadowView({0, 5, 0}, {0, -1, 0}, {0, 0, 1}, 2.0, 1.0, 9.0, true, true);
    view.xPx = 10;
    view.yPx = 20;
    view.widthPx = view.heightPx = 48;  // 12 texels per metre; 20 texels from the middle to the margin
    const ShadowViewModel model = makeShadowViewModels(std::span(&view, 1))[0];
    const auto fit = [&](Vec3 p) {
        Pixel pixel;
        pixel.position = p;
        return fitIn(model, pixel);
    };
    EXPECT_EQ(fit({0, 0, 0}).holds, Verdict::Must);
    EXPECT_EQ(fit({19.9 / 12, 0, 0}).holds, Verdict::Must);
    EXPECT_EQ(fit({20.1 / 12, 0, 0}).holds, Verdict::Never);
    EXPECT_EQ(fit({0, 0, -20.1 / 12}).holds, Verdict::Never);
    EXPECT_EQ(fit({0, 4.1, 0}).holds, Verdict::Never);  // before the near plane
    EXPECT_EQ(fit({0, -4.1, 0}).holds, Verdict::Never);
    EXPECT_EQ(fit({17.9 / 12, 0, 0}).blend.hi, 0.0);
    EXPECT_NEAR(fit({0, 0, 19.0 / 12}).blend.middle(), 0.5, 1e-4);
}

// --- One search for four pixels --------------------------------------------------------------------------------------

/// A quad of pixels on the floor, `apart` metres from each other, under a board's edge.
struct Quad {
    Stage stage;
    std::array<Pixel, 4> pixels;
    explicit Quad(double x, double apart = 0.01, LightType type = LightType::Spot, double y = 0)
        : stage(boardOverFloor(1.0), lamp(type, {0, 4, 0}, {0, -1, 0}, 0.3), {.viewSizePx = 400}) {
        stage.model.filter = Filter::PcssShared;
        for (std::uint32_t i = 0; i < 4; ++i) {
            Pixel& pixel = pixels[i];
            pixel.x = 6 + (i & 1u);
            pixel.y = 10 + (i >> 1);
            pixel.background = false;
            pixel.position = {x + apart * ((i & 1u) - 0.5), y, 0.1 + apart * ((i >> 1) - 0.5)};
            pixel.positionError = 1e-7;
            pixel.hasFaceNormal = true;
            pixel.faceNormal = {0, 1, 0};
        }
    }
    [[nodiscard]] QuadFinding find() const {
        return findQuad(stage.model, {&pixels[0], &pixels[1], &pixels[2], &pixels[3]}, stage.input);
    }
    [[nodiscard]] bool ownAlone() const {
        const QuadFinding found = find();
        return found.mayBeOwn && !found.mayBeDark && !found.mayBeLit && found.radii.empty() && !found.unknown;
    }
    [[nodiscard]] bool shares() const { return !find().mayBeOwn; }
};

// The radius that a quad finds is the penumbra's: R h / (4 - h) at the floor, seen from 4 m through the map.
TEST(SharedSearch, FindsDarkLitAndTheRadius) {
    const double half = 0.3 * 1.0 / 3.0;
    EXPECT_TRUE(Quad(-1.8).find().mayBeDark);  // as far as the search reaches
    EXPECT_TRUE(Quad(-1.8).find().radii.empty());
    EXPECT_TRUE(Quad(3 * half).find().mayBeLit);
    EXPECT_TRUE(Quad(3 * half).find().radii.empty());
    const Quad quad(0);
    const QuadFinding found = quad.find();
    EXPECT_FALSE(found.mayBeOwn || found.mayBeDark || found.mayBeLit || found.unknown);
    ASSERT_EQ(found.radii.size(), 1u);
    const double texels = half / 4 * quad.stage.input.views[0].pxPerMetreX;
    EXPECT_NEAR(found.radii[0].px.middle(), texels, 0.05 * texels);
    EXPECT_LT(found.radii[0].px.width(), 0.01);
    for (const double px : {found.radii[0].px.lo, found.radii[0].px.hi})
        EXPECT_NEAR(px * 1024, std::round(px * 1024), 0.01);
}

// From as far aside as the farthest of the four, a search sees what that one sees.
TEST(SharedSearch, ReachesAsFarAsItsPixelsLieApart) {
    const double half = 0.1, apart = 0.2;
    const Quad wide(1.4 * half, apart);  // its middle is lit, and its left pixels lie in the penumbra
    Quad narrow(1.4 * half, 0.001);
    EXPECT_FALSE(narrow.find().mayBeOwn);
    EXPECT_TRUE(narrow.find().mayBeLit);
    EXPECT_FALSE(wide.find().mayBeLit);
    EXPECT_FALSE(wide.find().radii.empty());
}

TEST(SharedSearch, SharesInOnePlaneAndOneView) {
    EXPECT_TRUE(Quad(0).shares());
    Quad quad(0);
    quad.pixels[3].position.y = 0.02;  // a step
    EXPECT_TRUE(quad.ownAlone());
    quad.pixels[3].offPlaneMetres = 0.02;  // which its depth is too coarse to tell
    EXPECT_TRUE(quad.shares());
    quad = Quad(0);
    quad.pixels[1].subsurface = true;
    EXPECT_TRUE(quad.ownAlone());
    for (Pixel& pixel : quad.pixels) pixel.subsurface = true;
    EXPECT_TRUE(quad.shares());
    // A pixel that does not ask takes no part, whatever it is.
    quad = Quad(0);
    quad.pixels[2].position.y = 1.5;
    quad.pixels[2].faceNormal = {0, -1, 0};
    EXPECT_TRUE(quad.shares());
    quad.pixels[2].faceNormal = {0, 1, 0};
    EXPECT_TRUE(quad.ownAlone());
    quad.pixels[2].background = true;
    EXPECT_TRUE(quad.shares());
    // Across the seam of two faces, which lies over x = 4 below a point light 4 m up.
    EXPECT_TRUE(Quad(4.0, 0.01, LightType::Point).ownAlone());
    EXPECT_TRUE(Quad(3.9, 0.01, LightType::Point).shares());
    // Too close to call: both.
    Quad close(4.005, 0.01, LightType::Point);
    EXPECT_TRUE(close.find().mayBeOwn);
    EXPECT_TRUE(close.find().mayBeLit || close.find().mayBeDark || !close.find().radii.empty());
}

// A flat quad is decided by a quarter of how far it reaches.
TEST(SharedSearch, FlatnessIsAQuarter) {
    // Two pixels that ask, 2 d apart: each lies d from the middle, and d sin(tilt) off its plane.
    for (const double sine : {0.2, 0.24, 0.26, 0.3}) {
        Quad quad(0);
        quad.pixels[2].background = quad.pixels[3].background = true;
        for (std::size_t i = 0; i < 2; ++i) quad.pixels[i].faceNormal = {-sine, std::sqrt(1 - sine * sine), 0};
        EXPECT_EQ(quad.shares(), sine < 0.25) << sine;
        EXPECT_EQ(quad.ownAlone(), sine > 0.25) << sine;
    }
}

TEST(SharedSearch, TapsFollowTheRadius) {
    const auto taps = [](int most, double radius) {
        const TapRange range = tapsForRadius(most, radius);
        EXPECT_EQ(range.from, range.to) << radius;
        return range.from;
    };
    EXPECT_EQ(taps(25, 0), 9);   // 8.3
    EXPECT_EQ(taps(25, 2), 12);  // 11.5
    EXPECT_EQ(taps(25, 4), 21);  // 20.8
    EXPECT_EQ(taps(25, 5), 25);  // all
    EXPECT_EQ(taps(64, 40), 64);
    EXPECT_EQ(taps(1, 3), 1);
    const TapRange either = tapsForRadius(24, 0);  // 8 exactly
    EXPECT_EQ(either.from, 8);
    EXPECT_EQ(either.to, 9);
}

TEST(DiskDirections, AreTurnedByPixelAndFrame) {
    double x = 0, y = 0;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const std::vector<DiskDirection> all = diskDirections(i % 40, i / 40, 77, 64);
        ASSERT_EQ(all.size(), 64u);
        for (std::size_t j = 0; j < all.size(); ++j) {
            EXPECT_NEAR(std::hypot(all[j].x.middle(), all[j].y.middle()), 1, 1e-5);
            EXPECT_LT(all[j].x.width(), 1e-4);
        }
        EXPECT_NEAR(all[0].x.middle() * all[1].x.middle() + all[0].y.middle() * all[1].y.middle(),
                    std::cos(kPi * (3 - std::sqrt(5.0))), 1e-5);
        x += all[0].x.middle();
        y += all[0].y.middle();
    }
    EXPECT_LT(std::hypot(x, y) / 1000, 0.02);  // no direction is preferred
    EXPECT_GT(std::abs(diskDirections(3, 4, 0, 1)[0].x.middle() - diskDirections(3, 4, 1u << 31, 1)[0].x.middle()),
              1e-3);
}

}  // namespace
}  // namespace gnomon::reference
