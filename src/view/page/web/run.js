// The run: its frames, unpacked one after the other.
import {ChannelDecoder, RowHistory, block, points_of, read_part} from './blocks.js';

export class Run {
  constructor(description) {
    this.description = description;
    this.frames = [];  // unpacked so far
    this.parts = [];
    this.attributes = description.attributes;
    this.rows = new RowHistory();
    const id_type = description.largestId < 2 ** 32 ? Uint32Array : Float64Array;
    this.ids = new id_type(0);
    this.axes = [0, 1, 2].map(() => new ChannelDecoder(description.positionBits));
    this.values = this.attributes.map((a) => a.constant ? null : new ChannelDecoder(a.bits));
    this.tints = description.colors ? [0, 1, 2].map(() => new ChannelDecoder(8)) : [];
    this.turns = description.shapes === null ? [] : [0, 1, 2].map(() => new ChannelDecoder(description.valueBits));
    this.deforming = description.parts.filter((part) => part.motion === 'deforming').map((part) => (
      {part, rows: new RowHistory(), axes: [0, 1, 2].map(() => new ChannelDecoder(description.positionBits))}));
  }

  get frame_count() { return this.description.frames.count.length; }
  // Returns true if at least some particles have a radius.
  get has_balls() {
    return this.attributes.some((a) => ['radius', 'size'].includes(a.name) && a.low + (a.constant ? 0 : a.step * a.largest) > 0);
  }
  // Returns the largest total displacement of the surfaces of particles and colliders, in m. It comes from rounding on
  // the page and from single precision here.
  get slack() {
    const {grid, parts, reach} = this.description;
    const radius = this.attributes.find((a) => a.name === 'radius' && !a.constant);
    const walls = Math.max(0, ...parts.map((part) => part.error));
    return 0.5 * Math.sqrt(3) * grid.step + (radius ? 0.5 * radius.step : 0) + walls + 2.5e-7 * reach;
  }
  get most() { return Math.max(1, ...this.description.frames.count); }

  async load_parts() {
    for (const [i, part] of this.description.parts.entries()) {
      this.parts.push({...part, ...read_part(await block(`part${i}`), part)});
    }
  }

  // Unpacks all frames in order and calls on_frame(number) after each.
  async load_frames(on_frame) {
    let next = block('frame0');
    for (let i = 0; i < this.frame_count; ++i) {
      const reader = await next;
      if (i + 1 < this.frame_count) next = block(`frame${i + 1}`);
      this.frames.push(this.read_frame(reader));
      on_frame(i);
    }
  }

  read_frame(reader) {
    const ids = this.read_ids(reader);
    const axes = this.axes.map((channel) => channel.decode(reader, this.rows));
    const frame = {ids, count: ids.length, positions: new Uint16Array(3 * ids.length), values: [], tints: null,
      turns: null};
    for (let axis = 0; axis < 3; ++axis) {
      for (let i = 0; i < ids.length; ++i) frame.positions[3 * i + axis] = axes[axis][i];
    }
    for (const [i, channel] of this.values.entries()) {
      const levels = channel === null ? null : channel.decode(reader, this.rows);
      const is_short = levels !== null && this.attributes[i].bits === 8;
      frame.values.push(is_short ? Uint8Array.from(levels) : levels);
    }
    if (this.tints.length > 0) {
      const tints = this.tints.map((channel) => channel.decode(reader, this.rows));
      frame.tints = new Uint8Array(3 * ids.length);
      for (let i = 0; i < frame.tints.length; ++i) frame.tints[i] = tints[i % 3][Math.floor(i / 3)];
    }
    if (this.turns.length > 0) {
      const {turnLow, turnStep} = this.description.shapes;
      frame.turns = this.turns.map((channel) =>
        Float32Array.from(channel.decode(reader, this.rows), (level) => turnLow + turnStep * level));
    }
    this.read_springs(reader, frame);
    this.read_moving(reader, frame);
    return frame;
  }

  read_ids(reader) {
    const old = this.ids;
    const gone = new Uint8Array(old.length);
    const gone_count = reader.varint();
    for (let i = 0, row = 0; i < gone_count; ++i, ++row) gone[row += reader.varint()] = 1;
    const born = new this.ids.constructor(reader.varint());
    for (let i = 0, id = 0; i < born.length; ++i, ++id) born[i] = id += reader.varint();
    if (gone_count === 0 && born.length === 0) {
      this.rows.follow(null, old.length);
      return old;
    }
    const count = old.length - gone_count + born.length;
    const ids = new this.ids.constructor(count);
    const parent = new Int32Array(count);
    for (let row = 0, from = 0, next = 0; row < count; ++row) {
      while (from < old.length && gone[from]) ++from;
      const takes_old = next === born.length || (from < old.length && old[from] < born[next]);
      parent[row] = takes_old ? from : -1;
      ids[row] = takes_old ? old[from++] : born[next++];
    }
    this.rows.follow(parent, count);
    this.ids = ids;
    return ids;
  }

  read_springs(reader, frame) {
    const told = reader.byte();
    const before = this.frames[this.frames.length - 1];
    frame.lines = told === 1 ? before.lines : told === 2 ? read_cells(reader, 2) : new Uint32Array(0);
    frame.triangles = told === 1 ? before.triangles : told === 2 ? read_cells(reader, 3) : new Uint32Array(0);
  }

  read_moving(reader, frame) {
    frame.poses = this.description.parts.filter((part) => part.motion === 'rigid')
        .map(() => Array.from({length: 12}, () => reader.float32()));
    frame.points = this.deforming.map(({part, rows, axes}) => {
      rows.follow(null, part.vertices);
      return axes.map((channel) => channel.decode(reader, rows));
    });
  }

  // Returns the positions of the particles as x, y, z, x, ... in m, relative to the page's origin.
  positions(frame) {
    const grid = this.description.grid;
    const positions = new Float32Array(frame.positions.length);
    for (let i = 0; i < positions.length; ++i) positions[i] = grid.lower[i % 3] + frame.positions[i] * grid.step;
    return positions;
  }

  position(frame, row) {
    const grid = this.description.grid;
    return [0, 1, 2].map((axis) => grid.lower[axis] + frame.positions[3 * row + axis] * grid.step);
  }

  // Returns the value of a particle, or NaN if the run had no value.
  value(frame, attribute, row) {
    const {low, step, largest, constant, gaps} = this.attributes[attribute];
    if (constant) return low;
    const level = frame.values[attribute][row];
    return gaps && level > largest ? NaN : low + level * step;
  }

  row_of(frame, id) {
    let low = 0;
    let high = frame.ids.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (frame.ids[middle] < id) low = middle + 1; else high = middle;
    }
    return frame.ids[low] === id ? low : -1;
  }

  deformed_points(frame, index) { return points_of(frame.points[index], this.deforming[index].part.frameGrid); }
}

function read_cells(reader, corners) {
  const cells = new Uint32Array(corners * reader.varint());
  for (let i = 0, corner = 0; i < cells.length; ++i) cells[i] = corner += reader.signed_varint();
  return cells;
}
