// Lines: ropes as ribbons of their thickness, trails and paths as fading threads.
import * as THREE from 'three';
import {LIGHT, light_uniforms} from './colors.js';

const ROPE = 0xb08a4a;
const MOST_SEGMENTS = 80000;

const ROPE_VERTEX = /* glsl */ `
  in vec3 from;
  in vec3 to;
  uniform float thick;
  uniform float pixel;
  out vec2 spot;
  out vec3 side;
  out vec3 ahead;
  void main() {
    vec3 a = (modelViewMatrix * vec4(from, 1.0)).xyz;
    vec3 b = (modelViewMatrix * vec4(to, 1.0)).xyz;
    vec3 here = mix(a, b, position.y);
    side = normalize(cross(b - a, here) + vec3(1e-30));
    ahead = normalize(cross(side, b - a) + vec3(1e-30));
    spot = position.xy;
    here += position.x * side * max(thick, 0.8 * pixel * length(here));
    gl_Position = projectionMatrix * vec4(here, 1.0);
  }
`;

const ROPE_FRAGMENT = /* glsl */ `
  in vec2 spot;
  in vec3 side;
  in vec3 ahead;
  uniform vec3 color;
  uniform mat3 world_from_view;
  ${LIGHT}
  void main() {
    vec3 toward = dot(ahead, vec3(0, 0, 1)) < 0.0 ? -ahead : ahead;
    vec3 normal = world_from_view * normalize(spot.x * side + sqrt(max(1.0 - spot.x * spot.x, 0.0)) * toward);
    gl_FragColor = vec4(lit(color, normal, normal), 1.0);
    #include <colorspace_fragment>
  }
`;

// Springs that are not part of a cloth.
export class Ropes {
  constructor(run) {
    this.run = run;
    this.uniforms = {
      ...light_uniforms(run.description.up), color: {value: new THREE.Color(ROPE)}, thick: {value: 0.01},
      pixel: {value: 0.001}, world_from_view: {value: new THREE.Matrix3()},
    };
    this.geometry = new THREE.InstancedBufferGeometry();
    this.geometry.setAttribute('position', new THREE.Float32BufferAttribute([-1, 0, 0, 1, 0, 0, 1, 1, 0, -1, 1, 0], 3));
    this.geometry.setIndex([0, 1, 2, 0, 2, 3]);
    this.object = new THREE.Mesh(this.geometry, new THREE.ShaderMaterial({
      vertexShader: ROPE_VERTEX, fragmentShader: ROPE_FRAGMENT, uniforms: this.uniforms, side: THREE.DoubleSide}));
    this.object.frustumCulled = false;
    this.object.onBeforeRender = (renderer, scene, camera) => {
      const height = renderer.getDrawingBufferSize(new THREE.Vector2()).y;
      this.uniforms.pixel.value = 2 * Math.tan(camera.fov * Math.PI / 360) / height / camera.zoom;
      this.uniforms.world_from_view.value.setFromMatrix4(camera.matrixWorld);
    };
    this.room = 0;
  }

  show(frame, positions, thick) {
    const count = frame.lines.length / 2;
    this.object.visible = count > 0;
    if (count === 0) return;
    if (count > this.room) {
      this.room = count;
      this.geometry.dispose();
      for (const name of ['from', 'to']) {
        this.geometry.setAttribute(name, new THREE.InstancedBufferAttribute(new Float32Array(3 * count), 3));
      }
    }
    for (const [end, name] of ['from', 'to'].entries()) {
      const attribute = this.geometry.getAttribute(name);
      for (let i = 0; i < count; ++i) {
        const row = frame.lines[2 * i + end];
        for (let axis = 0; axis < 3; ++axis) attribute.array[3 * i + axis] = positions[3 * row + axis];
      }
      attribute.needsUpdate = true;
    }
    this.geometry.instanceCount = count;
    this.uniforms.thick.value = thick;
  }
}

const THREAD_VERTEX = /* glsl */ `
  in float shade;
  in float fade;
  out vec2 look;
  void main() {
    look = vec2(shade, fade);
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }
`;

const THREAD_FRAGMENT = /* glsl */ `
  in vec2 look;
  uniform sampler2D map;
  uniform vec3 ink;
  uniform bool mapped;
  void main() {
    vec3 color = mapped ? texture(map, vec2(clamp(look.x, 0.0, 1.0) * 64.0 / 65.0 + 0.5 / 65.0, 0.5)).rgb : ink;
    gl_FragColor = vec4(color, look.y);
    #include <colorspace_fragment>
  }
`;

// Line segments that are replaced for every frame.
export class Threads {
  constructor() {
    this.uniforms = {map: {value: null}, ink: {value: new THREE.Color(0x3a6ea5)}, mapped: {value: true}};
    this.geometry = new THREE.BufferGeometry();
    this.object = new THREE.LineSegments(this.geometry, new THREE.ShaderMaterial({
      vertexShader: THREAD_VERTEX, fragmentShader: THREAD_FRAGMENT, uniforms: this.uniforms, transparent: true,
      depthWrite: false}));
    this.object.frustumCulled = false;
    this.object.renderOrder = 3;
    this.object.visible = false;
    this.room = 0;
  }

  // positions: 6 numbers per segment; shades, fades: 2 numbers per segment.
  show(positions, shades, fades, segments) {
    this.object.visible = segments > 0;
    if (segments === 0) return;
    if (2 * segments > this.room) {
      this.room = 2 * segments;
      this.geometry.dispose();
      this.geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(3 * this.room), 3));
      this.geometry.setAttribute('shade', new THREE.BufferAttribute(new Float32Array(this.room), 1));
      this.geometry.setAttribute('fade', new THREE.BufferAttribute(new Float32Array(this.room), 1));
    }
    for (const [name, values, size] of [['position', positions, 6], ['shade', shades, 2], ['fade', fades, 2]]) {
      const attribute = this.geometry.getAttribute(name);
      attribute.array.set(values.subarray(0, size * segments));
      attribute.needsUpdate = true;
    }
    this.geometry.setDrawRange(0, 2 * segments);
  }

  hide() { this.object.visible = false; }
}

// Returns the rows in another frame for the particles of the given rows (ascending). Missing particles get -1.
export function same_particles(from, to, rows) {
  if (from.ids === to.ids) return rows;
  const result = new Int32Array(rows.length).fill(-1);
  for (let i = 0, k = 0; i < rows.length; ++i) {
    if (rows[i] < 0) continue;
    const id = from.ids[rows[i]];
    while (k < to.ids.length && to.ids[k] < id) ++k;
    if (k < to.ids.length && to.ids[k] === id) result[i] = k;
  }
  return result;
}

// Returns the paths of the particles over the last frames up to this one. If there are too many, only every n-th
// particle is included.
export function trail_segments(run, number, length, shade_of) {
  const frames = run.frames;
  const steps = Math.min(length, number);
  const every = Math.max(1, Math.ceil(frames[number].count * steps / MOST_SEGMENTS));
  let rows = new Int32Array(Math.ceil(frames[number].count / every)).map((_, i) => i * every);
  const positions = new Float32Array(6 * rows.length * steps);
  const shades = new Float32Array(2 * rows.length * steps);
  const fades = new Float32Array(2 * rows.length * steps);
  let count = 0;
  for (let k = 0; k < steps; ++k) {
    const here = frames[number - k];
    const before = frames[number - k - 1];
    const old = same_particles(here, before, rows);
    for (let i = 0; i < rows.length; ++i) {
      if (old[i] < 0 || rows[i] < 0) continue;
      positions.set(run.position(before, old[i]), 6 * count);
      positions.set(run.position(here, rows[i]), 6 * count + 3);
      shades[2 * count] = shade_of(before, old[i]);
      shades[2 * count + 1] = shade_of(here, rows[i]);
      fades[2 * count] = 0.8 * (1 - (k + 1) / steps);
      fades[2 * count + 1] = 0.8 * (1 - k / steps);
      ++count;
    }
    rows = old;
  }
  return {positions, shades, fades, count, every};
}
