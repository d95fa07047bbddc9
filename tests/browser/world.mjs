// A world with its server and its gateway, on free ports of this machine, in a folder of its own.
import { execFileSync, spawn } from "node:child_process";
import { cpSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const START_MS = 30_000;

const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

// Starts a program that writes its port into a file, and returns it once it listens.
async function start(program, args, portFile) {
  rmSync(portFile, { force: true });
  const child = spawn(program, [...args, "--port-file", portFile], { stdio: ["ignore", "ignore", "pipe"] });
  let log = "";
  child.stderr.on("data", (data) => (log += data));
  for (const until = Date.now() + START_MS; Date.now() < until; await sleep(50)) {
    if (existsSync(portFile) && readFileSync(portFile, "utf8").endsWith("\n"))
      return { child, port: Number(readFileSync(portFile, "utf8")), log: () => log };
    if (child.exitCode !== null) break;
  }
  child.kill("SIGKILL");
  throw new Error(`${program} did not start:\n${log}`);
}

async function stop(program) {
  if (program.child.exitCode !== null) return;
  const ended = new Promise((resolve) => program.child.once("exit", resolve));
  program.child.kill("SIGTERM");
  await Promise.race([ended, sleep(15_000).then(() => program.child.kill("SIGKILL"))]);
  await ended;
}

export class World {
  // `bin` has the programs of the preset release, `page` the files of the preset web. Without a
  // page the gateway serves none. `gateway` are further options of runstone-web.
  static async open(bin, page, world, gateway = []) {
    const out = new World();
    out.bin = bin;
    out.folder = mkdtempSync(join(tmpdir(), "runstone-browser-"));
    out.worldFlags = world;
    await out.startServer(true);
    out.web = await start(join(bin, "runstone-web"),
      ["--listen", "127.0.0.1:0", "--gateway-socket", out.socket, "--world", join(out.folder, "world"),
        ...(page === null ? [] : ["--client-files", page]), ...gateway],
      join(out.folder, "web.port"));
    return out;
  }

  get socket() {
    return join(this.folder, "web.sock");
  }
  get address() {
    return `http://127.0.0.1:${this.web.port}`;
  }

  async startServer(isNew = false) {
    const args = ["--world", join(this.folder, "world"), "--listen", `127.0.0.1:${this.server?.port ?? 0}`,
      "--gateway-socket", this.socket];
    this.server = await start(join(this.bin, "runstone-server"), isNew ? [...args, "--create", "--generator", "terrain", "--seed", "1", ...this.worldFlags] : args,
      join(this.folder, "server.port"));
  }
  async stopServer() {
    await stop(this.server);
  }
  // Gives a command to the server, such as "role default moderator".
  control(command) {
    execFileSync(join(this.bin, "runstone-server"), ["control", "--world", join(this.folder, "world"), ...command.split(" ")]);
  }
  // Copies the world of a server that is stopped, and puts the copy back.
  backUp() {
    cpSync(join(this.folder, "world"), join(this.folder, "backup"), { recursive: true });
  }
  restore() {
    rmSync(join(this.folder, "world"), { recursive: true });
    cpSync(join(this.folder, "backup"), join(this.folder, "world"), { recursive: true });
  }

  // Returns the picture that the desktop client draws from this eye, as a PNG file. Angles are in
  // radians.
  picture(eye, yaw, pitch, { width, height, view, farLevels }) {
    const script = join(this.folder, "picture.txt");
    const degrees = (angle) => (angle * 180) / Math.PI;
    writeFileSync(script, `move ${eye.x} ${eye.y} ${eye.z}\nlook ${degrees(yaw)} ${degrees(pitch)}\nwait loaded\n` +
      `${farLevels > 0 ? "wait horizon\n" : ""}screenshot picture.png\n`);
    execFileSync(join(this.bin, "runstone-client"),
      ["--connect", `127.0.0.1:${this.server.port}`, "--headless", "--script", script, "--view", view,
        "--far-levels", farLevels, "--size", `${width}x${height}`, "--screenshot-dir", this.folder, "--quality", "high"],
      { stdio: ["ignore", "ignore", "ignore"], timeout: 120_000 });
    return readFileSync(join(this.folder, "picture.png"));
  }

  // Lets a desktop client without a window carry out the lines of a script. Returns a function that
  // ends the client.
  desktop(name, lines) {
    const script = join(this.folder, `${name}.txt`);
    writeFileSync(script, lines.map((line) => `${line}\n`).join(""));
    const child = spawn(join(this.bin, "runstone-client"),
      ["--connect", `127.0.0.1:${this.server.port}`, "--name", name, "--no-render", "--script", script],
      { stdio: "ignore" });
    return () => stop({ child });
  }

  async close() {
    await stop(this.web);
    await stop(this.server);
    rmSync(this.folder, { recursive: true, force: true });
  }
}
