#pragma once
// Samples of a D32 array image, as many as wanted: texel fetches and gathers, coherent and scattered.

#include <cstdint>
#include <vector>

#include "renderer/gpu/pipeline.h"
#include "renderer/gpu/resources.h"
#include "renderer/rates/stopwatch.h"

namespace gnomon::renderer {

/// What texture_rate.comp does.
struct SampleKind {
    bool gathers = false;  ///< 2x2 texels by textureGather, with a nearest sampler; else one by texelFetch
    bool scattered =
        false;  ///< each lane in its own place of a square of 32x32 texels; else neighbours read neighbours
};

struct SampleAmount {
    std::uint32_t groups = 0;  ///< of 64 lanes
    std::uint32_t rounds = 0;  ///< of four samples per lane
};

/// The device must outlive it. Its functions throw GpuError and wait for the device. Not thread safe.
class TextureRate {
public:
    explicit TextureRate(const Device& device);

    /// Samples per second, best of several runs of some milliseconds.
    [[nodiscard]] double measure(const Stopwatch& watch, SampleKind kind) const;

    /// By group and lane, the xor of the bits of all depths read: for tests. At most kMostSampleGroups groups.
    [[nodiscard]] std::vector<std::uint32_t> results(SampleKind kind, SampleAmount amount) const;
    static constexpr std::uint32_t kMostSampleGroups = 32768;  // below every device's limit of 65535

    /// What the image holds, row by row: from 0 to 1, without a pattern that a device could compress.
    [[nodiscard]] static std::vector<float> depths();

private:
    [[nodiscard]] Pipeline makePipeline(SampleKind kind) const;
    void record(VkCommandBuffer commands, VkPipeline pipeline, SampleAmount amount) const;

    const Device& device_;
    GpuImage atlas_;
    Sampler sampler_;
    Buffer result_;
    SetLayout setLayout_;
    PipelineLayout layout_;
    DescriptorPool pool_;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
};

}  // namespace gnomon::renderer
