// Decoder of the blocks of bytes that src/view/page/*_encoder.cpp write.

// Returns the unpacked bytes of the named block. Waits while the page is still loading.
export async function block(name) {
  for (;;) {
    const is_read = document.readyState !== 'loading';
    const element = document.querySelector(`script[data-block="${name}"]`);
    if (element && (is_read || element.nextElementSibling)) {
      const text = element.textContent;
      element.remove();
      return new ByteReader(await window.ricochet.unpack(text));
    }
    if (is_read) throw new Error(`the file is not complete: ${name} is missing`);
    await new Promise((resolve) => setTimeout(resolve, 4));
  }
}

export class ByteReader {
  constructor(bytes) {
    this.bytes = bytes;
    this.at = 0;
  }
  byte() { return this.bytes[this.at++]; }
  take(count) {
    this.at += count;
    return this.bytes.subarray(this.at - count, this.at);
  }
  // Shifts are not possible here, because they have only 32 bits.
  varint() {
    let value = 0;
    for (let factor = 1; ; factor *= 128) {
      const byte = this.bytes[this.at++];
      value += (byte & 127) * factor;
      if (byte < 128) return value;
    }
  }
  signed_varint() {
    const counted = this.varint();
    return counted % 2 === 0 ? counted / 2 : -(counted + 1) / 2;
  }
  float32() {
    const bytes = this.take(4);
    return new DataView(bytes.buffer, bytes.byteOffset, 4).getFloat32(0, true);
  }
}

// Relation between the rows of a frame and the rows of the previous frame. parent is null if they are the same.
export class RowHistory {
  constructor() {
    this.known = new Uint8Array(0);
    this.parent = null;
  }
  // parent: rows of the previous frame, -1 for new rows; null: unchanged. count: number of rows in this frame.
  follow(parent, count) {
    if (parent === null && count !== this.known.length) parent = new Int32Array(count).fill(-1);
    const known = new Uint8Array(count);
    for (let row = 0; row < count; ++row) {
      const from = parent === null ? row : parent[row];
      if (from >= 0) known[row] = Math.min(this.known[from] + 1, 3);
    }
    this.known = known;
    this.parent = parent;
  }
}

// Decoder of one channel, frame after frame (see ChannelEncoder).
export class ChannelDecoder {
  constructor(bits) {
    this.bits = bits;
    this.past = [new Uint16Array(0), new Uint16Array(0), new Uint16Array(0)];
  }
  decode(reader, rows) {
    const count = rows.known.length;
    const mask = (1 << this.bits) - 1;
    if (rows.parent !== null) this.past = this.past.map((values) => moved(values, rows.parent));
    const [a, b, c] = this.past;
    const order = reader.byte();
    const low = reader.take(count);
    const high = this.bits > 8 ? reader.take(count) : null;
    const values = new Uint16Array(count);
    let before = 0;
    for (let row = 0; row < count; ++row) {
      const counted = low[row] | (high === null ? 0 : high[row] << 8);
      const difference = counted & 1 ? -(counted + 1) >> 1 : counted >> 1;
      const used = Math.min(rows.known[row], order + 1);
      const expected = used === 0 ? before
          : used === 1 ? a[row]
          : used === 2 ? 2 * a[row] - b[row]
          : 3 * a[row] - 3 * b[row] + c[row];
      before = (expected + difference) & mask;
      values[row] = before;
    }
    this.past = [values, a, b];
    return values;
  }
}

function moved(values, parent) {
  const result = new Uint16Array(parent.length);
  for (let row = 0; row < parent.length; ++row) {
    if (parent[row] >= 0 && parent[row] < values.length) result[row] = values[parent[row]];
  }
  return result;
}

// Returns the vertices of a grid as x, y, z, x, ...
export function points_of(axes, grid) {
  const count = axes[0].length;
  const points = new Float32Array(3 * count);
  for (let axis = 0; axis < 3; ++axis) {
    for (let i = 0; i < count; ++i) points[3 * i + axis] = grid.lower[axis] + axes[axis][i] * grid.step;
  }
  return points;
}

// Reads a collider's data that precede all frames (see encoded_part).
export function read_part(reader, part) {
  const alone = (bits, count) => {
    const rows = new RowHistory();
    rows.follow(null, count);
    return new ChannelDecoder(bits).decode(reader, rows);
  };
  const axes = [0, 1, 2].map(() => alone(16, part.vertices));
  const corners = new Uint32Array(3 * part.triangles);
  let corner = 0;
  for (let i = 0; i < corners.length; ++i) corners[i] = corner += reader.signed_varint();
  const maps = {};
  for (const name of ['hits', 'impulse']) {
    if (name in part) maps[name] = Uint8Array.from(alone(8, part.triangles));
  }
  return {points: points_of(axes, part.grid), corners, maps};
}
