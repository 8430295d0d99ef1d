// The minimal host, run as a program on every Vulkan device: it must succeed, keep validation silent, and make the
// picture that an independent ray caster in double precision expects.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

constexpr int kWidthPx = 480, kHeightPx = 270;

struct Outcome {
    int exitCode = -1;
    std::string output;
    std::vector<std::uint8_t> picture;  // rgb; empty if none was written
};

std::string readFile(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

Outcome runProgram(int device, const std::string& pools = "", const std::string& environment = "") {
    const auto folder = std::filesystem::path(testing::TempDir()) / "gnomon_minimal_host";
    std::filesystem::create_directories(folder);
    const auto picture = folder / "picture.ppm", log = folder / "log.txt";
    std::filesystem::remove(picture);
    const std::string command =
        "VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation "
        "VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT " +
        environment + " " GNOMON_MINIMAL_HOST " " + picture.string() + " " + std::to_string(device) + " " + pools +
        " >" + log.string() + " 2>&1";
    Outcome run;
    const int status = std::system(command.c_str());
    run.exitCode = status == 0 ? 0 : 1;
    run.output = readFile(log);
    const std::string header = "P6\n480 270\n255\n", bytes = readFile(picture);
    if (bytes.size() == header.size() + 3u * kWidthPx * kHeightPx && bytes.starts_with(header)) {
        run.picture.assign(bytes.begin() + static_cast<std::ptrdiff_t>(header.size()), bytes.end());
    }
    return run;
}

struct Found {
    int index;
    Outcome run;
};

// What the program makes of each device that the loader lists, found by asking for one after the other.
std::vector<Found> runOnEveryDevice() {
    std::vector<Found> found;
    for (int i = 0; i < 16; ++i) {
        Outcome run = runProgram(i);
        if (run.output.find("no such Vulkan device") != std::string::npos) break;
        if (run.output.find("lacks Vulkan 1.3") != std::string::npos ||
            run.output.find("no graphics queue") != std::string::npos) {
            std::printf("skipped: device %d: %s", i, run.output.c_str());
            continue;
        }
        found.push_back({i, std::move(run)});
    }
    return found;
}

// --- The expectation, written from the description of the scene and from nothing of the library ----------------------

struct V {
    double x = 0, y = 0, z = 0;
};
V operator+(V a, V b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
V operator-(V a, V b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
V operator*(V a, double s) {
    return {a.x * s, a.y * s, a.z * s};
}
double dot(V a, V b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
V unit(V a) {
    return a * (1.0 / std::sqrt(dot(a, a)));
}
double component(V a, int axis) {
    return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}

struct Box {
    V low, high;
};
const Box kBoxes[] = {{{-6, -0.2, -4}, {6, 0, 5}},       {{-6, -0.2, -4.2}, {6, 2.5, -4}},
                      {{-2, 0, -0.6}, {-0.8, 1.2, 0.6}}, {{0.9, 0, -1.4}, {1.3, 2.2, -1}},
                      {{1.8, 0, 0.6}, {3.2, 0.4, 1.8}},  {{-0.4, 0.9, 1}, {0.4, 1.2, 1.8}}};

struct Hit {
    double t = 1e30;
    int box = -1, face = -1;  // face: 2 * axis + (positive side)
    V position, normal;
};

Hit castRay(V origin, V direction) {
    Hit hit;
    for (int b = 0; b < 6; ++b) {
        double enter = 1e-9, leave = 1e30;
        int face = -1;
        for (int axis = 0; axis < 3; ++axis) {
            const double o = component(origin, axis), d = component(direction, axis);
            const double low = component(kBoxes[b].low, axis), high = component(kBoxes[b].high, axis);
            if (d == 0.0) {
                if (o < low || o > high) leave = -1.0;
                continue;
            }
            const double first = ((d > 0 ? low : high) - o) / d, last = ((d > 0 ? high : low) - o) / d;
            if (first > enter) {
                enter = first;
                face = 2 * axis + (d > 0 ? 0 : 1);
            }
            leave = std::min(leave, last);
        }
        if (enter > leave || enter >= hit.t || leave < 0) continue;
        const double sign = face % 2 == 0 ? -1.0 : 1.0;
        const V normal = {face / 2 == 0 ? sign : 0, face / 2 == 1 ? sign : 0, face / 2 == 2 ? sign : 0};
        hit = {enter, b, face, origin + direction * enter, normal};
    }
    return hit;
}

Hit seenAt(int x, int y) {
    const V forward = unit({0, -2.8, -7.5});
    const V up = {0, -forward.z, forward.y};  // right is +x
    const double u = ((x + 0.5) / kWidthPx * 2 - 1) * 0.4 * kWidthPx / kHeightPx;
    const double v = ((y + 0.5) / kHeightPx * 2 - 1) * 0.4;
    return castRay({0, 3.2, 7.5}, forward + V{u, 0, 0} - up * v);
}

struct SceneLight {
    V position, direction;  // direction 0: a point light
    double range;           // 0: a directional light
    V candela;
    int leastPx;    // across a shadow view of it; 0: it casts none. The program says how many it gave
    double source;  // radius in metres, or in radians
};
// As they are in the last frame.
const SceneLight kLights[] = {
    {{-4, 4, 3}, unit({3, -3.6, -3}), 14, {19, 14, 8}, 1024, 0.15},
    {{4, 4.5, 2}, unit({-3, -4.5, -3}), 14, {5, 9, 17}, 1024, 0},
    {{-0.2, 1.8, -1.8}, {}, 7, {1.5, 1.3, 1.1}, 256, 0},
    {{2.5, 0.8, 2.6}, {}, 2.5, {0.1, 0.4, 0.15}, 0, 0},
    {{}, unit({0.4, -1, -0.5}), 0, {0.09, 0.11, 0.14}, 1024, 0.01},
};
constexpr int kLightCount = 5;
const double kMoonWidth = 2 * 1.2 * 8;  // metres across its view
const double kCosOuter = std::cos(0.785398163);

// From a point to a place from which the light comes: to its position, or as far as nothing is beyond.
V toLight(const SceneLight& light, V p) {
    return light.range > 0 ? light.position - p : light.direction * -100.0;
}

V unshadowed(const SceneLight& light, V p, V normal) {
    const V d = toLight(light, p);
    const double squared = dot(d, d), distance = std::sqrt(squared);
    const double facing = dot(normal, d) / distance;
    if (facing <= 0) return {};
    if (light.range == 0) return light.candela * facing;
    if (distance > light.range) return {};
    double cone = 1.0;
    if (dot(light.direction, light.direction) > 0) {
        const double c = -dot(d, light.direction) / distance;
        cone = std::clamp((c - kCosOuter) / (1 - kCosOuter) * 3, 0.0, 1.0);
    }
    const double window = 1 - std::pow(distance / light.range, 4);
    return light.candela * (facing * cone * window * window / squared);
}

bool blocked(const SceneLight& light, V p, V onSource = {}) {
    return castRay(p, toLight(light, p) + onSource).t < 1.0;
}

// Metres across a texel of its shadowmap, at a point.
double texelAt(const SceneLight& light, V p) {
    if (light.range == 0) return kMoonWidth / light.leastPx;
    const V d = toLight(light, p);
    return 2.0 / (light.leastPx - 8) * std::sqrt(dot(d, d));
}

enum class Shadow { Lit, Dark, Edge };

// Whether all of the light's source, and twice as much around it, is blocked as its centre is.
bool unanimous(const SceneLight& light, V p, bool dark) {
    const V d = toLight(light, p);
    const double radius = light.range > 0 ? light.source : light.source * std::sqrt(dot(d, d));
    const V axis = unit(d), side = std::abs(axis.y) > 0.9 ? V{1, 0, 0} : V{0, 1, 0};
    const V a = unit(side - axis * dot(side, axis));
    const V b = {axis.y * a.z - axis.z * a.y, axis.z * a.x - axis.x * a.z, axis.x * a.y - axis.y * a.x};
    for (double r : {radius, 2 * radius}) {
        for (int i = 0; i < 12; ++i) {
            const double angle = i * 0.5235987756;
            if (blocked(light, p, a * (r * std::cos(angle)) + b * (r * std::sin(angle))) != dark) return false;
        }
    }
    return true;
}

// Edge: within some texels of where the answer changes, in the plane of the surface or above it; or in a penumbra.
Shadow shadowAt(const SceneLight& light, V p, V normal) {
    const double reach = 8 * texelAt(light, p);
    const V base = p + normal * 1e-4;
    const bool dark = blocked(light, base);
    if (light.source > 0 && !unanimous(light, base, dark)) return Shadow::Edge;
    const V a = std::abs(normal.x) > 0.5 ? V{0, 1, 0} : V{1, 0, 0},
            b = std::abs(normal.z) > 0.5 ? V{0, 1, 0} : V{0, 0, 1};
    for (int ring = 1; ring <= 3; ++ring) {
        for (int i = 0; i < 12; ++i) {
            const double angle = i * 0.5235987756, r = reach * ring / 3;
            const V q = base + a * (r * std::cos(angle)) + b * (r * std::sin(angle));
            if (blocked(light, q) != dark || blocked(light, q + normal * (reach / 2)) != dark) return Shadow::Edge;
        }
    }
    return dark ? Shadow::Dark : Shadow::Lit;
}

std::uint8_t stored(double linear) {
    return static_cast<std::uint8_t>(std::lround(255 * std::pow(std::clamp(linear, 0.0, 1.0), 1 / 2.2)));
}

struct Expected {
    bool known = false;  // away from edges of geometry and shadows
    bool background = false;
    int rgb[3] = {};
    int shadowedBy = 0;  // bit per light that would have contributed well
};

Expected expectedAt(int x, int y) {
    Expected e;
    const Hit hit = seenAt(x, y);
    for (int j = -2; j <= 2; ++j) {
        for (int i = -2; i <= 2; ++i) {
            const Hit near = seenAt(x + i, y + j);
            if (near.box != hit.box || near.face != hit.face) return e;
        }
    }
    V sum = {0.02, 0.02, 0.02};
    if (hit.box < 0) {
        sum = {0.005, 0.008, 0.02};
        e.background = true;
    }
    for (int i = 0; i < kLightCount && hit.box >= 0; ++i) {
        const V light = unshadowed(kLights[i], hit.position, hit.normal);
        if (light.x + light.y + light.z < 1e-4) continue;
        const Shadow shadow = kLights[i].leastPx > 0 ? shadowAt(kLights[i], hit.position, hit.normal) : Shadow::Lit;
        if (shadow == Shadow::Edge) return e;
        if (shadow == Shadow::Lit) sum = sum + light;
        if (shadow == Shadow::Dark && light.y > 0.05) e.shadowedBy |= 1 << i;
    }
    e.known = true;
    e.rgb[0] = stored(sum.x);
    e.rgb[1] = stored(sum.y);
    e.rgb[2] = stored(sum.z);
    return e;
}

const std::vector<Expected>& expectedPicture() {
    static const std::vector<Expected> picture = [] {
        std::vector<Expected> all;
        for (int y = 0; y < kHeightPx; ++y) {
            for (int x = 0; x < kWidthPx; ++x) all.push_back(expectedAt(x, y));
        }
        return all;
    }();
    return picture;
}

// Largest difference of a channel at pixels whose value is known, and where.
struct Difference {
    int most = 0, x = 0, y = 0, above = 0;
};
constexpr int kTolerance = 3;  // of 255: face normals have 16 bits a component, positions those of depth

Difference compare(const std::vector<std::uint8_t>& picture) {
    Difference d;
    for (int i = 0; i < kWidthPx * kHeightPx; ++i) {
        const Expected& e = expectedPicture()[static_cast<std::size_t>(i)];
        if (!e.known) continue;
        int most = 0;
        for (int c = 0; c < 3; ++c)
            most = std::max(most, std::abs(picture[static_cast<std::size_t>(3 * i + c)] - e.rgb[c]));
        if (most > kTolerance) ++d.above;
        if (most > d.most) d = {most, i % kWidthPx, i / kWidthPx, d.above};
    }
    return d;
}

// --- Tests -----------------------------------------------------------------------------------------------------------

// What is copied into an engine must not reach into the library.
TEST(MinimalHost, UsesThePublicFaceAlone) {
    const std::filesystem::path folder = GNOMON_SOURCE_DIR "/examples/minimal_host";
    int files = 0, includes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string ending = entry.path().extension().string();
        const bool cpp = ending == ".cpp" || ending == ".h";
        if (!cpp && ending != ".comp" && ending != ".vert" && ending != ".frag") continue;
        ++files;
        std::ifstream file(entry.path());
        for (std::string line; std::getline(file, line);) {
            EXPECT_LE(line.size(), 120u) << entry.path() << ": " << line;
            if (!line.starts_with("#include")) continue;
            ++includes;
            const auto from = line.find_first_of("<\""), to = line.find_last_of(">\"");
            const std::string name = line.substr(from + 1, to - from - 1);
            const bool standard = line[from] == '<' && name.find_first_of("./") == std::string::npos;
            const bool own = std::filesystem::exists(folder / name) || name.ends_with(".spv.h");
            const bool face = name == "vulkan/vulkan.h" || name.starts_with("gnomon/");
            EXPECT_TRUE(cpp ? standard || face || own : name.starts_with("shading/")) << entry.path() << ": " << name;
        }
    }
    EXPECT_GE(files, 10);
    EXPECT_GT(includes, 30);
}

// The comparison means something only if it sees enough of every kind of pixel.
TEST(MinimalHost, ExpectationCoversThePicture) {
    int known = 0, background = 0, shadowed[kLightCount] = {};
    for (const Expected& e : expectedPicture()) {
        known += e.known;
        background += e.known && e.background;
        for (int i = 0; i < kLightCount; ++i) shadowed[i] += e.shadowedBy >> i & 1;
    }
    std::printf("known: %d of %d pixels, %d background; shadowed from each light: %d %d %d %d\n", known,
                kWidthPx * kHeightPx, background, shadowed[0], shadowed[1], shadowed[2], shadowed[4]);
    EXPECT_GT(known, kWidthPx * kHeightPx / 2);
    EXPECT_LT(background, known / 2);
    for (int i : {0, 1, 2, 4}) EXPECT_GT(shadowed[i], 100) << "light " << i;
}

TEST(MinimalHost, ValidationLayerIsLoaded) {
    const Outcome run = runProgram(15, "", "VK_LOADER_DEBUG=layer");  // layers come before devices
    EXPECT_NE(run.output.find("VK_LAYER_KHRONOS_validation"), std::string::npos) << run.output;
}

void expectSilence(const Outcome& run) {
    for (const char* word : {"VUID", "Validation", "SYNC-HAZARD", "UNASSIGNED"}) {
        EXPECT_EQ(run.output.find(word), std::string::npos) << word << "\n" << run.output;
    }
}

void expectSaid(const Outcome& run, const std::string& text) {
    EXPECT_NE(run.output.find(text), std::string::npos) << "not said: " << text << "\n" << run.output;
}

// Lines such as "light 2: 100 % of the view, 6 shadow views of 256x256".
void expectPlan(const Outcome& run) {
    int seen = 0;
    std::istringstream lines(run.output);
    for (std::string line; std::getline(lines, line);) {
        unsigned light = 0, views = 0, sidePx = 0;
        double share = 0;
        const char* const form = "light %u: %lf %% of the view, %u shadow views of %u";
        if (std::sscanf(line.c_str(), form, &light, &share, &views, &sidePx) != 4) continue;
        ++seen;
        ASSERT_LT(light, static_cast<unsigned>(kLightCount));
        EXPECT_EQ(views, light == 2 ? 6u : kLights[light].leastPx > 0 ? 1u : 0u) << line;
        EXPECT_GE(sidePx, static_cast<unsigned>(kLights[light].leastPx)) << line;
    }
    EXPECT_EQ(seen, kLightCount);
    expectSaid(run, "shadow views: 9, of which 6 are drawn in the last frame");  // only one light moves
}

// The table of buffers adds up, copies included.
void expectMemory(const Outcome& run) {
    std::istringstream lines(run.output);
    double sum = 0, total = 0;
    int buffers = 0;
    for (std::string line; std::getline(lines, line);) {
        char name[64] = {};
        double kib = 0;
        unsigned copies = 0;
        const int read = std::sscanf(line.c_str(), "%63s %lf %u", name, &kib, &copies);
        if (read == 2 && std::string(name) == "total") {
            total = kib;
            break;
        }
        if (read != 3) continue;
        sum += kib * copies;
        ++buffers;
    }
    EXPECT_GE(buffers, 15);
    EXPECT_NEAR(sum, total, 0.1 * buffers);
}

// Rows of the host and of the library stand in one table, in the order of the paper's figure 1.
void expectTimeline(const Outcome& run) {
    std::size_t at = run.output.find("\nprepare ");
    for (const char* row : {"gbuffer", "hierarchical_depth", "find_lights_approximate", "shadowmaps", "shadow_bounds",
                            "filter_tiles", "classify_pairs", "filter_pairs", "lighting", "lighting_evaluate"}) {
        const std::size_t next = run.output.find(std::string("\n").append(row).append(" "), at);
        ASSERT_NE(next, std::string::npos) << row << "\n" << run.output;
        at = next;
    }
}

TEST(MinimalHost, DrawsTheExpectedPictureOnEveryDevice) {
    const std::vector<Found> found = runOnEveryDevice();
    ASSERT_FALSE(found.empty()) << "No Vulkan 1.3 device was found.";
    for (const auto& [device, run] : found) {
        SCOPED_TRACE(run.output);
        std::printf("%s", run.output.c_str());
        EXPECT_EQ(run.exitCode, 0);
        expectSilence(run);
        expectSaid(run, "lights: 5 given, 5 visible, 4 casting");
        expectSaid(run, "evaluated: 0 tiles");
        expectSaid(run, " made ahead of time, 0 in a frame");
        expectPlan(run);
        expectMemory(run);
        expectTimeline(run);
        ASSERT_FALSE(run.picture.empty());
        const Difference d = compare(run.picture);
        EXPECT_LE(d.most, kTolerance) << d.above << " pixels differ, most of all (" << d.x << ", " << d.y << ")";

        const Outcome overflow = runProgram(device, "600");  // too small: most tiles go to the second lighting pipeline
        EXPECT_EQ(overflow.exitCode, 0);
        EXPECT_EQ(overflow.output.find("evaluated: 0 tiles"), std::string::npos);
        expectSilence(overflow);
        EXPECT_TRUE(overflow.picture == run.picture) << "an overflow changes the picture";
        const Outcome grown = runProgram(device, "600 100000");  // and then they grow between frames
        EXPECT_EQ(grown.exitCode, 0);
        expectSaid(grown, "evaluated: 0 tiles");
        expectSaid(grown, "pools: 600 list entries");
        expectSilence(grown);
        EXPECT_TRUE(grown.picture == run.picture) << "growing pools change the picture";
    }
}

TEST(MinimalHost, SaysWhatIsWrong) {
    const Outcome device = runProgram(15);
    EXPECT_NE(device.exitCode, 0);
    expectSaid(device, "There is no such Vulkan device: give");
    const Outcome pools = runProgram(0, "many");
    EXPECT_NE(pools.exitCode, 0);
    expectSaid(pools, "The argument 'many' is no number.");
    EXPECT_TRUE(pools.picture.empty());
}

}  // namespace
