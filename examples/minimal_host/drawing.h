#pragma once
// What the host draws for the library to read: the camera's depth and face normals, and the shadowmaps. Each record
// function leaves its images as the library wants them: SHADER_READ_ONLY_OPTIMAL, visible to sampling compute shaders.

#include <gnomon/scene.h>

#include <span>

#include "scene.h"
#include "vulkan_setup.h"

namespace host {

class Drawing {
public:
    Drawing(Device& device, std::uint32_t widthPx, std::uint32_t heightPx, std::uint32_t atlasPx);

    void recordGBuffer(VkCommandBuffer commands, const Mat4& clipFromWorld);
    /// Draws those that changed; the others stay in the atlas as they are.
    void recordShadowmaps(VkCommandBuffer commands, std::span<const gnomon::ShadowView> views);

    [[nodiscard]] const Image& depth() const { return depth_; }
    [[nodiscard]] const Image& faceNormals() const { return faceNormals_; }
    [[nodiscard]] const Image& atlas() const { return atlas_; }

private:
    VkPipeline makePipeline(bool gbuffer);
    void drawScene(VkCommandBuffer commands, const VkRect2D& rectangle, const float* clipFromWorld);

    Device& device_;
    VkExtent2D extent_;
    VkExtent2D atlasExtent_;
    Image depth_, faceNormals_, atlas_;
    VkImageLayout atlasLayout_ = VK_IMAGE_LAYOUT_UNDEFINED;
    Buffer vertices_;
    std::uint32_t vertexCount_ = 0;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline gbufferPipeline_ = VK_NULL_HANDLE, shadowPipeline_ = VK_NULL_HANDLE;
};

}  // namespace host
