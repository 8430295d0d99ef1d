// Textures, samplers, and one descriptor set per material: no descriptor indexing is needed.
#include <algorithm>

#include "renderer/gpu/gpu_scene.h"
#include "renderer/gpu/scene_data.h"

namespace gnomon::renderer {

namespace {

constexpr VkDescriptorType kMaterialTypes[] = {
    VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
    VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
    VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};
// A multiple of every minUniformBufferOffsetAlignment (at most 256).
constexpr VkDeviceSize kMaterialStride = 256;
constexpr std::uint32_t kWhiteImage = 0;  // stands in where there is no texture

GpuTextureUse packUse(const TextureUse& use) {
    const glm::mat2& m = use.uvTransform;  // column major
    return {{m[0][0], m[1][0], m[0][1], m[1][1]},
            {use.uvOffset.x, use.uvOffset.y, static_cast<float>(use.texcoord), use.image != kNone ? 1.0f : 0.0f}};
}

GpuMaterial packMaterial(const Material& material) {
    GpuMaterial out{};
    out.baseColour = material.baseColour;
    out.emissiveAlphaCutoff = glm::vec4(material.emissive, leastOpaqueAlpha(material));
    out.metallicRoughness = {material.metallic, material.roughness, material.normalScale, 0.0f};
    out.baseColourUse = packUse(material.baseColourTexture);
    out.metallicRoughnessUse = packUse(material.metallicRoughnessTexture);
    out.normalUse = packUse(material.normalTexture);
    out.emissiveUse = packUse(material.emissiveTexture);
    out.flags = material.subsurface ? kMaterialSubsurfaceBit : 0u;
    return out;
}

}  // namespace

std::uint32_t GpuScene::imageOf(const TextureUse& use, bool srgb, Uploader& uploader, const Scene& scene) {
    if (use.image == kNone) return kWhiteImage;
    std::uint32_t& index = imageIndex_[srgb ? 1 : 0][use.image];
    if (index == kNone) {
        const Image& source = scene.images[use.image];
        ImageDesc desc;
        desc.name = "scene texture " + std::to_string(use.image);
        desc.format = srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
        desc.width = source.width;
        desc.height = source.height;
        desc.mips = mipCountOf(source.width, source.height);
        desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
        images_.emplace_back(device_, desc);
        uploader.image(images_.back(), source.rgba8);
        index = static_cast<std::uint32_t>(images_.size() - 1);
    }
    return index;
}

VkSampler GpuScene::samplerOf(const TextureUse& use) const {
    return samplers_[(use.repeatU ? 1u : 0u) + (use.repeatV ? 2u : 0u) + (use.linear ? 4u : 0u)].handle();
}

void GpuScene::createImages(const Scene& scene, Uploader& uploader) {
    for (auto& indices : imageIndex_) indices.assign(scene.images.size(), kNone);
    ImageDesc white;
    white.name = "white texture";
    white.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    images_.emplace_back(device_, white);
    const std::uint8_t texel[] = {255, 255, 255, 255};
    uploader.image(images_.back(), texel);
    for (std::uint32_t s = 0; s < 8; ++s) {
        SamplerDesc desc;
        desc.repeatU = (s & 1u) != 0;
        desc.repeatV = (s & 2u) != 0;
        desc.linear = (s & 4u) != 0;
        // On a CPU each extra tap costs as much as the whole lighting of a pixel.
        desc.anisotropy = device_.info().properties.deviceType != VK_PHYSICAL_DEVICE_TYPE_CPU;
        samplers_.emplace_back(device_, desc);
    }
}

void GpuScene::createMaterials(const Scene& scene, Uploader& uploader) {
    createImages(scene, uploader);
    const auto count = static_cast<std::uint32_t>(scene.materials.size());
    std::vector<std::byte> records(count * kMaterialStride);
    for (std::uint32_t m = 0; m < count; ++m) {
        const GpuMaterial packed = packMaterial(scene.materials[m]);
        std::copy_n(reinterpret_cast<const std::byte*>(&packed), sizeof(packed), records.data() + m * kMaterialStride);
    }
    materialBuffer_ = Buffer(device_, "scene materials", records.size(),
                             VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    if (!records.empty()) uploader.buffer(materialBuffer_, records);
    materialSetLayout_ =
        makeSetLayout(device_, kMaterialTypes, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT);
    materialPool_ = makeDescriptorPool(device_, std::max(count, 1u), kMaterialTypes);
    for (std::uint32_t m = 0; m < count; ++m) {
        const Material& material = scene.materials[m];
        const VkDescriptorSet set = allocateSet(device_, materialPool_, materialSetLayout_);
        writeBuffer(device_, set, 0, kMaterialTypes[0], materialBuffer_.handle(), m * kMaterialStride,
                    sizeof(GpuMaterial));
        const TextureUse* uses[] = {&material.baseColourTexture, &material.metallicRoughnessTexture,
                                    &material.normalTexture, &material.emissiveTexture};
        const bool srgb[] = {true, false, false, true};
        for (std::uint32_t t = 0; t < 4; ++t) {
            const std::uint32_t image = imageOf(*uses[t], srgb[t], uploader, scene);
            writeImage(device_, set, t + 1, kMaterialTypes[t + 1], images_[image].view(), samplerOf(*uses[t]));
        }
        materialSets_.push_back(set);
    }
}

}  // namespace gnomon::renderer
