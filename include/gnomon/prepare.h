#pragma once
// Phase 1, Prepare: culls and sorts the lights of one view and writes the buffers that the GPU phases read. Pure CPU
// code: no Vulkan device is needed. Source: the paper, section 2.1.
//
// It answers before it writes: run() says which lights are visible and how large they are on screen, so that a host can
// plan its shadow views for these; write() takes the shadow views and fills the buffers. A View does both for its host.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "gnomon/export.h"
#include "gnomon/result.h"
#include "gnomon/scene.h"

namespace gnomon {

struct PrepareDesc {
    std::uint32_t maxWidthPx = 3840, maxHeightPx = 2160;
    /// Illuminance in lux, above 0, at which a light without a range ends.
    float rangeCutoffLux = 0.02f;
    /// Where more than 1024 lights compete, one that was kept last frame counts this much more (at least 1), so that
    /// the choice does not flicker.
    float keepFactor = 1.2f;
};

/// Bytes that write() writes at each destination for an extent.
struct PrepareSizes {
    std::size_t frameConstants = 0, lights = 0, zBins = 0, tileLightMasks = 0;
};

/// Where write() writes: each pointer to at least the bytes that prepareSizes() gives, aligned to 16. Written front to
/// back and never read, so write-combined mapped memory is fine.
struct PrepareOutput {
    void* frameConstants = nullptr;
    void* lights = nullptr;
    void* zBins = nullptr;
    void* tileLightMasks = nullptr;
};

struct PrepareReport {
    std::uint32_t given = 0;
    std::uint32_t visible = 0;      ///< in the lists: at most 1024
    std::uint32_t dropped = 0;      ///< visible too, but beyond 1024
    std::uint32_t directional = 0;  ///< of the visible ones
    std::uint32_t casting = 0;  ///< of the visible ones: after run(), that want shadow views; after write(), that have
};

/// A visible light, as the view sees it.
struct LightOnScreen {
    std::uint32_t light = 0;  ///< index into ViewInput::lights
    LightType type = LightType::Point;
    /// It wants shadow views: Light::casts, and its shadow has not faded away at this distance.
    bool casts = false;
    Filter filter = Filter::Pcss;  ///< as given
    std::uint8_t pcssPreset = 0;   ///< likewise
    /// Pixels across of the sphere around all that it reaches, and of its source. Neither is cut by the view's borders.
    /// The eye is taken to be no nearer to a sphere's centre than half its radius. A directional light reaches
    /// everything (infinity), and its source has its angular diameter.
    float reachDiameterPx = 0.0f;
    float sourceDiameterPx = 0.0f;
    /// Share of the view that its reach covers, 0 to 1, counted in squares of 32 pixels and rounded up.
    float screenShare = 0.0f;
    /// View depths between which it reaches, metres; directional lights: 0 to infinity.
    float nearestMetres = 0.0f, farthestMetres = 0.0f;
};

/// What run() answers: the visible lights in the order of the lists, directional ones first in the host's order, then
/// by nearest view depth. Valid until the next run().
struct PreparedLights {
    std::span<const LightOnScreen> visible;
    PrepareReport report;
};

/// Thread safe; no failure.
GNOMON_API PrepareSizes prepareSizes(std::uint32_t widthPx, std::uint32_t heightPx) noexcept;

/// The state of phase 1 for one view: scratch memory, and which lights were kept last frame. Not thread safe; different
/// objects are independent. Allocates nothing unless the number of given lights grows.
class GNOMON_API Prepare {
public:
    static Result create(const PrepareDesc& desc, std::unique_ptr<Prepare>& out) noexcept;
    ~Prepare();
    Prepare(const Prepare&) = delete;
    Prepare& operator=(const Prepare&) = delete;

    /// Other limits; which lights were kept last frame is still known. run() must come before write().
    Result resize(const PrepareDesc& desc) noexcept;
    /// Culls, sorts and measures. Fails with a sentence on an extent of zero or above the maximum, a camera that is not
    /// rigid or not finite, or a light with a value that is not finite or outside its range; nothing can be written
    /// then.
    Result run(const ViewInput& input, PreparedLights& out) noexcept;
    /// Writes what the last run() found. `lightViews`: one per visible light in the order of the answer, or empty for
    /// no shadow at all; those of lights that do not cast are ignored. Fails with a sentence (and writes nothing that
    /// may be used) without a successful run(), on another number of lights, on views at or beyond `shadowViewCount`,
    /// and on a number of views that the light's type cannot have.
    Result write(std::span<const LightShadowViews> lightViews, std::uint32_t shadowViewCount,
                 const PrepareOutput& output, PrepareReport* report = nullptr) noexcept;

private:
    struct State;
    explicit Prepare(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

}  // namespace gnomon
