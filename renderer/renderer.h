#pragma once
// The reference host: draws a scene with Gnomon's tiled deferred shadows, or with the same shadows evaluated inside the
// lighting shader ("inline", the paper's "before"), and says what each pass took.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gnomon/gnomon.h"
#include "picture/picture.h"
#include "renderer/frame/frame_settings.h"
#include "renderer/frame/renderer_desc.h"
#include "renderer/gpu/device.h"
#include "renderer/shared_pipelines.h"
#include "scene/scene.h"

namespace gnomon::renderer {

struct MemoryUseRow {
    std::string name;
    std::uint64_t bytes = 0;   // of one copy
    bool library = false;      // of the library; else of the reference renderer
    std::uint32_t copies = 1;  // one per frame in flight
};

struct FrameReport {
    FrameStatistics statistics;
    std::vector<TimelineRow> passes;  // library's and renderer's, in order of execution; empty without timestamps
    std::uint32_t shadowViews = 0, shadowViewsDrawn = 0;
    std::uint64_t shadowTrianglesDrawn = 0;
    std::uint32_t shadowLightsShrunk = 0, shadowLightsDropped = 0;  // by the atlas' budget
    std::uint32_t atlasSizePx = 0;
};

/// What was made so far, shared pipelines included: settings that change should make little.
struct RendererCounts {
    std::uint32_t libraryPipelines = 0, lightingPipelines = 0;
    std::uint32_t views = 0, resizes = 0;
};

/// Not thread safe. Throws GpuError or PoseError (std::runtime_errors with one sentence).
class Renderer {
public:
    /// Uploads the scene; it is copied as far as needed and may go afterwards. Lights must have ranges
    /// (completeLights()). Without `pipelines` it has its own.
    Renderer(const Device& device, const Scene& scene, const RendererDesc& desc,
             std::shared_ptr<SharedPipelines> pipelines = nullptr);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// Settings of the frames from now on. Where the extent is larger than any before, images grow, which waits for the
    /// device. Pipelines that are new are made with the next frame, or by prepare().
    void set(const FrameSettings& settings);
    [[nodiscard]] const FrameSettings& settings() const;
    /// Makes the pipelines that the next frame of this mode needs.
    void prepare(ShadowMode mode);

    /// Records and submits one frame, which shows the scene's animations at a time. Lights follow their nodes. So does
    /// the camera, if it is one of the scene's. Waits only for the frame before the last. Returns the frame's number.
    std::uint64_t renderFrame(const SceneCamera& camera, ShadowMode mode, double timeSeconds = 0.0);
    /// Waits until everything submitted has finished.
    void wait();
    /// Of a frame that has finished (after wait(): of the last two). Throws if it is not known any more.
    [[nodiscard]] FrameReport report(std::uint64_t frameNumber) const;

    // Of the last frame, by its extent. All of them wait.
    HdrPicture readPicture();  ///< linear; of halves or floats, as RendererDesc::floatPicture has it
    /// Per pixel the distance along the view axis from the camera, in the scene's units (metres): that of the plane
    /// across the axis in which the point lies, not the length of the ray. Infinity at background. As exact as the
    /// depth buffer: to 1e-6 of the distance for perspective cameras with reversed Z, of the far plane's for
    /// orthographic ones.
    std::vector<float> readDepth();
    /// Per pixel the shading normal in world space, unit, normal map included, on the side that the camera sees. Exact
    /// to 0.0001. Zero at background.
    std::vector<glm::vec3> readNormals();
    /// Per pixel the triangle's position among all instances' triangles in the scene's order, kNone at background.
    std::vector<std::uint32_t> readTriangleIds();
    /// Per pixel the visibility of a light of the scene; the frame must have been ShadowMode::Deferred. -1 where the
    /// light does not reach, and everywhere for a light out of view.
    std::vector<float> readVisibility(std::uint32_t light);
    /// The shadow views of a light in the last frame, empty for one without; positions are relative to frameOrigin().
    [[nodiscard]] std::vector<ShadowView> shadowViews(std::uint32_t light) const;
    [[nodiscard]] glm::dvec3 frameOrigin() const;

    [[nodiscard]] std::vector<MemoryUseRow> memory() const;
    [[nodiscard]] const MemoryReport& libraryMemory() const;
    [[nodiscard]] std::uint32_t subgroupSize() const;
    [[nodiscard]] RendererCounts counts() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace gnomon::renderer
