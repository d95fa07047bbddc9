// The worlds and the meshes that WebAssembly makes equal those of the native programs, bit for bit.
// The test also prints the times of meshes.
//   node mesh_test.mjs NATIVE WEB    the folders with runstone-mesh-probe
import { execFileSync } from "node:child_process";
import { join } from "node:path";

const [native, web] = process.argv.slice(2);
const SECONDS = "0.2"; // for each world

const lines = (program, args) => execFileSync(program, args, { encoding: "utf8", timeout: 240_000 }).trim().split("\n");

// Returns for each world its quads, their number, and the time of a chunk in microseconds.
function probe(program, args) {
  const out = new Map();
  for (const line of lines(program, [...args, SECONDS])) {
    const [name, quads, number, us] = line.split(", ");
    out.set(name, { mesh: `${quads} quads, ${number}`, us: Number(us) });
  }
  return out;
}

// Emscripten 3.1 takes a node that has fetch() for a browser.
const ofMachine = [join(native, "runstone-mesh-probe"), []];
const ofWasm = [process.execPath, ["--no-experimental-fetch", join(web, "runstone-mesh-probe.js")]];

const worlds = lines(ofMachine[0], ["digests"]);
const sameWorlds = lines(ofWasm[0], [...ofWasm[1], "digests"]);
const different = worlds.filter((line, i) => line !== sameWorlds[i]);
for (const line of different) console.log(`FAILED  the digest of ${line} natively, not in WebAssembly`);
const areWorldsEqual = different.length === 0 && worlds.length >= 30 && worlds.length === sameWorlds.length;
if (areWorldsEqual) console.log(`ok      ${worlds.length} digests of worlds are equal`);

const onMachine = probe(...ofMachine);
const inWasm = probe(...ofWasm);
let failed = !areWorldsEqual || onMachine.size < 30 || inWasm.size !== onMachine.size;
let logs = 0;
for (const [name, { mesh, us }] of onMachine) {
  const other = inWasm.get(name);
  if (other?.mesh !== mesh) {
    failed = true;
    console.log(`FAILED  ${name}: ${mesh} natively, ${other?.mesh} in WebAssembly`);
  } else {
    logs += Math.log(other.us / us);
  }
}
if (!failed) {
  console.log(`ok      the meshes of ${onMachine.size} worlds are equal`);
  // Times depend on the machine: they are measured and printed, not checked.
  console.log(`measured  WebAssembly takes ${Math.exp(logs / onMachine.size).toFixed(2)} times as long for a chunk ` +
    "(geometric mean)");
}
process.exit(failed ? 1 : 0);
