// Chunks, edits, meshes, levels of detail and collision, over the functions of runstone.h.
import { bytesAt, call, Handle, list, memory, pointer, readPos, readVec, RunstoneError, use, wasm, whole } from "./wasm.js";

// Axis orders, fastest axis first.
export const Order = Object.freeze({ XYZ: 0, XZY: 1, YXZ: 2, YZX: 3, ZXY: 4, ZYX: 5, CHEAPEST: 6 });
export const Direction = Object.freeze({ NEG_X: 0, POS_X: 1, NEG_Y: 2, POS_Y: 3, NEG_Z: 4, POS_Z: 5, NONE: 6 });
export const Encoding = Object.freeze({ RAW: 1, PACKED: 2, CODED: 3 });
export const Mask = Object.freeze({ EVERYTHING: 0, ONLY_EMPTY: 1, ONLY_SOLID: 2, ONLY_MATERIAL: 3 });
export const Look = Object.freeze({ EMPTY: 0, OPAQUE: 1, TRANSPARENT: 2 });
export const Pass = Object.freeze({ OPAQUE: 0, TRANSPARENT: 1 });

const MATERIAL_MAX = 0xffff;
const sidesOf = (sides) => (typeof sides === "number" ? [sides, sides, sides] : [...sides]).map((side) => whole(side, "a side"));
const material = (id) => whole(id, "a material", 0, MATERIAL_MAX);

// The voxels of a chunk as runs.
export class Chunk extends Handle {
  constructor(make) {
    if (typeof make !== "function") throw new RunstoneError("bad argument", "use Chunk.filled(), fromArray(), fromRuns() or decode()");
    super("chunk", make);
  }
  static filled(sides, id = 0) {
    return new Chunk((out) => call("chunk_create_filled", ...sidesOf(sides), material(id), out));
  }
  static fromArray(sides, voxels, order = Order.XYZ) {
    return new Chunk((out, room) => call("chunk_create_from_array", ...sidesOf(sides), whole(order, "order"),
      room.put(Uint16Array.from(voxels)), voxels.length, out));
  }
  static fromRuns(sides, { ends, materials }, order = Order.XYZ) {
    if (ends.length !== materials.length) throw new RunstoneError("bad argument", "ends and materials differ in length");
    return new Chunk((out, room) => call("chunk_create_from_runs", ...sidesOf(sides), whole(order, "order"),
      room.put(Uint32Array.from(ends)), room.put(Uint16Array.from(materials)), ends.length, out));
  }
  // The chunk must have the sides `sides`, if they are given.
  static decode(bytes, sides = null) {
    return new Chunk((out, room) => call("chunk_decode", room.put(bytes), bytes.byteLength,
      sides === null ? 0 : room.put(Uint32Array.from(sidesOf(sides))), out));
  }
  clone() {
    return new Chunk((out) => call("chunk_clone", this.at, out));
  }
  get info() {
    return use((room) => {
      const at = room.struct(32);
      call("chunk_get_info", this.at, at);
      const read = (field) => memory().getUint32(at + 4 * field, true);
      return { sides: [read(1), read(2), read(3)], order: read(4), volume: read(5), runs: read(6), isUniform: read(7) === 1 };
    });
  }
  get(x, y, z) {
    return use((room) => {
      const out = room.take(2);
      call("chunk_get", this.at, whole(x, "x"), whole(y, "y"), whole(z, "z"), out);
      return memory().getUint16(out, true);
    });
  }
  fill(first, voxels, id) {
    call("chunk_fill", this.at, whole(first, "first"), whole(voxels, "voxels"), material(id));
  }
  toArray(order = Order.XYZ) {
    return list(Uint16Array, 1, "chunk_to_array", this.at, whole(order, "order"));
  }
  get runs() {
    const { runs } = this.info;
    return use((room) => {
      const [ends, materials, count] = [room.take(4 * runs), room.take(2 * runs), room.take(4)];
      call("chunk_runs", this.at, ends, materials, runs, count);
      const { buffer } = wasm().memory;
      return { ends: new Uint32Array(buffer.slice(ends, ends + 4 * runs)), materials: new Uint16Array(buffer.slice(materials, materials + 2 * runs)) };
    });
  }
  reorder(order = Order.CHEAPEST) {
    call("chunk_reorder", this.at, whole(order, "order"));
  }
  // Returns the digest of the voxels: two numbers of 64 bits.
  get digest() {
    return use((room) => {
      const at = room.take(16);
      call("chunk_digest", this.at, at);
      return [memory().getBigUint64(at, true), memory().getBigUint64(at + 8, true)];
    });
  }
  equals(other) {
    return use((room) => {
      const at = room.take(4);
      call("chunk_equal", this.at, pointer(other, Chunk), at);
      return memory().getUint32(at, true) === 1;
    });
  }
  encode(encoding = Encoding.PACKED) {
    return list(Uint8Array, 1, "chunk_encode", this.at, whole(encoding, "encoding"));
  }
  // Applies edits to the chunk of a world at this place in the grid of chunks. Returns the changes.
  apply(place, edits) {
    return use((room) => {
      const at = room.struct(64);
      call("chunk_apply", this.at, room.pos(place), pointer(edits, Edits), at);
      const bits = bytesAt(at + 16, 48);
      const layers = [0, 1, 2].map((axis) => Array.from({ length: 128 }, (_, layer) => layer)
        .filter((layer) => (bits[16 * axis + (layer >> 3)] >> (layer & 7)) & 1));
      return { isChanged: memory().getUint32(at + 4, true) === 1, voxels: Number(memory().getBigUint64(at + 8, true)), layers };
    });
  }
  // Returns boxes that cover each solid voxel once, for physics engines:
  // [{min: [x, y, z], max: [x, y, z]}].
  boxes(solid = [0], others = true) {
    const bytes = use((room) => list(Uint8Array, 6, "chunk_boxes", this.at, room.put(Uint8Array.from(solid, Number)), solid.length, others ? 1 : 0));
    return Array.from({ length: bytes.length / 6 }, (_, i) => ({ min: [...bytes.slice(6 * i, 6 * i + 3)], max: [...bytes.slice(6 * i + 3, 6 * i + 6)] }));
  }
}

// Puts two structs of this size side by side. Views are taken after the last allocation, because
// memory that grows detaches the earlier ones.
function joined(room, bytes, first, second) {
  const at = room.take(2 * bytes);
  bytesAt(at, bytes).set(bytesAt(first, bytes));
  bytesAt(at + bytes, bytes).set(bytesAt(second, bytes));
  return at;
}

// Edits, in the order in which they are applied. A brush is a material, or {material, mask, only}.
export class Edits extends Handle {
  constructor() {
    super("edits", (out) => call("edits_create", out));
  }
  #add(name, brush, args) {
    const of = typeof brush === "number" ? { material: brush } : brush;
    use((room) => {
      const at = room.struct(12);
      const before = args(room);
      memory().setUint32(at + 4, whole(of.mask ?? Mask.EVERYTHING, "a mask"), true);
      memory().setUint16(at + 8, material(of.only ?? 0), true);
      memory().setUint16(at + 10, material(of.material), true);
      call(`edits_add_${name}`, this.at, ...before, at);
    });
    return this;
  }
  voxel(place, brush) {
    return this.#add("voxel", brush, (room) => [room.pos(place)]);
  }
  // Adds a box. It is half-open: max lies outside.
  box(min, max, brush) {
    return this.#add("box", brush, (room) => [joined(room, 12, room.pos(min), room.pos(max))]);
  }
  sphere(centre, radius, brush) {
    return this.#add("sphere", brush, (room) => [room.pos(centre), whole(radius, "radius")]);
  }
  stroke(points, radius, brush) {
    return this.#add("stroke", brush, (room) => [room.put(Int32Array.from(points.flatMap(({ x, y, z }) => [x, y, z]))), points.length, whole(radius, "radius")]);
  }
  // Adds an edit in its canonical bytes.
  bytes(bytes) {
    use((room) => call("edits_add_bytes", this.at, room.put(bytes), bytes.byteLength));
    return this;
  }
  clear() {
    call("edits_clear", this.at);
  }
  get count() {
    return use((room) => {
      const at = room.take(4);
      call("edits_count", this.at, at);
      return memory().getUint32(at, true);
    });
  }
  toBytes(index) {
    return list(Uint8Array, 1, "edits_bytes", this.at, whole(index, "index"));
  }
  bounds(index) {
    return use((room) => {
      const at = room.take(24);
      call("edits_bounds", this.at, whole(index, "index"), at);
      return { min: readPos(at), max: readPos(at + 12) };
    });
  }
  touchedChunks(index, edge) {
    const flat = list(Int32Array, 3, "edits_touched_chunks", this.at, whole(index, "index"), whole(edge, "edge"));
    return Array.from({ length: flat.length / 3 }, (_, i) => ({ x: flat[3 * i], y: flat[3 * i + 1], z: flat[3 * i + 2] }));
  }
}

// How materials are drawn: looks[i] is the Look of material i; others are opaque.
export class Visibility extends Handle {
  constructor(looks = []) {
    super("visibility", (out, room) => call("visibility_create", room.put(Uint8Array.from(looks)), looks.length, out));
  }
}

// The outermost layers of a chunk as it is now, for the meshes of its neighbours.
export class Borders extends Handle {
  constructor(chunk, visibility) {
    super("borders", (out) => call("borders_create", pointer(chunk, Chunk), pointer(visibility, Visibility), out));
  }
}

const pointers = (room, handles, Class) => (handles ? room.put(Uint32Array.from({ length: 6 }, (_, d) => pointer(handles[d], Class, true))) : 0);

// The quads of a chunk.
export class Mesh extends Handle {
  constructor() {
    super("mesh", (out) => call("mesh_create", out));
  }
  // Meshes a chunk. `neighbours` and `borders` are arrays by Direction, with gaps.
  build(chunk, visibility, { neighbours = null, borders = null } = {}) {
    use((room) => call("mesh_chunk", this.at, pointer(chunk, Chunk), pointers(room, neighbours, Chunk), pointers(room, borders, Borders), pointer(visibility, Visibility)));
    return this;
  }
  // Meshes the layers that changed since the mesh was made. Returns true if all of it was meshed.
  update(chunk, visibility, { neighbours = null, borders = null } = {}) {
    return use((room) => {
      const whole = room.take(4);
      call("mesh_update", this.at, pointer(chunk, Chunk), pointers(room, neighbours, Chunk), pointers(room, borders, Borders), pointer(visibility, Visibility), whole);
      return memory().getUint32(whole, true) === 1;
    });
  }
  // Returns two numbers of 32 bits for each quad, low bits first (docs/meshing.md; unpackQuad()).
  quads(pass = Pass.OPAQUE) {
    return list(Uint32Array, 2, "mesh_quads", this.at, whole(pass, "pass"));
  }
  layerQuads(pass, direction, layer) {
    return list(Uint32Array, 2, "mesh_layer_quads", this.at, whole(pass, "pass"), whole(direction, "direction"), whole(layer, "layer"));
  }
  quadCount(pass = Pass.OPAQUE) {
    return use((room) => {
      const count = room.take(4);
      call("mesh_quads", this.at, whole(pass, "pass"), 0, 0, count);
      return memory().getUint32(count, true);
    });
  }
  // Returns vertices and triangles in arrays for graphics libraries: four vertices a quad, in
  // voxels of the chunk.
  geometry(pass = Pass.OPAQUE) {
    const FLOATS = 9; // of a runstone_vertex: position, normal, uv, and two numbers of 16 bits
    const floats = list(Float32Array, FLOATS, "mesh_vertices", this.at, whole(pass, "pass"));
    const ids = new Uint16Array(floats.buffer);
    const count = floats.length / FLOATS;
    const out = { positions: new Float32Array(3 * count), normals: new Float32Array(3 * count), uvs: new Float32Array(2 * count), materials: new Uint16Array(count), indices: list(Uint32Array, 1, "mesh_indices", this.at, pass) };
    for (let i = 0; i < count; ++i) {
      const at = FLOATS * i;
      out.positions.set(floats.subarray(at, at + 3), 3 * i);
      out.normals.set(floats.subarray(at + 3, at + 6), 3 * i);
      out.uvs.set(floats.subarray(at + 6, at + 8), 2 * i);
      out.materials[i] = ids[2 * (at + 8)];
    }
    return out;
  }
}

// Unpacks a quad of Mesh.quads().
export function unpackQuad(low, high) {
  return {
    x: low & 127, y: (low >>> 7) & 127, z: (low >>> 14) & 127, width: ((low >>> 21) & 127) + 1,
    height: (((low >>> 28) | (high << 4)) & 127) + 1, direction: (high >>> 3) & 7, material: (high >>> 6) & 0xffff,
  };
}

// Makes the tile of eight children: child i lies at x = i & 1, y = i >> 1 & 1, z = i >> 2. null is
// empty.
export function buildTile(children, edge, visibility, order = Order.YXZ) {
  return new Chunk((out, room) => call("tile_build", room.put(Uint32Array.from({ length: 8 }, (_, i) => pointer(children[i], Chunk, true))),
    whole(edge, "edge"), whole(order, "order"), pointer(visibility, Visibility), out));
}
export function veilTile(tile, visibility) {
  call("tile_veil", pointer(tile, Chunk), pointer(visibility, Visibility));
}

const rayOf = (at) => (memory().getUint32(at + 4, true) === 0 ? null : {
  distance: memory().getFloat64(at + 8, true), direction: memory().getUint32(at + 16, true), voxel: readPos(at + 20), material: memory().getUint32(at + 32, true),
});
// Calls a function that finds the first voxel along a ray. Returns null if there is none.
export function ray(name, of, eye, direction, reach) {
  return use((room) => {
    const at = room.struct(40);
    call(name, of, room.vec(eye), room.vec(direction), reach, at);
    return rayOf(at);
  });
}

// Chunks of a world, for collision. Bodies are {min, max}.
export class Space extends Handle {
  constructor(edge) {
    super("space", (out) => call("space_create", whole(edge, "edge"), out));
  }
  // Sets a chunk. null removes it.
  set(place, chunk) {
    use((room) => call("space_set", this.at, room.pos(place), pointer(chunk, Chunk, true)));
  }
  setSolid(solid, others = true) {
    use((room) => call("space_set_solid", this.at, room.put(Uint8Array.from(solid, Number)), solid.length, others ? 1 : 0));
  }
  #body(room, { min, max }) {
    return joined(room, 24, room.vec(min), room.vec(max));
  }
  sweep(body, move) {
    return use((room) => {
      const at = room.struct(32);
      call("space_sweep", this.at, this.#body(room, body), room.vec(move), at);
      return { isHit: memory().getUint32(at + 4, true) === 1, fraction: memory().getFloat64(at + 8, true), direction: memory().getUint32(at + 16, true), voxel: readPos(at + 20) };
    });
  }
  // `stopped` has bit d if the move in Direction d met a solid voxel.
  slide(body, move) {
    return use((room) => {
      const at = room.struct(32);
      call("space_slide", this.at, this.#body(room, body), room.vec(move), at);
      return { stopped: memory().getUint32(at + 4, true), moved: readVec(at + 8) };
    });
  }
  overlaps(body) {
    return use((room) => {
      const at = room.take(4);
      call("space_overlaps", this.at, this.#body(room, body), at);
      return memory().getUint32(at, true) === 1;
    });
  }
  pick(eye, direction, reach) {
    return ray("space_pick", this.at, eye, direction, reach);
  }
}
