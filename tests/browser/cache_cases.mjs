// Test cases of the chunk cache of the client in a browser.
import assert from "node:assert/strict";

import { ABOVE, Player, until } from "./player.mjs";
import { World } from "./world.mjs";

// Waits until the cache has all chunks of the player, and no rows come any more. Returns the report.
function kept(player) {
  return until("the chunks are kept", async () => {
    const one = await player.report();
    await new Promise((resolve) => setTimeout(resolve, 2500)); // longer than between two rounds of keeping
    const other = await player.report();
    const rows = (report) => report.cache.hits + report.cache.kept;
    return rows(one) >= one.replica.confirmed_chunks && rows(one) === rows(other) ? other : null;
  });
}

// Carries out a function with the database of the cache, in a page of the gateway that has no client.
async function inDatabase(context, address, body) {
  const page = await context.newPage();
  await page.goto(`${address}/client/client.css`);
  const out = await page.evaluate(`(async () => {
    const database = await new Promise((resolve, reject) => {
      const request = indexedDB.open("runstone-chunks");
      request.onsuccess = () => resolve(request.result);
      request.onerror = () => reject(request.error);
    });
    const answered = (request) => new Promise((resolve) => (request.onsuccess = () => resolve(request.result)));
    const out = await (${body})(database, answered);
    database.close();
    return out;
  })()`);
  await page.close();
  return out;
}

// Returns the size of the cache as it is kept and by its rows, and the number of entries and of rows.
const sizesOf = (context, address) => inDatabase(context, address, async (database, answered) => {
  const transaction = database.transaction(["chunks", "entries", "state"]);
  const entries = await answered(transaction.objectStore("entries").getAll());
  return { size: (await answered(transaction.objectStore("state").get("bytes"))) ?? 0,
    sum: entries.reduce((all, entry) => all + entry.bytes, 0), entries: entries.length,
    rows: await answered(transaction.objectStore("chunks").count()) };
});

// Adds the cases by test(). `somebody` makes a browser context, and `world` returns the shared world.
export function addCacheCases({ test, bin, files, measured, somebody, world }) {
  test("a reload continues from the kept chunks, and shows what was built meanwhile", async () => {
    const hills = await World.open(bin, files, ["--generator", "terrain", "--seed", "7"]);
    try {
      const context = await somebody();
      const visit = async (inject = null) => {
        const player = await Player.open(context, hills.address, { inject });
        await player.joined("ada");
        await player.complete();
        return player;
      };
      const ada = await visit();
      const first = await kept(ada);
      assert.equal(first.cache.hits, 0);
      assert(first.snapshots.count > 100, `${first.snapshots.count} snapshots`);
      const eye = await ada.state();
      await ada.page.close();

      const eve = await Player.open(await somebody(), hills.address);
      await eve.joined("eve");
      await eve.complete();
      await eve.capture();
      await eve.camera(eye.x, eye.y, eye.z, ABOVE.yaw, ABOVE.pitch);
      await until("the ground is in sight", async () => (await eve.state()).sight);
      const built = await eve.place();
      await until("what eve built is on the disk of the server", () =>
        eve.page.evaluate(() => runstone._web_unconfirmed() === 0));
      await eve.page.close();

      const again = await visit(() => {
        const { getAll } = IDBObjectStore.prototype;
        window.answers = []; // how many rows each has
        IDBObjectStore.prototype.getAll = function (...all) {
          const request = getAll.apply(this, all);
          if (this.name === "chunks") request.addEventListener("success", () => answers.push(request.result.length));
          return request;
        };
      });
      const second = await kept(again);
      assert.equal(await again.voxel(...built.slice(0, 3)), built[3]);
      const { confirmed_chunks, adopted, claims_refuted, drifted, tiles_adopted } = second.replica;
      console.log(`measured  after a reload ${adopted} of ${confirmed_chunks} chunks and ${tiles_adopted} of ` +
        `${second.far_ground.tiles} tiles came from the cache; ${second.net.bytes_received} bytes were received, ` +
        `${first.net.bytes_received} at the first visit`);
      measured.cache = { first: { net: first.net, join: first.join, cache: first.cache },
        second: { net: second.net, join: second.join, cache: second.cache } };
      assert.equal(second.cache.corrupt, 0);
      assert(adopted > 0.9 * confirmed_chunks, `${adopted} of ${confirmed_chunks} chunks`);
      const tilesKept = first.cache.kept - first.replica.confirmed_chunks; // empty tiles are not kept
      assert(tiles_adopted > 0.9 * tilesKept && tilesKept > 100, `${tiles_adopted} of ${tilesKept} tiles`);
      assert(second.net.chunk_bytes < 0.2 * first.net.chunk_bytes, `${second.net.chunk_bytes} bytes of chunks`);
      assert.equal(claims_refuted + drifted, 0);
      const answers = await again.page.evaluate(() => window.answers);
      assert(answers.length > 5 && Math.max(...answers) <= 64, `answers of ${answers} rows`);
      assert.deepEqual(again.errors, []);
      await again.page.close();

      // After a restart the server has another epoch. What it had on its disk is still common.
      await hills.stopServer();
      await hills.startServer();
      // Some rows are damaged: they are dropped, and the server sends these chunks.
      const damaged = await inDatabase(context, hills.address, async (database, answered) => {
        const chunks = database.transaction("chunks", "readwrite").objectStore("chunks");
        const names = (await answered(chunks.getAllKeys())).filter((name) => /\/0[0-9a-f]{24}$/.test(name)).slice(0, 30);
        for (const [i, name] of names.entries()) {
          const row = await answered(chunks.get(name));
          row[(7 * i + 5) % row.length] ^= 1 << (i % 8);
          await answered(chunks.put(row, name));
        }
        return names.length;
      });
      assert.equal(damaged, 30);
      const third = await visit();
      const report = await kept(third);
      assert.equal(report.cache.corrupt, damaged);
      assert.equal(report.cache.not_common, 0);
      assert(report.replica.adopted + damaged > 0.9 * confirmed_chunks, `${report.replica.adopted} chunks`);
      assert.equal(report.replica.drifted, 0);
      assert.equal(await third.voxel(...built.slice(0, 3)), built[3]);
      await third.page.close();
      const fourth = await visit();
      assert.equal((await kept(fourth)).cache.corrupt, 0);
      await fourth.page.close();
    } finally {
      await hills.close();
    }
  });

  test("the kept chunks stay within their bound, and one tab keeps them", async () => {
    const BYTES_MAX = 60_000;
    const context = await somebody();
    const player = await Player.open(context, world().address);
    await player.loaded();
    await player.page.evaluate((max) => {
      const { open } = Chunks;
      Chunks.open = () => open(max);
    }, BYTES_MAX);
    await player.joined("bound");
    await player.complete();
    const report = await until("rows are evicted", async () => {
      const one = await player.report();
      return one.cache.evicted > 0 && one.cache.kept >= one.replica.confirmed_chunks ? one : null;
    });
    assert.equal(report.cache.corrupt, 0);
    const other = await Player.open(context, world().address);
    await other.joined("bound2");
    await until("the other tab says that it keeps none", async () => /another tab keeps them/.test(await other.text("#notices")));
    assert.equal((await other.report()).cache, null);
    await other.page.close();
    await player.page.close();
    const { size, sum, entries, rows } = await sizesOf(context, world().address);
    assert(size <= BYTES_MAX && size === sum, `${size} bytes, and ${sum} by the rows`);
    assert(entries > 0 && entries === rows, `${entries} entries, ${rows} rows`);
  });

  test("a browser without room says so, and leaves the cache to other tabs", async () => {
    const context = await somebody();
    const player = await Player.open(context, world().address, { inject: () => {
      const { put } = IDBObjectStore.prototype;
      let rows = 0;
      IDBObjectStore.prototype.put = function (...all) {
        if (this.name === "entries" && ++rows === 5)
          throw new DOMException("no room", "QuotaExceededError");
        return put.apply(this, all);
      };
    } });
    await player.joined("full");
    await until("words about the room", async () =>
      /this browser has no more room for them/.test(await player.text("#notices")));
    await player.complete();
    assert.equal((await player.report()).cache.kept, 0);
    // The batch that failed in its middle has changed nothing.
    assert.deepEqual(await sizesOf(context, world().address), { size: 0, sum: 0, entries: 0, rows: 0 });
    const other = await Player.open(context, world().address);
    await other.joined("full2");
    await until("the other tab keeps chunks", async () => (await other.report()).cache?.kept > 0);
    assert.deepEqual(player.errors.concat(other.errors), []);
    await other.page.close();
    await player.page.close();
  });

  test("a browser whose database does not answer keeps no chunks, and the player joins", async () => {
    const player = await Player.open(await somebody(), world().address, { inject: () => {
      const { open } = IDBFactory.prototype;
      IDBFactory.prototype.open = function (name, ...rest) {
        return name === "runstone-chunks" ? new EventTarget() : open.call(this, name, ...rest);
      };
    } });
    await player.joined("patient");
    assert.match(await player.text("#notices"), /keeps no chunks, .* its database does not answer/);
    assert.equal((await player.report()).cache, null);
    assert.deepEqual(player.errors, []);
    await player.page.close();
  });

  test("after a world was restored from a backup, the browser drops what it does not have", async () => {
    const flat = await World.open(bin, files, ["--generator", "flat"]);
    try {
      const context = await somebody();
      const visit = async () => {
        const player = await Player.open(context, flat.address);
        await player.joined("ada");
        await player.complete();
        return player;
      };
      const build = async (player) => {
        await player.capture();
        await player.lookDown();
        const built = await player.place();
        await until("what was built is on the disk of the server", () =>
          player.page.evaluate(() => runstone._web_unconfirmed() === 0));
        return built;
      };
      const first = await visit();
      const old = await build(first);
      await first.page.close();
      await flat.stopServer();
      flat.backUp();
      await flat.startServer();
      const second = await visit();
      const lost = await build(second);
      await kept(second);
      await second.page.close();
      await flat.stopServer();
      flat.restore();
      await flat.startServer();
      const third = await visit();
      const report = await kept(third);
      assert(report.cache.not_common > 0, "no row was dropped");
      assert(report.cache.hits > 100, `${report.cache.hits} rows were found`);
      assert.equal(report.cache.corrupt, 0);
      assert.equal(report.replica.drifted, 0);
      assert.equal(await third.voxel(...old.slice(0, 3)), old[3]);
      assert.equal(await third.voxel(...lost.slice(0, 3)), 0);
      assert.deepEqual(third.errors, []);
      await third.page.close();
    } finally {
      await flat.close();
    }
  });

  test("the page drops the rows that the program names, and evicts those unused for longest", async () => {
    const context = await somebody();
    const player = await Player.open(context, world().address);
    await player.loaded();
    const out = await player.page.evaluate(async () => {
      const WORLD = "ab".repeat(16), ROW = 100, OVERHEAD = 160;
      const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
      const answers = [];
      Program.call = (name, ...args) => {
        answers.push({ name, args });
        return 1;
      };
      Program.buffer = () => {};
      // Waits for the answer to an operation, and returns its numbers.
      const answer = async (name) => {
        for (;;) {
          const at = answers.findIndex((one) => one.name === name);
          if (at >= 0) return answers.splice(at, 1)[0].args;
          await sleep(10);
        }
      };
      const keep = async (rows) => {
        const batch = new Uint8Array(rows.length * (32 + ROW));
        const view = new DataView(batch.buffer);
        rows.forEach(({ level = 0, z, epoch = 1, seq = 0 }, i) => {
          const at = i * (32 + ROW);
          view.setUint32(at, ROW, true);
          view.setInt32(at + 4, level, true);
          view.setInt32(at + 16, z, true);
          view.setUint32(at + 20, epoch, true);
          view.setFloat64(at + 24, seq, true);
        });
        Chunks.keep(WORLD, batch);
        return answer("web_cache_kept");
      };
      // Returns which of these rows are found, by z.
      const found = async (count, level = 0) => {
        Chunks.find(WORLD, Array.from({ length: count }, (_, z) => [level, 0, 0, z]));
        await answer("web_cache_looked_up");
        const out = answers.filter(({ name }) => name === "web_cache_found").map(({ args }) => args[0]);
        answers.length = 0;
        return out;
      };
      const drop = async (...what) => {
        Chunks.dropRows(WORLD, ...what);
        return answer("web_cache_dropped");
      };
      const out = {};
      await Chunks.open(10 * (ROW + OVERHEAD));
      await keep([{ z: 0 }, { z: 1, epoch: 1, seq: 5 }, { z: 2, epoch: 1, seq: 9 },
        { z: 3, epoch: 2, seq: 9 }, { level: 2, z: 0 }]);
      out.lost = [await drop(false, false, true, false, 5, 2), await found(4)];
      out.edited = [await drop(false, true, false, false, 0, 2), await found(4)];
      out.tiles = [await drop(false, false, false, true, 0, 2), await found(4, 2)];
      out.all = [await drop(true, false, false, false, 0, 2), await found(4)];
      await keep(Array.from({ length: 10 }, (_, z) => ({ z })));
      out.used = await found(5);
      await sleep(2500); // the page notes the use of rows after 2 s
      out.kept = await keep([{ z: 10 }, { z: 11 }, { z: 12 }]);
      out.left = await found(13);
      return out;
    });
    assert.deepEqual(out, { lost: [[1], [0, 1, 3]], edited: [[2], [0]], tiles: [[1], []], all: [[1], []],
      used: [0, 1, 2, 3, 4], kept: [3, 3], left: [0, 1, 2, 3, 4, 8, 9, 10, 11, 12] });
    await player.page.close();
    const { size, sum, entries, rows } = await sizesOf(context, world().address);
    assert.deepEqual([size, entries, rows], [sum, 10, 10]);
  });
}
