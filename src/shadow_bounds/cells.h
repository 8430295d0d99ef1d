#pragma once
// Which cells of the shadow bounds must be made this frame, and where in the buffer an atlas' bounds lie. Pure CPU.

#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/view.h"
#include "gpu_interface/numbers.h"
#include "gpu_interface/structs.h"

namespace gnomon {

// Cells of 256x256 texels that hold `texels`, at most; a capacity.
std::uint32_t shadowBoundsCellsFor(std::uint64_t texels) noexcept;
// Bytes of the bounds of so many cells, all levels.
std::uint64_t shadowBoundsBytes(std::uint32_t cells) noexcept;

// Remembers which cells hold bounds of what the atlases hold. In a frame with bounds call list(), and made() if the
// pass is recorded. In a frame without them call skip(). Not thread safe.
class ShadowBoundsCells {
public:
    // Takes memory once. Throws std::bad_alloc.
    void create(std::uint32_t capacity);

    // Lists the cells to be made into `out`, which has room for the capacity: those of changed shadow views, and those
    // never made yet. Returns how many. Sets in `gpuViews`, which are parallel to `views`, where their bounds lie in
    // the buffer. They have none where the atlases are larger than the capacity.
    std::uint32_t list(std::span<const ShadowView> views, std::span<const ShadowAtlas> atlases,
                       gpu::GpuShadowView* gpuViews, gpu::GpuShadowBoundsCell* out) noexcept;
    // The pass that makes the cells last listed is recorded. Without this call they are listed again.
    void made() noexcept;
    // A frame without bounds: the cells of changed shadow views no longer hold what the atlases hold.
    void skip(std::span<const ShadowView> views, std::span<const ShadowAtlas> atlases) noexcept;

private:
    struct Grid {
        std::uint32_t columns = 0, rows = 0;  // cells of one layer
        std::uint32_t firstCell = 0;          // of the first layer
    };
    bool layOut(std::span<const ShadowAtlas> atlases) noexcept;

    std::uint32_t capacity_ = 0;
    Grid grids_[gpu::kMaxShadowAtlases];
    ShadowAtlas atlases_[gpu::kMaxShadowAtlases];
    std::uint32_t atlasCount_ = 0;
    enum class Cell : std::uint8_t { Unknown, Made, Listed };
    std::vector<Cell> state_;
};

}  // namespace gnomon
