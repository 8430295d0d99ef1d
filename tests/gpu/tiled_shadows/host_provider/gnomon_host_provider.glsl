// A host's own visibility provider, for tests: bright and grey half-metre cells in the world, whatever the shadowmaps
// hold.
#ifndef GNOMON_TESTS_HOST_PROVIDER_GLSL
#define GNOMON_TESTS_HOST_PROVIDER_GLSL

float hostVisibility(GpuLight light, Receiver receiver, vec3 toLight) {
    ivec3 cell = ivec3(floor(receiver.positionWs * 2.0));
    return ((cell.x + cell.y + cell.z) & 1) == 0 ? 1.0 : 0.25;
}

#endif
