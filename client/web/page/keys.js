// The keys that this browser keeps: the player's identity, and the keys of the servers that it has
// joined. They are in IndexedDB, which other sites cannot read. No address contains a key.
"use strict";

const Keys = (() => {
  const SEED_BYTES = 32;

  const toHex = (bytes) => Array.from(bytes, (b) => b.toString(16).padStart(2, "0")).join("");

  function answered(request) {
    return new Promise((resolve, reject) => {
      request.onsuccess = () => resolve(request.result);
      request.onerror = () => reject(request.error);
    });
  }

  function open() {
    const request = indexedDB.open("runstone", 1);
    request.onupgradeneeded = () => {
      request.result.createObjectStore("identity");
      request.result.createObjectStore("servers");
    };
    return answered(request);
  }

  // Returns the identity of this browser and the keys of the servers that it has joined. The first
  // visit makes the identity. Without IndexedDB, as in some private windows, each visit makes one.
  async function load() {
    const fresh = crypto.getRandomValues(new Uint8Array(SEED_BYTES));
    try {
      const database = await open();
      // Two tabs may run this at the same time. Both get the seed that the first one has written.
      const change = database.transaction("identity", "readwrite").objectStore("identity");
      let seed = await answered(change.get("seed"));
      if (!(seed instanceof Uint8Array) || seed.length !== SEED_BYTES) {
        await answered(change.put(fresh, "seed"));
        seed = fresh;
      }
      const servers = database.transaction("servers").objectStore("servers");
      const [worlds, keys] = await Promise.all([answered(servers.getAllKeys()), answered(servers.getAll())]);
      return { seed: toHex(seed), isKept: true, servers: worlds.map((world, i) => `${world} ${keys[i]}`).join("\n") };
    } catch (error) {
      console.warn("this browser keeps no keys:", error);
      return { seed: toHex(fresh), isKept: false, servers: "" };
    }
  }

  async function keepServer(world, key) {
    try {
      const database = await open();
      await answered(database.transaction("servers", "readwrite").objectStore("servers").put(key, world));
    } catch (error) {
      page.notice(`the key of this server is not kept: ${error?.message || error}`, true);
    }
  }

  return { load, keepServer };
})();
