# Phase 4 with a host's own visibility provider, compiled as a host would.
gnomon_add_shaders(gpu_tiled_shadows_tests
    ${GNOMON_SHADER_INCLUDE_DIR}/generate_shadows/generate_shadows.comp:generate_shadows_host_provider:GNOMON_HOST_PROVIDER
    INCLUDES gpu/tiled_shadows/host_provider)
