// The application: display, input and playback.
import * as THREE from 'three';
import {Body, Cloth} from './bodies.js';
import {map_texture, number_text} from './colors.js';
import {Panel} from './panel.js';
import {Particles} from './particles.js';
import {Ropes, Threads, trail_segments} from './ribbons.js';
import {Run} from './run.js';
import {Stage} from './stage.js';

const element = (id) => document.getElementById(id);
const THEMES = {light: ['#dfe6ed', '#fbfcfd'], dark: ['#0e1319', '#2b3540']};

class App {
  constructor(description) {
    this.run = new Run(description);
    this.stage = new Stage(element('canvas'), description);
    this.number = 0;      // number of the shown frame
    // First frame with particles, because runs with emitters begin empty.
    this.opening = Math.max(0, description.frames.count.findIndex((count) => count > 0));
    this.is_playing = false;
    this.speed = 1;
    this.picked = null;   // id of the picked particle
    this.bodies = [];
    this.maps = Object.fromEntries(Object.entries(description.maps).map(([name, text]) => [name, map_texture(text)]));
    this.particles = new Particles(this.run);
    this.cloth = new Cloth(this.run);
    this.ropes = new Ropes(this.run);
    this.trails = new Threads();
    this.path = new Threads();
    this.marker = make_marker();
    const own = [this.particles, this.cloth, this.ropes, this.trails, this.path, this.marker];
    for (const {object} of [...own, ...this.particles.copies]) this.stage.add(object);
    this.stage.before_drawing = () => this.place_marker();
    const attribute = this.first_attribute(description);
    this.look = {attribute, map: description.map, shown: [0, 1], enlarge: 1, trails: false, trail_length: 12, body_map: '',
      drawing: this.particles.opacity_attribute >= 0 && !this.particles.has_shapes() ? 'glow' : 'spheres'};
    if (attribute >= 0) this.look.shown = description.attributes[attribute].shown.slice();
    const is_dark = this.look.drawing === 'glow' || matchMedia('(prefers-color-scheme: dark)').matches;
    this.set_theme(is_dark ? 'dark' : 'light');
  }

  first_attribute({attributes, colors, colorBy}) {
    const find = (name) => attributes.findIndex((a) => a.name === name);
    if (colorBy !== '' && colorBy !== 'color') return find(colorBy);
    return colors ? -1 : Math.max(0, find('speed'));
  }

  async load() {
    await this.run.load_parts();
    for (const part of this.run.parts) this.bodies.push(new Body(this.run, part, this.maps.viridis));
    for (const body of this.bodies) {
      this.stage.add(body.object);
      body.set_theme(this.theme);
    }
    this.rigid = this.bodies.filter((body) => body.part.motion === 'rigid');
    this.deforming = this.bodies.filter((body) => body.is_deforming);
    this.panel = new Panel(this);
    element('scrub').max = this.run.frame_count - 1;
    await this.run.load_frames((i) => this.on_frame(i));
    performance.mark('all frames unpacked');
    this.show_facts();
  }

  on_frame(i) {
    if (i === this.opening) {
      performance.mark('first frame unpacked');
      element('message').textContent = '';
      this.show_frame(i);
    }
    this.show_facts();
    if (i >= this.opening) for (const wake of this.waiting.splice(0)) wake();
  }

  waiting = [];

  // Shows a frame as soon as it is unpacked.
  async show(number) {
    const wanted = Math.min(Math.max(Math.round(number), 0), this.run.frame_count - 1);
    while (this.run.frames.length <= wanted) await new Promise((resolve) => this.waiting.push(resolve));
    this.show_frame(wanted);
    this.stage.draw();
    return wanted;
  }

  show_frame(number) {
    const {run} = this;
    this.number = Math.min(Math.max(number, 0), run.frames.length - 1);
    const frame = run.frames[this.number];
    this.particles.show(frame, this.look.attribute);
    this.rigid.forEach((body, i) => body.set_pose(frame.poses[i]));
    this.deforming.forEach((body, i) => body.set_points(run.deformed_points(frame, i)));
    if (frame.lines.length > 0 || frame.triangles.length > 0) {
      const positions = run.positions(frame);
      this.cloth.show(frame, positions);
      this.ropes.show(frame, positions, 0.5 * this.particles.drawn_radius(frame, 0));
    } else {
      this.cloth.object.visible = this.ropes.object.visible = false;
    }
    this.show_look();
    element('scrub').value = this.number;
    this.show_clock();
  }

  // Updates everything that depends on the settings.
  show_look() {
    const {look, particles} = this;
    particles.uniforms.map.value = this.maps[look.map];
    particles.uniforms.shown.value.set(...look.shown);
    particles.uniforms.enlarge.value = look.enlarge;
    const reach = this.run.description.reach + particles.largest_radius();
    this.stage.reach = Math.max(reach, ...this.bodies.map((body) => body.reach()));
    particles.draw_as(look.drawing);
    this.show_trails();
    this.show_picked();
    this.stage.request();
  }

  show_trails() {
    this.trails.hide();
    this.panel.show_trails(1);
    if (!this.look.trails || this.number === 0) return;
    const shade_of = (frame, row) => this.shade(frame, row);
    const trail = trail_segments(this.run, this.number, this.look.trail_length, shade_of);
    this.trails.uniforms.map.value = this.maps[this.look.map];
    this.trails.uniforms.mapped.value = this.look.attribute >= 0;
    this.trails.show(trail.positions, trail.shades, trail.fades, trail.count);
    this.panel.show_trails(trail.every);
  }

  // Returns the position of a particle's value in the colour range, 0 to 1.
  shade(frame, row) {
    const {attribute, shown} = this.look;
    return attribute < 0 ? 0 : (this.run.value(frame, attribute, row) - shown[0]) / Math.max(shown[1] - shown[0], 1e-30);
  }

  change(settings) {
    Object.assign(this.look, settings);
    if ('body_map' in settings) this.bodies.forEach((body) => body.show_map(this.look.body_map));
    this.panel.show();
    this.show_look();
  }

  color_by(attribute) {
    if (attribute >= 0) this.look.shown = this.run.attributes[attribute].shown.slice();
    this.look.attribute = attribute;
    this.particles.show(this.run.frames[this.number], attribute);
    this.panel.show();
    this.show_look();
  }

  // Picks the particle at a point of the window.
  pick(x, y) {
    const frame = this.run.frames[this.number];
    const caster = this.stage.ray(x, y);
    const found = this.particles.pick(frame, caster.ray, 3 * this.stage.pixel);
    const solid = this.bodies.filter((body) => body.object.visible && !body.is_glass && !body.is_plane);
    const [wall] = found.row < 0 ? [] : caster.intersectObjects(solid.map((body) => body.object), false);
    const is_hidden = wall !== undefined && wall.distance < found.distance - 2 * this.particles.drawn_radius(frame, found.row);
    this.pick_id(found.row < 0 || is_hidden ? null : frame.ids[found.row]);
    return this.picked;
  }

  pick_id(id) {
    this.picked = id;
    this.show_path();
    this.show_picked();
    this.stage.request();
  }

  show_picked() {
    const frame = this.run.frames[this.number];
    this.picked_row = this.picked === null ? -1 : this.run.row_of(frame, this.picked);
    this.panel.show_particle(this.picked, this.picked_row, frame);
    this.marker.object.visible = this.picked_row >= 0;
  }

  // Shows the whole path of the picked particle.
  show_path() {
    this.path.hide();
    if (this.picked === null) return;
    const {frames} = this.run;
    const positions = new Float32Array(6 * frames.length);
    let count = 0;
    for (let i = 1, before = this.run.row_of(frames[0], this.picked); i < frames.length; ++i) {
      const row = this.run.row_of(frames[i], this.picked);
      if (before >= 0 && row >= 0) {
        positions.set(this.run.position(frames[i - 1], before), 6 * count);
        positions.set(this.run.position(frames[i], row), 6 * count++ + 3);
      }
      before = row;
    }
    this.path.uniforms.mapped.value = false;
    this.path.show(positions, new Float32Array(2 * count), new Float32Array(2 * count).fill(1), count);
  }

  // Places a ring around the picked particle, facing the camera.
  place_marker() {
    if (!this.marker.object.visible) return;
    const frame = this.run.frames[this.number];
    const {object} = this.marker;
    object.position.set(...this.run.position(frame, this.picked_row));
    object.quaternion.copy(this.stage.camera.quaternion);
    const away = this.stage.camera.position.distanceTo(object.position);
    object.scale.setScalar(Math.max(1.3 * this.particles.drawn_radius(frame, this.picked_row), 9 * this.stage.pixel * away));
  }

  show_clock() {
    const {time, step} = this.run.description.frames;
    element('clock').value = `${time[this.number].toFixed(decimals(time))} s, step ${step[this.number]}`;
    element('scrub').setAttribute('aria-valuetext', element('clock').value);
  }

  show_facts() {
    const {description, frames, frame_count} = this.run;
    const counts = description.frames.count;
    const loaded = frames.length < frame_count ? `, ${frames.length} unpacked` : '';
    element('facts').textContent = `up to ${this.run.most.toLocaleString('en')} particles, ` +
        `${counts.length} ${counts.length === 1 ? 'frame' : 'frames'}${loaded}`;
    element('note').hidden = description.notes.length === 0;
    element('note').textContent = description.notes.join('; ');
    element('made').textContent = `${description.scene} - made by Ricochet ${description.version} with three.js ${THREE.REVISION}`;
  }

  set_theme(theme) {
    this.theme = theme;
    document.documentElement.dataset.theme = theme;
    this.stage.set_background(...THEMES[theme]);
    this.path.uniforms.ink.value.set(theme === 'dark' ? 0xffffff : 0x14202c);
    for (const body of this.bodies) body.set_theme(theme);
    this.trails.uniforms.ink.value.set(theme === 'dark' ? 0x9fc4e8 : 0x3a6ea5);
  }

  change_theme() { this.set_theme(this.theme === 'dark' ? 'light' : 'dark'); }

  play(is_playing) {
    if (is_playing && this.number >= this.run.frame_count - 1) this.show_frame(0);
    this.is_playing = is_playing && this.run.frame_count > 1;
    element('play').textContent = this.is_playing ? '❚❚' : '▶';
    element('play').setAttribute('aria-label', this.is_playing ? 'Stop' : 'Play');
    if (!this.is_playing) return;
    this.clock = {since: performance.now(), from: this.number};
    const tick = (now) => {
      if (!this.is_playing) return;
      this.advance(now);
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  // Shows the frame of the current time. Waits for frames that are not unpacked, and restarts after the last one.
  advance(now) {
    const {time} = this.run.description.frames;
    const last = this.run.frame_count - 1;
    const rate = this.speed * this.natural_rate();
    const at = time[this.clock.from] + rate * (now - this.clock.since) / 1000;
    let next = this.number;
    while (next < last && time[next + 1] <= at) ++next;
    const is_over = this.number === last && at > time[last] + rate * 0.7;
    if (is_over || next >= this.run.frames.length) {
      this.clock = {since: now, from: is_over ? 0 : this.run.frames.length - 1};
      next = this.clock.from;
    }
    if (next !== this.number) this.show_frame(next);
  }

  // Returns simulated seconds per second at speed 1: real time for runs of 2 s to 1 min, otherwise a rate that takes
  // 10 s.
  natural_rate() {
    const {time} = this.run.description.frames;
    const length = time[time.length - 1] - time[0];
    return length >= 2 && length <= 60 ? 1 : Math.max(length, 1e-30) / 10;
  }
}

// Returns the number of decimals that distinguish the frames' times.
function decimals(time) {
  const step = time.length > 1 ? (time[time.length - 1] - time[0]) / (time.length - 1) : 1;
  return Math.min(Math.max(Math.ceil(1 - Math.log10(Math.max(step, 1e-12))), 0), 9);
}

function make_marker() {
  const ring = new THREE.RingGeometry(0.92, 1, 64);
  const material = new THREE.MeshBasicMaterial({color: 0xff8a00, depthTest: false, transparent: true});
  const object = new THREE.Mesh(ring, material);
  object.visible = false;
  object.renderOrder = 4;
  return {object};
}

function connect(app) {
  const {canvas} = app.stage;
  let down = null;
  canvas.addEventListener('pointerdown', (event) => {
    canvas.focus();
    down = event.isPrimary && event.button === 0 ? [event.clientX, event.clientY] : null;
  });
  canvas.addEventListener('pointerup', (event) => {
    const is_click = down !== null && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 5;
    if (is_click && app.run.frames.length > 0) app.pick(event.clientX, event.clientY);
    down = null;
  });
  element('play').onclick = () => app.play(!app.is_playing);
  element('scrub').oninput = (event) => {
    app.play(false);
    void app.show(Number(event.target.value));
  };
  for (const speed of [0.1, 0.25, 0.5, 1, 2, 4]) element('speed').append(new Option(`${number_text(speed)} ×`, speed));
  element('speed').value = '1';
  element('speed').onchange = (event) => {
    app.speed = Number(event.target.value);
    app.clock = {since: performance.now(), from: app.number};
  };
  element('ask').onclick = () => element('help').showModal();
  document.addEventListener('keydown', (event) => on_key(app, event));
}

function on_key(app, event) {
  const is_typing = event.target.matches('input[type="text"], select') || element('help').open;
  if (is_typing || event.ctrlKey || event.metaKey || event.altKey || app.run.frames.length === 0) return;
  const step = (frames) => {
    app.play(false);
    void app.show(app.number + frames);
  };
  const attributes = app.run.attributes.length;
  const keys = {
    ' ': () => app.play(!app.is_playing),
    ArrowLeft: () => step(event.shiftKey ? -10 : -1),
    ArrowRight: () => step(event.shiftKey ? 10 : 1),
    Home: () => step(-Infinity),
    End: () => step(1e9),
    c: () => app.color_by(app.look.attribute + 1 < attributes ? app.look.attribute + 1 : app.run.description.colors ? -1 : 0),
    t: () => app.change({trails: !app.look.trails}),
    r: () => app.stage.reset_view(),
    d: () => app.change_theme(),
    h: () => document.body.classList.toggle('bare'),
    '?': () => element('help').showModal(),
  };
  if (!(event.key in keys)) return;
  event.preventDefault();
  keys[event.key]();
}

// Resolves when the opening frame is on the screen. The remaining frames are unpacked in the background.
export async function start(description) {
  performance.mark('modules loaded');
  const app = new App(description);
  const first = new Promise((resolve) => app.waiting.push(resolve));
  const loaded = app.load();
  loaded.catch(window.ricochet.fail);
  await Promise.race([first, loaded]);
  connect(app);
  app.stage.draw();
  performance.mark('first picture');
  Object.assign(window.ricochet, {
    app, loaded, camera: app.stage.camera,
    show: (number) => app.show(number),
    orbit: (around, over) => app.stage.orbit(around, over),
    pick: (x, y) => app.pick(x, y),
  });
}
