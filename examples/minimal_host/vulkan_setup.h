#pragma once
// What an engine has long before it meets this library: a device, memory, images, pipelines, command buffers. Nothing
// in here is about shadows, except for the three device features in Device's constructor that the library needs.

#include <vulkan/vulkan.h>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace host {

/// Throws a sentence unless the call succeeded.
void check(VkResult result, const char* call);

struct Buffer {
    VkBuffer handle = VK_NULL_HANDLE;
    void* mapped = nullptr;  ///< host-visible and coherent
};

struct Image {
    VkImage handle = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkImageAspectFlags aspect = 0;
};

/// Stage and access of one side of a barrier.
struct Use {
    VkPipelineStageFlags2 stage = VK_PIPELINE_STAGE_2_NONE;
    VkAccessFlags2 access = VK_ACCESS_2_NONE;
};

/// Waits for `from`, makes its writes visible to `to`, and changes the layout.
void imageBarrier(VkCommandBuffer commands, const Image& image, Use from, VkImageLayout before, Use to,
                  VkImageLayout after);

/// Instance, device and one queue for everything. Owns what is made with it.
class Device {
public:
    /// Throws a sentence if there is no such device or if it cannot run this program.
    explicit Device(std::uint32_t index);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    Buffer makeBuffer(VkDeviceSize bytes, VkBufferUsageFlags usage);
    /// One layer, one mip level. `viewType` 2D_ARRAY is what the library wants of a shadow atlas.
    Image makeImage(VkFormat format, std::uint32_t widthPx, std::uint32_t heightPx, VkImageUsageFlags usage,
                    VkImageViewType viewType = VK_IMAGE_VIEW_TYPE_2D);
    VkPipelineLayout makePipelineLayout(std::span<const VkDescriptorSetLayout> sets, std::uint32_t pushBytes = 0);
    VkShaderModule makeShader(std::span<const std::uint32_t> spirv);
    /// Constant `id` of the shader has the id-th value.
    VkPipeline makeComputePipeline(std::span<const std::uint32_t> spirv, VkPipelineLayout layout,
                                   std::span<const std::uint32_t> constants);
    /// `destroy` runs when the device ends, the last one first. It may capture the device, and nothing that ends
    /// earlier.
    void own(std::function<void()> destroy) { undo_.push_back(std::move(destroy)); }

    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice handle = VK_NULL_HANDLE;
    std::uint32_t queueFamily = 0;
    VkQueue queue = VK_NULL_HANDLE;

private:
    void choosePhysical(std::uint32_t index);
    void chooseQueueFamily();
    void makeDevice();
    VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted);

    std::vector<std::function<void()>> undo_;
};

/// A command buffer and a fence for each frame in flight.
class FrameRing {
public:
    FrameRing(Device& device, std::uint32_t framesInFlight);
    /// Waits until frame `number` - framesInFlight has finished: the library counts on that. Then begins recording.
    VkCommandBuffer begin(std::uint64_t number);
    void submit(std::uint64_t number);
    /// Until everything submitted has finished.
    void waitForAll() const;

private:
    struct Frame {
        VkCommandBuffer commands = VK_NULL_HANDLE;
        VkFence finished = VK_NULL_HANDLE;
    };
    Device& device_;
    std::vector<Frame> frames_;
};

}  // namespace host
