#pragma once
// The G-buffer and the pass that draws it.
//
// Clip space, depth range and jitter are the caller's; the pass looks at the matrix for nothing but the winding of
// mirrored views and the frustum.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "gnomon/scene.h"
#include "renderer/gpu/gpu_scene.h"

namespace gnomon::renderer {

/// What the pass needs of a camera. Positions are relative to the origin that GpuScene::recordTransforms() was given.
struct GBufferCamera {
    glm::mat4 viewFromWorld{1.0f}, clipFromView{1.0f};
    glm::mat4 clipFromWorld{1.0f};          ///< their product, for culling
    glm::vec4 eye{0.0f, 0.0f, 0.0f, 1.0f};  ///< xyz position, w 1; orthographic: xyz direction towards the camera, w 0
    DeviceDepth deviceDepth = DeviceDepth::ReversedZ;
    bool mirrored = false;  ///< the view turns the winding around (a reflection)
};
/// From the library's description of a camera, which holds everything needed.
GBufferCamera gbufferCameraOf(const Camera& camera);

struct GBufferStatistics {
    std::uint32_t draws = 0;
    std::uint64_t triangles = 0;
};

/// Images of one size. After record() each is in SHADER_READ_ONLY_OPTIMAL, visible to sampled reads of compute and
/// fragment shaders. Not thread safe.
class GBuffer {
public:
    enum Channel : std::uint32_t {
        BaseColour,    ///< R8G8B8A8_SRGB: linear colour when sampled; alpha 1 where there is geometry
        Normal,        ///< R16G16_UINT: shading normal, octahedral
        MaterialData,  ///< R8G8B8A8_UNORM: metallic, roughness, subsurface, 0
        Emissive,      ///< B10G11R11_UFLOAT: linear
        FaceNormal,    ///< R16G16_UINT: face normal, octahedral, on the side that the camera sees
        Receiver,      ///< R8G8_UINT: receiver mask 255; bit 0: subsurface
        TriangleId,    ///< R32_UINT: GpuScene::triangle(); 0xFFFFFFFF: background
        kColourCount
    };
    static constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
    static constexpr std::array<VkFormat, kColourCount> kFormats = {
        VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R16G16_UINT, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B10G11R11_UFLOAT_PACK32,
        VK_FORMAT_R16G16_UINT,   VK_FORMAT_R8G8_UINT,   VK_FORMAT_R32_UINT};

    /// The scene gives the set layouts; any other GpuScene may be drawn as well. Throws GpuError.
    GBuffer(const Device& device, const GpuScene& scene, std::uint32_t width, std::uint32_t height);
    /// New images; the device must have finished with the old ones.
    void resize(std::uint32_t width, std::uint32_t height);

    /// Culls on the CPU, draws into the images' upper left `activeWidth` x `activeHeight` pixels (0: all).
    GBufferStatistics record(VkCommandBuffer commands, const GpuScene& scene, const GBufferCamera& camera,
                             std::uint32_t activeWidth = 0, std::uint32_t activeHeight = 0);

    [[nodiscard]] const GpuImage& image(Channel channel) const { return colours_[channel]; }
    [[nodiscard]] VkImageView view(Channel channel) const { return colours_[channel].view(); }
    [[nodiscard]] const GpuImage& depth() const { return depth_; }
    [[nodiscard]] VkExtent2D extent() const { return extent_; }
    [[nodiscard]] std::vector<MemoryRow> memoryRows() const;

private:
    void beginRendering(VkCommandBuffer commands, VkExtent2D active, DeviceDepth deviceDepth) const;
    GBufferStatistics drawRanges(VkCommandBuffer commands, const GpuScene& scene, const GBufferCamera& camera) const;
    void recordLayouts(VkCommandBuffer commands, bool forDrawing) const;

    const Device& device_;
    VkExtent2D extent_{};
    std::array<GpuImage, kColourCount> colours_;
    GpuImage depth_;
    PipelineLayout layout_;
    Pipeline opaque_, masked_;
    std::vector<DrawRange> ranges_;
};

}  // namespace gnomon::renderer
