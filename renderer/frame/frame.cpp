// The paper's figure 1, with a G-buffer before it and lighting at its end.
#include "renderer/frame/frame.h"

#include "renderer/gpu/timeline_scope.h"

namespace gnomon::renderer {

ShadowAtlasStatistics recordFrame(VkCommandBuffer commands, const FrameParts& parts, const FrameInput& frame) {
    View& view = parts.view;
    {
        const TimelineScope scope(parts.device, &parts.timeline, commands, "gbuffer", Phase::Host, RowKind::Drawing);
        parts.gbuffer.record(commands, parts.scene, frame.camera, frame.extent.width, frame.extent.height);
    }
    view.recordHierarchicalDepth(commands);
    view.recordFindLightsApproximate(commands);
    view.recordFindLightsAccurate(commands);
    ShadowAtlasStatistics drawn;
    {
        const TimelineScope scope(parts.device, &parts.timeline, commands, "shadow_atlas", Phase::Host,
                                  RowKind::Drawing);
        drawn = parts.atlas.record(commands, parts.scene);
    }
    if (frame.shadows.shadowBounds) view.recordShadowBounds(commands);
    if (frame.mode == ShadowMode::Deferred) {
        view.recordGenerateShadows(commands);
        parts.lighting.recordDeferred(commands, view, frame.shadows, &parts.timeline);
    } else {
        const LightingKind kind = frame.mode == ShadowMode::Inline ? LightingKind::Inline : LightingKind::Unshadowed;
        parts.lighting.recordInline(commands, view, kind, frame.shadows, frame.inlineVariant, &parts.timeline);
    }
    view.recordEndFrame(commands);
    return drawn;
}

}  // namespace gnomon::renderer
