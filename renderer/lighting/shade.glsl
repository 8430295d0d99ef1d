// Physically based shading: metallic-roughness with a GGX lobe, punctual lights, ambient light of two colours.
//
// Source: Khronos glTF 2.0 specification, appendix B (BRDF) and KHR_lights_punctual (attenuation); Walter et al. 2007
// for the GGX distribution, Heitz 2014 for its height-correlated masking, Schlick 1994 for Fresnel.
#ifndef GNOMON_RENDERER_SHADE_GLSL
#define GNOMON_RENDERER_SHADE_GLSL

#include "renderer/lighting/lighting_set.glsl"
#include "shading/light_tests.glsl"
#include "shading/octahedral.glsl"

const float kPi = 3.14159265358979;

struct Surface {
    vec3 normal;      // shading normal, unit
    vec3 toEye;       // unit
    vec3 diffuse;     // diffuse albedo
    vec3 specular;    // reflectance at normal incidence
    float roughness;  // GGX alpha
    vec3 emissive;
    bool subsurface;
};

Surface surfaceAt(ivec2 pixel, vec3 toEye, bool subsurface) {
    vec3 baseColour = texelFetch(gbufferBaseColour, pixel, 0).rgb;
    vec2 material = texelFetch(gbufferMaterial, pixel, 0).rg;
    Surface s;
    s.normal = decodeOctahedral(texelFetch(gbufferNormal, pixel, 0).xy);
    s.toEye = toEye;
    s.diffuse = baseColour * (1.0 - material.r);
    s.specular = mix(vec3(0.04), baseColour, material.r);
    s.roughness = max(material.g * material.g, 0.002);
    s.emissive = texelFetch(gbufferEmissive, pixel, 0).rgb;
    s.subsurface = subsurface;
    return s;
}

// Reflected radiance per unit of irradiance on a surface facing the light, times the cosine.
vec3 reflected(Surface s, vec3 toLight) {
    float nl = dot(s.normal, toLight);
    // Light through thin matter: a wrapped, dimmer diffuse term from behind.
    float diffuseCosine = s.subsurface ? max(nl, 0.0) + 0.4 * max(-nl, 0.0) : max(nl, 0.0);
    vec3 result = s.diffuse / kPi * diffuseCosine;
    if (nl <= 0.0) return result;
    vec3 h = normalize(toLight + s.toEye);
    float nv = max(abs(dot(s.normal, s.toEye)), 1e-4);
    float nh = clamp(dot(s.normal, h), 0.0, 1.0);
    float lh = clamp(dot(toLight, h), 0.0, 1.0);
    float a2 = s.roughness * s.roughness;
    float d = nh * nh * (a2 - 1.0) + 1.0;
    float distribution = a2 / (kPi * d * d);
    float masking = 0.5 / (nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2));
    vec3 fresnel = s.specular + (1.0 - s.specular) * pow(1.0 - lh, 5.0);
    return result * (1.0 - fresnel) + fresnel * (min(distribution * masking, 1e3) * nl);
}

// Unshadowed radiance toward the eye. The light is known to reach the point.
vec3 shadeLight(Surface s, GpuLight light, vec3 positionWs, vec3 toLight) {
    HostLight host = hostLights[light.hostIndex];
    vec3 irradiance = host.intensity * light.lightFade;
    if (lightType(light) != kLightDirectional) {
        vec3 d = light.positionWs - positionWs;
        float squared = dot(d, d);
        float ratio = squared * host.windowPerSquareMetre;
        float window = clamp(1.0 - ratio * ratio, 0.0, 1.0);
        irradiance *= window / max(squared, 1e-12);  // right at a lamp there is no answer
        if (lightType(light) == kLightSpot) {
            vec3 chord = toLight + light.directionWs;
            float cone = clamp((host.coneVersine - 0.5 * dot(chord, chord)) * host.coneScale, 0.0, 1.0);
            irradiance *= cone * cone;
        }
    }
    return irradiance * reflected(s, toLight);
}

vec3 ambient(Surface s) {
    vec3 up = mix(scene.groundRadiance.rgb, scene.skyRadiance.rgb, 0.5 + 0.5 * s.normal.y);
    vec3 mirrored = reflect(-s.toEye, s.normal);
    vec3 sky = mix(scene.groundRadiance.rgb, scene.skyRadiance.rgb, smoothstep(-0.5, 0.5, mirrored.y));
    return s.diffuse * up + s.specular * sky * (1.0 - 0.7 * sqrt(s.roughness)) + s.emissive;
}

vec3 backgroundRadiance(vec3 direction) {
    return mix(scene.groundRadiance.rgb, scene.skyRadiance.rgb, smoothstep(-0.2, 0.3, direction.y));
}

#endif
