// Timeline: two timestamps per row in one query pool, a part of it per frame in flight.
#include "gnomon/timeline.h"

#include <algorithm>
#include <new>
#include <vector>

#include "core/context.h"

namespace gnomon {
namespace {

constexpr std::uint32_t kMostFramesInFlight = 4, kMostRows = 1024;

Result checkDesc(const TimelineDesc& desc) {
    if (desc.framesInFlight == 0 || desc.framesInFlight > kMostFramesInFlight) {
        return Result::failure(Status::BadArgument, "TimelineDesc::framesInFlight is %u; it must be 1 to %u.",
                               desc.framesInFlight, kMostFramesInFlight);
    }
    if (desc.maxRows == 0 || desc.maxRows > kMostRows) {
        return Result::failure(Status::BadArgument, "TimelineDesc::maxRows is %u; it must be 1 to %u.", desc.maxRows,
                               kMostRows);
    }
    return {};
}

}  // namespace

struct GNOMON_HIDDEN Timeline::State {
    struct Recorded {
        const char* name;
        Phase phase;
        RowKind kind;
        bool ended;
    };
    struct Frame {
        std::uint64_t number = ~std::uint64_t{0};
        std::vector<Recorded> rows;  // never beyond maxRows
        std::uint32_t lost = 0;
    };
    const Context::State* context = nullptr;
    TimelineDesc desc;
    VkQueryPool queries = VK_NULL_HANDLE;  // null: nothing is measured
    Frame frames[kMostFramesInFlight];
    std::uint32_t current = 0;
    std::vector<TimelineRow> answer;

    ~State() {
        if (context != nullptr) context->device.vk.DestroyQueryPool(context->device.device, queries, nullptr);
    }
    [[nodiscard]] std::uint32_t query(std::uint32_t frame, Row row) const { return (frame * desc.maxRows + row) * 2; }
};

Timeline::Timeline(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
Timeline::~Timeline() = default;

Result Timeline::create(const Context& context, const TimelineDesc& desc, std::unique_ptr<Timeline>& out) noexcept {
    if (Result checked = checkDesc(desc); !checked) return checked;
    try {
        auto state = std::make_unique<State>();
        state->context = &context.state();
        state->desc = desc;
        for (State::Frame& frame : state->frames) frame.rows.reserve(desc.maxRows);
        state->answer.reserve(desc.maxRows);
        if (state->context->timestampPeriodNs != 0.0f) {
            VkQueryPoolCreateInfo info = {VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
            info.queryType = VK_QUERY_TYPE_TIMESTAMP;
            info.queryCount = desc.framesInFlight * 2 * desc.maxRows;
            const DeviceContext& device = state->context->device;
            const VkResult result = device.vk.CreateQueryPool(device.device, &info, nullptr, &state->queries);
            if (result != VK_SUCCESS) return vulkanFailure(result, "vkCreateQueryPool");
        }
        out.reset(new Timeline(std::move(state)));
        return {};
    } catch (const std::bad_alloc&) {
        return Result::failure(Status::OutOfMemory, "Out of memory while creating a timeline.");
    }
}

bool Timeline::records() const noexcept {
    return state_->queries != VK_NULL_HANDLE;
}

void Timeline::beginFrame(VkCommandBuffer commands, std::uint64_t frameNumber) noexcept {
    State& s = *state_;
    s.current = static_cast<std::uint32_t>(frameNumber % s.desc.framesInFlight);
    State::Frame& frame = s.frames[s.current];
    frame.number = frameNumber;
    frame.rows.clear();
    frame.lost = 0;
    if (!records()) return;
    s.context->device.vk.CmdResetQueryPool(commands, s.queries, s.query(s.current, 0), 2 * s.desc.maxRows);
}

Timeline::Row Timeline::begin(VkCommandBuffer commands, const char* name, Phase phase, RowKind kind) noexcept {
    State& s = *state_;
    State::Frame& frame = s.frames[s.current];
    if (!records() || frame.number == ~std::uint64_t{0}) return kNone;
    if (frame.rows.size() == s.desc.maxRows) {
        ++frame.lost;
        return kNone;
    }
    const auto row = static_cast<Row>(frame.rows.size());
    frame.rows.push_back({name, phase, kind, false});  // within what was reserved
    s.context->device.vk.CmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, s.queries,
                                            s.query(s.current, row));
    return row;
}

void Timeline::end(VkCommandBuffer commands, Row row) noexcept {
    State& s = *state_;
    State::Frame& frame = s.frames[s.current];
    if (row >= frame.rows.size() || frame.rows[row].ended) return;
    s.context->device.vk.CmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, s.queries,
                                            s.query(s.current, row) + 1);
    frame.rows[row].ended = true;
}

std::span<const TimelineRow> Timeline::rows(std::uint64_t frameNumber) const noexcept {
    State& s = *state_;
    const auto index = static_cast<std::uint32_t>(frameNumber % s.desc.framesInFlight);
    const State::Frame& frame = s.frames[index];
    s.answer.clear();
    if (frame.number != frameNumber || frame.rows.empty()) return {};
    const DeviceContext& device = s.context->device;
    struct Ticks {
        std::uint64_t begin, end;
    };
    std::uint64_t first = 0;
    for (Row row = 0; row < frame.rows.size(); ++row) {
        if (!frame.rows[row].ended) continue;
        Ticks ticks = {};
        const VkResult result =
            device.vk.GetQueryPoolResults(device.device, s.queries, s.query(index, row), 2, sizeof(ticks), &ticks,
                                          sizeof(std::uint64_t), VK_QUERY_RESULT_64_BIT);
        if (result != VK_SUCCESS) continue;
        if (s.answer.empty()) first = ticks.begin;
        // Relative to the first row, so that a counter of few bits may wrap around within the frame.
        const auto since = [&](std::uint64_t tick) {
            const std::uint64_t mask = s.context->timestampMask;
            std::uint64_t difference = (tick - first) & mask;
            const bool before = difference > mask / 2;  // recorded later, executed earlier
            if (before) difference = (first - tick) & mask;
            const double ms =
                static_cast<double>(difference) * static_cast<double>(s.context->timestampPeriodNs) * 1e-6;
            return before ? -ms : ms;
        };
        const State::Recorded& r = frame.rows[row];
        s.answer.push_back({r.name, r.phase, r.kind, since(ticks.begin), since(ticks.end)});
    }
    std::stable_sort(s.answer.begin(), s.answer.end(), [](const TimelineRow& a, const TimelineRow& b) {
        return a.beginMilliseconds < b.beginMilliseconds;
    });
    if (s.answer.empty()) return {};
    const double start = s.answer.front().beginMilliseconds;
    for (TimelineRow& row : s.answer) {
        row.beginMilliseconds -= start;
        row.endMilliseconds -= start;
    }
    return s.answer;
}

std::uint32_t Timeline::lostRows(std::uint64_t frameNumber) const noexcept {
    const State::Frame& frame = state_->frames[frameNumber % state_->desc.framesInFlight];
    return frame.number == frameNumber ? frame.lost : 0;
}

}  // namespace gnomon
