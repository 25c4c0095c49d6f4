// Colliders, planes and cloth: triangles with lighting and a map of their hits.
import * as THREE from 'three';
import {GLOSS, LIGHT, light_uniforms} from './colors.js';

const CREASE = Math.cos(38 * Math.PI / 180);
const PALETTE = [0xa79f92, 0x9aa5b3, 0xb7a384, 0x94a59a, 0xb3968a, 0xa2abb8];
const PLANE = {light: 0xb4b4b0, dark: 0x4a525b};
const CLOTH = 0xb4413a;

const VERTEX = /* glsl */ `
  in float level;
  out vec3 at;
  out vec3 across;
  out float total;
  uniform bool flat_faces;
  void main() {
    vec4 world = modelMatrix * vec4(position, 1.0);
    at = world.xyz;
    across = flat_faces ? vec3(0.0) : mat3(modelMatrix) * normal;
    total = level;
    gl_Position = projectionMatrix * viewMatrix * world;
  }
`;

const FRAGMENT = /* glsl */ `
  in vec3 at;
  in vec3 across;
  in float total;
  uniform vec3 color;
  uniform sampler2D map;
  uniform bool mapped;
  uniform bool flat_faces;
  uniform bool is_plane;
  uniform float roughness;
  uniform float glass;   // 0: solid; 1: only outlines
  uniform float spacing; // of a plane's lines; 0: none
  uniform vec3 middle;
  uniform float reach;
  ${LIGHT}
  ${GLOSS}
  // Returns the coverage of a pixel by lines at the distance apart.
  float lines_at(vec2 place, float apart) {
    vec2 cell = place / apart;
    vec2 wide = fwidth(cell);
    vec2 near = abs(fract(cell - 0.5) - 0.5) / max(wide, vec2(1e-9));
    vec2 faint = clamp(1.2 - 3.0 * wide, 0.0, 1.0);
    return max((1.0 - min(near.x, 1.0)) * faint.x, (1.0 - min(near.y, 1.0)) * faint.y);
  }
  void main() {
    vec3 to_eye = normalize(cameraPosition - at);
    vec3 normal = flat_faces ? cross(dFdx(at), dFdy(at)) : across;
    normal = normalize(normal + vec3(1e-30));
    normal = faceforward(normal, -to_eye, normal);
    vec3 albedo = mapped ? texture(map, vec2(total * 64.0 / 65.0 + 0.5 / 65.0, 0.5)).rgb : color;
    float alpha = 1.0;
    if (is_plane) {
      vec3 a = abs(normal);
      vec2 place = a.z >= a.x && a.z >= a.y ? at.xy : a.y >= a.x ? at.xz : at.yz;
      if (spacing > 0.0) {
        float line = 0.35 * lines_at(place, spacing) + 0.4 * lines_at(place, 5.0 * spacing);
        albedo *= 1.0 - 0.45 * line;
      }
      alpha = 0.92 * (1.0 - smoothstep(0.35 * reach, reach, distance(at, middle)));
      if (dot(normal, up) < -0.2) alpha *= 0.25;  // seen from below
    }
    vec3 light = lit(albedo, normal, to_eye) + gloss(roughness, normal, to_eye);
    if (glass > 0.0) {
      float rim = 1.0 - abs(dot(normal, to_eye));
      alpha *= mix(1.0, mapped ? 0.35 : 0.07 + 0.5 * rim * rim * rim, glass);
    }
    gl_FragColor = vec4(light, alpha);
    #include <colorspace_fragment>
  }
`;

// has_balls: particles have their own sizes. Otherwise they are points, which lie in the surfaces that they touch.
function material_of({description: {up}, has_balls}, color) {
  const uniforms = {
    ...light_uniforms(up), color: {value: new THREE.Color(color)}, map: {value: null}, mapped: {value: false},
    flat_faces: {value: false}, is_plane: {value: false}, roughness: {value: 1}, glass: {value: 0}, spacing: {value: 1},
    middle: {value: new THREE.Vector3()}, reach: {value: 1},
  };
  return new THREE.ShaderMaterial({
    vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms, side: THREE.DoubleSide,
    polygonOffset: !has_balls, polygonOffsetFactor: 1, polygonOffsetUnits: 1,  // draws points on a surface in front of
                                                                               // it
  });
}

// Returns positions with separate corners for every triangle.
function spread(points, corners, positions = new Float32Array(3 * corners.length)) {
  for (let i = 0; i < corners.length; ++i) {
    for (let axis = 0; axis < 3; ++axis) positions[3 * i + axis] = points[3 * corners[i] + axis];
  }
  return positions;
}

function face_normals(positions) {
  const normals = new Float32Array(positions.length / 3);
  const a = new THREE.Vector3();
  const b = new THREE.Vector3();
  for (let t = 0; t < normals.length; t += 3) {
    const p = 3 * t;
    a.set(positions[p + 3] - positions[p], positions[p + 4] - positions[p + 1], positions[p + 5] - positions[p + 2]);
    b.set(positions[p + 6] - positions[p], positions[p + 7] - positions[p + 1], positions[p + 8] - positions[p + 2]);
    a.cross(b).toArray(normals, t);
  }
  return normals;
}

// Returns normals that are smooth over blunt edges and sharp elsewhere. The weights are areas.
function corner_normals(corners, faces, vertex_count) {
  const first = new Uint32Array(vertex_count + 1);
  for (const corner of corners) ++first[corner + 1];
  for (let v = 0; v < vertex_count; ++v) first[v + 1] += first[v];
  const around = new Uint32Array(corners.length);
  const next = first.slice();
  for (let i = 0; i < corners.length; ++i) around[next[corners[i]]++] = Math.floor(i / 3);
  const normals = new Float32Array(3 * corners.length);
  const length = (f) => Math.hypot(faces[3 * f], faces[3 * f + 1], faces[3 * f + 2]) || 1;
  for (let i = 0; i < corners.length; ++i) {
    const own = Math.floor(i / 3);
    const own_length = length(own);
    for (let k = first[corners[i]]; k < first[corners[i] + 1]; ++k) {
      const other = around[k];
      const cosine = (faces[3 * own] * faces[3 * other] + faces[3 * own + 1] * faces[3 * other + 1] +
          faces[3 * own + 2] * faces[3 * other + 2]) / (own_length * length(other));
      if (other !== own && cosine < CREASE) continue;
      for (let axis = 0; axis < 3; ++axis) normals[3 * i + axis] += faces[3 * other + axis];
    }
  }
  return normals;
}

// Returns normals that are smooth everywhere.
function vertex_normals(corners, faces, vertex_count) {
  const normals = new Float32Array(3 * vertex_count);
  for (let i = 0; i < corners.length; ++i) {
    const face = Math.floor(i / 3);
    for (let axis = 0; axis < 3; ++axis) normals[3 * corners[i] + axis] += faces[3 * face + axis];
  }
  return normals;
}

function mesh_of(positions, normals, levels, material) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
  if (normals !== null) geometry.setAttribute('normal', new THREE.BufferAttribute(normals, 3));
  geometry.setAttribute('level', new THREE.BufferAttribute(levels, 1, true));
  const mesh = new THREE.Mesh(geometry, material);
  mesh.frustumCulled = false;
  return mesh;
}

// One collider.
export class Body {
  constructor(run, part, map) {
    this.part = part;
    this.is_plane = 'planeNormal' in part;
    this.is_deforming = part.motion === 'deforming';
    const {description} = run;
    const color = this.is_plane ? PLANE.light : PALETTE[part.material % PALETTE.length];
    this.material = material_of(run, color);
    this.material.uniforms.roughness.value = part.roughness;
    this.material.uniforms.map.value = map;
    const positions = spread(part.points, part.corners);
    const normals = this.is_deforming || this.is_plane ? null
        : corner_normals(part.corners, face_normals(positions), part.vertices);
    this.material.uniforms.flat_faces.value = normals === null;
    this.object = mesh_of(positions, normals, new Uint8Array(part.corners.length), this.material);
    this.object.matrixAutoUpdate = false;
    this.object.visible = !part.hidden;
    if (this.is_plane) this.make_plane(description);
    if (part.color) this.material.uniforms.color.value.setRGB(...part.color);
    this.see_through(part.glass);
  }

  // A plane is infinite. It is shown around the middle of the run and fades out.
  make_plane(description) {
    const size = Math.max(Math.hypot(...description.size), 1e-9);
    const {uniforms} = this.material;
    const wanted = size / 14;
    const power = 10 ** Math.floor(Math.log10(wanted));
    uniforms.is_plane.value = true;
    uniforms.spacing.value = !this.part.pattern ? 0 : power * (wanted / power >= 5 ? 5 : wanted / power >= 2 ? 2 : 1);
    uniforms.reach.value = Math.min(2.2 * size, this.half_edge());
    const p = this.part.points;
    uniforms.middle.value.set(0.5 * (p[0] + p[6]), 0.5 * (p[1] + p[7]), 0.5 * (p[2] + p[8]));
    this.material.transparent = true;
    this.object.renderOrder = 1;
  }

  // Returns the visible distance of a plane from the page's origin, in m. Everything else is within the run's reach.
  reach() {
    const {middle, reach} = this.material.uniforms;
    return this.is_plane ? middle.value.length() + reach.value : 0;
  }

  set_theme(theme) {
    if (this.is_plane && !this.part.color) this.material.uniforms.color.value.set(PLANE[theme]);
  }

  half_edge() {
    const p = this.part.points;
    return 0.5 * Math.hypot(p[3] - p[0], p[4] - p[1], p[5] - p[2]);
  }

  see_through(is_glass) {
    this.is_glass = is_glass;
    this.material.uniforms.glass.value = is_glass ? 1 : 0;
    this.material.transparent = is_glass || this.is_plane;
    this.material.depthWrite = !is_glass;
    this.object.renderOrder = is_glass ? 2 : this.is_plane ? 1 : 0;
  }

  // name: hits, impulse, or anything else for the plain colour.
  show_map(name) {
    const totals = this.is_plane ? undefined : this.part.maps[name];  // a plane has only one total for its whole
                                                                      // infinite surface
    this.material.uniforms.mapped.value = totals !== undefined;
    if (totals === undefined) return;
    const level = this.object.geometry.getAttribute('level');
    for (let i = 0; i < level.array.length; ++i) level.array[i] = totals[Math.floor(i / 3)];
    level.needsUpdate = true;
  }

  set_pose(p) {
    this.object.matrix.set(p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8], p[9], p[10], p[11], 0, 0, 0, 1);
    this.object.matrixWorldNeedsUpdate = true;
  }

  set_points(points) {
    const position = this.object.geometry.getAttribute('position');
    spread(points, this.part.corners, position.array);
    position.needsUpdate = true;
    this.object.geometry.boundingSphere = null;
  }
}

// The cloth made of springs.
export class Cloth {
  constructor(run) {
    this.run = run;
    this.material = material_of(run, CLOTH);
    this.object = mesh_of(new Float32Array(0), new Float32Array(0), new Uint8Array(0), this.material);
  }

  show(frame, positions) {
    this.object.visible = frame.triangles.length > 0;
    if (!this.object.visible) return;
    const geometry = this.object.geometry;
    if (geometry.getAttribute('position').count !== frame.triangles.length) {
      geometry.dispose();
      for (const name of ['position', 'normal']) {
        geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(3 * frame.triangles.length), 3));
      }
      geometry.setAttribute('level', new THREE.BufferAttribute(new Uint8Array(frame.triangles.length), 1, true));
    }
    const position = geometry.getAttribute('position');
    const normal = geometry.getAttribute('normal');
    spread(positions, frame.triangles, position.array);
    spread(vertex_normals(frame.triangles, face_normals(position.array), frame.count), frame.triangles, normal.array);
    position.needsUpdate = normal.needsUpdate = true;
  }
}
