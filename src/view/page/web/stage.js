// The canvas: camera, controls, background, and redrawing.
import * as THREE from 'three';
import {OrbitControls} from './OrbitControls.js';

export class Stage {
  constructor(canvas, description) {
    this.canvas = canvas;
    this.description = description;
    // The context is created here because three.js always requests alpha, and the page would shine through the rims of
    // spheres.
    const wanted = {alpha: false, antialias: true, powerPreference: 'high-performance'};
    this.renderer = new THREE.WebGLRenderer({canvas, context: canvas.getContext('webgl2', wanted) ?? undefined});
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.toneMapping = THREE.NoToneMapping;
    this.scene = new THREE.Scene();
    this.scene.matrixWorldAutoUpdate = true;
    this.camera = new THREE.PerspectiveCamera(description.camera.fov, 1, 0.1, 10);
    this.camera.up.set(...description.up);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener('change', () => this.request());
    this.before_drawing = () => {};
    this.reach = Infinity;  // radius of a ball around the page's origin that contains all drawn objects, in m
    this.draws = 0;
    this.is_requested = false;
    this.reset_view();
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
  }

  add(object) { this.scene.add(object); }

  // Restores the initial view.
  reset_view() {
    const {position, target, fov} = this.description.camera;
    this.camera.fov = fov;
    this.controls.target.set(...target);
    this.camera.position.set(...position);
    this.controls.update();
    this.request();
  }

  // Rotates the camera around the target by angles around the upward axis and towards it.
  orbit(around, over) {
    const away = this.camera.position.clone().sub(this.controls.target);
    const to_pole = new THREE.Quaternion().setFromUnitVectors(this.camera.up, new THREE.Vector3(0, 1, 0));
    const angles = new THREE.Spherical().setFromVector3(away.applyQuaternion(to_pole));
    angles.theta += around;
    angles.phi = Math.min(Math.max(angles.phi - over, 0.01), Math.PI - 0.01);
    this.camera.position.setFromSpherical(angles).applyQuaternion(to_pole.invert()).add(this.controls.target);
    this.controls.update();
    this.request();
  }

  resize() {
    const {clientWidth, clientHeight} = this.canvas.parentElement;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.zoom = Math.min(1, this.camera.aspect / 1.25);
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  // Sets a background gradient from top to bottom.
  set_background(top, bottom) {
    const canvas = document.createElement('canvas');
    canvas.width = 2;
    canvas.height = 256;
    const context = canvas.getContext('2d');
    const gradient = context.createLinearGradient(0, 0, 0, 256);
    gradient.addColorStop(0, top);
    gradient.addColorStop(1, bottom);
    context.fillStyle = gradient;
    context.fillRect(0, 0, 2, 256);
    if (this.scene.background !== null) this.scene.background.dispose();
    this.scene.background = new THREE.CanvasTexture(canvas);
    this.scene.background.colorSpace = THREE.SRGBColorSpace;
    this.request();
  }

  request() {
    if (this.is_requested) return;
    this.is_requested = true;
    requestAnimationFrame(() => {
      this.is_requested = false;
      this.draw();
    });
  }

  draw() {
    const size = Math.max(Math.hypot(...this.description.size), 1e-6);
    const away = this.camera.position.distanceTo(this.controls.target);
    // The near plane is as far away as possible, because this gives the finest depth resolution.
    const ahead = this.camera.getWorldDirection(new THREE.Vector3());
    const free = -this.camera.position.dot(ahead) - this.reach;
    this.camera.near = Math.max(1e-3 * away, 1e-7 * size, 0.98 * free);
    this.camera.far = Math.max(away, this.camera.near) + 12 * size;
    this.camera.updateProjectionMatrix();
    this.before_drawing();
    this.renderer.render(this.scene, this.camera);
    ++this.draws;
  }

  // Returns the ray through a point of the window.
  ray(x, y) {
    const area = this.canvas.getBoundingClientRect();
    const caster = new THREE.Raycaster();
    caster.setFromCamera(new THREE.Vector2((x - area.left) / area.width * 2 - 1, 1 - (y - area.top) / area.height * 2),
                         this.camera);
    return caster;
  }

  // Returns the tangent of a pixel's angle.
  get pixel() { return 2 * Math.tan(this.camera.fov * Math.PI / 360) / this.canvas.clientHeight / this.camera.zoom; }
}
