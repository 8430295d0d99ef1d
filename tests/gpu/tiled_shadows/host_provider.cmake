# Phase 4 with a host's own visibility provider, compiled as a host would.
set(dir ${CMAKE_CURRENT_BINARY_DIR}/shaders)
set(header ${dir}/generate_shadows_host_provider.spv.h)
set(host_provider_dir ${CMAKE_CURRENT_SOURCE_DIR}/gpu/tiled_shadows/host_provider)
file(MAKE_DIRECTORY ${dir})
add_custom_command(
    OUTPUT ${header}
    COMMAND ${GLSLC} --target-env=vulkan1.2 -O -mfmt=num -I${GNOMON_SHADER_INCLUDE_DIR} -I${host_provider_dir}
            -DGNOMON_HOST_PROVIDER -MD -MF ${header}.d -MT ${header} -o ${header}
            ${GNOMON_SHADER_INCLUDE_DIR}/generate_shadows/generate_shadows.comp
    DEPENDS ${GNOMON_SHADER_INCLUDE_DIR}/generate_shadows/generate_shadows.comp
            ${host_provider_dir}/gnomon_host_provider.glsl
    DEPFILE ${header}.d
    COMMENT "Shader generate_shadows_host_provider"
    VERBATIM)
target_sources(gpu_tiled_shadows_tests PRIVATE ${header})
target_include_directories(gpu_tiled_shadows_tests PRIVATE ${dir})
