#include "unit/house/reflection.h"

#include <spirv_cross/spirv_cross_c.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <stdexcept>

#include "unit/house/accesses.h"

namespace gnomon::house {
namespace {

struct Reflector {
    spvc_context context = nullptr;
    spvc_compiler compiler = nullptr;
    ~Reflector() {
        if (context != nullptr) spvc_context_destroy(context);
    }
};

void check(const Reflector& r, spvc_result result, const std::string& name) {
    if (result == SPVC_SUCCESS) return;
    throw std::runtime_error(name + ": " + spvc_context_get_last_error_string(r.context));
}

char kindOf(spvc_basetype type) {
    if (type == SPVC_BASETYPE_FP32) return 'f';
    return type == SPVC_BASETYPE_UINT32 ? 'u' : '?';
}

MemberLayout memberOf(spvc_type type, std::size_t offset) {
    const std::size_t count = std::size_t(spvc_type_get_vector_size(type)) * spvc_type_get_columns(type);
    return {offset, count * spvc_type_get_bit_width(type) / 8, kindOf(spvc_type_get_basetype(type))};
}

// The members of a structure that begins at `start`, with those of structures and arrays within it.
void addMembers(const Reflector& r, spvc_type type, std::size_t start, const std::string& name,
                std::vector<MemberLayout>& out) {
    for (unsigned i = 0; i < spvc_type_get_num_member_types(type); ++i) {
        unsigned offset = 0, stride = 0;
        check(r, spvc_compiler_type_struct_member_offset(r.compiler, type, i, &offset), name);
        const spvc_type member = spvc_compiler_get_type_handle(r.compiler, spvc_type_get_member_type(type, i));
        std::size_t elements = 1;
        if (spvc_type_get_num_array_dimensions(member) != 0) {
            check(r, spvc_compiler_type_struct_member_array_stride(r.compiler, type, i, &stride), name);
            elements = spvc_type_get_array_dimension(member, 0);
        }
        for (std::size_t element = 0; element < elements; ++element) {
            const std::size_t at = start + offset + element * stride;
            if (spvc_type_get_basetype(member) == SPVC_BASETYPE_STRUCT) {
                addMembers(r, spvc_compiler_get_type_handle(r.compiler, spvc_type_get_base_type_id(member)), at, name,
                           out);
                continue;
            }
            MemberLayout layout = memberOf(member, at);
            if (spvc_type_get_columns(member) > 1) {
                unsigned column = 0;
                check(r, spvc_compiler_type_struct_member_matrix_stride(r.compiler, type, i, &column), name);
                layout.bytes = std::size_t(column) * spvc_type_get_columns(member);
            }
            out.push_back(layout);
        }
    }
}

std::vector<MemberLayout> membersOf(const Reflector& r, spvc_type type, const std::string& name) {
    if (spvc_type_get_basetype(type) != SPVC_BASETYPE_STRUCT) return {memberOf(type, 0)};
    std::vector<MemberLayout> out;
    addMembers(r, type, 0, name, out);
    return out;
}

std::vector<PartLayout> partsOf(const Reflector& r, spvc_type block, const std::string& name) {
    std::vector<PartLayout> out;
    for (unsigned i = 0; i < spvc_type_get_num_member_types(block); ++i) {
        PartLayout part;
        unsigned offset = 0, stride = 0;
        check(r, spvc_compiler_type_struct_member_offset(r.compiler, block, i, &offset), name);
        part.offset = offset;
        spvc_type type = spvc_compiler_get_type_handle(r.compiler, spvc_type_get_member_type(block, i));
        if (spvc_type_get_num_array_dimensions(type) != 0) {
            check(r, spvc_compiler_type_struct_member_array_stride(r.compiler, block, i, &stride), name);
            part.arrayStride = stride;
            part.runtimeArray = spvc_type_get_array_dimension(type, 0) == 0;
        }
        part.members = membersOf(r, spvc_compiler_get_type_handle(r.compiler, spvc_type_get_base_type_id(type)), name);
        out.push_back(part);
    }
    return out;
}

void addResources(const Reflector& r, spvc_resources all, const std::map<std::uint32_t, ShaderAccess>& accesses,
                  ShaderLayout& out) {
    const struct {
        spvc_resource_type from;
        VkDescriptorType to;
    } kinds[] = {
        {SPVC_RESOURCE_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
        {SPVC_RESOURCE_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
        {SPVC_RESOURCE_TYPE_SEPARATE_IMAGE, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
        {SPVC_RESOURCE_TYPE_SEPARATE_SAMPLERS, VK_DESCRIPTOR_TYPE_SAMPLER},
        {SPVC_RESOURCE_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
        {SPVC_RESOURCE_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
        {SPVC_RESOURCE_TYPE_SUBPASS_INPUT, VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT},
        {SPVC_RESOURCE_TYPE_ACCELERATION_STRUCTURE, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR},
    };
    for (const auto& kind : kinds) {
        const spvc_reflected_resource* list = nullptr;
        std::size_t count = 0;
        check(r, spvc_resources_get_resource_list_for_type(all, kind.from, &list, &count), out.name);
        for (std::size_t i = 0; i < count; ++i) {
            ResourceLayout resource;
            resource.set = spvc_compiler_get_decoration(r.compiler, list[i].id, SpvDecorationDescriptorSet);
            resource.binding = spvc_compiler_get_decoration(r.compiler, list[i].id, SpvDecorationBinding);
            resource.type = kind.to;
            if (const auto access = accesses.find(list[i].id); access != accesses.end()) {
                resource.read = access->second.read;
                resource.written = access->second.written;
            }
            const spvc_type type = spvc_compiler_get_type_handle(r.compiler, list[i].type_id);
            if (spvc_type_get_num_array_dimensions(type) != 0) resource.count = spvc_type_get_array_dimension(type, 0);
            const spvc_type base = spvc_compiler_get_type_handle(r.compiler, list[i].base_type_id);
            if (spvc_type_get_basetype(base) == SPVC_BASETYPE_STRUCT) resource.parts = partsOf(r, base, out.name);
            out.resources.push_back(resource);
        }
    }
    const spvc_reflected_resource* list = nullptr;
    check(r,
          spvc_resources_get_resource_list_for_type(all, SPVC_RESOURCE_TYPE_PUSH_CONSTANT, &list,
                                                    &out.pushConstantBlocks),
          out.name);
}

void addEntryPoint(const Reflector& r, ShaderLayout& out) {
    out.compute = spvc_compiler_get_execution_model(r.compiler) == SpvExecutionModelGLCompute;
    if (out.compute) {
        for (unsigned i = 0; i < 3; ++i) {
            out.workGroup[i] =
                spvc_compiler_get_execution_mode_argument_by_index(r.compiler, SpvExecutionModeLocalSize, i);
        }
    }
    const spvc_specialization_constant* constants = nullptr;
    std::size_t count = 0;
    check(r, spvc_compiler_get_specialization_constants(r.compiler, &constants, &count), out.name);
    for (std::size_t i = 0; i < count; ++i) out.constantIds.push_back(constants[i].constant_id);
    std::ranges::sort(out.constantIds);
    const SpvCapability* capabilities = nullptr;
    check(r, spvc_compiler_get_declared_capabilities(r.compiler, &capabilities, &count), out.name);
    for (std::size_t i = 0; i < count; ++i) out.capabilities.push_back(static_cast<std::uint32_t>(capabilities[i]));
    std::ranges::sort(out.capabilities);
}

}  // namespace

ShaderLayout reflectWords(const std::vector<std::uint32_t>& words, const std::string& name) {
    if (words.size() < 5 || words[0] != SpvMagicNumber) throw std::runtime_error(name + " is no SPIR-V");
    ShaderLayout out;
    out.name = name;
    out.spirvVersion = words[1];
    Reflector r;
    if (spvc_context_create(&r.context) != SPVC_SUCCESS) throw std::runtime_error("SPIRV-Cross does not start");
    spvc_parsed_ir ir = nullptr;
    check(r, spvc_context_parse_spirv(r.context, words.data(), words.size(), &ir), name);
    check(r,
          spvc_context_create_compiler(r.context, SPVC_BACKEND_NONE, ir, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP, &r.compiler),
          name);
    spvc_resources resources = nullptr;
    check(r, spvc_compiler_create_shader_resources(r.compiler, &resources), name);
    addResources(r, resources, accessesOf(words, name), out);
    addEntryPoint(r, out);
    return out;
}

ShaderLayout reflect(const std::filesystem::path& spirv) {
    std::ifstream in(spirv, std::ios::binary | std::ios::ate);
    if (!in) throw std::runtime_error(spirv.string() + " cannot be read");
    std::vector<std::uint32_t> words(static_cast<std::size_t>(in.tellg()) / 4);
    in.seekg(0);
    in.read(reinterpret_cast<char*>(words.data()), static_cast<std::streamsize>(words.size() * 4));
    return reflectWords(words, spirv.stem().string());
}

}  // namespace gnomon::house
