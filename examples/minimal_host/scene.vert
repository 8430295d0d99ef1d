#version 460
// The scene's triangles, for the camera and for every shadow view.
layout(location = 0) in vec3 positionWs;
layout(location = 1) in vec3 normalWs;
layout(location = 0) flat out vec3 faceNormalWs;
layout(push_constant) uniform Push { mat4 clipFromWorld; };

void main() {
    // The camera's depth must come from the very matrix that the library is told of. With standard Z instead of
    // reversed Z, transform into the view first and then into clip space: far from the origin one matrix rounds more.
    gl_Position = clipFromWorld * vec4(positionWs, 1.0);
    faceNormalWs = normalWs;
}
