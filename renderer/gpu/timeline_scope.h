#pragma once
// A row of the timeline, and a debug label, for the block it lives in.

#include "gnomon/timeline.h"
#include "renderer/gpu/device.h"

namespace gnomon::renderer {

/// Outside of rendering or wholly within one. `name` is a literal; a null timeline is fine.
class TimelineScope {
public:
    TimelineScope(const Device& device, Timeline* timeline, VkCommandBuffer commands, const char* name, Phase phase,
                  RowKind kind)
        : device_(device), timeline_(timeline), commands_(commands) {
        device_.beginLabel(commands, name);
        if (timeline_ != nullptr) row_ = timeline_->begin(commands, name, phase, kind);
    }
    ~TimelineScope() {
        if (timeline_ != nullptr) timeline_->end(commands_, row_);
        device_.endLabel(commands_);
    }
    TimelineScope(const TimelineScope&) = delete;
    TimelineScope& operator=(const TimelineScope&) = delete;

private:
    const Device& device_;
    Timeline* timeline_;
    VkCommandBuffer commands_;
    Timeline::Row row_ = Timeline::kNone;
};

}  // namespace gnomon::renderer
