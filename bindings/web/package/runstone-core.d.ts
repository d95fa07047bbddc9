// Types of @runstone/core (docs/web-core.md).

/** A refused call. `status` is the name of a status of runstone.h, such as "truncated". */
export class RunstoneError extends Error {
  readonly status: string;
  constructor(status: string, message: string);
}

/**
 * Loads the WebAssembly, once: the file of the package, or another source. All other functions need
 * it.
 */
export function load(source?: string | URL | Response | ArrayBuffer | ArrayBufferView | WebAssembly.Module): Promise<void>;
/** The version of Runstone, as MAJOR.MINOR.PATCH. */
export function version(): string;

export interface Vec { x: number; y: number; z: number }
/** A voxel, or a chunk in the grid of chunks: whole numbers. */
export type Pos = Vec;
/** The sides of a chunk, 8 to 128 voxels: of a cube, or along x, y and z. */
export type Sides = number | readonly [number, number, number];

/** Axis orders, fastest axis first. */
export const Order: { readonly XYZ: 0; readonly XZY: 1; readonly YXZ: 2; readonly YZX: 3; readonly ZXY: 4; readonly ZYX: 5; readonly CHEAPEST: 6 };
export const Direction: { readonly NEG_X: 0; readonly POS_X: 1; readonly NEG_Y: 2; readonly POS_Y: 3; readonly NEG_Z: 4; readonly POS_Z: 5; readonly NONE: 6 };
export const Encoding: { readonly RAW: 1; readonly PACKED: 2; readonly CODED: 3 };
export const Mask: { readonly EVERYTHING: 0; readonly ONLY_EMPTY: 1; readonly ONLY_SOLID: 2; readonly ONLY_MATERIAL: 3 };
export const Look: { readonly EMPTY: 0; readonly OPAQUE: 1; readonly TRANSPARENT: 2 };
export const Pass: { readonly OPAQUE: 0; readonly TRANSPARENT: 1 };

/**
 * An object of the WebAssembly. free() frees its memory at once. Otherwise the memory is freed some
 * time after the last reference is gone.
 */
declare class Handle {
  free(): void;
}

export interface ChunkInfo { sides: [number, number, number]; order: number; volume: number; runs: number; isUniform: boolean }
/** The changes of Chunk.apply(). layers[axis] are the layers with a changed voxel. */
export interface Changes { isChanged: boolean; voxels: number; layers: [number[], number[], number[]] }
export interface Runs { ends: Uint32Array; materials: Uint16Array }
export interface LocalBox { min: [number, number, number]; max: [number, number, number] }

/** The voxels of a chunk as runs. */
export class Chunk extends Handle {
  private constructor();
  static filled(sides: Sides, material?: number): Chunk;
  /** `voxels` has a material for each voxel, flattened in `order`. */
  static fromArray(sides: Sides, voxels: ArrayLike<number>, order?: number): Chunk;
  static fromRuns(sides: Sides, runs: { ends: ArrayLike<number>; materials: ArrayLike<number> }, order?: number): Chunk;
  /**
   * Makes a chunk of bytes of any encoding. The chunk must have the sides `sides`, if they are
   * given.
   */
  static decode(bytes: ArrayBuffer | ArrayBufferView, sides?: Sides | null): Chunk;
  clone(): Chunk;
  readonly info: ChunkInfo;
  readonly runs: Runs;
  /** The digest of the voxels: two numbers of 64 bits, which do not depend on the axis order. */
  readonly digest: [bigint, bigint];
  get(x: number, y: number, z: number): number;
  /** Sets voxels [first, first + voxels) of the chunk, flattened in its own order. */
  fill(first: number, voxels: number, material: number): void;
  toArray(order?: number): Uint16Array;
  reorder(order?: number): void;
  equals(other: Chunk): boolean;
  encode(encoding?: number): Uint8Array;
  /** Applies edits to the chunk of a world at a place in the grid of chunks. */
  apply(place: Pos, edits: Edits): Changes;
  /** Boxes that cover each solid voxel once, for physics engines. */
  boxes(solid?: ArrayLike<number | boolean>, others?: boolean): LocalBox[];
}

/**
 * The material that the voxels of an edit get, and the voxels that may change. A number is a
 * material.
 */
export type Brush = number | { material: number; mask?: number; only?: number };

/** Edits, in the order in which they are applied. */
export class Edits extends Handle {
  constructor();
  voxel(place: Pos, brush: Brush): this;
  /** Adds a box. It is half-open: `max` lies outside. */
  box(min: Pos, max: Pos, brush: Brush): this;
  sphere(centre: Pos, radius: number, brush: Brush): this;
  stroke(points: readonly Pos[], radius: number, brush: Brush): this;
  /** Adds an edit in its canonical bytes (docs/edit-log.md). */
  bytes(bytes: ArrayBuffer | ArrayBufferView): this;
  clear(): void;
  readonly count: number;
  toBytes(index: number): Uint8Array;
  bounds(index: number): { min: Pos; max: Pos };
  touchedChunks(index: number, edge: number): Pos[];
}

/** How materials are drawn: looks[i] is the Look of material i; others are opaque. */
export class Visibility extends Handle {
  constructor(looks?: ArrayLike<number>);
}
/** The outermost layers of a chunk as it is now, for the meshes of its neighbours. */
export class Borders extends Handle {
  constructor(chunk: Chunk, visibility: Visibility);
}

export interface Beside {
  /** The neighbours by Direction. Gaps count as empty. */
  neighbours?: ArrayLike<Chunk | null | undefined> | null;
  /** The borders of these neighbours, by Direction. */
  borders?: ArrayLike<Borders | null | undefined> | null;
}
/**
 * Four vertices and two triangles a quad, counter-clockwise seen from outside; voxels of the chunk.
 */
export interface Geometry { positions: Float32Array; normals: Float32Array; uvs: Float32Array; materials: Uint16Array; indices: Uint32Array }

/** The quads of a chunk. */
export class Mesh extends Handle {
  constructor();
  build(chunk: Chunk, visibility: Visibility, beside?: Beside): this;
  /**
   * Meshes the layers that changed since the mesh was made. Returns true if all of it was meshed.
   */
  update(chunk: Chunk, visibility: Visibility, beside?: Beside): boolean;
  quadCount(pass?: number): number;
  /** Two numbers of 32 bits for each quad, low bits first. */
  quads(pass?: number): Uint32Array;
  layerQuads(pass: number, direction: number, layer: number): Uint32Array;
  geometry(pass?: number): Geometry;
}
export interface QuadFields { x: number; y: number; z: number; width: number; height: number; direction: number; material: number }
export function unpackQuad(low: number, high: number): QuadFields;

/** Makes the tile of eight children: child i lies at x = i & 1, y = i >> 1 & 1, z = i >> 2. */
export function buildTile(children: ArrayLike<Chunk | null | undefined>, edge: number, visibility: Visibility, order?: number): Chunk;
export function veilTile(tile: Chunk, visibility: Visibility): void;

export interface Body { min: Vec; max: Vec }
export interface RayHit { voxel: Pos; material: number; direction: number; distance: number }
/** Chunks of a world, for collision. */
export class Space extends Handle {
  constructor(edge: number);
  set(place: Pos, chunk: Chunk | null): void;
  setSolid(solid: ArrayLike<number | boolean>, others?: boolean): void;
  sweep(body: Body, move: Vec): { isHit: boolean; fraction: number; direction: number; voxel: Pos };
  slide(body: Body, move: Vec): { stopped: number; moved: Vec };
  overlaps(body: Body): boolean;
  pick(eye: Vec, direction: Vec, reach: number): RayHit | null;
}

export interface SessionOptions {
  /** The WebSocket of a gateway: ws://HOST:PORT/play, or wss:. */
  url: string | URL;
  name?: string;
  /** The secret key of the player, 32 bytes. Without one the player is new with each session. */
  key?: Uint8Array;
  /** An invite token. */
  invite?: string;
  /** The radii of the view in chunks: 0 to 32. The server may allow less. */
  radius?: number;
  radiusVertical?: number;
  /** A class with the interface of the browsers' WebSocket, where there is none. */
  WebSocket?: unknown;
}
export interface SessionInfo {
  isOpen: boolean;
  wantsClose: boolean;
  /** True if every chunk of the view has arrived, or the server cannot send it. */
  isLoaded: boolean;
  /** The edge of the chunks in voxels; 0 before the world is open. */
  edge: number;
  author: number;
  materials: number;
  chunks: number;
  /** The number of chunks whose mesh is out of date. */
  unmeshed: number;
  /** The number of edits without an answer. */
  pending: number;
  hasPlace: boolean;
  /** The last place of the player, or the spawn point of the world. */
  place: Vec;
}
/**
 * - open: the world is open, for the first time or again.
 * - closed: the connection ended, and the session connects again.
 * - refused: the connection ended, and no further attempt is made.
 * - rejected, durable and unseen: `number` is the number of an edit. The answer to an unseen edit
 *   was lost, and the chunks show whether the edit was applied.
 * - chat: a line of the chat.
 * - materials: Session.materials has changed.
 * - command: the command has ended. `text` is its output, and `number` is 1 if it succeeded.
 */
export interface SessionEvent {
  type: "open" | "closed" | "refused" | "rejected" | "chat" | "materials" | "durable" | "unseen" | "command" | "unknown";
  number: number;
  text: string;
}
export interface Material { id: number; name: string; colour: [number, number, number, number]; look: number; isCube: boolean }

/** A world of a server. It connects again by itself after a loss. */
export class Session {
  constructor(options: SessionOptions);
  /**
   * Receives for at most `ms`, sends due messages, and returns the events. Call it about every
   * 10 ms.
   */
  step(ms?: number): SessionEvent[];
  readonly info: SessionInfo;
  readonly materials: readonly Material[];
  /** The id of a material of this name. */
  material(name: string): number;
  /**
   * Moves the eye, and the view with it. Before the world is open, the view moves when it opens. Yaw 0 looks along +z
   * and grows towards +x; radians.
   */
  move(eye: Vec, yaw?: number, pitch?: number): void;
  /**
   * Makes meshes that are out of date. `mesh` is valid until the next one. null: remove the mesh of
   * the chunk.
   */
  meshes(ms?: number): Generator<{ at: Pos; mesh: Mesh | null }, void, void>;
  /**
   * Shows edits at once and sends them. Returns their numbers. Fails for an edit that the player
   * may not make. The edits before it are made.
   */
  edit(edits: Edits): number[];
  chat(line: string): void;
  /**
   * Sends a command, such as "undo". The event `command` has its output as text, and the number 1
   * if it succeeded. Fails while another command runs.
   */
  command(text: string): void;
  /** A copy of a chunk as it is shown. */
  chunk(place: Pos): Chunk;
  /** The material of a voxel, or null where no chunk is held. */
  get(place: Pos): number | null;
  pick(eye: Vec, direction: Vec, reach?: number): RayHit | null;
  /** Says goodbye and frees the memory. Further calls do nothing. */
  close(): void;
}
