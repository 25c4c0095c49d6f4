// The settings, the colour bars, and the card of a particle.
import {map_gradient, number_text} from './colors.js';

function make(tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

// Returns a setting: a label and its control.
function row(label, control, help = '') {
  control.setAttribute('aria-label', label);
  return make('label', {className: 'row', title: help}, make('span', {textContent: label}), control);
}

function choice(options, chosen, on_change) {
  const select = make('select', {onchange: () => on_change(select.value)});
  for (const [value, text] of options) select.append(make('option', {value, textContent: text}));
  select.value = chosen;
  return select;
}

function slider(min, max, step, value, on_input) {
  const input = make('input', {type: 'range', min, max, step, value, oninput: () => on_input(Number(input.value))});
  return input;
}

// Returns a colour bar of a map with values along it.
function bar(name, gradient, texts) {
  const colors = make('div', {className: 'bar'});
  colors.style.background = gradient;
  const ticks = make('div', {className: 'ticks'});
  texts.forEach((text, i) => {
    const tick = make('span', {textContent: text});
    tick.style.left = `${100 * i / (texts.length - 1)}%`;
    ticks.append(tick);
  });
  return [make('h2', {textContent: name}), colors, ticks];
}

export class Panel {
  constructor(app) {
    this.app = app;
    this.place = document.getElementById('settings');
    if (window.innerWidth < 640) document.getElementById('panel').open = false;
    this.add_particles();
    this.add_bodies();
    this.add_looks();
    this.show();
  }

  add_particles() {
    const {app} = this;
    const {description} = app.run;
    const attributes = description.attributes.map((a, i) => [String(i), a.name]);
    if (description.colors) attributes.unshift(['-1', 'own colours']);
    this.attribute = choice(attributes, String(app.look.attribute), (value) => app.color_by(Number(value)));
    this.map = choice(Object.keys(description.maps).map((name) => [name, name]), app.look.map,
                      (name) => app.change({map: name}));
    this.low = make('input', {type: 'text', inputMode: 'decimal', onchange: () => this.set_range()});
    this.high = make('input', {type: 'text', inputMode: 'decimal', onchange: () => this.set_range()});
    this.low.setAttribute('aria-label', 'Least value of the colours');
    this.high.setAttribute('aria-label', 'Largest value of the colours');
    this.trails = make('input', {type: 'checkbox', onchange: () => app.change({trails: this.trails.checked})});
    const range = make('div', {className: 'row'}, make('span', {textContent: 'from, to'}),
                       make('span', {className: 'two'}, this.low, this.high));
    this.place.append(
        row('colour by', this.attribute), row('colours', this.map), range,
        row('size', slider(-1, 1, 0.02, 0, (power) => app.change({enlarge: 10 ** power})),
            'Draws particles smaller or larger than they are'),
        row('draw', choice(['spheres', 'soft', 'glow'].map((name) => [name, name]), app.look.drawing,
                           (drawing) => app.change({drawing})), 'Spheres, soft discs, or additive light'),
        row('trails', make('span', {className: 'two'}, this.trails,
            slider(2, 60, 1, app.look.trail_length, (frames) => app.change({trail_length: frames, trails: true}))),
            'Paths over the last frames'));
    this.trail_note = make('div', {hidden: true});
    this.place.append(this.trail_note);
  }

  set_range() {
    const low = Number(this.low.value.replace(',', '.'));
    const high = Number(this.high.value.replace(',', '.'));
    if (Number.isFinite(low) && Number.isFinite(high) && low < high) this.app.change({shown: [low, high]});
    this.show();
  }

  add_bodies() {
    const {app} = this;
    if (app.bodies.length === 0) return;
    this.place.append(make('h3', {textContent: 'Colliders'}));
    const maps = [['', 'plain'], ['hits', 'hits'], ['impulse', 'impulse']]
        .filter(([name]) => name === '' || app.bodies.some((body) => name in body.part));
    this.body_map = choice(maps, app.look.body_map, (name) => app.change({body_map: name}));
    this.place.append(row('colour by', this.body_map, 'Totals of each triangle over the whole run'));
    const list = make('div', {className: 'bodies'});
    for (const body of app.bodies) {
      const shown = make('input', {type: 'checkbox', checked: body.object.visible, onchange: () => {
        body.object.visible = shown.checked;
        app.stage.request();
      }});
      const glass = make('input', {type: 'checkbox', checked: body.is_glass, onchange: () => {
        body.see_through(glass.checked);
        app.stage.request();
      }});
      shown.setAttribute('aria-label', `show ${body.part.name}`);
      list.append(make('div', {className: 'body'},
          make('label', {title: body.part.name}, shown, make('span', {textContent: body.part.name})),
          make('label', {className: 'see', title: 'make it transparent'}, glass, 'glass')));
    }
    this.place.append(list);
  }

  add_looks() {
    const {app} = this;
    this.place.append(make('h3', {textContent: 'View'}));
    this.place.append(make('div', {className: 'two'},
        make('button', {textContent: 'First view', title: 'r', onclick: () => app.stage.reset_view()}),
        make('button', {textContent: 'Dark, light', title: 'd', onclick: () => app.change_theme()})));
  }

  // Sets all controls to the current settings.
  show() {
    const {look, run} = this.app;
    this.attribute.value = String(look.attribute);
    this.map.value = look.map;
    this.trails.checked = look.trails;
    this.low.disabled = this.high.disabled = look.attribute < 0;
    this.low.value = look.attribute < 0 ? '' : number_text(look.shown[0]);
    this.high.value = look.attribute < 0 ? '' : number_text(look.shown[1]);
    if (this.body_map) this.body_map.value = look.body_map;
    this.show_legend(run.description);
  }

  // Shows a bar for the particles' colours, and one for the colliders' colours.
  show_legend({maps}) {
    const {look, bodies} = this.app;
    const legend = document.getElementById('legend');
    legend.replaceChildren();
    if (look.attribute >= 0) {
      const [low, high] = look.shown;
      const ticks = [0, 0.25, 0.5, 0.75, 1].map((part) => number_text(low + part * (high - low), 3));
      legend.append(...bar(this.unit_name(look.attribute), map_gradient(maps[look.map]), ticks));
    }
    const total = Math.max(0, ...bodies.map((body) => body.is_plane ? 0 : body.part[look.body_map] ?? 0));
    if (total > 0) {
      const name = look.body_map === 'impulse' ? 'impulse of a triangle, N s' : 'hits (impacts only) of a triangle';
      legend.append(...bar(`${name} (logarithmic)`, map_gradient(maps.viridis), ['0', number_text(total, 3)]));
    }
  }

  unit_name(attribute) {
    const units = {speed: 'm/s', age: 's', mass: 'kg', radius: 'm', spin: 'rad/s', size: 'm', unsimulated_time: 's'};
    const {name} = this.app.run.attributes[attribute];
    return name in units ? `${name}, ${units[name]}` : name;
  }

  show_trails(every) {
    this.trail_note.hidden = every <= 1;
    this.trail_note.textContent = every > 1 ? `trails of 1 particle in ${every}` : '';
  }

  // Shows the card of a particle, or hides it if id is null.
  show_particle(id, row, frame) {
    const card = document.getElementById('picked');
    card.hidden = id === null;
    if (id === null) return;
    const {app} = this;
    const {run} = app;
    const table = make('table');
    const line = (name, text) => table.append(make('tr', {}, make('td', {textContent: name}), make('td', {textContent: text})));
    if (row < 0) {
      line('not in this frame', '');
    } else {
      const place = run.position(frame, row).map((x, axis) => x + run.description.origin[axis]);
      const digits = Math.min(Math.max(-Math.floor(Math.log10(run.description.grid.step)), 0), 12);
      line('position, m', place.map((x) => String(Number(x.toFixed(digits)))).join('  '));
      run.attributes.forEach((a, i) => {
        const value = run.value(frame, i, row);
        const level = a.constant ? 0 : frame.values[i][row];
        const mark = a.cut && (level === 0 || level === a.largest) ? (level === 0 ? '≤ ' : '≥ ') : '';
        line(this.unit_name(i), mark + number_text(value, a.bits === 8 ? 3 : 4));
      });
    }
    card.replaceChildren(
        make('h2', {}, make('span', {textContent: `particle ${id}`}),
             make('button', {textContent: '×', title: 'none', ariaLabel: 'No particle', onclick: () => app.pick_id(null)})),
        table);
  }
}
