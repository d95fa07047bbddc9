// Session: a world of a server, over a WebSocket to its gateway (runstone-web). It needs no DOM: it
// runs in pages, in workers, and in programs that have a WebSocket.
import { Chunk, Edits, Mesh, ray } from "./chunks.js";
import { bytesAt, call, Handle, memory, pointer, readPos, readVec, RunstoneError, textAt, use, whole } from "./wasm.js";

const NOTICES = { 1: "open", 2: "closed", 3: "refused", 4: "rejected", 5: "chat", 6: "materials", 7: "durable", 8: "unseen", 9: "command" };
const PAUSES_MS = { first: 250, most: 5000 };
const CONNECT_MS_MAX = 10_000;
const RECEIVED_BYTES_MAX = 64 << 20; // wait for step(); with more the connection ends
const random = (bytes) => crypto.getRandomValues(new Uint8Array(bytes));

class SessionHandle extends Handle {
  constructor({ key, name, invite, radius, radiusVertical }) {
    super("session", (out, room) => call("session_create", room.put(key), room.text(name), room.text(invite),
      new Uint32Array(random(4).buffer)[0] || 1, whole(radius, "radius"), whole(radiusVertical, "radiusVertical"), out));
  }
}

export class Session {
  #handle;
  #url;
  #WebSocket;
  #socket = null;
  #isClosed = false; // by close()
  #isOpen = false;
  #received = [];
  #receivedBytes = 0;
  #lost = false;
  #pauseMs = PAUSES_MS.first;
  #nextMs = 0; // when the next attempt begins, or the one under way began
  #isOver = false;
  #mesh = new Mesh();
  #materials = [];
  #events = []; // that the WebAssembly does not know

  constructor({ url, name = "visitor", key = random(32), invite = "", radius = 4, radiusVertical = 2, WebSocket = globalThis.WebSocket }) {
    if (WebSocket === undefined) throw new RunstoneError("bad argument", "there is no WebSocket here: pass a class");
    if (key.byteLength !== 32) throw new RunstoneError("bad argument", "a key has 32 bytes");
    this.#url = String(url);
    this.#WebSocket = WebSocket;
    this.#handle = new SessionHandle({ key, name, invite, radius, radiusVertical });
  }

  #connect(nowMs) {
    this.#nextMs = nowMs;
    let socket;
    try {
      socket = new this.#WebSocket(this.#url);
    } catch (error) {
      // The address is invalid, or this page may not connect to it.
      this.#events.push({ type: "refused", number: 0, text: `${this.#url}: ${error.message}` });
      return;
    }
    this.#socket = socket;
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      if (socket !== this.#socket) return;
      this.#isOpen = true;
      use((room) => call("session_connected", this.#handle.at, room.put(random(32)), performance.now()));
      this.#send();
    };
    socket.onmessage = ({ data }) => {
      if (socket !== this.#socket) return;
      // A text message is no frame.
      if (typeof data === "string" || this.#receivedBytes + data.byteLength > RECEIVED_BYTES_MAX) return this.#lose();
      this.#received.push(data);
      this.#receivedBytes += data.byteLength;
    };
    socket.onclose = () => {
      if (socket === this.#socket) this.#lost = true;
    };
    socket.onerror = () => {}; // onclose() follows; some classes end the program without it
  }

  #lose() {
    this.#lost = true;
    this.#received = [];
    this.#receivedBytes = 0;
  }

  #disconnect(nowMs) {
    const socket = this.#socket;
    this.#socket = null;
    this.#lost = false;
    socket?.close();
    if (this.#isOpen) call("session_disconnected", this.#handle.at);
    else this.#events.push({ type: "closed", number: 0, text: `cannot connect to ${this.#url}` });
    this.#isOpen = false;
    this.#received = [];
    this.#receivedBytes = 0;
    this.#nextMs = nowMs + this.#pauseMs;
    this.#pauseMs = Math.min(2 * this.#pauseMs, PAUSES_MS.most);
  }

  #receive(untilMs) {
    do {
      const data = this.#received.shift();
      if (data === undefined) return;
      this.#receivedBytes -= data.byteLength;
      try {
        use((room) => call("session_receive", this.#handle.at, room.put(data), data.byteLength, performance.now()));
      } catch (error) {
        if (!(error instanceof RunstoneError)) throw error;
        return this.#lose();
      }
    } while (performance.now() < untilMs);
  }

  #send() {
    if (!this.#isOpen || this.#socket.readyState !== 1) return;
    use((room) => {
      const out = room.take(8);
      for (;;) {
        call("session_next_frame", this.#handle.at, out, out + 4);
        const count = memory().getUint32(out + 4, true);
        if (count === 0) return;
        this.#socket.send(bytesAt(memory().getUint32(out, true), count).slice());
      }
    });
  }

  // Receives for at most `ms`, sends due messages, and returns the events since the last call. Call
  // it about every 10 ms, at least once a second.
  step(ms = 8) {
    const nowMs = performance.now();
    if (!this.#isOver && this.#socket === null && nowMs >= this.#nextMs) this.#connect(nowMs);
    this.#receive(nowMs + ms);
    call("session_step", this.#handle.at, performance.now());
    this.#send();
    const isSlow = this.#socket !== null && !this.#isOpen && nowMs - this.#nextMs > CONNECT_MS_MAX;
    if (this.#socket !== null && (isSlow || (this.#lost && this.#received.length === 0) || this.info.wantsClose))
      this.#disconnect(performance.now());
    return this.#notices();
  }

  #notices() {
    const out = this.#events.splice(0);
    use((room) => {
      const at = room.take(16);
      for (;;) {
        call("session_next_notice", this.#handle.at, at, at + 4, at + 8, at + 12);
        const [kind, number, text, bytes] = [0, 4, 8, 12].map((field) => memory().getUint32(at + field, true));
        if (kind === 0) return;
        out.push({ type: NOTICES[kind] ?? "unknown", number, text: bytes === 0 ? "" : textAt(text, bytes) });
      }
    });
    for (const { type } of out) {
      if (type === "open") this.#pauseMs = PAUSES_MS.first;
      if (type === "refused") this.#isOver = true;
      if (type === "materials") this.#materials = this.#readMaterials();
    }
    return out;
  }

  get info() {
    return use((room) => {
      const at = room.struct(72);
      call("session_get_info", this.#handle.at, at);
      const read = (field) => memory().getUint32(at + 4 * field, true);
      return { isOpen: read(1) === 1, wantsClose: read(2) === 1, isLoaded: read(3) === 1, edge: read(4), author: read(5), materials: read(6),
        chunks: read(7), unmeshed: read(8), pending: read(9), hasPlace: read(10) === 1, place: readVec(at + 48) };
    });
  }

  #readMaterials() {
    return use((room) => {
      const [at, name] = [room.struct(16), room.take(8)];
      return Array.from({ length: this.info.materials }, (_, id) => {
        call("session_get_material", this.#handle.at, id, at, name, name + 4);
        return { id, name: textAt(memory().getUint32(name, true), memory().getUint32(name + 4, true)), colour: [...bytesAt(at + 8, 4)],
          look: memory().getUint32(at + 4, true), isCube: memory().getUint32(at + 12, true) === 1 };
      });
    });
  }
  // The materials of the world by id: {id, name, colour: [r, g, b, a] of 255, look, isCube}.
  get materials() {
    return this.#materials;
  }
  // Returns the id of a material by its name. Fails if the world has none.
  material(name) {
    const found = this.#materials.find((row) => row.name === name);
    if (found === undefined) throw new RunstoneError("not found", `the world has no material ${name}`);
    return found.id;
  }

  // Moves the eye, and the view with it. Before the world is open, the view moves when it opens. Yaw 0 looks along +z
  // and grows towards +x; radians.
  move(eye, yaw = 0, pitch = 0) {
    use((room) => call("session_move", this.#handle.at, room.vec(eye), yaw, pitch));
  }

  // Makes meshes that are out of date, for at most `ms`: {at, mesh}, where `at` is the place of the
  // chunk in the grid of chunks. `mesh` is valid until the next one, or null: remove the mesh of
  // the chunk.
  *meshes(ms = 6) {
    const untilMs = performance.now() + ms;
    do {
      const next = use((room) => {
        const at = room.take(16);
        call("session_next_mesh", this.#handle.at, this.#mesh.at, at, at + 12);
        return { at: readPos(at), has: memory().getUint32(at + 12, true) };
      });
      if (next.has === 0) return;
      yield { at: next.at, mesh: next.has === 1 ? this.#mesh : null };
    } while (performance.now() < untilMs);
  }

  // Shows edits at once and sends them. Returns their numbers, which `rejected` and `durable` name.
  edit(edits) {
    pointer(edits, Edits);
    const numbers = [];
    for (let i = 0; i < edits.count; ++i) {
      const bytes = edits.toBytes(i);
      numbers.push(use((room) => {
        const number = room.take(4);
        call("session_edit", this.#handle.at, room.put(bytes), bytes.length, performance.now(), number);
        return memory().getUint32(number, true);
      }));
    }
    this.#send();
    return numbers;
  }

  #sendText(name, text) {
    const bytes = new TextEncoder().encode(text);
    use((room) => call(name, this.#handle.at, room.put(bytes), bytes.length));
    this.#send();
  }
  chat(line) {
    this.#sendText("session_chat", line);
  }
  // Sends a command, such as "undo". The event `command` has its output as text, and the number 1 if
  // it succeeded. Fails while another command runs.
  command(text) {
    this.#sendText("session_command", text);
  }

  // Returns a copy of a chunk as it is shown. Fails if it is not held.
  chunk(place) {
    return new Chunk((out, room) => call("session_chunk", this.#handle.at, room.pos(place), out));
  }
  // Returns the material of a voxel, or null where no chunk is held.
  get(place) {
    return use((room) => {
      const out = room.take(8);
      call("session_get", this.#handle.at, room.pos(place), out, out + 4);
      return memory().getUint32(out + 4, true) === 1 ? memory().getUint16(out, true) : null;
    });
  }
  // Returns the first voxel along a ray, or null: {voxel, material, direction, distance}.
  pick(eye, direction, reach = 64) {
    return ray("session_pick", this.#handle.at, eye, direction, reach);
  }

  // Says goodbye, closes the connection and frees the memory. The session cannot be used any more.
  // Further calls do nothing.
  close() {
    if (this.#isClosed) return;
    this.#isClosed = true;
    call("session_leave", this.#handle.at);
    this.#send();
    this.#isOver = true;
    const socket = this.#socket;
    this.#socket = null;
    socket?.close();
    this.#handle.free();
    this.#mesh.free();
  }
}
