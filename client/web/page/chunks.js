// The chunks that this browser keeps between visits, in IndexedDB. The program makes and checks the
// rows (client/web/web_cache.hpp); this file stores them, in five stores of one database:
//   chunks   name -> the row, bytes
//   entries  name -> { epoch, seq, bytes }: what is needed to drop a row without reading it
//   used     name -> { stamp }: when the row was last used; lower stamps were used longer ago
//   worlds   world -> how its server described it last, a text
//   state    "bytes" -> the size of all rows, "stamp" -> the newest stamp, "world" -> the last world
// A name is "WORLD/LEVEL" and y, x and z in fixed width, so that the chunks of a line along z follow
// each other and are read by one request. One tab of the browser uses the database at a time.
// Operations are carried out one after the other, in their order. One that fails changes nothing, and
// ends the cache.
"use strict";

const Chunks = (() => {
  const DATABASE = "runstone-chunks";
  const LAYOUT = 1;
  const STORES = ["chunks", "entries", "used", "worlds", "state"];
  const LOCK_MS = 2000; // the page before may need a moment to end
  const OPEN_MS = 3000; // joining waits for the database no longer
  const ROW_OVERHEAD = 160; // bytes of a row and its entries, about
  const RANGE_ROWS_MAX = 64; // the rows of one answer are checked in one task
  const RANGES_AT_A_TIME = 4, EVICTED_AT_A_TIME = 64;
  const TOUCH_MS = 2000;

  let database = null;
  let unlock = () => {}; // gives the lock of the database back
  let bytesMax = 0;
  let bytes = 0, stamp = 1;
  let world = "", lines = new Map(); // of this world: the names without z -> the names of the rows
  let touched = new Set(); // names of rows that were used, which `used` does not show yet
  let last = Promise.resolve(); // the newest operation

  // Calls `body` with these stores in a transaction. If the body or the transaction fails, nothing is
  // changed.
  async function change(stores, body) {
    const transaction = database.transaction(stores, "readwrite");
    const done = Database.completed(transaction);
    try {
      await body(...stores.map((name) => transaction.objectStore(name)));
    } catch (error) {
      done.catch(() => {}); // this error is thrown instead
      if (transaction.error === null) transaction.abort();
      throw error;
    }
    await done;
  }
  const rangeOf = (id) => IDBKeyRange.bound(`${id}/`, `${id}0`, false, true); // '0' follows '/'

  const digits = (c) => (c + 2 ** 31).toString(16).padStart(8, "0");
  const nameOf = (id, level, x, y, z) => `${id}/${level}${digits(y)}${digits(x)}${digits(z)}`;
  const lineOf = (name) => name.slice(0, -8);
  const has = (name) => lines.get(lineOf(name))?.has(name) ?? false;
  function add(name) {
    const line = lineOf(name);
    if (!lines.has(line)) lines.set(line, new Set());
    lines.get(line).add(name);
  }
  const remove = (name) => lines.get(lineOf(name))?.delete(name);

  function openDatabase() {
    const request = indexedDB.open(DATABASE, LAYOUT);
    request.onupgradeneeded = () => {
      const made = request.result;
      for (const name of made.objectStoreNames) made.deleteObjectStore(name);
      for (const name of STORES) made.createObjectStore(name);
      request.transaction.objectStore("used").createIndex("stamp", "stamp");
    };
    return Database.answered(request);
  }

  // Takes the lock of the database until unlock().
  function lock() {
    return new Promise((resolve, reject) => {
      if (!navigator.locks) return reject(new Error("this page was not loaded over https"));
      const timeout = new AbortController();
      const timer = setTimeout(() => timeout.abort(), LOCK_MS);
      navigator.locks.request(DATABASE, { signal: timeout.signal }, () => {
        clearTimeout(timer);
        resolve();
        return new Promise((release) => (unlock = release));
      }).catch(() => reject(new Error("another tab keeps them")));
    });
  }

  async function load() {
    const transaction = database.transaction(["worlds", "state"]);
    const worlds = transaction.objectStore("worlds"), state = transaction.objectStore("state");
    const [ids, texts, size, newest, lastWorld] = await Promise.all([worlds.getAllKeys(), worlds.getAll(),
      ...["bytes", "stamp", "world"].map((key) => state.get(key))].map(Database.answered));
    bytes = size ?? 0;
    stamp = (newest ?? 0) + 1;
    if (lastWorld) await use(lastWorld);
    return ids.map((id, i) => `${id} ${texts[i]}`).join("\n");
  }

  // Opens the database. A damaged one is replaced by a new one.
  async function openAndLoad() {
    try {
      database = await openDatabase();
      return await load();
    } catch (error) {
      console.warn("the kept chunks cannot be read; they are deleted:", error);
      database?.close();
      await Database.answered(indexedDB.deleteDatabase(DATABASE));
      database = await openDatabase();
      return await load();
    }
  }

  function close() {
    database?.close();
    database = null;
    unlock();
  }

  // Begins the cache. Returns the known worlds as lines of text. Throws with words if there is no
  // cache, or if the database does not answer within OPEN_MS.
  async function open(sizeMax) {
    bytesMax = sizeMax;
    await lock();
    const opened = openAndLoad();
    try {
      return await Database.inTime(opened, OPEN_MS);
    } catch (error) {
      opened.catch(() => {}).then(close); // it may still answer, and keeps the lock until then
      throw error;
    }
  }

  // Ends the cache.
  function fail(error) {
    if (database === null) return;
    console.warn("no chunks are kept any more:", error);
    close();
    Program.call("web_cache_failed");
    const isFull = error?.name === "QuotaExceededError";
    page.notice(`no chunks are kept any more: ${isFull ? "this browser has no more room for them" :
      error?.message || error}`, true);
  }

  // Carries out an operation after all others. The first failure ends the cache.
  function queue(operation) {
    last = last.then(() => (database === null ? null : operation())).catch(fail);
  }

  async function use(id) {
    if (world === id) return;
    const names = await Database.answered(database.transaction("entries").objectStore("entries").getAllKeys(rangeOf(id)));
    world = id;
    lines = new Map();
    names.forEach(add);
  }

  function enter(id, text) {
    queue(() => {
      const transaction = database.transaction(["worlds", "state"], "readwrite");
      transaction.objectStore("worlds").put(text, id);
      transaction.objectStore("state").put(id, "world");
      Database.completed(transaction).catch(fail); // no operation waits for it
    });
  }

  // Drops the rows of these names.
  async function drop(wrong) {
    let left = bytes;
    await change(["chunks", "entries", "used", "state"], async (chunks, entries, used, state) => {
      const dropped = await Promise.all(wrong.map((name) => Database.answered(entries.get(name))));
      wrong.forEach((name, i) => {
        left -= dropped[i]?.bytes ?? 0;
        for (const store of [chunks, entries, used]) store.delete(name);
      });
      state.put(left, "bytes");
    });
    bytes = left;
    wrong.forEach(remove);
  }

  // Drops the rows of a world that CacheDrops names (client/cache/cache_drops.hpp).
  function dropRows(id, all, edited, lost, tiles, common, epoch) {
    const isWrong = (name, entry) => all || (edited && entry.seq > 0) ||
      (lost && entry.seq > common && entry.epoch < epoch) || (tiles && !name.startsWith(`${id}/0`));
    queue(async () => {
      await use(id);
      const entries = database.transaction("entries").objectStore("entries");
      const [keys, values] = await Promise.all([Database.answered(entries.getAllKeys(rangeOf(id))),
        Database.answered(entries.getAll(rangeOf(id)))]);
      const wrong = keys.filter((name, i) => isWrong(name, values[i]));
      await drop(wrong);
      Program.call("web_cache_dropped", wrong.length);
    });
  }
  function dropRow(id, ...key) {
    queue(async () => {
      await use(id);
      await drop([nameOf(id, ...key)]);
    });
  }

  // Returns ranges of names that contain the wanted ones, RANGE_ROWS_MAX at most in each, and few
  // others. `wanted` is sorted.
  function rangesOf(wanted) {
    const out = [];
    let range = null;
    for (const name of wanted) {
      const line = lineOf(name);
      if (range !== null && range.line !== line) {
        // The line beside it continues the range, unless other rows are in between.
        const stored = range.stored + lines.get(line).size;
        const isBeside = line.slice(0, -8) === range.line.slice(0, -8) &&
          parseInt(line.slice(-8), 16) === parseInt(range.line.slice(-8), 16) + 1;
        const isDense = 2 * stored <= 3 * (range.count + lines.get(line).size);
        if (isBeside && isDense && stored <= RANGE_ROWS_MAX) Object.assign(range, { line, stored });
        else range = null;
      }
      if (range?.count === RANGE_ROWS_MAX) range = null;
      if (range === null) out.push(range = { from: name, line, count: 0, stored: lines.get(line).size });
      range.to = name;
      ++range.count;
    }
    return out.map(({ from, to }) => IDBKeyRange.bound(from, to));
  }

  // Reads the rows of these keys, each [level, x, y, z], and gives each to the program.
  function find(id, keys) {
    queue(async () => {
      await use(id);
      const wanted = new Map(); // name -> index of the key
      keys.forEach((key, index) => {
        const name = nameOf(id, ...key);
        if (has(name)) wanted.set(name, index);
      });
      let hasRoom = true;
      const give = (name, stored) => {
        if (database === null || !hasRoom || !wanted.has(name)) return;
        touched.add(name);
        const row = stored instanceof Uint8Array ? stored : new Uint8Array();
        Program.buffer(row);
        hasRoom = Program.call("web_cache_found", wanted.get(name)) !== 0;
      };
      const ranges = rangesOf([...wanted.keys()].sort());
      const chunks = ranges.length === 0 ? null : database.transaction("chunks").objectStore("chunks");
      for (let i = 0; i < ranges.length && hasRoom; i += RANGES_AT_A_TIME) {
        await Promise.all(ranges.slice(i, i + RANGES_AT_A_TIME).map(async (range) => {
          const [names, rows] = await Promise.all([Database.answered(chunks.getAllKeys(range)), Database.answered(chunks.getAll(range))]);
          names.forEach((name, j) => give(name, rows[j]));
        }));
      }
      Program.call("web_cache_looked_up");
    });
    setTimeout(() => queue(touch), TOUCH_MS);
  }

  // Notes which rows were used.
  async function touch() {
    if (touched.size === 0) return;
    const transaction = database.transaction("used", "readwrite");
    const used = transaction.objectStore("used");
    for (const name of touched) if (has(name)) used.put({ stamp }, name);
    touched = new Set();
    await Database.completed(transaction);
  }

  // Writes rows. Each is a head of 32 bytes, see WebCache::keep(), and its bytes.
  function keep(id, batch) {
    queue(async () => {
      await use(id);
      const byName = new Map(); // a chunk that was kept twice meanwhile has one row, the last one
      const view = new DataView(batch.buffer, batch.byteOffset, batch.byteLength);
      for (let at = 0; at < batch.length;) {
        const size = view.getUint32(at, true);
        const [level, x, y, z] = [4, 8, 12, 16].map((offset) => view.getInt32(at + offset, true));
        const epoch = view.getUint32(at + 20, true), seq = view.getFloat64(at + 24, true);
        const name = nameOf(id, level, x, y, z);
        byName.set(name, { name, row: batch.slice(at + 32, at + 32 + size),
          entry: { epoch, seq, bytes: size + ROW_OVERHEAD } });
        at += 32 + size;
      }
      const rows = [...byName.values()];
      let size = bytes;
      const evicted = [];
      await change(["chunks", "entries", "used", "state"], async (chunks, entries, used, state) => {
        const before = await Promise.all(rows.map(({ name }) =>
          (has(name) ? Database.answered(entries.get(name)) : null)));
        rows.forEach(({ name, row, entry }, i) => {
          size += entry.bytes - (before[i]?.bytes ?? 0);
          chunks.put(row, name);
          entries.put(entry, name);
          used.put({ stamp }, name);
        });
        // The rows that were unused for longest are evicted.
        while (size > bytesMax) {
          const oldest = await Database.answered(used.index("stamp").getAllKeys(null, EVICTED_AT_A_TIME));
          if (oldest.length === 0) break;
          for (const name of oldest) {
            if (size <= bytesMax) break;
            size -= (await Database.answered(entries.get(name))).bytes;
            for (const store of [chunks, entries, used]) store.delete(name);
            evicted.push(name);
          }
        }
        state.put(size, "bytes");
        state.put(stamp, "stamp");
      });
      bytes = size;
      ++stamp;
      for (const { name } of rows) add(name);
      evicted.forEach(remove);
      Program.call("web_cache_kept", rows.length, evicted.length);
    });
  }

  return { open, enter, dropRows, dropRow, find, keep };
})();
