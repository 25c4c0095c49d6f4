// Particles as copies of a mesh, rotated as in the run. Colours, sizes and lighting match the spheres.
import * as THREE from 'three';
import {COLOR, LIGHT} from './colors.js';

const VERTEX = /* glsl */ `
  in vec3 turn;  // vector part of a unit quaternion whose scalar part is not negative
  out vec3 at;
  out vec3 facing;
  flat out vec4 color;
  in vec4 place;
  in float size;
  in vec4 tint;
  uniform float slack;
  ${COLOR}
  vec3 turned(vec3 v) {
    float w = sqrt(max(1.0 - dot(turn, turn), 0.0));
    return v + 2.0 * cross(turn, cross(turn, v) + w * v);
  }
  void main() {
    float reach = enlarge * size;
    at = lower + grid_step * place.xyz + (reach - min(slack, 0.5 * reach)) * turned(position);
    facing = turned(normal);
    color = color_of();
    gl_Position = projectionMatrix * viewMatrix * vec4(at, 1.0);
  }
`;

const FRAGMENT = /* glsl */ `
  in vec3 at;
  in vec3 facing;
  flat in vec4 color;
  ${LIGHT}
  void main() {
    vec3 to_eye = normalize(cameraPosition - at);
    vec3 normal = normalize(facing);
    if (dot(normal, to_eye) < 0.0) normal = -normal;
    gl_FragColor = vec4(lit(0.92 * color.rgb, normal, to_eye), 1.0);
    #include <colorspace_fragment>
  }
`;

// Returns a geometry with separate corners for each triangle, so that faces are flat.
function faces_of({vertices, triangles}) {
  const positions = new Float32Array(3 * triangles.length);
  triangles.forEach((vertex, i) => positions.set(vertices.slice(3 * vertex, 3 * vertex + 3), 3 * i));
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
  geometry.computeVertexNormals();
  return geometry;
}

export class Copies {
  // uniforms: shared with the spheres.
  constructor(mesh, room, uniforms) {
    const faces = faces_of(mesh);
    this.geometry = new THREE.InstancedBufferGeometry();
    for (const name of ['position', 'normal']) this.geometry.setAttribute(name, faces.getAttribute(name));
    this.geometry.instanceCount = 0;
    const add = (name, array, size, normalized = false) => {
      const attribute = new THREE.InstancedBufferAttribute(array, size, normalized);
      attribute.setUsage(THREE.DynamicDrawUsage);
      this.geometry.setAttribute(name, attribute);
      return attribute;
    };
    this.place = add('place', new Uint16Array(4 * room), 4);
    this.size = add('size', new Float32Array(room), 1);
    this.tint = add('tint', new Uint8Array(4 * room), 4, true);
    this.turn = add('turn', new Float32Array(3 * room), 3);
    const material = new THREE.ShaderMaterial({vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms,
      side: THREE.DoubleSide});
    this.object = new THREE.Mesh(this.geometry, material);
    this.object.frustumCulled = false;
  }

  // Shows the given rows as copies, with the data of their spheres.
  show(spheres, turns, rows) {
    rows.forEach((row, k) => {
      const at = (column) => column.is_one ? 0 : row * column.size;
      for (const name of ['place', 'size', 'tint']) {
        const from = spheres[name];
        const {size} = from;
        for (let c = 0; c < size; ++c) this[name].array[size * k + c] = from.array[at(from) + c];
      }
      for (let c = 0; c < 3; ++c) this.turn.array[3 * k + c] = turns[c][row];
    });
    for (const attribute of [this.place, this.size, this.tint, this.turn]) {
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, attribute.itemSize * rows.length);
      attribute.needsUpdate = true;
    }
    this.geometry.instanceCount = rows.length;
  }
}
