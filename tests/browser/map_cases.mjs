// Cases of the map and of the page about the state of a server.
import assert from "node:assert/strict";
import { join } from "node:path";

import { Player, until } from "./player.mjs";
import { World } from "./world.mjs";

const PIXELS_PER_VOXEL = 16;
const VOXELS_BESIDE = 6;

// Opens a page, and collects what goes wrong in it and which hosts it asks.
async function openPage(context, address, { width = 900, height = 600, scripts = true } = {}) {
  const page = await context.newPage();
  const told = { errors: [], hosts: new Set() };
  page.on("pageerror", (error) => told.errors.push(String(error)));
  page.on("request", (request) => told.hosts.add(new URL(request.url()).host));
  await page.setJavaScriptEnabled(scripts);
  await page.setViewport({ width, height, deviceScaleFactor: 1, isMobile: width < 520 });
  await page.goto(address);
  return { page, told };
}

// Adds the cases by test(). `somebody` makes a browser context, and `out` is the folder for pictures.
export function addMapCases({ test, bin, files, out, somebody }) {
  test("the map shows what is built at once, who built it, and the past", async () => {
    const world = await World.open(bin, files, ["--generator", "flat"]);
    try {
      const player = await Player.open(await somebody(), world.address);
      await player.joined("mason");
      await player.complete();
      await player.capture();
      await player.lookDown();
      const [x, , z] = (await player.state()).sight;
      const { page, told } = await openPage(await somebody(),
        `${world.address}/map#${x + 0.5},${z + 0.5},${PIXELS_PER_VOXEL}`);
      // Returns true if the voxel in the middle has another colour than its surroundings.
      const stands = () => page.evaluate((far) => {
        const map = document.getElementById("map");
        const colour = (right) => map.getContext("2d").getImageData(map.width / 2 + right, map.height / 2, 1, 1).data.join();
        return colour(0) !== colour(far);
      }, PIXELS_PER_VOXEL * VOXELS_BESIDE);
      const text = (selector) => page.$eval(selector, (element) => element.textContent);
      await until("the map is drawn", () => page.evaluate("isComplete"));
      assert.equal(await stands(), false);

      await player.place();
      await until("the map shows the voxel", stands);
      assert.equal(await page.evaluate("players[0][0]"), "mason");
      await page.screenshot({ path: join(out, "map-with-player.png") });
      await player.page.close();
      await until("the player is gone from the map", () => page.evaluate("players.length === 0"));

      await page.mouse.click(450, 300);
      await until("the map says who built it", async () => /mason/.test(await text("#builders ol")));
      assert.match(await text("#builders h2"), new RegExp(`at ${x} -?\\d+ ${z}$`));
      assert.match(await text("#builders code"), /^rollback /);
      await page.screenshot({ path: join(out, "map-today.png") });

      await page.$eval("#moment", (slider) => {
        slider.value = slider.min;
        slider.dispatchEvent(new Event("input"));
      });
      await until("the past lacks the voxel", async () => (await page.evaluate("isComplete")) && !(await stands()));
      await until("the map says which moment it shows", async () => /before the first edit/.test(await text("#when")));
      assert(await page.$eval("#builders", (panel) => panel.hidden));
      await page.screenshot({ path: join(out, "map-past.png") });
      await page.click("#play");
      await until("the play has come to the present", async () =>
        (await text("#play")) === "Play" && (await page.evaluate("at === null")) && stands());
      assert.deepEqual(told.errors, []);
      assert.deepEqual([...told.hosts], [new URL(world.address).host]);
    } finally {
      await world.close();
    }
  });

  test("the state of a server can be read without JavaScript, also on a phone", async () => {
    const world = await World.open(bin, files, ["--generator", "flat"]);
    try {
      const player = await Player.open(await somebody(), world.address);
      await player.joined("mason");
      await player.complete();
      const { page, told } = await openPage(await somebody(), `${world.address}/status`, { scripts: false });
      const words = () => page.$eval("body", (body) => body.innerText);
      await until("the page counts the player", async () => {
        await page.reload();
        return /mason/.test(await words());
      });
      await page.screenshot({ path: join(out, "status.png"), fullPage: true });
      assert.deepEqual([...told.hosts], [new URL(world.address).host]);
      const phone = await openPage(await somebody(), `${world.address}/status`, { width: 390, height: 780, scripts: false });
      const width = await phone.page.evaluate("document.documentElement.scrollWidth");
      assert(width <= 390, `the page is ${width} pixels wide`);
      await phone.page.screenshot({ path: join(out, "status-phone.png") });
    } finally {
      await world.close();
    }
  });
}
