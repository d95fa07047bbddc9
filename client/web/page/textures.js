// The pictures of textures that this browser keeps between visits, in IndexedDB. The program checks
// them (client/web/web_textures.hpp); this file stores them by their hash, in two stores of one
// database:
//   pngs     hash -> the bytes of the picture
//   entries  hash -> { used, bytes }: when it was last used, and its size
// Tabs of the browser share the database. If it fails, no pictures are found and kept any more.
"use strict";

const Textures = (() => {
  const DATABASE = "runstone-textures";
  const LAYOUT = 1;
  const BYTES_MAX = 64 * 2 ** 20, HASH_BYTES = 32;
  const TOUCH_MS = 24 * 3600 * 1000; // a use is noted once a day

  let opened = null; // the promise of the database
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

  function openDatabase() {
    const request = indexedDB.open(DATABASE, LAYOUT);
    request.onupgradeneeded = () => {
      const made = request.result;
      for (const name of made.objectStoreNames) made.deleteObjectStore(name);
      made.createObjectStore("pngs");
      made.createObjectStore("entries").createIndex("used", "used");
    };
    request.onblocked = () => console.warn("another tab holds an older database of textures");
    return answered(request);
  }

  // Carries out an operation after all others. After a failure none is carried out.
  function queue(operation) {
    last = last.then(async () => operation(await (opened ??= openDatabase())));
    return last;
  }

  const nameOf = (bytes) => Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");

  // Reads the pictures with these hashes, and gives each to the program.
  function find(hashes) {
    const names = [];
    for (let at = 0; at < hashes.length; at += HASH_BYTES) names.push(nameOf(hashes.subarray(at, at + HASH_BYTES)));
    queue(async (database) => {
      const transaction = database.transaction(["pngs", "entries"], "readwrite");
      const done = completed(transaction);
      const pngs = transaction.objectStore("pngs"), entries = transaction.objectStore("entries");
      const now = Date.now();
      await Promise.all(names.map(async (name, index) => {
        const [png, entry] = await Promise.all([answered(pngs.get(name)), answered(entries.get(name))]);
        if (!(png instanceof Uint8Array)) return;
        if (entry && now - entry.used > TOUCH_MS) entries.put({ ...entry, used: now }, name);
        Program.buffer(png);
        Program.call("web_texture_found", index);
      }));
      await done;
    }).catch((error) => console.warn("the kept textures cannot be read:", error))
      .then(() => Program.call("web_textures_looked_up"));
  }

  // Writes pictures. Each is its hash, a u32 with its size, little-endian, and its bytes.
  function keep(rows) {
    queue(async (database) => {
      const transaction = database.transaction(["pngs", "entries"], "readwrite");
      const done = completed(transaction);
      const pngs = transaction.objectStore("pngs"), entries = transaction.objectStore("entries");
      const view = new DataView(rows.buffer, rows.byteOffset, rows.byteLength);
      const used = Date.now();
      for (let at = 0; at < rows.length;) {
        const name = nameOf(rows.subarray(at, at + HASH_BYTES));
        const begin = at + HASH_BYTES + 4, bytes = view.getUint32(at + HASH_BYTES, true);
        pngs.put(rows.slice(begin, begin + bytes), name);
        entries.put({ used, bytes }, name);
        at = begin + bytes;
      }
      // The pictures that were unused for longest are dropped.
      const all = await answered(entries.getAll());
      let size = all.reduce((sum, entry) => sum + entry.bytes, 0);
      if (size > BYTES_MAX) {
        for (const name of await answered(entries.index("used").getAllKeys())) {
          if (size <= BYTES_MAX) break;
          size -= (await answered(entries.get(name))).bytes;
          for (const store of [pngs, entries]) store.delete(name);
        }
      }
      await done;
    }).catch((error) => console.warn("no textures are kept:", error));
  }

  return { find, keep };
})();
