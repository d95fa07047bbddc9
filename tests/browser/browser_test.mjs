// Tests of the client in a browser: headless Chromium, a real server and a real gateway.
//   node browser_test.mjs PROGRAMS PAGE [OUT]
// PROGRAMS is the folder of the native programs, PAGE that of the files that the preset web builds.
// Pictures and measurements go to OUT. scripts/check-browser builds both and runs this.
import puppeteer from "puppeteer-core";
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { addCacheCases } from "./cache_cases.mjs";
import { addMapCases } from "./map_cases.mjs";
import { differenceOf, sideBySide } from "./pictures.mjs";
import { ABOVE, Player, until } from "./player.mjs";
import { addWindowCases } from "./window_cases.mjs";
import { World } from "./world.mjs";

const [bin, files, out = "browser-out"] = process.argv.slice(2);
if (!files) {
  console.error("usage: browser_test.mjs PROGRAMS PAGE [OUT]");
  process.exit(2);
}
mkdirSync(out, { recursive: true });

const PAGE_BYTES_MAX = 1_500_000; // compressed
const FLAT = ["--generator", "flat"];

const browser = await puppeteer.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
const cases = [];
const test = (name, body) => cases.push({ name, body });
const measured = {};

// What all cases share: a world, and a way to open a browser of somebody who was never here.
let world;
const contexts = [];
const somebody = async () => {
  contexts.push(await browser.createBrowserContext());
  return contexts.at(-1);
};

test("a browser joins, and shows the ground", async () => {
  const player = await Player.open(await somebody(), world.address);
  await player.joined("ada");
  await player.complete();
  const state = await player.state();
  assert(state.meshed > 50, `${state.meshed} chunks were meshed`);
  assert(await player.page.evaluate(() => crossOriginIsolated));
  await player.page.screenshot({ path: join(out, "joined.png") });
  assert.deepEqual(player.errors, []);
  await player.page.close();
});

test("a name or an invite that no server takes gets words, and the player may try again", async () => {
  const player = await Player.open(await somebody(), world.address, { hash: `#invite=${"x".repeat(129)}` });
  const long = await player.refused("石".repeat(11));
  assert.match(long.detail, /at most 32 bytes, and this one has 33/);
  const damaged = await player.refused("ada");
  assert.match(damaged.detail, /the invite in this link is damaged/);
  await player.page.goto(`${world.address}/client/`);
  await player.joined("石".repeat(10));
  assert.deepEqual(player.errors, []);
  await player.page.close();
});

test("a browser that keeps nothing gets words, and plays", async () => {
  const player = await Player.open(await somebody(), world.address, { inject: () => {
    for (const name of ["localStorage", "indexedDB"]) {
      Object.defineProperty(window, name, { get() {
        throw new DOMException("it is forbidden", "SecurityError");
      } });
    }
  } });
  await player.joined("private");
  await player.complete();
  const notices = await player.text("#notices");
  assert.match(notices, /keeps no keys: you are somebody else at your next visit/);
  assert.match(notices, /keeps no chunks, so a reload takes longer/);
  assert.equal((await player.report()).cache, null);
  assert.deepEqual(player.errors, []);
  await player.page.close();
});

test("buttons, wheel and keys reach the player", async () => {
  const player = await Player.open(await somebody(), world.address);
  await player.joined("keys");
  await player.complete();
  await player.capture();
  await player.lookDown();
  const { held } = await player.state();
  await player.page.mouse.wheel({ deltaY: 100 });
  await until("the wheel chose another material", async () => (await player.state()).held !== held);
  await player.page.mouse.wheel({ deltaY: -100 });
  await until("and this one again", async () => (await player.state()).held === held);

  // A second button counts while another one is held.
  await player.page.evaluate(() => {
    window.buttons = [];
    const send = runstone._web_button;
    runstone._web_button = (...all) => {
      buttons.push(all.join());
      send(...all);
    };
  });
  for (const button of ["left", "right"]) await player.page.mouse.down({ button });
  for (const button of ["right", "left"]) await player.page.mouse.up({ button });
  assert.deepEqual(await player.page.evaluate(() => buttons), ["0,1", "2,1", "2,0", "0,0"]);

  const placed = await player.place();
  await player.page.keyboard.down("Control");
  await player.page.keyboard.press("KeyZ");
  await player.page.keyboard.up("Control");
  await until("control and Z undid it", async () => (await player.voxel(...placed.slice(0, 3))) === 0);
  assert.deepEqual(player.errors, []);
  await player.page.close();
});

test("keys move the player, who walks on the ground", async () => {
  const player = await Player.open(await somebody(), world.address);
  await player.joined("wanda");
  await player.complete();
  await player.capture();
  const before = await player.state();
  await player.moveBy("KeyW", 2);
  await player.page.keyboard.press("KeyF");
  await until("F lets the player walk", async () => (await player.state()).walking);
  await until("the player stands", async () => {
    const one = (await player.state()).y;
    await new Promise((resolve) => setTimeout(resolve, 300));
    return one < before.y && (await player.state()).y === one;
  });
  await player.moveBy("KeyD", 0.5);
  assert.deepEqual(player.errors, []);
  await player.page.close();
});

test("what one builds and digs, the other sees, and a reload finds", async () => {
  const context = await somebody();
  const bob = await Player.open(context, world.address);
  await bob.joined("bob");
  await bob.complete();
  const eve = await Player.open(await somebody(), world.address);
  await eve.joined("eve");
  await eve.complete();
  await until("each sees the other's name", async () =>
    (await bob.text("#players")) === "eve" && (await eve.text("#players")) === "bob");

  await bob.page.bringToFront();
  await bob.capture();
  const ground = await bob.lookDown();
  await bob.page.keyboard.press("Digit3");
  const placed = await bob.place();
  assert.notDeepEqual(placed.slice(0, 3), ground.slice(0, 3));
  await until("eve sees what bob placed", async () => (await eve.voxel(...placed.slice(0, 3))) === placed[3]);
  await eve.page.bringToFront();
  await eve.camera(placed[0] - 9.5, placed[1] + 8, placed[2] - 9.5, Math.PI / 4, -0.45);
  await eve.drawn();
  await new Promise((resolve) => setTimeout(resolve, 500));
  await eve.page.screenshot({ path: join(out, "together.png") });
  await bob.page.bringToFront();
  await bob.click("left");
  await until("bob removed it", async () => (await bob.voxel(...placed.slice(0, 3))) === 0);
  await bob.click("left");
  await until("and dug into the ground", async () => (await bob.voxel(...ground.slice(0, 3))) === 0);
  await until("eve sees the hole", async () => (await eve.voxel(...ground.slice(0, 3))) === 0);
  await eve.page.bringToFront();
  await eve.camera(ground[0] + 0.5, ground[1] + 6, ground[2] + 0.5, 0, -1.5);
  await new Promise((resolve) => setTimeout(resolve, 500));
  await eve.page.screenshot({ path: join(out, "hole.png") });
  await eve.page.close();

  // The key is in IndexedDB, so the player of the next visit is the same, and owns the name.
  await bob.page.reload();
  await bob.joined("bob");
  await bob.complete();
  assert.equal(await bob.voxel(...ground.slice(0, 3)), 0);
  const seeds = await bob.page.evaluate(async () => [(await Keys.load()).seed, (await Keys.load()).seed]);
  assert.equal(seeds[0], seeds[1]);
  assert.match(seeds[0], /^[0-9a-f]{64}$/);
  assert(!(await bob.page.evaluate(() => location.href)).includes(seeds[0]));
  const mallory = await Player.open(await somebody(), world.address);
  const refused = await mallory.refused("bob");
  assert.match(refused.step, /refuses this name/);
  assert.equal(refused.button, "Try again");
  await mallory.page.close();
  assert.deepEqual(bob.errors, []);
  await bob.page.close();
});

test("players see what others are about to do, in a browser and on the desktop", async () => {
  const eve = await Player.open(await somebody(), world.address);
  await eve.joined("eva");
  await eve.complete();
  const [x, y, z] = await eve.lookDown();
  const ghosts = async () => (await eve.windows()).others;
  assert.equal(await ghosts(), 0);
  const end = world.desktop("dora", [`move ${x}.5 ${y + 8}.5 ${z}.5`, "preview on", "tool sphere",
    `aim ${x} ${y} ${z} +y`, "wait loaded", "wait 300"]);
  try {
    await until("eva sees the preview of dora", async () => (await ghosts()) > 0);
    await eve.drawn();
    await eve.page.screenshot({ path: join(out, "preview-of-another.png") });
    assert.equal(await eve.voxel(x, y + 1, z), 0);
  } finally {
    await end();
  }
  await until("the preview is gone with dora", async () => (await ghosts()) === 0);

  const bob = await Player.open(await somebody(), world.address);
  await bob.joined("bo");
  await bob.complete();
  const { y: height } = await bob.state();
  await bob.camera(x + 0.5, height, z + 0.5, ABOVE.yaw, ABOVE.pitch);
  await bob.act("next_tool");
  await until("eva sees the preview of bo", async () => (await ghosts()) > 0);
  await bob.act("preview");
  await until("bo hides it", async () => (await ghosts()) === 0);
  for (const player of [bob, eve]) {
    assert.deepEqual(player.errors, []);
    await player.page.close();
  }
});

test("the timeline shows the past, in which nothing can be built, and leads back", async () => {
  const player = await Player.open(await somebody(), world.address);
  await player.joined("clio");
  await player.complete();
  await player.capture();
  await player.lookDown();
  const [x, y, z, material] = await player.place();
  const shown = () => player.voxel(x, y, z);
  await until("the edit is in the log", () => player.page.evaluate(() => runstone._web_unconfirmed() === 0));
  await player.page.keyboard.press("KeyH");
  await until("the timeline is open", () => player.page.$eval("#timeline", (line) => !line.hidden));
  await player.page.$eval("#moment", (slider) => {
    slider.value = 0;
    slider.dispatchEvent(new Event("input"));
  });
  await until("the voxel is not there yet", async () => (await shown()) === 0);
  assert.match(await player.text("#state"), /^the past: after edit 0/);
  await player.page.screenshot({ path: join(out, "past.png") });
  await player.page.click("#live");
  await until("the voxel is there again", async () => (await shown()) === material);
  await until("the text is gone", async () => (await player.text("#state")) === "");
  await player.page.keyboard.press("BracketLeft");
  await until("the key leads into the past", async () => /^the past/.test(await player.text("#state")));
  await player.page.keyboard.press("Home");
  await until("and this one back", async () => (await player.text("#state")) === "");
  assert.deepEqual(player.errors, []);
  await player.page.close();
});

test("a click in hills is meshed without meshing whole chunks, and its latency is measured", async () => {
  // A flat chunk has so few runs that meshing all of it costs less than meshing layers.
  const hills = await World.open(bin, files, ["--generator", "terrain", "--seed", "7"]);
  try {
    const player = await Player.open(await somebody(), hills.address);
    await player.joined("click");
    await player.complete();
    await player.capture();
    await player.lookDown();
    await player.complete(); // the player has moved, so chunks may have come
    const CLICKS = 20;
    const before = await player.report();
    for (let i = 0; i < CLICKS; ++i) {
      await player.click(i % 2 === 0 ? "right" : "left");
      await new Promise((resolve) => setTimeout(resolve, 150));
    }
    const report = await until("the edits are counted", async () => {
      const now = await player.report();
      return now.latency_us.local_predicted.since_submit.meshed?.count >= CLICKS ? now : null;
    });
    // Times depend on the machine: they are measured and printed, not checked.
    measured.latency_us = report.latency_us.local_predicted;
    measured.mesh = report.mesh;
    measured.join = report.join;
    console.log(`measured  from a click to the new mesh: ${measured.latency_us.since_submit.meshed.p50 / 1000} ms (median)`);
    assert.equal(report.latency_us.local_rejected, 0);
    assert.equal(report.latency_us.local_predicted.since_submit.meshed.infinite, 0);
    const made = (kind) => report.mesh[kind].count - before.mesh[kind].count;
    // Two clicks may share a mesh on a slow machine.
    assert(made("layers_ns") > CLICKS / 2, `${made("layers_ns")} meshes of layers`);
    assert(made("whole_ns") === 0, `${made("whole_ns")} meshes of whole chunks`);
    await player.page.close();
  } finally {
    await hills.close();
  }
});

test("the connection is made again after the server has restarted", async () => {
  const player = await Player.open(await somebody(), world.address);
  await player.joined("rita");
  await player.complete();
  await player.capture();
  await player.lookDown();
  const before = await player.place();
  await world.stopServer();
  await until("the page says that the server is gone", async () => /server is gone/.test(await player.text("#state")));
  const offline = await player.place(); // it waits for the server
  await player.page.screenshot({ path: join(out, "server-gone.png") });
  await world.startServer();
  await until("the player is there again", async () => (await player.state()).connected);
  await until("the words are gone", async () => (await player.text("#state")) === "");
  await player.complete();
  assert.equal(await player.voxel(...before.slice(0, 3)), before[3]);
  const witness = await Player.open(await somebody(), world.address);
  await witness.joined("witness");
  await witness.complete();
  await until("what was built while the server was away has arrived", async () =>
    (await witness.voxel(...offline.slice(0, 3))) === offline[3]);
  await witness.page.close();
  await player.page.close();
});

test("a network that drops for a while loses nothing", async () => {
  const player = await Player.open(await somebody(), world.address,
    { inject: () => {
      // Every WebSocket of the page can be cut.
      const Real = WebSocket;
      window.sockets = [];
      window.WebSocket = class extends Real {
        constructor(...all) {
          super(...all);
          window.sockets.push(this);
        }
      };
    } });
  await player.joined("dropped");
  await player.complete();
  await player.page.evaluate(() => sockets.at(-1).close());
  await until("the connection is made again", async () =>
    (await player.page.evaluate(() => sockets.length)) >= 2 && (await player.state()).connected);
  await player.complete();
  assert.deepEqual(player.errors, []);
  await player.page.close();
});

test("tampered frames end the connection with words", async () => {
  const player = await Player.open(await somebody(), world.address,
    { inject: () => {
      const Real = WebSocket;
      window.WebSocket = class extends Real {
        set onmessage(handle) {
          super.onmessage = (event) => {
            const bytes = new Uint8Array(event.data.slice(0));
            if (window.tampers) bytes[bytes.length - 1] ^= 0xff, bytes[3] ^= 0x80;
            handle(new MessageEvent("message", { data: bytes.buffer }));
          };
        }
      };
    } });
  await player.joined("tampered");
  await player.page.evaluate(() => (window.tampers = true));
  await until("the page says what is wrong", async () => /no Runstone server, or it is broken/.test(await player.text("#state")));
  await player.page.evaluate(() => (window.tampers = false));
  await until("the connection is made again", async () => (await player.text("#state")) === "");
  await player.page.close();
});

test("a browser that lacks something gets words", async () => {
  const noWebGl = await Player.open(await somebody(), world.address, { inject: () => {
    const real = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      return kind === "webgl2" ? null : real.call(this, kind, ...rest);
    };
  } });
  await until("words about WebGL", async () => /no WebGL 2/.test(await noWebGl.text("#step")));
  await noWebGl.page.screenshot({ path: join(out, "no-webgl.png") });
  await noWebGl.page.close();
  const noWasm = await Player.open(await somebody(), world.address, { inject: () => delete window.WebAssembly });
  await until("words about WebAssembly", async () => /no WebAssembly/.test(await noWasm.text("#step")));
  await noWasm.page.close();
});

test("on a phone, thumbs move, turn, place and remove", async () => {
  const player = await Player.open(await somebody(), world.address, { width: 390, height: 780, touch: true });
  await player.joined("thumb");
  await player.complete();
  const ground = await player.lookDown();
  const touch = player.page.touchscreen;
  const before = await player.state();
  await touch.touchStart(80, 640);
  await touch.touchMove(80, 580);
  await new Promise((resolve) => setTimeout(resolve, 600));
  await touch.touchEnd();
  const moved = await player.state();
  assert(Math.hypot(moved.x - before.x, moved.z - before.z) > 1, "the stick moved the player");
  await player.camera(before.x, before.y, before.z, ABOVE.yaw, ABOVE.pitch);
  await until("the same ground is in sight", async () => (await player.state()).sight?.join() === ground.join());
  await touch.tap(300, 200);
  const placed = await until("the tap placed a voxel", async () => {
    const { sight } = await player.state();
    return sight && sight.join() !== ground.join() ? sight : null;
  });
  await player.page.screenshot({ path: join(out, "phone.png") });
  await player.page.tap("#mode");
  await touch.tap(300, 200);
  await until("a tap removed it again", async () => (await player.voxel(...placed.slice(0, 3))) === 0);
  await touch.touchStart(250, 300);
  await touch.touchMove(330, 300);
  await touch.touchEnd();
  await until("a thumb turned the player", async () => (await player.state()).sight?.join() !== ground.join());
  assert.deepEqual(player.errors, []);
  await player.page.close();
});

test("the picture is that of the desktop client", async () => {
  const hills = await World.open(bin, files, ["--generator", "terrain", "--seed", "7"]);
  try {
    const [width, height] = [640, 360];
    const player = await Player.open(await somebody(), hills.address, { width, height });
    await player.joined("pia", { quality: "2", sight: "4" });
    const eye = { x: 20.5, y: 75.5, z: -30.5 };
    await player.camera(eye.x, eye.y, eye.z, 0.4, -0.35, true);
    await player.complete();
    const tiles = async () => (await player.report()).far_ground.tiles;
    await until("the distant ground is there", async () => {
      const one = await tiles();
      await new Promise((resolve) => setTimeout(resolve, 1500));
      return one > 0 && (await tiles()) === one;
    });
    await player.complete();
    await player.page.$eval("#hud", (hud) => (hud.hidden = true));
    await new Promise((resolve) => setTimeout(resolve, 1000));
    const inBrowser = Buffer.from(await player.page.screenshot());
    writeFileSync(join(out, "picture-browser.png"), inBrowser);
    const onDesktop = hills.picture(eye, 0.4, -0.35, { width, height, view: 4, farLevels: 3 });
    writeFileSync(join(out, "picture-desktop.png"), onDesktop);
    writeFileSync(join(out, "browser-and-desktop.png"), Buffer.from(
      await sideBySide(player.page, inBrowser.toString("base64"), onDesktop.toString("base64")), "base64"));
    const { share, mean } = await differenceOf(player.page, inBrowser.toString("base64"),
      onDesktop.toString("base64"), 24);
    measured.picture = { share, mean };
    assert(share < 0.02, `${(100 * share).toFixed(2)} % of the pixels differ`);
    await player.page.close();
  } finally {
    await hills.close();
  }
});

test("a program that has failed is called no more", async () => {
  const player = await Player.open(await somebody(), world.address);
  await player.joined("unlucky");
  await player.complete();
  const calls = () => player.page.evaluate(() => window.calls.splice(0));
  const useAll = async () => {
    await player.page.setViewport({ width: 600, height: 300 });
    await player.page.keyboard.press("KeyF");
    await player.click("left");
    await player.page.evaluate(() => {
      for (const type of ["blur", "resize", "pagehide"]) window.dispatchEvent(new Event(type));
      ticker.onmessage();
    });
    await new Promise((resolve) => setTimeout(resolve, 3000)); // the cache has timers
  };
  await player.page.evaluate(() => {
    window.calls = [];
    for (const name of Object.keys(runstone).filter((one) => one.startsWith("_web_")))
      runstone[name] = () => void calls.push(name);
  });
  await useAll();
  const before = await calls();
  for (const name of ["resize", "key", "button", "focus_lost", "leave", "tick"].map((one) => `_web_${one}`))
    assert(before.includes(name), `${name} was not called`);
  await player.page.evaluate(() => {
    calls.length = 0; // a tick may have come since they were read
    runstone.onAbort("it failed on purpose");
    Chunks.dropRows("00".repeat(16), true, false, false, false, 0, 0);
  });
  await useAll();
  assert.deepEqual(await calls(), []);
  assert.match(await player.text("#step"), /The client has failed/);
  assert.match(await player.text("#detail"), /it failed on purpose/);
  assert.deepEqual(player.errors, []);
  await player.page.close();
});

addWindowCases({ test, bin, files, out, somebody, world: () => world });
addMapCases({ test, bin, files, out, somebody });
addCacheCases({ test, bin, files, measured, somebody, world: () => world });

test("the page is small", async () => {
  let bytes = 0;
  for (const name of readFileSync(join(files, "files"), "utf8").trim().split("\n"))
    bytes += statSync(join(files, `${name}.br`)).size;
  measured.page_bytes = bytes;
  assert(bytes <= PAGE_BYTES_MAX, `${bytes} bytes compressed`);
});

const only = process.env.ONLY;
let failed = 0;
try {
  world = await World.open(bin, files, FLAT);
  for (const { name, body } of cases) {
    if (only && !name.includes(only)) continue;
    const start = Date.now();
    try {
      await body();
      console.log(`ok      ${name} (${((Date.now() - start) / 1000).toFixed(1)} s)`);
    } catch (error) {
      ++failed;
      console.log(`FAILED  ${name}: ${error.stack ?? error}`);
    }
    // A case that fails leaves no player in the world, whom the next ones would see.
    for (const context of contexts.splice(0)) await context.close().catch(() => {});
  }
} finally {
  await browser.close();
  await world?.close();
}
writeFileSync(join(out, "measured.json"), JSON.stringify(measured, null, 2) + "\n");
console.log(failed === 0 ? "all passed" : `${failed} failed`);
process.exit(failed === 0 ? 0 : 1);
