// A player in a browser: a page of the gateway with the client for browsers.
const STEP_MS = 60_000;
// Above the flat ground of the world, looking down at 45 degrees.
export const ABOVE = { yaw: 0.5, pitch: -0.8 };
let places = 0; // of the ground that players have looked at

const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

// Asks until the answer is true (or not null), and returns it. Fails with `what` otherwise.
export async function until(what, ask, ms = STEP_MS) {
  let last;
  for (const end = Date.now() + ms; Date.now() < end; await sleep(50)) {
    last = await ask();
    if (last) return last;
  }
  throw new Error(`${what}: not within ${ms / 1000} s`);
}

export class Player {
  // Opens the page and fills in the form. `context` is a browser context, which has keys of its own.
  static async open(context, address, { width = 640, height = 360, touch = false, hash = "", inject = null } = {}) {
    const out = new Player();
    out.page = await context.newPage();
    out.errors = [];
    out.page.on("pageerror", (error) => out.errors.push(String(error)));
    out.page.on("console", (line) => {
      if (line.type() === "error") out.errors.push(line.text());
    });
    await out.page.setViewport({ width, height, deviceScaleFactor: 1, hasTouch: touch, isMobile: touch });
    out.page.on("dialog", (dialog) => dialog.accept());
    if (inject) await out.page.evaluateOnNewDocument(inject);
    await out.page.goto(`${address}/client/${hash}`);
    return out;
  }

  loaded() {
    return until("the program is loaded", () => this.page.$eval("#enter", (button) => !button.disabled));
  }
  async join(name, { quality = "0", sight = "4" } = {}) {
    await this.loaded();
    await this.page.$eval("#name", (input, text) => (input.value = text), name);
    await this.page.select("#quality", quality);
    await this.page.select("#sight", sight);
    await this.page.click("#enter");
  }
  async joined(name, options) {
    await this.join(name, options);
    await until(`${name} has joined`, () => this.page.$eval("#hud", (hud) => !hud.hidden));
  }
  // Fails to join, and returns what the page then shows.
  async refused(name) {
    await this.join(name);
    return until(`${name} is refused`, () => this.page.evaluate(() => {
      const [step, detail, enter] = ["step", "detail", "enter"].map((id) => document.getElementById(id));
      return enter.disabled || !enter.checkVisibility() ? null :
        { step: step.textContent, detail: detail.textContent, button: enter.textContent };
    }));
  }
  // Waits until the view has arrived, is meshed, and is on the screen.
  async complete() {
    await until("the view is complete", async () => (await this.state()).complete);
  }

  state() {
    return this.page.evaluate(() => JSON.parse(runstone.ccall("web_state", "string", [], [])));
  }
  // Carries out an action of a key by its name.
  act(name) {
    return this.page.evaluate((action) => runstone.ccall("web_act", null, ["string"], [action]), name);
  }
  hasWindowAt(x, y) {
    return this.page.evaluate((...at) => runstone._web_has_window_at(...at) !== 0, x, y);
  }
  windows() {
    return this.page.evaluate(() => JSON.parse(runstone.ccall("web_windows", "string", [], [])));
  }
  // The text of the window's field that has the keyboard.
  fieldText() {
    return this.page.evaluate(() => runstone.ccall("web_field", "string", [], []));
  }
  report() {
    return this.page.evaluate(() => JSON.parse(runstone.ccall("web_report", "string", [], [])));
  }
  voxel(x, y, z) {
    return this.page.evaluate((...at) => runstone._web_voxel(...at), x, y, z);
  }
  camera(x, y, z, yaw, pitch, isExact = false) {
    return this.page.evaluate((...all) => runstone._web_camera(...all), x, y, z, yaw, pitch, isExact ? 1 : 0);
  }
  text(id) {
    return this.page.$eval(id, (element) => element.textContent);
  }

  // Looks from some voxels above at a place of the ground that nobody has used yet. Returns the voxel in
  // sight and its material.
  async lookDown() {
    const { y } = await this.state();
    await this.camera(0.5 + 12 * places++, y, 0.5, ABOVE.yaw, ABOVE.pitch);
    return until("the ground is in sight", async () => (await this.state()).sight);
  }
  // Adds one voxel on top of the one in sight by a click. Returns its place and its material.
  async place() {
    const [x, y, z] = (await this.state()).sight;
    await this.click("right");
    return until("the placed voxel is shown", async () => {
      const { sight } = await this.state();
      return sight && (sight[0] !== x || sight[1] !== y || sight[2] !== z) ? sight : null;
    });
  }

  // The mouse is captured by the first click on the canvas.
  async capture() {
    const { width, height } = this.page.viewport();
    await this.page.mouse.click(width / 2, height / 2);
    await sleep(200);
  }
  async click(button) {
    const { width, height } = this.page.viewport();
    await this.page.mouse.click(width / 2, height / 2, { button, delay: 60 });
  }
  // Waits until the page has drawn what it has been told, also on a machine that draws slowly.
  async drawn() {
    await this.page.evaluate(() => new Promise((done) =>
      requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done)))));
  }
  // Holds a key until the player has moved sideways by more than this many voxels.
  async moveBy(code, distance) {
    const from = await this.state();
    await this.page.keyboard.down(code);
    await until(`${code} moved the player`, async () => {
      const now = await this.state();
      return Math.hypot(now.x - from.x, now.z - from.z) > distance;
    });
    await this.page.keyboard.up(code);
  }
}
