// The keys that this browser keeps: the player's identity, and the keys of the servers it has met.
// They lie in IndexedDB, which other sites cannot read. Nothing of them is ever in an address.
"use strict";

const Keys = (() => {
  const SEED_BYTES = 32;

  const toHex = (bytes) => Array.from(bytes, (b) => b.toString(16).padStart(2, "0")).join("");

  function settled(request) {
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
    return settled(request);
  }

  // Returns the identity of this browser, made at the first visit, and the servers it knows. Without
  // IndexedDB, as in some private windows, the identity is for this visit alone.
  async function load() {
    const fresh = crypto.getRandomValues(new Uint8Array(SEED_BYTES));
    try {
      const database = await open();
      // Two tabs may come here at once. Both get the seed that the first one has written.
      const change = database.transaction("identity", "readwrite").objectStore("identity");
      let seed = await settled(change.get("seed"));
      if (!(seed instanceof Uint8Array) || seed.length !== SEED_BYTES) {
        await settled(change.put(fresh, "seed"));
        seed = fresh;
      }
      const servers = database.transaction("servers").objectStore("servers");
      const [worlds, keys] = await Promise.all([settled(servers.getAllKeys()), settled(servers.getAll())]);
      return { seed: toHex(seed), isKept: true, servers: worlds.map((world, i) => `${world} ${keys[i]}`).join("\n") };
    } catch (error) {
      console.warn("this browser keeps no keys:", error);
      return { seed: toHex(fresh), isKept: false, servers: "" };
    }
  }

  async function keepServer(world, key) {
    try {
      const database = await open();
      await settled(database.transaction("servers", "readwrite").objectStore("servers").put(key, world));
    } catch (error) {
      console.warn("the key of this server is not kept:", error);
    }
  }

  return { load, keepServer };
})();
