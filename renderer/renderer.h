#pragma once
// The reference host: draws a scene with Gnomon's tiled deferred shadows, or with the same shadows evaluated inside the
// lighting shader ("inline", the paper's "before"), and says what each pass took.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gnomon/gnomon.h"
#include "picture/picture.h"
#include "renderer/gpu/device.h"
#include "renderer/shadow_atlas/drawing.h"
#include "scene/scene.h"

namespace gnomon::renderer {

enum class ShadowMode : std::uint8_t { Deferred, Inline, Off };

struct RendererDesc {
    std::uint32_t widthPx = 1280, heightPx = 720;
    Filter filter = Filter::Pcss;
    std::uint32_t pcfRadius = 1;
    PcssTaps pcss = kPcssMedium;
    bool patternPerFrame = false;
    std::uint32_t visibilityBits = 8;
    DepthBias depthBias = DepthBias::Oriented;
    bool facedAwayIsDark = true;
    float biasMetres = 0.002f;           // of lights that state none
    float subsurfaceBiasMetres = 0.02f;  // with shadowDrawing.subsurfaceFronts
    ShadowDrawing shadowDrawing;
    bool readFaceNormals = true;  // off: they are derived from the depth buffer
    bool shadowBounds = true;     // searches of Filter::Pcss end where the bounds of the shadowmaps tell the result
    ListReservation listReservation = ListReservation::Accurate;
    std::uint32_t fixedListEntriesPerTile = 32;          // with ListReservation::Fixed
    std::uint32_t subgroupSize = 0;                      // 0: the device's own
    std::uint32_t listEntries = 0, visibilitySlots = 0;  // pools; 0: the library's defaults
    std::uint32_t atlasSizePx = 0;  // 0: 4096 up to 1920x1080, above 8192; at most what the device has
    DeviceDepth deviceDepth = DeviceDepth::ReversedZ;
    bool quantiseInline = true;  // inline visibility has the 8 bits of a slot; off: to measure what they cost
    // Inline and Off leave the lights of tiles without list space out (FrameStatistics::listOverflowTiles counts them):
    // the fastest inline shading, for measurements.
    bool inlineNeedsLists = false;
};

struct PassTime {
    std::string name;
    double milliseconds = 0.0;
    bool drawing = false;  // rasterization; else compute
};

struct MemoryUseRow {
    std::string name;
    std::uint64_t bytes = 0;   // of one copy
    bool library = false;      // of the library; else of the reference renderer
    std::uint32_t copies = 1;  // one per frame in flight
};

struct FrameReport {
    FrameStatistics statistics;
    std::vector<PassTime> passes;  // library's and renderer's, in order of execution; empty without timestamps
    std::uint32_t shadowViews = 0, shadowViewsDrawn = 0;
    std::uint64_t shadowTrianglesDrawn = 0;
    std::uint32_t shadowLightsShrunk = 0, shadowLightsDropped = 0;  // by the atlas' budget
    std::uint32_t atlasSizePx = 0;
};

/// Not thread safe. Throws GpuError or PoseError (std::runtime_errors with one sentence).
class Renderer {
public:
    /// Uploads the scene; it is copied as far as needed and may go afterwards. Lights must have ranges
    /// (completeLights()).
    Renderer(const Device& device, const Scene& scene, const RendererDesc& desc);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// Records and submits one frame, which shows the scene's animations at a time; lights follow their nodes, and so
    /// does the camera, if it is one of the scene's. Waits only for the frame before the last. Returns its number.
    std::uint64_t renderFrame(const SceneCamera& camera, ShadowMode mode, double timeSeconds = 0.0);
    /// Waits until everything submitted has finished.
    void wait();
    /// Of a frame that has finished (after wait(): of the last two). Throws if it is not known any more.
    FrameReport report(std::uint64_t frameNumber) const;
    /// Linear picture of the last frame. Waits.
    HdrPicture readPicture();
    /// Per pixel the triangle's position among all instances' triangles in the scene's order, kNone at background.
    /// Waits.
    std::vector<std::uint32_t> readTriangleIds();
    /// Per pixel the visibility of a light of the scene in the last frame, which must have been ShadowMode::Deferred;
    /// -1 where the light does not reach, and everywhere for a light out of view. Waits.
    std::vector<float> readVisibility(std::uint32_t light);
    /// The shadow views of a light in the last frame, empty for one without; positions are relative to frameOrigin().
    std::vector<ShadowView> shadowViews(std::uint32_t light) const;
    glm::dvec3 frameOrigin() const;

    std::vector<MemoryUseRow> memory() const;
    const MemoryReport& libraryMemory() const;
    std::uint32_t subgroupSize() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace gnomon::renderer
