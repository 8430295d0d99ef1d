#include "scene/gltf_material.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <thread>

namespace gnomon::renderer::gltf {
namespace {

// A page of 8192 x 8192; what a small compressed file may unfold to.
constexpr std::uint64_t kMaxPixelsPerImage = 1ull << 26;
constexpr std::uint64_t kMaxPixels = 1ull << 29;

// A factor clamped to the range that glTF's schema gives it.
float factor(double value, float least, float most) {
    return std::isfinite(value) ? static_cast<float>(std::clamp(value, double(least), double(most))) : least;
}

const tinygltf::Value* object(const tinygltf::Value& parent, const char* name) {
    const tinygltf::Value* value = member(parent, name);
    return value && value->IsObject() ? value : nullptr;
}

}  // namespace

std::uint32_t MaterialLoader::use(int material, std::string_view user) {
    if (const auto known = slots_.find(material); known != slots_.end()) return known->second;
    Material loaded;
    if (material == -1) {
        loaded.name = "glTF default";
    } else {
        const tinygltf::Material& source = at(document_.model().materials, material, "material", user);
        loaded = load(source, fmt::format("material {} '{}'", material, source.name.substr(0, 60)));
    }
    const auto slot = static_cast<std::uint32_t>(scene_.materials.size());
    scene_.materials.push_back(std::move(loaded));
    slots_.emplace(material, slot);
    return slot;
}

Material MaterialLoader::load(const tinygltf::Material& source, const std::string& user) {
    Material out;
    out.name = source.name;
    const auto& pbr = source.pbrMetallicRoughness;
    if (pbr.baseColorFactor.size() == 4)
        for (int c = 0; c < 4; ++c)
            out.baseColour[c] = factor(pbr.baseColorFactor[static_cast<std::size_t>(c)], 0.0f, 1.0f);
    out.metallic = factor(pbr.metallicFactor, 0.0f, 1.0f);
    out.roughness = factor(pbr.roughnessFactor, 0.0f, 1.0f);
    out.baseColourTexture = texture(pbr.baseColorTexture, user);
    out.metallicRoughnessTexture = texture(pbr.metallicRoughnessTexture, user);
    out.normalTexture = texture(source.normalTexture, user);
    out.normalScale = factor(source.normalTexture.scale, -16.0f, 16.0f);
    out.emissiveTexture = texture(source.emissiveTexture, user);
    double strength = 1.0;
    if (const auto* emissive = extension(source.extensions, "KHR_materials_emissive_strength"))
        strength = number(*emissive, "emissiveStrength", 1.0, user);
    if (source.emissiveFactor.size() == 3)
        for (int c = 0; c < 3; ++c)
            out.emissive[c] = factor(source.emissiveFactor[static_cast<std::size_t>(c)] * strength, 0.0f, 1.0e6f);
    if (source.alphaMode == "MASK") out.alphaMode = AlphaMode::Mask;
    if (source.alphaMode == "BLEND") out.alphaMode = AlphaMode::Blend;
    out.alphaCutoff = out.alphaMode == AlphaMode::Mask ? factor(source.alphaCutoff, 0.0f, 1.0e6f) : 0.5f;
    out.doubleSided = source.doubleSided;
    if (const auto* glossy = extension(source.extensions, "KHR_materials_pbrSpecularGlossiness"))
        specularGlossiness(*glossy, out, user);
    const tinygltf::Value* flag = member(source.extras, "subsurface");
    out.subsurface = (flag && flag->Get<bool>()) || source.extensions.contains("KHR_materials_transmission") ||
                     source.extensions.contains("KHR_materials_diffuse_transmission");
    return out;
}

// The diffuse part of the older model as a dielectric; its specular colour is left out.
void MaterialLoader::specularGlossiness(const tinygltf::Value& source, Material& material, const std::string& user) {
    const std::vector<double> diffuse = numbers(source, "diffuseFactor", {1.0, 1.0, 1.0, 1.0}, user);
    for (int c = 0; c < 4; ++c) material.baseColour[c] = factor(diffuse[static_cast<std::size_t>(c)], 0.0f, 1.0f);
    material.metallic = 0.0f;
    material.roughness = 1.0f - factor(number(source, "glossinessFactor", 1.0, user), 0.0f, 1.0f);
    material.metallicRoughnessTexture = TextureUse();
    if (const tinygltf::Value* info = object(source, "diffuseTexture")) {
        const tinygltf::Value* extensions = object(*info, "extensions");
        material.baseColourTexture = texture(integer(*info, "index", -1, user), integer(*info, "texCoord", 0, user),
                                             extensions ? object(*extensions, "KHR_texture_transform") : nullptr, user);
    }
}

template <class Info>
TextureUse MaterialLoader::texture(const Info& info, const std::string& user) {
    if (info.index == -1) return {};
    return texture(info.index, info.texCoord, extension(info.extensions, "KHR_texture_transform"), user);
}

TextureUse MaterialLoader::texture(int index, int texcoord, const tinygltf::Value* transform, const std::string& user) {
    const tinygltf::Texture& source = at(document_.model().textures, index, "texture", user);
    TextureUse out;
    if (source.source == -1) {
        document_.note(fmt::format("Texture {} of {} has no PNG or JPEG image and is left out.", index, user));
        return out;
    }
    at(document_.images(), source.source, "image", fmt::format("texture {}", index));
    glm::mat2 matrix(1.0f);
    glm::vec2 offset(0.0f);
    if (transform) {
        const auto move = numbers(*transform, "offset", {0.0, 0.0}, user);
        const auto scale = numbers(*transform, "scale", {1.0, 1.0}, user);
        const float turn = toFloat(number(*transform, "rotation", 0.0, user), user);
        const float cosine = std::cos(turn), sine = std::sin(turn);
        texcoord = integer(*transform, "texCoord", texcoord, user);
        offset = {toFloat(move[0], user), toFloat(move[1], user)};
        // Counter-clockwise in a space whose v points down. Columns: images of u and v.
        matrix = glm::mat2(glm::vec2(cosine, -sine) * toFloat(scale[0], user),
                           glm::vec2(sine, cosine) * toFloat(scale[1], user));
    }
    if (texcoord < 0 || texcoord > 1) {
        document_.note(fmt::format("Texture {} of {} uses TEXCOORD_{}; only 0 and 1 are read, so it is left out.",
                                   index, user, texcoord));
        return out;
    }
    out.texcoord = static_cast<std::uint32_t>(texcoord);
    bool mirrorU = false, mirrorV = false;
    if (source.sampler != -1) {
        const tinygltf::Sampler& sampler =
            at(document_.model().samplers, source.sampler, "sampler", fmt::format("texture {}", index));
        out.repeatU = sampler.wrapS != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
        out.repeatV = sampler.wrapT != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
        mirrorU = sampler.wrapS == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
        mirrorV = sampler.wrapT == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
        out.linear = sampler.magFilter != TINYGLTF_TEXTURE_FILTER_NEAREST;
    }
    const glm::vec2 halve(mirrorU ? 0.5f : 1.0f, mirrorV ? 0.5f : 1.0f);
    out.uvTransform = glm::mat2(matrix[0] * halve, matrix[1] * halve);
    out.uvOffset = offset * halve;
    const ImageKey key(source.source, mirrorU, mirrorV);
    out.image = imageSlots_.emplace(key, static_cast<std::uint32_t>(imageSlots_.size())).first->second;
    return out;
}

void MaterialLoader::noteBlended() {
    constexpr std::size_t kMostNamed = 3;
    std::vector<std::string> names;
    std::size_t count = 0;
    for (const Material& material : scene_.materials) {
        if (material.alphaMode != AlphaMode::Blend) continue;
        ++count;
        if (!material.name.empty() && names.size() < kMostNamed)
            names.push_back(fmt::format("'{}'", material.name.substr(0, 40)));
    }
    if (count == 0) return;
    if (!names.empty() && names.size() < count) names.emplace_back("...");
    document_.note(fmt::format("{} of {} materials {} blended{}: alpha below 0.5 is cut out, the rest is drawn opaque.",
                               count, scene_.materials.size(), count == 1 ? "is" : "are",
                               names.empty() ? "" : fmt::format(" ({})", fmt::join(names, ", "))));
}

void MaterialLoader::decodeImages() {
    struct Job {
        ImageKey key;
        std::vector<std::uint8_t> storage;
        std::span<const std::uint8_t> encoded;
        Image image;
        bool good = false;
        std::string reason;
    };
    std::vector<Job> jobs(imageSlots_.size());
    std::uint64_t pixels = 0;
    for (const auto& [key, slot] : imageSlots_) {
        Job& job = jobs[slot];
        job.key = key;
        job.encoded = document_.encodedImage(std::get<0>(key), job.storage);
        const std::uint64_t unfolded = imagePixels(job.encoded) << (int(std::get<1>(key)) + int(std::get<2>(key)));
        if (unfolded > kMaxPixelsPerImage || pixels + unfolded > kMaxPixels) {
            document_.note(fmt::format("Image {} is left out: it unfolds to {} pixels.", std::get<0>(key), unfolded));
            job.encoded = {};
        } else {
            pixels += unfolded;
        }
    }
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
        for (std::size_t i = next++; i < jobs.size(); i = next++) {
            Job& job = jobs[i];
            if (job.encoded.empty()) continue;
            job.good = decodeImage(job.encoded, std::get<1>(job.key), std::get<2>(job.key), job.image, job.reason);
            if (!job.good && job.reason.empty()) job.reason = "it cannot be decoded";
        }
    };
    {
        const std::size_t helpers =
            std::min<std::size_t>({std::max(1u, std::thread::hardware_concurrency()) - 1, jobs.size(), 15});
        std::vector<std::jthread> threads;
        for (std::size_t i = 0; i < helpers; ++i) threads.emplace_back(work);
        work();
    }
    std::vector<std::uint32_t> finalSlot(jobs.size(), kNone);
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        if (!jobs[i].good) {
            if (!jobs[i].reason.empty())
                document_.note(fmt::format("Image {} is left out: {}.", std::get<0>(jobs[i].key), jobs[i].reason));
            continue;
        }
        finalSlot[i] = static_cast<std::uint32_t>(scene_.images.size());
        scene_.images.push_back(std::move(jobs[i].image));
    }
    for (Material& material : scene_.materials)
        for (TextureUse* use : {&material.baseColourTexture, &material.metallicRoughnessTexture,
                                &material.normalTexture, &material.emissiveTexture})
            if (use->image != kNone) use->image = finalSlot[use->image];
}

}  // namespace gnomon::renderer::gltf
