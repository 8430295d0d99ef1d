# Phase 4 with a host's own visibility provider, compiled as a host would.
gnomon_add_shaders(gpu_tiled_shadows_tests
    ${GNOMON_SHADER_INCLUDE_DIR}/generate_shadows/filter_pairs.comp:filter_pairs_host_provider:GNOMON_HOST_PROVIDER
    INCLUDES gpu/tiled_shadows/host_provider)
