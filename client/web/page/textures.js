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
  const ANSWER_MS = 3000; // pictures wait for the database no longer
  const TOUCH_MS = 24 * 3600 * 1000; // a use is noted once a day

  let opened = null; // the promise of the database
  let last = Promise.resolve(); // the newest operation

  function openDatabase() {
    const request = indexedDB.open(DATABASE, LAYOUT);
    request.onupgradeneeded = () => {
      const made = request.result;
      for (const name of made.objectStoreNames) made.deleteObjectStore(name);
      made.createObjectStore("pngs");
      made.createObjectStore("entries").createIndex("used", "used");
    };
    request.onblocked = () => console.warn("another tab holds an older database of textures");
    return Database.inTime(Database.answered(request), ANSWER_MS);
  }

  // Carries out an operation after all others. It fails if the database does not answer in time.
  // After a failure none is carried out.
  function queue(operation) {
    last = last.then(async () => Database.inTime(operation(await (opened ??= openDatabase())), ANSWER_MS));
    return last;
  }

  const nameOf = (bytes) => Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");

  // Reads the pictures with these hashes, and gives each to the program.
  function find(hashes) {
    const names = [];
    for (let at = 0; at < hashes.length; at += HASH_BYTES) names.push(nameOf(hashes.subarray(at, at + HASH_BYTES)));
    queue(async (database) => {
      const transaction = database.transaction(["pngs", "entries"], "readwrite");
      const done = Database.completed(transaction);
      const pngs = transaction.objectStore("pngs"), entries = transaction.objectStore("entries");
      const now = Date.now();
      await Promise.all(names.map(async (name, index) => {
        const [png, entry] = await Promise.all([Database.answered(pngs.get(name)), Database.answered(entries.get(name))]);
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
      const done = Database.completed(transaction);
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
      const all = await Database.answered(entries.getAll());
      let size = all.reduce((sum, entry) => sum + entry.bytes, 0);
      if (size > BYTES_MAX) {
        for (const name of await Database.answered(entries.index("used").getAllKeys())) {
          if (size <= BYTES_MAX) break;
          size -= (await Database.answered(entries.get(name))).bytes;
          for (const store of [pngs, entries]) store.delete(name);
        }
      }
      await done;
    }).catch((error) => console.warn("no textures are kept:", error));
  }

  return { find, keep };
})();
