// Test cases of the windows that the client in a browser has in common with the desktop client.
import assert from "node:assert/strict";
import { join } from "node:path";

import { Player, until } from "./player.mjs";
import { World } from "./world.mjs";

const SIZE = { width: 800, height: 600 };
const TOOLS_LEFT = SIZE.width - 10 - 460; // of the tool window

// Clicks at these places, one after the other, until `ask` answers. Returns the answer and the place.
async function clickUntil(player, what, places, ask, options = {}) {
  for (const [x, y] of places) {
    await player.page.mouse.move(x, y);
    await player.page.mouse.click(x, y, { delay: 80, ...options });
    await player.drawn();
    await new Promise((resolve) => setTimeout(resolve, 250));
    const answer = await ask();
    if (answer) return { answer, x, y };
  }
  throw new Error(`${what}: no click did it`);
}
const downward = (x, from, to, step = 9) =>
  Array.from({ length: Math.ceil((to - from) / step) }, (_, i) => [x, from + i * step]);

// Opens a window by a key, and waits until it is drawn at this place.
async function openWindow(player, name, key, x, y) {
  await key();
  await until(`${name} is open`, async () => (await player.windows())[name]);
  await until(`${name} is drawn`, () => player.hasWindowAt(x, y));
  await until(`${name} has freed the mouse`, async () => !(await player.windows()).captured);
}

// Adds the cases by test(). `somebody` makes a browser context, and `world` returns the shared world.
export function addWindowCases({ test, bin, files, out, somebody, world }) {
  test("the tool window chooses a tool and its size, with which the player builds", async () => {
    const player = await Player.open(await somebody(), world().address, SIZE);
    await player.joined("tilda");
    await player.complete();
    await player.capture();
    const [x, y, z] = await player.lookDown();
    await openWindow(player, "tools", () => player.page.keyboard.press("KeyQ"), TOOLS_LEFT + 30, 60);
    const sphere = await clickUntil(player, "the sphere is chosen", downward(TOOLS_LEFT + 30, 40, 300),
      async () => (await player.windows()).tool === "sphere");
    const before = await player.text("#state");
    const slider = await clickUntil(player, "the radius changes",
      downward(TOOLS_LEFT + 150, sphere.y + 155, 420), async () =>
        (await player.text("#state")) !== before && (await player.windows()).tool === "sphere");
    // With control, a slider is a field for its number.
    await until("the radius was typed", async () => {
      await player.page.keyboard.down("Control");
      await player.drawn();
      await player.page.mouse.click(slider.x, slider.y, { delay: 80 });
      await player.drawn();
      await player.page.keyboard.up("Control");
      await player.drawn();
      await player.page.keyboard.type("3", { delay: 80 });
      await player.drawn();
      await player.page.keyboard.press("Enter", { delay: 80 });
      await player.drawn();
      return /radius 3\b/.test(await player.text("#state"));
    });
    await player.page.screenshot({ path: join(out, "tools.png") });
    assert.equal(await player.voxel(x, y + 2, z), 0);
    await player.page.keyboard.press("Escape");
    await until("escape closed the window", async () => !(await player.windows()).tools);
    await until("the mouse is captured again", async () => (await player.windows()).captured);
    await player.click("right");
    await until("a sphere stands there", async () => (await player.voxel(x, y + 2, z)) > 0);
    assert.deepEqual(player.errors, []);
    await player.page.close();
  });

  test("the rollback window takes back what another player has built", async () => {
    const flat = await World.open(bin, files, ["--generator", "flat"]);
    try {
      flat.control("role default moderator anyway");
      const bob = await Player.open(await somebody(), flat.address);
      await bob.joined("bob");
      await bob.complete();
      await bob.capture();
      await bob.lookDown();
      const built = await bob.place();
      await until("what bob built is on the disk of the server", () =>
        bob.page.evaluate(() => runstone._web_unconfirmed() === 0));
      await bob.page.close();

      const player = await Player.open(await somebody(), flat.address, SIZE);
      await player.joined("moda");
      await player.complete();
      await player.capture();
      await player.camera(built[0] - 4.5, built[1] + 8, built[2] - 4.5, 0.8, -0.9);
      const shownMaterial = () => player.voxel(...built.slice(0, 3));
      await until("the voxel is there", async () => (await shownMaterial()) === built[3]);
      await openWindow(player, "rollback", async () => {
        await player.page.keyboard.down("Control");
        await player.page.keyboard.press("KeyH");
        await player.page.keyboard.up("Control");
      }, 40, 140);
      const focused = () => player.page.evaluate(() => document.activeElement.id);
      const field = await clickUntil(player, "a field has the keyboard", downward(60, 130, 240), async () =>
        (await focused()) === "typed");
      await player.page.mouse.click(field.x, field.y, { delay: 80 });
      await player.drawn();
      assert.equal(await focused(), "typed"); // also after a second click
      await player.page.mouse.click(200, 130, { delay: 80 }); // the title
      await until("the world has the keyboard", async () => (await focused()) === "canvas");
      let bottom = 140;
      while (await player.hasWindowAt(40, bottom)) ++bottom;
      const phase = async (wanted) => (await player.windows()).phase === wanted;
      const IDLE = 0, PREVIEWED = 2, APPLIED = 4;
      const upward = downward(45, bottom - 14, 200, -6);
      const preview = await clickUntil(player, "the preview is ordered", upward, async () =>
        !(await phase(IDLE)));
      const shown = await until("the preview is here", async () => {
        const now = await player.windows();
        return now.phase === PREVIEWED && now.ghosts > 0 ? now : null;
      });
      assert.equal(shown.voxels, 1);
      assert.equal(await shownMaterial(), built[3]);
      await player.page.screenshot({ path: join(out, "rollback.png") });
      const toTheRight = Array.from({ length: 12 }, (_, i) => [80 + 6 * i, preview.y]);
      await clickUntil(player, "the rollback is ordered", toTheRight, async () =>
        !(await phase(PREVIEWED)));
      await until("the rollback is applied", () => phase(APPLIED));
      await until("the voxel is gone", async () => (await shownMaterial()) === 0);
      assert.deepEqual(player.errors, []);
      await player.page.close();
    } finally {
      await flat.close();
    }
  });

  test("the map shows the chunks around the player", async () => {
    const player = await Player.open(await somebody(), world().address, SIZE);
    await player.joined("mapa");
    await player.complete();
    await player.capture();
    const middle = [SIZE.width * 0.75, SIZE.height * 0.35];
    await openWindow(player, "map", () => player.page.keyboard.press("KeyM"), ...middle);
    await until("the map has tiles", async () => (await player.windows()).tiles >= 49);
    const { x, y, z } = await player.state();
    await player.page.mouse.move(...middle);
    await player.page.mouse.wheel({ deltaY: -200 });
    await player.page.mouse.click(...middle, { delay: 80 }); // it is the map's
    await new Promise((resolve) => setTimeout(resolve, 500));
    await player.page.screenshot({ path: join(out, "map.png") });
    assert((await player.windows()).map && !(await player.windows()).captured);
    const now = await player.state();
    assert.deepEqual([now.x, now.y, now.z], [x, y, z]);
    await player.page.keyboard.press("KeyM");
    await until("the map is closed", async () => !(await player.windows()).map);
    await until("the mouse is captured again", async () => (await player.windows()).captured);
    assert.deepEqual(player.errors, []);
    await player.page.close();
  });

  test("without their font, the windows are there and the page says what they lack", async () => {
    const player = await Player.open(await somebody(), world().address, { ...SIZE, inject: () => {
      const real = window.fetch;
      window.fetch = (what, ...rest) =>
        (/ttf$/.test(what) ? Promise.reject(new Error("no network")) : real(what, ...rest));
    } });
    await player.joined("fontless");
    await player.complete();
    await player.capture();
    await openWindow(player, "tools", () => player.page.keyboard.press("KeyQ"), TOOLS_LEFT + 30, 60);
    assert.match(await player.text("#notices"), /the windows lack some letters/);
    await player.page.close();
  });

  test("a field of a window takes the text of a phone's keyboard and of an input method", async () => {
    const flat = await World.open(bin, files, ["--generator", "flat"]);
    try {
      flat.control("role default moderator anyway");
      const player = await Player.open(await somebody(), flat.address,
        { width: 390, height: 780, touch: true });
      await player.joined("typer");
      await player.complete();
      // Without a field, a dead key is the key that it is in the world.
      const walks = () => player.text("#walk");
      const before = await walks();
      await player.page.evaluate(() => {
        for (const type of ["keydown", "keyup"]) {
          document.getElementById("canvas").dispatchEvent(
            new KeyboardEvent(type, { key: "Dead", code: "KeyF", bubbles: true }));
        }
      });
      await until("the player walks or flies", async () => (await walks()) !== before);
      await player.page.tap("#rollback");
      await until("the window is drawn", () => player.hasWindowAt(60, 100));
      const focused = () => player.page.evaluate(() => document.activeElement.id);
      assert.notEqual(await focused(), "typed");
      for (let y = 60; y < 400 && (await focused()) !== "typed"; y += 6) {
        await player.page.touchscreen.tap(60, y);
        await new Promise((resolve) => setTimeout(resolve, 250));
      }
      assert.equal(await focused(), "typed");
      const shows = (text) => until(`the field shows '${text}'`, async () => (await player.fieldText()) === text);
      await shows("60"); // minutes
      const keyboard = await player.page.createCDPSession();
      // The field has its whole text selected, so the first character replaces it.
      await keyboard.send("Input.insertText", { text: "12" });
      await shows("12");
      // A word that is composed, changed and then confirmed.
      await keyboard.send("Input.imeSetComposition", { text: "34", selectionStart: 2, selectionEnd: 2 });
      await shows("1234");
      await keyboard.send("Input.imeSetComposition", { text: "35", selectionStart: 2, selectionEnd: 2 });
      await shows("1235");
      await keyboard.send("Input.insertText", { text: "36" });
      await shows("1236");
      // The key for deleting as a phone reports it: the page sees only that the text changes.
      await player.page.evaluate(() => document.execCommand("delete"));
      await shows("123");
      await player.page.screenshot({ path: join(out, "phone-typing.png") });
      await player.page.keyboard.press("Enter"); // a key as those of a computer
      await until("the canvas has the focus again", async () => (await focused()) === "canvas");
      assert.deepEqual(player.errors, []);
      await player.page.close();
    } finally {
      await flat.close();
    }
  });

  test("on a phone, a touch on a window is the window's", async () => {
    const player = await Player.open(await somebody(), world().address,
      { width: 390, height: 780, touch: true });
    await player.joined("toucan");
    await player.complete();
    await player.lookDown();
    const before = await player.state();
    await player.page.tap("#tools");
    await until("the window is drawn", () => player.hasWindowAt(200, 60));
    const { tool } = await player.windows();
    for (let y = 30; y < 200 && (await player.windows()).tool === tool; y += 8) {
      await player.page.touchscreen.tap(60, y);
      await new Promise((resolve) => setTimeout(resolve, 250));
    }
    await player.page.screenshot({ path: join(out, "phone-tools.png") });
    assert.notEqual((await player.windows()).tool, tool);
    assert.deepEqual((await player.state()).sight, before.sight);
    assert.deepEqual(player.errors, []);
    await player.page.close();
  });
}
