#pragma once
// What a compiled shader says of itself: resources, layouts of structures, work group size, constants, capabilities.

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace gnomon::house {

/// A member of a structure of scalars, vectors and matrices. Arrays of a fixed length and structures within the
/// structure count as the members of all their elements.
struct MemberLayout {
    std::size_t offset = 0, bytes = 0;
    char kind = '?';  // 'f' float, 'u' unsigned, '?' anything else
    bool operator==(const MemberLayout&) const = default;
};

/// One thing within a block: a structure, or an array of structures or of scalars and vectors.
struct PartLayout {
    std::size_t offset = 0;
    std::size_t arrayStride = 0;  // 0: no array
    bool runtimeArray = false;
    std::vector<MemberLayout> members;  // a scalar or vector counts as a structure of one
};

struct ResourceLayout {
    std::uint32_t set = 0, binding = 0;
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_MAX_ENUM;
    std::uint32_t count = 1;
    std::vector<PartLayout> parts;       // of a block
    bool read = false, written = false;  // by the shader's instructions; neither: declared and not used
};

struct ShaderLayout {
    std::string name;  // file name without ending
    std::vector<ResourceLayout> resources;
    bool compute = false;
    std::uint32_t workGroup[3] = {};
    std::vector<std::uint32_t> constantIds;   // of specialization constants, ascending
    std::vector<std::uint32_t> capabilities;  // SpvCapability, ascending
    std::uint32_t spirvVersion = 0;           // as in the file's head: 0x00010500 is 1.5
    std::size_t pushConstantBlocks = 0;
};

/// Throws std::runtime_error on a file that is no SPIR-V.
ShaderLayout reflect(const std::filesystem::path& spirv);
ShaderLayout reflectWords(const std::vector<std::uint32_t>& words, const std::string& name);

}  // namespace gnomon::house
