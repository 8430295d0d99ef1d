#pragma once
// GPU times of a frame, in one table that the library and the host both write to.
//
//     timeline.beginFrame(commands, frameNumber);            // before the first row
//     { const auto row = timeline.begin(commands, "gbuffer", Phase::Host, RowKind::Drawing);
//       ... draw ...
//       timeline.end(commands, row); }
//     ... the view's record calls add their rows, with FrameDesc::timeline ...
//     std::span<const TimelineRow> rows = timeline.rows(frameNumber);   // when the frame has finished

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <memory>
#include <span>

#include "gnomon/export.h"
#include "gnomon/result.h"

namespace gnomon {

class Context;

/// Where a row belongs in the technique.
enum class Phase : std::uint8_t {
    Host,                   ///< the host's own work
    HierarchicalDepth,      ///< paper 2.2, note 1
    FindLightsApproximate,  ///< phase 2
    FindLightsAccurate,     ///< phase 3
    ShadowBounds,           ///< upkeep of the shadowmaps
    GenerateShadows,        ///< phase 4
    Closeups,               ///< phase 5
    Lighting,
    Statistics,
};

enum class RowKind : std::uint8_t {
    Compute,
    Drawing,  ///< rasterization
    Transfer,
};

struct TimelineRow {
    const char* name = "";
    Phase phase = Phase::Host;
    RowKind kind = RowKind::Compute;
    double beginMilliseconds = 0.0, endMilliseconds = 0.0;  ///< since the frame's first row began

    [[nodiscard]] double milliseconds() const noexcept { return endMilliseconds - beginMilliseconds; }
};

struct TimelineDesc {
    std::uint32_t framesInFlight = 2;  ///< 1 to 4
    std::uint32_t maxRows = 64;        ///< 1 to 1024 of a frame; rows beyond are counted, not recorded
};

/// Not thread safe. Needs queues with timestamps in all families of the context: else it records nothing.
class GNOMON_API Timeline {
public:
    /// A row that was begun; kNone where it is not recorded.
    using Row = std::uint32_t;
    static constexpr Row kNone = 0xFFFFFFFFu;

    /// The context must outlive the timeline.
    static Result create(const Context& context, const TimelineDesc& desc, std::unique_ptr<Timeline>& out) noexcept;
    ~Timeline();
    Timeline(const Timeline&) = delete;
    Timeline& operator=(const Timeline&) = delete;

    /// False where the device cannot measure.
    [[nodiscard]] bool records() const noexcept;

    /// Frame `frameNumber` - framesInFlight must have finished on the device. Outside of rendering.
    void beginFrame(VkCommandBuffer commands, std::uint64_t frameNumber) noexcept;
    /// `name` must stay valid as long as rows are read; a literal does.
    Row begin(VkCommandBuffer commands, const char* name, Phase phase, RowKind kind) noexcept;
    void end(VkCommandBuffer commands, Row row) noexcept;

    /// Rows of a frame that the host knows to have finished, one of the last framesInFlight, in order of execution;
    /// rows that were begun and not ended are left out. Empty for other frames. Never waits; valid until the next call.
    [[nodiscard]] std::span<const TimelineRow> rows(std::uint64_t frameNumber) const noexcept;
    /// Rows of that frame for which there was no space.
    [[nodiscard]] std::uint32_t lostRows(std::uint64_t frameNumber) const noexcept;

private:
    struct State;
    explicit Timeline(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

}  // namespace gnomon
