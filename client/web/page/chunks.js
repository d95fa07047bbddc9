// The chunks that this browser keeps between visits, in IndexedDB. The program makes and checks the
// rows (client/web/web_cache.hpp); this file stores them, in four stores of one database:
//   chunks   name -> the row, bytes
//   entries  name -> { epoch, seq, bytes, used }: what is needed to drop rows without reading them
//   worlds   world -> how its server described it last, a text
//   state    "bytes" -> the size of all rows, "stamp" -> a number that rises with each batch
// A name is "WORLD/LEVEL,X,Y,Z". One tab of the browser uses the database at a time. Operations are
// carried out one after the other, in their order.
"use strict";

const Chunks = (() => {
  const DATABASE = "runstone-chunks";
  const LAYOUT = 1;
  const STORES = ["chunks", "entries", "worlds", "state"];
  const LOCK_MS = 2000; // the page before may need a moment to end
  const ROW_OVERHEAD = 160; // bytes of a row and its entry, about
  const READ_AT_A_TIME = 64, EVICTED_AT_A_TIME = 64;

  let database = null;
  let bytesMax = 0;
  let bytes = 0, stamp = 1;
  let world = "", names = new Set(); // of the rows of this world
  let last = Promise.resolve(); // the newest operation

  function answered(request) {
    return new Promise((resolve, reject) => {
      request.onsuccess = () => resolve(request.result);
      request.onerror = () => reject(request.error);
    });
  }
  function completed(transaction) {
    return new Promise((resolve, reject) => {
      transaction.oncomplete = () => resolve();
      transaction.onabort = () => reject(transaction.error ?? new Error("the transaction was aborted"));
    });
  }
  const rangeOf = (id) => IDBKeyRange.bound(`${id}/`, `${id}0`, false, true); // '0' follows '/'

  function openDatabase() {
    const request = indexedDB.open(DATABASE, LAYOUT);
    request.onupgradeneeded = () => {
      const made = request.result;
      for (const name of made.objectStoreNames) made.deleteObjectStore(name);
      for (const name of STORES) made.createObjectStore(name);
      request.transaction.objectStore("entries").createIndex("used", "used");
    };
    return answered(request);
  }

  // Takes the lock of the database for as long as the page lives.
  function lock() {
    return new Promise((resolve, reject) => {
      if (!navigator.locks) return reject(new Error("this page was not loaded over https"));
      const timeout = new AbortController();
      const timer = setTimeout(() => timeout.abort(), LOCK_MS);
      navigator.locks.request(DATABASE, { signal: timeout.signal }, () => {
        clearTimeout(timer);
        resolve();
        return new Promise(() => {});
      }).catch(() => reject(new Error("another tab keeps them")));
    });
  }

  async function load() {
    const transaction = database.transaction(["worlds", "state"]);
    const worlds = transaction.objectStore("worlds"), state = transaction.objectStore("state");
    const [ids, texts, size, stamped] = await Promise.all([worlds.getAllKeys(), worlds.getAll(), state.get("bytes"),
      state.get("stamp")].map(answered));
    bytes = size ?? 0;
    stamp = (stamped ?? 0) + 1;
    return ids.map((id, i) => `${id} ${texts[i]}`).join("\n");
  }

  // Opens the database. Returns the known worlds as lines of text, and throws with words if there is
  // no cache. A damaged database is replaced by a new one.
  async function open(sizeMax) {
    bytesMax = sizeMax;
    await lock();
    try {
      database = await openDatabase();
      return await load();
    } catch (error) {
      console.warn("the kept chunks cannot be read; they are deleted:", error);
      database?.close();
      await answered(indexedDB.deleteDatabase(DATABASE));
      database = await openDatabase();
      return await load();
    }
  }

  // Carries out an operation after all others. The first failure ends the cache.
  function queue(operation) {
    last = last.then(async () => {
      if (database === null) return;
      try {
        await operation();
      } catch (error) {
        console.warn("no chunks are kept any more:", error);
        database.close();
        database = null;
        runstone._web_cache_failed();
        const isFull = error?.name === "QuotaExceededError";
        page.notice(`no chunks are kept any more: ${isFull ? "this browser has no more room for them" :
          error?.message || error}`, true);
      }
    });
  }

  async function use(id) {
    if (world === id) return;
    const keys = await answered(database.transaction("entries").objectStore("entries").getAllKeys(rangeOf(id)));
    world = id;
    names = new Set(keys);
  }

  function enter(id, text) {
    queue(async () => {
      const transaction = database.transaction("worlds", "readwrite");
      transaction.objectStore("worlds").put(text, id);
      await completed(transaction);
    });
  }

  // Drops the rows of these names.
  async function drop(wrong) {
    const transaction = database.transaction(["chunks", "entries", "state"], "readwrite");
    const done = completed(transaction);
    const entries = transaction.objectStore("entries");
    const dropped = await Promise.all(wrong.map((name) => answered(entries.get(name))));
    let left = bytes;
    wrong.forEach((name, i) => {
      left -= dropped[i]?.bytes ?? 0;
      entries.delete(name);
      transaction.objectStore("chunks").delete(name);
    });
    transaction.objectStore("state").put(left, "bytes");
    await done;
    bytes = left;
    for (const name of wrong) names.delete(name);
  }

  // Drops the rows of a world that CacheDrops names (client/cache/cache_drops.hpp).
  function dropRows(id, all, edited, lost, tiles, common, epoch) {
    const isWrong = (name, entry) => all || (edited && entry.seq > 0) ||
      (lost && entry.seq > common && entry.epoch < epoch) || (tiles && !name.startsWith(`${id}/0,`));
    queue(async () => {
      await use(id);
      const entries = database.transaction("entries").objectStore("entries");
      const [keys, values] = await Promise.all([answered(entries.getAllKeys(rangeOf(id))),
        answered(entries.getAll(rangeOf(id)))]);
      const wrong = keys.filter((name, i) => isWrong(name, values[i]));
      await drop(wrong);
      runstone._web_cache_dropped(wrong.length);
    });
  }
  function dropRow(id, key) {
    queue(async () => {
      await use(id);
      await drop([`${id}/${key}`]);
    });
  }

  // Reads the rows of these keys and gives each to the program.
  function find(id, keys) {
    queue(async () => {
      await use(id);
      const wanted = [];
      keys.forEach((key, index) => names.has(`${id}/${key}`) && wanted.push({ name: `${id}/${key}`, index }));
      const chunks = wanted.length && database.transaction("chunks").objectStore("chunks");
      let hasRoom = true;
      for (let i = 0; i < wanted.length && hasRoom; i += READ_AT_A_TIME) {
        await Promise.all(wanted.slice(i, i + READ_AT_A_TIME).map(async ({ name, index }) => {
          const row = await answered(chunks.get(name));
          if (!hasRoom || !(row instanceof Uint8Array)) return;
          const at = runstone._web_cache_buffer(row.length); // the memory may grow in this call
          runstone.HEAPU8.set(row, at);
          hasRoom = runstone._web_cache_found(index) !== 0;
        }));
      }
      runstone._web_cache_looked_up();
      if (wanted.length) await touch(wanted.map(({ name }) => name));
    });
  }

  // Notes that rows were used.
  async function touch(used) {
    const transaction = database.transaction("entries", "readwrite");
    const done = completed(transaction);
    const entries = transaction.objectStore("entries");
    for (const name of used) {
      entries.get(name).onsuccess = (event) => {
        const entry = event.target.result;
        if (entry && entry.used !== stamp) entries.put({ ...entry, used: stamp }, name);
      };
    }
    await done;
  }

  // Writes rows. Each is a head of 32 bytes, see WebCache::keep(), and its bytes.
  function keep(id, batch) {
    queue(async () => {
      await use(id);
      const rows = [];
      const view = new DataView(batch.buffer, batch.byteOffset, batch.byteLength);
      for (let at = 0; at < batch.length;) {
        const size = view.getUint32(at, true);
        const [level, x, y, z] = [4, 8, 12, 16].map((offset) => view.getInt32(at + offset, true));
        const epoch = view.getUint32(at + 20, true), seq = view.getFloat64(at + 24, true);
        rows.push({ name: `${id}/${level},${x},${y},${z}`, row: batch.slice(at + 32, at + 32 + size),
          entry: { epoch, seq, bytes: size + ROW_OVERHEAD, used: stamp } });
        at += 32 + size;
      }
      const transaction = database.transaction(STORES, "readwrite");
      const done = completed(transaction);
      const [chunks, entries, , state] = STORES.map((store) => transaction.objectStore(store));
      const before = await Promise.all(rows.map(({ name }) => (names.has(name) ? answered(entries.get(name)) : null)));
      let size = bytes;
      rows.forEach(({ name, row, entry }, i) => {
        size += entry.bytes - (before[i]?.bytes ?? 0);
        chunks.put(row, name);
        entries.put(entry, name);
      });
      // The rows that were unused for longest are evicted.
      const evicted = [];
      while (size > bytesMax) {
        const oldest = await answered(entries.index("used").getAllKeys(null, EVICTED_AT_A_TIME));
        if (oldest.length === 0) break;
        for (const name of oldest) {
          if (size <= bytesMax) break;
          size -= (await answered(entries.get(name))).bytes;
          entries.delete(name);
          chunks.delete(name);
          evicted.push(name);
        }
      }
      state.put(size, "bytes");
      state.put(stamp, "stamp");
      await done;
      bytes = size;
      ++stamp;
      for (const { name } of rows) names.add(name);
      for (const name of evicted) names.delete(name);
      runstone._web_cache_kept(rows.length, evicted.length);
    });
  }

  return { open, enter, dropRows, dropRow, find, keep };
})();
