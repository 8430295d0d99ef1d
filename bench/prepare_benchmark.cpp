// Time of phase 1 (Prepare::run and Prepare::write) on one core, the whole call: validation, culling, sort, zBins, tile
// light masks.
//
// Light distributions, all seeded, all lights visible, half of them spots (half-angle 0.2 to 1.0 rad, any direction),
// camera with a vertical field of view of 60 degrees at the origin, infinite far, reversed Z:
//   Spread  lights spread evenly over the view frustum between 2 and 100 m of depth, range 2 to 8 m
//           (a lit street; at 3840x2160 a light covers 0.9 % of the screen on average);
//   Near    the same between 1 and 25 m of depth (a room; many lights are cut by the near plane or hold the eye);
//   Fringe  the worst for spans: points in front of the camera whose image fills the screen but for its corners, so
//           that each light has a span in every row and none takes the short way;
//   Full    the worst for tiles: every light covers the whole screen.
// The label gives the mean count of lights per tile.
//
// Every call is timed by itself. Least, median and 95th percentile of the calls are reported in microseconds: min_us,
// median_us, p95_us. It is the thread's own time where the system tells it (POSIX), so that waiting for a core does not
// count. Other work on the machine still slows a call down, by caches and clock. That moves the last most and the first
// least.
//
// prepare_benchmark --benchmark_filter=Spread --benchmark_counters_tabular=true

#include <benchmark/benchmark.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "gnomon/prepare.h"

namespace {

enum class Distribution { Spread, Near, Fringe, Full };

constexpr double kTanHalfFov = 0.5773502691896258;

double uniform(std::mt19937& random, double low, double high) {
    return low + (high - low) * (random() / 4294967296.0);
}

gnomon::Light lightAt(double x, double y, double depth, double range) {
    gnomon::Light light;
    light.position[0] = static_cast<float>(x);
    light.position[1] = static_cast<float>(y);
    light.position[2] = static_cast<float>(-depth);
    light.rangeMetres = static_cast<float>(range);
    return light;
}

void makeSpot(gnomon::Light& light, std::mt19937& random) {
    light.type = gnomon::LightType::Spot;
    for (float& f : light.direction) f = static_cast<float>(uniform(random, -1, 1));
    light.direction[2] += light.direction[2] < 0 ? -0.01f : 0.01f;
    light.outerConeAngle = static_cast<float>(uniform(random, 0.2, 1.0));
}

std::vector<gnomon::Light> makeLights(Distribution distribution, int count, double aspect) {
    std::mt19937 random(7);
    std::vector<gnomon::Light> lights;
    for (int i = 0; i < count; ++i) {
        // Named, because the order in which a call's arguments are computed is the compiler's choice.
        const double x = uniform(random, -1, 1), y = uniform(random, -1, 1), z = uniform(random, 0, 1);
        const double range = uniform(random, 2, 8);
        if (distribution == Distribution::Full) {
            lights.push_back(lightAt(x, y, z, 50));
            continue;
        }
        if (distribution == Distribution::Fringe) {
            // Seen under a half-angle between that of the screen's side and that of its corner.
            const double depth = 10 + 50 * z, tangent = kTanHalfFov * aspect * (1.06 + 0.04 * x);
            lights.push_back(lightAt(0, 0, depth, depth * tangent / std::sqrt(1 + tangent * tangent)));
            continue;
        }
        const bool isNear = distribution == Distribution::Near;
        // Evenly over the frustum's volume: the cube of the depth is uniform.
        const double first = isNear ? 1 : 2, last = isNear ? 25 : 100;
        const double depth = std::cbrt(first * first * first * (1 - z) + last * last * last * z);
        const double halfHeight = depth * kTanHalfFov;
        lights.push_back(lightAt(x * halfHeight * aspect, y * halfHeight, depth, range));
        if (i % 2 == 0) makeSpot(lights.back(), random);
    }
    return lights;
}

gnomon::Camera makeCamera(double aspect) {
    gnomon::Camera camera;
    camera.clipFromView[0] = static_cast<float>(1 / (kTanHalfFov * aspect));
    camera.clipFromView[5] = static_cast<float>(-1 / kTanHalfFov);
    camera.clipFromView[11] = -1;
    camera.clipFromView[14] = 0.1f;
    return camera;
}

double lightsPerTile(const std::vector<std::uint32_t>& masks) {
    double bits = 0;
    for (std::size_t word = 0; word < masks.size(); ++word) {
        if (word % 33 != 0) bits += std::popcount(masks[word]);
    }
    return bits / (static_cast<double>(masks.size()) / 33);
}

// Times of single calls.
class CallTimes {
public:
    CallTimes() { microseconds_.reserve(1u << 16); }
    void start() { start_ = now(); }
    void stop() { microseconds_.push_back(now() - start_); }
    void report(benchmark::State& state) {
        if (microseconds_.empty()) return;
        std::sort(microseconds_.begin(), microseconds_.end());
        const auto quantile = [&](double share) {
            return microseconds_[static_cast<std::size_t>(share * static_cast<double>(microseconds_.size() - 1))];
        };
        state.counters["min_us"] = quantile(0);
        state.counters["median_us"] = quantile(0.5);
        state.counters["p95_us"] = quantile(0.95);
    }

private:
    static double now() {
#if defined(__unix__) || defined(__APPLE__)
        timespec time{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return 1e6 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_nsec);
#else
        const auto time = std::chrono::steady_clock::now().time_since_epoch();
        return std::chrono::duration<double, std::micro>(time).count();
#endif
    }

    double start_ = 0;
    std::vector<double> microseconds_;
};

// As Linux tells it; empty elsewhere.
std::string processorName() {
    std::ifstream info("/proc/cpuinfo");
    std::string family, model, name;
    for (std::string line; std::getline(info, line) && !line.empty();) {
        const std::size_t colon = line.find(':');
        const std::string value = colon + 2 < line.size() ? line.substr(colon + 2) : "";
        if (line.rfind("cpu family", 0) == 0) family = value;
        if (line.rfind("model\t", 0) == 0) model = value;
        if (line.rfind("model name", 0) == 0) name = value;
    }
    return name.empty() ? name : name + ", family " + family + ", model " + model;
}

std::string compilerName() {
#if defined(__clang__)
    return "Clang " __clang_version__;
#elif defined(__GNUC__)
    return "GCC " __VERSION__;
#elif defined(_MSC_VER)
    return "MSVC " + std::to_string(_MSC_VER);
#else
    return "unknown";
#endif
}

void prepareLights(benchmark::State& state, Distribution distribution) {
    const auto count = static_cast<int>(state.range(0));
    const auto width = static_cast<std::uint32_t>(state.range(1)), height = static_cast<std::uint32_t>(state.range(2));
    const double aspect = static_cast<double>(width) / height;
    const std::vector<gnomon::Light> lights = makeLights(distribution, count, aspect);
    gnomon::PrepareDesc desc;
    desc.maxWidthPx = width, desc.maxHeightPx = height;
    std::unique_ptr<gnomon::Prepare> prepare;
    if (!gnomon::Prepare::create(desc, prepare)) std::abort();

    const gnomon::PrepareSizes sizes = gnomon::prepareSizes(width, height);
    std::vector<std::uint32_t> frame(sizes.frameConstants / 4), gpuLights(sizes.lights / 4), zBins(sizes.zBins / 4),
        masks(sizes.tileLightMasks / 4);
    gnomon::ViewInput input;
    input.camera = makeCamera(aspect);
    input.widthPx = width, input.heightPx = height;
    input.lights = lights;
    gnomon::PreparedLights prepared;
    gnomon::PrepareReport report;
    CallTimes times;
    for (auto _ : state) {
        times.start();
        gnomon::Result result = prepare->run(input, prepared);
        if (result) {
            result = prepare->write({}, 0, {frame.data(), gpuLights.data(), zBins.data(), masks.data()}, &report);
        }
        if (!result) {
            state.SkipWithError(result.message());
            break;
        }
        benchmark::ClobberMemory();
        times.stop();
    }
    times.report(state);
    state.SetLabel(std::to_string(report.visible) + " visible, " + std::to_string(lightsPerTile(masks)).substr(0, 6) +
                   " per tile");
}

void sizes(benchmark::internal::Benchmark* benchmark) {
    for (const int count : {64, 256, 512, 1024}) benchmark->Args({count, 3840, 2160});
    benchmark->Args({1024, 1920, 1080})->Args({1024, 7680, 4320})->Unit(benchmark::kMicrosecond);
}

BENCHMARK_CAPTURE(prepareLights, Spread, Distribution::Spread)->Apply(sizes);
BENCHMARK_CAPTURE(prepareLights, Near, Distribution::Near)->Apply(sizes);
BENCHMARK_CAPTURE(prepareLights, Fringe, Distribution::Fringe)->Apply(sizes);
BENCHMARK_CAPTURE(prepareLights, Full, Distribution::Full)->Apply(sizes);
// More than fit: the choice among 10,000.
BENCHMARK_CAPTURE(prepareLights, SpreadCrowd, Distribution::Spread)
    ->Args({10000, 3840, 2160})
    ->Unit(benchmark::kMicrosecond);

}  // namespace

int main(int argc, char** argv) {
    const std::string processor = processorName();
    if (!processor.empty()) benchmark::AddCustomContext("processor", processor);
    benchmark::AddCustomContext("compiler", compilerName());
#ifdef NDEBUG
    benchmark::AddCustomContext("assertions", "off");
#else
    benchmark::AddCustomContext("assertions", "on: these are no figures of an optimised build");
#endif
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
