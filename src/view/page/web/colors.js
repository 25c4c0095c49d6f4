// Colour maps, their bars, and the lighting of all objects.
import * as THREE from 'three';

// Returns the sRGB samples of a map's hexadecimal text.
function samples_of(text) {
  const samples = [];
  for (let i = 0; i < text.length; i += 6) {
    samples.push([0, 2, 4].map((k) => parseInt(text.slice(i + k, i + k + 2), 16)));
  }
  return samples;
}

export function map_texture(text) {
  const samples = samples_of(text);
  const bytes = new Uint8Array(4 * samples.length);
  samples.forEach((rgb, i) => bytes.set([...rgb, 255], 4 * i));
  const texture = new THREE.DataTexture(bytes, samples.length, 1, THREE.RGBAFormat);
  texture.colorSpace = THREE.SRGBColorSpace;
  texture.minFilter = texture.magFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

export function map_gradient(text) {
  return `linear-gradient(to right, ${samples_of(text).map((rgb) => `rgb(${rgb.join(',')})`).join(', ')})`;
}

// Formats a number for display.
export function number_text(value, digits = 4) {
  if (!Number.isFinite(value)) return 'none';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) return value.toExponential(Math.max(0, digits - 2)).replace('e+', 'e');
  return String(Number(value.toPrecision(digits)));
}

// Colour of a particle from `place` (levels of x, y, z and of the value), `size` and `tint`.
export const COLOR = /* glsl */ `
  uniform vec3 lower;
  uniform float grid_step;
  uniform vec2 value_scale;  // low, step
  uniform vec2 shown;
  uniform float gap_level;   // levels from this one on mean "not a number"
  uniform sampler2D map;
  uniform bool own_colors;
  uniform float enlarge;
  vec4 color_of() {
    float t = (value_scale.x + value_scale.y * place.w - shown.x) / max(shown.y - shown.x, 1e-30);
    vec3 mapped = place.w >= gap_level ? vec3(0.3) : texture(map, vec2(clamp(t, 0.0, 1.0) * 64.0 / 65.0 + 0.5 / 65.0, 0.5)).rgb;
    return vec4(own_colors ? pow(tint.rgb, vec3(2.2)) : mapped, tint.a);
  }
`;

// Lighting of all objects: sky, light reflected from the ground, and a sun.
export const LIGHT = /* glsl */ `
  uniform vec3 sun;
  uniform vec3 up;
  vec3 lit(vec3 albedo, vec3 normal, vec3 to_eye) {
    float sky = 0.5 + 0.5 * dot(normal, up);
    float direct = max(dot(normal, sun), 0.0);
    float shine = pow(max(dot(normal, normalize(sun + to_eye)), 0.0), 40.0);
    return albedo * (mix(vec3(0.30, 0.28, 0.27), vec3(0.58, 0.62, 0.68), sky) + 0.62 * direct * vec3(1.0, 0.97, 0.92))
        + 0.06 * shine;
  }
`;

// Additional gloss of surfaces that are not matt: highlights of the sun and the sky, with the same formula as in
// rendered pictures.
export const GLOSS = /* glsl */ `
  vec3 gloss(float roughness, vec3 normal, vec3 to_eye) {
    if (roughness >= 1.0) return vec3(0.0);
    float grazing = 1.0 - clamp(dot(normal, to_eye), 0.0, 1.0);
    float fresnel = 0.04 + 0.5 * pow(grazing, 5.0) * min(1.0, (1.0 - roughness) / 0.58);
    vec3 mirrored = reflect(-to_eye, normal);
    float width = max(0.02, roughness * roughness);
    float power = max(1.0, 2.0 / (width * width) - 2.0);
    float spot = 4.0 * pow(max(dot(mirrored, sun), 0.0), power) * clamp(sqrt(power / 60.0), 0.1, 8.0);
    float blur = 0.3 * roughness + 0.02;
    float sky = smoothstep(-blur, blur, dot(mirrored, up));
    vec3 around = mix(vec3(0.30, 0.28, 0.27), vec3(0.58, 0.62, 0.68), sky);
    return fresnel * (around + 0.62 * spot);
  }
`;

// Returns the uniforms of LIGHT for a scene with the given upward direction.
export function light_uniforms(up) {
  const upward = new THREE.Vector3(...up).normalize();
  const side = Math.abs(upward.x) < 0.9 ? new THREE.Vector3(1, 0, 0) : new THREE.Vector3(0, 1, 0);
  const across = new THREE.Vector3().crossVectors(upward, side).normalize();
  const sun = upward.clone().multiplyScalar(1.3).addScaledVector(side, 0.55).addScaledVector(across, 0.75).normalize();
  return {sun: {value: sun}, up: {value: upward}};
}
