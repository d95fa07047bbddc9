// The WebAssembly of @runstone/core: its instance, its memory, and calls that can be refused.

export class RunstoneError extends Error {
  // `status` is the name of a status of runstone.h, such as "truncated".
  constructor(status, message) {
    super(`${status}: ${message}`);
    this.name = "RunstoneError";
    this.status = status;
  }
}

let functions = null; // of the instance; null before load()
let view = null; // of the memory, which moves when it grows

// Returns the functions of the instance. Fails before load().
export function wasm() {
  if (functions === null) throw new RunstoneError("not loaded", "call load() of @runstone/core first");
  return functions;
}

export function memory() {
  if (view === null || view.buffer !== wasm().memory.buffer) view = new DataView(functions.memory.buffer);
  return view;
}

export const bytesAt = (at, count) => new Uint8Array(wasm().memory.buffer, at, count);
const decoder = new TextDecoder();
const encoder = new TextEncoder();
export const textAt = (at, count) => decoder.decode(bytesAt(at, count));

function zeroEndedText(at) {
  const all = new Uint8Array(wasm().memory.buffer);
  return textAt(at, all.indexOf(0, at) - at);
}

// Calls runstone_NAME() and fails if it is refused.
export function call(name, ...args) {
  const status = wasm()[`runstone_${name}`](...args);
  if (status !== 0)
    throw new RunstoneError(zeroEndedText(functions.runstone_status_name(status)),
      zeroEndedText(functions.runstone_last_error()));
}

// Memory for the arguments of one call. use() frees it when the work is done.
class Room {
  #taken = [];
  // Returns zeroed memory.
  take(bytes) {
    const at = wasm().malloc(Math.max(bytes, 1));
    if (at === 0) throw new RunstoneError("not enough memory", `there is no room for ${bytes} bytes`);
    this.#taken.push(at);
    bytesAt(at, bytes).fill(0);
    return at;
  }
  // Copies bytes or a typed array.
  put(from) {
    const bytes = ArrayBuffer.isView(from) ? new Uint8Array(from.buffer, from.byteOffset, from.byteLength) : new Uint8Array(from);
    const at = this.take(bytes.length);
    bytesAt(at, bytes.length).set(bytes);
    return at;
  }
  text(text) {
    return this.put(encoder.encode(`${text}\0`));
  }
  // A versioned struct of this size.
  struct(size) {
    const at = this.take(size);
    memory().setUint32(at, size, true);
    return at;
  }
  // runstone_pos and runstone_vec.
  pos({ x, y, z }) {
    const at = this.take(12);
    [x, y, z].forEach((along, i) => memory().setInt32(at + 4 * i, whole(along, "a position", -(2 ** 31), 2 ** 31 - 1), true));
    return at;
  }
  vec({ x, y, z }) {
    const at = this.take(24);
    [x, y, z].forEach((along, i) => memory().setFloat64(at + 8 * i, along, true));
    return at;
  }
  free() {
    for (const at of this.#taken) functions.free(at);
  }
}

export function use(work) {
  const room = new Room();
  try {
    return work(room);
  } finally {
    room.free();
  }
}

// Returns a number that the interface takes. Fails for other values: WebAssembly would cut them
// silently.
export function whole(value, name, min = 0, max = 0xffff_ffff) {
  if (!Number.isInteger(value) || value < min || value > max)
    throw new RunstoneError("bad argument", `${name} is ${String(value)}, and not a whole number from ${min} to ${max}`);
  return value;
}

export const readPos = (at) => ({ x: memory().getInt32(at, true), y: memory().getInt32(at + 4, true), z: memory().getInt32(at + 8, true) });
export const readVec = (at) => ({ x: memory().getFloat64(at, true), y: memory().getFloat64(at + 8, true), z: memory().getFloat64(at + 16, true) });

// Calls a function with the parameters `out, capacity, count` and returns its elements in a new
// array of `Type`. An element has `parts` numbers of the array.
export function list(Type, parts, name, ...args) {
  return use((room) => {
    const count = room.take(4);
    call(name, ...args, 0, 0, count);
    const elements = memory().getUint32(count, true);
    const out = room.take(elements * parts * Type.BYTES_PER_ELEMENT);
    if (elements !== 0) call(name, ...args, out, elements, count);
    return new Type(wasm().memory.buffer.slice(out, out + elements * parts * Type.BYTES_PER_ELEMENT));
  });
}

const forgotten = new FinalizationRegistry(({ kind, at }) => functions[`runstone_${kind}_free`](at));

// An object of the WebAssembly. free() frees its memory at once; otherwise it is freed some time
// after the last reference is gone.
export class Handle {
  #at = 0;
  #kind;
  constructor(kind, make) {
    this.#kind = kind;
    this.#at = use((room) => {
      const out = room.take(4);
      make(out, room);
      return memory().getUint32(out, true);
    });
    forgotten.register(this, { kind, at: this.#at }, this);
  }
  // The pointer to the object.
  get at() {
    if (this.#at === 0) throw new RunstoneError("bad handle", `the ${this.#kind} was freed`);
    return this.#at;
  }
  free() {
    if (this.#at === 0) return;
    forgotten.unregister(this);
    call(`${this.#kind}_free`, this.#at);
    this.#at = 0;
  }
}

// Returns the pointer of a handle of this class. NULL stands for null and undefined if it is
// `optional`.
export function pointer(handle, Class, optional = false) {
  if (optional && (handle === null || handle === undefined)) return 0;
  if (!(handle instanceof Class)) throw new RunstoneError("bad argument", `a ${Class.name} is needed`);
  return handle.at;
}

// The few functions of the system that the WebAssembly imports. It opens no files and reads no
// clock.
function imports() {
  const fill = (at, count) => (crypto.getRandomValues(bytesAt(at, count)), 0);
  const none = () => 52; // ENOSYS of WASI
  const known = {
    random_get: fill,
    getentropy: fill, // Emscripten 3.1.6 imports it in place of random_get
    proc_exit: (code) => {
      throw new Error(`the WebAssembly of @runstone/core ended (${code})`);
    },
    emscripten_notify_memory_growth: () => {},
  };
  const any = new Proxy(known, { get: (of, name) => of[name] ?? none, has: () => true });
  return { env: any, wasi_snapshot_preview1: any };
}

async function compiled(source) {
  if (source instanceof WebAssembly.Module) return source;
  if (source instanceof ArrayBuffer || ArrayBuffer.isView(source)) return WebAssembly.compile(source);
  if (source instanceof URL || typeof source === "string") {
    const url = new URL(source, import.meta.url);
    if (url.protocol === "file:") {
      const { readFile } = await import("node:fs/promises");
      return WebAssembly.compile(await readFile(url));
    }
    source = await fetch(url);
  }
  if (!source.ok) throw new RunstoneError("not found", `${source.url}: ${source.status}`);
  // A server may send another type than application/wasm, which compileStreaming() refuses.
  return WebAssembly.compile(await source.arrayBuffer());
}

let loading = null;

// Loads the WebAssembly, once: the file beside this one, or the source that is given. All other
// calls need it.
export function load(source = new URL("runstone-core.wasm", import.meta.url)) {
  loading ??= compiled(source).then((module) => WebAssembly.instantiate(module, imports())).then((instance) => {
    functions = instance.exports;
    functions._initialize();
  }).catch((error) => {
    loading = null;
    throw error;
  });
  return loading;
}

// Returns the version of Runstone.
export const version = () => zeroEndedText(wasm().runstone_version());
