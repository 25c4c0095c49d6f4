// Particles as spheres. Each sphere is ray-traced inside a triangle that faces the camera.
import * as THREE from 'three';
import {COLOR, LIGHT, light_uniforms} from './colors.js';
import {Copies} from './copies.js';

const TEXTURE_WIDTH = 2048;

// The vertex number identifies the particle, and textures hold its data. With software rendering this takes a quarter
// of the time of instanced squares, which are drawn one by one there.
const VERTEX = /* glsl */ `
  uniform highp usampler2D places;
  uniform highp sampler2D sizes;
  uniform highp sampler2D tints;
  uniform bool tinted;
  vec4 place;
  float size;
  vec4 tint;
  ${COLOR}
  uniform float radius;      // common radius; 0: individual radii
  uniform float pixel;       // size of a picture's pixel, divided by its distance
  out vec3 at;
  flat out vec3 center;
  flat out float ball;
  flat out vec4 color;
  void main() {
    int row = gl_VertexID / 3;
    ivec2 at_row = ivec2(row % ${TEXTURE_WIDTH}, row / ${TEXTURE_WIDTH});
    int which = gl_VertexID - 3 * row;
    // The triangle has an inscribed circle of radius 1.
    vec2 corner = which == 2 ? vec2(0.0, 2.0) : vec2(which == 0 ? -1.7320508 : 1.7320508, -1.0);
    place = vec4(texelFetch(places, at_row, 0));
    size = radius > 0.0 ? 0.0 : texelFetch(sizes, at_row, 0).r;
    tint = tinted ? texelFetch(tints, at_row, 0) : vec4(1.0);
    center = (modelViewMatrix * vec4(lower + grid_step * place.xyz, 1.0)).xyz;
    float far = length(center);
    ball = enlarge * (radius > 0.0 ? radius : size);
    ball = ball > 0.0 ? max(ball, 0.8 * pixel * far) : 0.0;
    vec3 ahead = center / max(far, 1e-30);
    vec3 right = normalize(cross(abs(ahead.y) < 0.99 ? vec3(0, 1, 0) : vec3(1, 0, 0), ahead));
    vec3 over = cross(ahead, right);
    // The outline of a sphere in perspective is wider than the sphere.
    float wide = (ball + pixel * far) * far / sqrt(max(far * far - ball * ball, 1e-6 * far * far));
    at = center + wide * (corner.x * right + corner.y * over);
    color = color_of();
    gl_Position = ball > 0.0 && far > ball ? projectionMatrix * vec4(at, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
  }
`;

const FRAGMENT = /* glsl */ `
  in vec3 at;
  flat in vec3 center;
  flat in float ball;
  flat in vec4 color;
  uniform mat3 world_from_view;
  uniform bool soft;
  uniform float pixel;
  uniform float slack;       // in m
  uniform float depth_step;  // resolution of the depth buffer at a distance d, divided by d * d
  uniform mat4 projectionMatrix;
  ${LIGHT}
  void main() {
    vec3 ray = normalize(at);
    float along = dot(center, ray);
    vec3 beside = center - along * ray;
    float room = 1.0 - dot(beside, beside) / (ball * ball);
    float edge = clamp(room / max(fwidth(room), 1e-6) + 0.5, 0.0, 1.0);
    float covered = soft ? color.a * max(room, 0.0) : color.a * edge;
    if (covered < 0.02) discard;
    vec3 hit = ray * (along - ball * sqrt(max(room, 0.0)));
    vec3 normal = world_from_view * normalize(hit - center);
    // The depth is that of a slightly smaller sphere. A sphere that touches a wall penetrates it by rounding. The wall
    // would show through the penetrating cap, in a spot as wide as the square root of the depth. The rim stays
    // unchanged.
    float far = length(center);
    float solid = ball - min(slack + 0.5 * pixel * far + depth_step * far * far, 0.5 * ball);
    vec3 seen = ray * (along - sqrt(max(solid * solid - dot(beside, beside), 0.0)));
    gl_FragColor = vec4(soft ? color.rgb : lit(0.92 * color.rgb, normal, world_from_view * -ray), covered);
    vec4 clip = projectionMatrix * vec4(seen, 1.0);
    gl_FragDepth = clamp(0.5 + 0.5 * clip.z / clip.w, 0.0, 1.0);
    #include <colorspace_fragment>
  }
`;

// Data of the particles in a texture, one pixel each. Holds a single pixel row if all particles are equal.
class Column {
  constructor(array, size, format, type, is_one) {
    Object.assign(this, {array, size, is_one});
    this.texture = new THREE.DataTexture(array, TEXTURE_WIDTH, array.length / size / TEXTURE_WIDTH, format, type);
    this.texture.needsUpdate = true;
  }
  sent() { this.texture.needsUpdate = true; }
}

export class Particles {
  constructor(run) {
    this.run = run;
    const {description} = run;
    const find = (name) => run.attributes.findIndex((a) => a.name === name);
    this.radius_attribute = find('radius');
    if (find('size') >= 0) this.radius_attribute = find('size');
    this.opacity_attribute = find('opacity');
    this.drawing_attribute = find('drawing');
    const room = run.most;
    this.geometry = new THREE.BufferGeometry();
    this.geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(3 * room).map((_, i) => i), 1));
    this.geometry.boundingSphere = new THREE.Sphere();
    this.geometry.setDrawRange(0, 0);
    const column = (type, size, format, gl_type, varies) => new Column(
        new type(size * TEXTURE_WIDTH * (varies ? Math.ceil(room / TEXTURE_WIDTH) : 1)), size, format, gl_type, !varies);
    this.place = column(Uint16Array, 4, THREE.RGBAIntegerFormat, THREE.UnsignedShortType, true);
    this.size = column(Float32Array, 1, THREE.RedFormat, THREE.FloatType, this.has_sizes());
    this.tint = column(Uint8Array, 4, THREE.RGBAFormat, THREE.UnsignedByteType, this.has_tint());
    this.tint.array.fill(255);
    this.uniforms = {
      ...light_uniforms(description.up), lower: {value: new THREE.Vector3(...description.grid.lower)},
      grid_step: {value: description.grid.step}, value_scale: {value: new THREE.Vector2(0, 1)},
      shown: {value: new THREE.Vector2(0, 1)}, gap_level: {value: 1e9}, map: {value: null}, own_colors: {value: false},
      radius: {value: 0}, enlarge: {value: 1}, pixel: {value: 0.001}, slack: {value: run.slack},
      depth_step: {value: 0}, world_from_view: {value: new THREE.Matrix3()},
      soft: {value: false}, places: {value: this.place.texture}, sizes: {value: this.size.texture},
      tints: {value: this.tint.texture}, tinted: {value: this.has_tint()},
    };
    const material = new THREE.ShaderMaterial({
      vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms: this.uniforms, alphaToCoverage: true,
      side: THREE.DoubleSide,
    });
    this.object = new THREE.Mesh(this.geometry, material);
    this.object.frustumCulled = false;
    this.object.onBeforeRender = (renderer, scene, camera) => {
      const height = renderer.getDrawingBufferSize(new THREE.Vector2()).y;
      this.uniforms.pixel.value = 2 * Math.tan(camera.fov * Math.PI / 360) / height / camera.zoom;
      this.uniforms.world_from_view.value.setFromMatrix4(camera.matrixWorld);
      this.uniforms.depth_step.value = 2 ** -23 * (1 / camera.near - 1 / camera.far);
    };
    this.bound_radius = this.visible_radius();
    this.copies = this.has_shapes() ? description.shapes.meshes.map((mesh) => new Copies(mesh, room, this.uniforms)) : [];
  }

  // spheres: solid; soft: discs that cover the background; glow: discs of additive light, in any order.
  draw_as(drawing) {
    const {material} = this.object;
    const is_soft = drawing !== 'spheres';
    if (this.drawing === drawing) return;
    this.drawing = drawing;
    this.uniforms.soft.value = is_soft;
    material.alphaToCoverage = !is_soft;
    material.transparent = is_soft;
    material.depthWrite = !is_soft;
    material.blending = drawing === 'glow' ? THREE.AdditiveBlending : THREE.NormalBlending;
    material.needsUpdate = true;
    this.object.renderOrder = is_soft ? 3 : 0;
    for (const copies of this.copies) copies.object.visible = !is_soft;
    if (this.copies.length > 0 && this.last !== undefined) this.show(...this.last);
  }

  varies(attribute) { return attribute >= 0 && !this.run.attributes[attribute].constant; }
  has_shapes() { return this.run.description.shapes !== null; }
  has_sizes() { return this.varies(this.radius_attribute) || this.run.description.springs || this.has_shapes(); }
  has_tint() { return this.run.description.colors || this.opacity_attribute >= 0; }

  // Returns a visible radius for points, which have no size. It decreases with their number.
  visible_radius() {
    const {camera} = this.run.description;
    const away = Math.hypot(...camera.position.map((x, axis) => x - camera.target[axis]));
    const size = Math.min(Math.max(0.8 / Math.sqrt(this.run.most), 0.0029), 0.02);
    return Math.tan(camera.fov * Math.PI / 360) * away * size;
  }

  // Returns the largest drawn radius, in m.
  largest_radius() {
    const own = this.run.attributes[this.radius_attribute];
    const most = own === undefined ? 0 : own.low + (own.constant ? 0 : own.step * own.largest);
    return this.uniforms.enlarge.value * Math.max(most, this.visible_radius());
  }

  // Returns the drawn radius of a row.
  drawn_radius(frame, row) {
    const own = this.radius_attribute >= 0 ? this.run.value(frame, this.radius_attribute, row) : 0;
    return this.uniforms.enlarge.value * (this.uniforms.radius.value || own || this.visible_radius());
  }

  // attribute: index, or -1 for the particles' own colours.
  show(frame, attribute) {
    const count = frame.count;
    const levels = attribute >= 0 ? frame.values[attribute] : null;
    const place = this.place.array;
    for (let i = 0, from = 0, to = 0; i < count; ++i, from += 3, to += 4) {
      place[to] = frame.positions[from];
      place[to + 1] = frame.positions[from + 1];
      place[to + 2] = frame.positions[from + 2];
      place[to + 3] = levels === null ? 0 : levels[i];
    }
    this.place.sent();
    this.show_sizes(frame);
    this.show_tints(frame);
    this.uniforms.own_colors.value = attribute < 0 && this.run.description.colors;
    const scale = attribute >= 0 ? this.run.attributes[attribute] : {low: 0, step: 1, gaps: false};
    this.uniforms.value_scale.value.set(scale.low, scale.constant ? 0 : scale.step);
    this.uniforms.gap_level.value = scale.gaps ? scale.largest + 0.5 : 1e9;
    this.geometry.setDrawRange(0, 3 * count);
    this.last = [frame, attribute];
    if (this.drawing === 'spheres') this.show_copies(frame);
  }

  // Shows particles with a mesh as copies, and hides their spheres.
  show_copies(frame) {
    if (this.copies.length === 0) return;
    const {of} = this.run.description.shapes;
    const rows = this.copies.map(() => []);
    for (let row = 0; row < frame.count; ++row) {
      const drawing = this.drawing_attribute < 0 ? 0 : this.run.value(frame, this.drawing_attribute, row);
      const shape = of[Math.round(drawing)] ?? -1;
      if (shape >= 0 && this.size.array[row] > 0) rows[shape].push(row);
    }
    this.copies.forEach((copies, shape) => copies.show(this, frame.turns, rows[shape]));
    for (const row of rows.flat()) this.size.array[row] = 0;
    this.size.sent();
  }

  show_sizes(frame) {
    const visible = this.visible_radius();
    const sizes = this.run.attributes[this.radius_attribute];
    this.uniforms.radius.value = 0;
    if (!this.has_sizes()) {
      this.uniforms.radius.value = sizes !== undefined && sizes.low > 0 ? sizes.low : visible;
      return;
    }
    const vanish = sizes !== undefined && sizes.name === 'size';
    for (let i = 0; i < frame.count; ++i) {
      const own = sizes === undefined ? 0 : this.run.value(frame, this.radius_attribute, i);
      this.size.array[i] = own > 0 ? own : vanish ? 0 : visible;
    }
    if (frame.lines.length + frame.triangles.length > 0) this.hide_woven(frame);
    this.size.sent();
  }

  // Hides particles at the ends of springs, because ropes and cloth show them. Thicker particles stay visible.
  hide_woven(frame) {
    const sizes = this.size.array;
    const threads = new Float32Array(frame.count);
    for (let i = 0; i < frame.lines.length; i += 2) {
      const [a, b] = [frame.lines[i], frame.lines[i + 1]];
      const thread = Math.min(sizes[a], sizes[b]);
      threads[a] = Math.max(threads[a], thread);
      threads[b] = Math.max(threads[b], thread);
    }
    for (let i = 0; i < frame.count; ++i) if (threads[i] > 0 && sizes[i] <= 1.5 * threads[i]) sizes[i] = 0;
    for (const corner of frame.triangles) sizes[corner] = 0;
  }

  show_tints(frame) {
    if (!this.has_tint()) return;
    const tint = this.tint.array;
    for (let i = 0; i < frame.count; ++i) {
      if (frame.tints !== null) tint.set(frame.tints.subarray(3 * i, 3 * i + 3), 4 * i);
      const opacity = this.opacity_attribute < 0 ? 1 : this.run.value(frame, this.opacity_attribute, i);
      tint[4 * i + 3] = Math.round(255 * Math.min(Math.max(opacity, 0), 1));
    }
    this.tint.sent();
  }

  // Returns the row of the first sphere on a ray and its distance: {row, distance}. The row is -1 if the ray misses
  // all spheres.
  pick(frame, ray, slack) {
    const positions = this.run.positions(frame);
    const {origin, direction} = ray;
    let found = {row: -1, distance: Infinity};
    for (let row = 0; row < frame.count; ++row) {
      const x = positions[3 * row] - origin.x;
      const y = positions[3 * row + 1] - origin.y;
      const z = positions[3 * row + 2] - origin.z;
      const along = x * direction.x + y * direction.y + z * direction.z;
      if (along <= 0 || along > found.distance * 1.5) continue;
      const beside = x * x + y * y + z * z - along * along;
      const reach = Math.max(this.drawn_radius(frame, row), slack * along);
      if (beside > reach * reach) continue;
      const distance = along - Math.sqrt(Math.max(reach * reach - beside, 0));
      if (distance < found.distance) found = {row, distance};
    }
    return found;
  }
}
