#pragma once
// Phase 1, Prepare: culls and sorts the lights of one view and writes the buffers that the GPU phases read. Pure CPU
// code: no Vulkan device is needed. Source: the paper, section 2.1.

#include <cstddef>
#include <cstdint>
#include <memory>

#include "gnomon/result.h"
#include "gnomon/scene.h"

namespace gnomon {

struct PrepareDesc {
    std::uint32_t maxWidthPx = 3840, maxHeightPx = 2160;
    /// Illuminance in lux at which a light without a range ends.
    float rangeCutoffLux = 0.02f;
    /// Where more than 1024 lights compete, one that was kept last frame counts this much more, so that the choice does
    /// not flicker.
    float keepFactor = 1.2f;
};

/// Bytes that run() writes at each destination for an extent.
struct PrepareSizes {
    std::size_t frameConstants = 0, lights = 0, zBins = 0, tileLightMasks = 0;
};

/// Where run() writes: each pointer to at least the bytes that prepareSizes() gives, aligned to 16. Written front to
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
    std::uint32_t casting = 0;      ///< of the visible ones
};

/// Thread safe; no failure.
PrepareSizes prepareSizes(std::uint32_t widthPx, std::uint32_t heightPx) noexcept;

/// The state of phase 1 for one view: scratch memory, and which lights were kept last frame. Not thread safe; different
/// objects are independent. run() allocates nothing unless the number of given lights grows.
class Prepare {
public:
    static Result create(const PrepareDesc& desc, std::unique_ptr<Prepare>& out) noexcept;
    ~Prepare();
    Prepare(const Prepare&) = delete;
    Prepare& operator=(const Prepare&) = delete;

    /// Fails with a sentence (and writes nothing that may be used) on an extent of zero or above the maximum, a camera
    /// that is not rigid or not finite, a light with a value that is not finite or outside its range, or a shadow view
    /// index out of bounds.
    Result run(const ViewInput& input, const PrepareOutput& output, PrepareReport& report) noexcept;

private:
    struct State;
    explicit Prepare(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

}  // namespace gnomon
