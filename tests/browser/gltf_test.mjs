// Models that Runstone writes as glTF open in three.js, and look like the voxels that they were
// made of.
//   node gltf_test.mjs PROGRAMS [OUT]
// PROGRAMS is the folder of the native programs. Pictures go to OUT. The voxels are drawn a second
// time face by face, by code of this test alone, and the pictures are compared.
import puppeteer from "puppeteer-core";
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

import { CHROMIUM, serve } from "./pages.mjs";
import { differenceOf, sideBySide } from "./pictures.mjs";
import { World } from "./world.mjs";

const [bin, out = "browser-out"] = process.argv.slice(2);
if (!bin) {
  console.error("usage: gltf_test.mjs PROGRAMS [OUT]");
  process.exit(2);
}
mkdirSync(out, { recursive: true });
const folder = mkdtempSync(join(tmpdir(), "runstone-gltf-"));
const here = import.meta.dirname;

// Reads an array of .npy with the axes x, y and z in C order: {sides, at(x, y, z)}.
function readArray(file) {
  const bytes = readFileSync(file);
  const headBytes = bytes.readUInt16LE(8);
  const head = bytes.toString("latin1", 10, 10 + headBytes);
  const sides = head.match(/'shape': \((\d+), (\d+), (\d+)\)/).slice(1).map(Number);
  assert.match(head, /'fortran_order': False/);
  const isWide = head.includes("<u2");
  const data = bytes.subarray(10 + headBytes);
  const at = (x, y, z) => {
    const i = (x * sides[1] + y) * sides[2] + z;
    return isWide ? data.readUInt16LE(2 * i) : data[i];
  };
  return { sides, at };
}

function writeArray(file, { sides, at }) {
  let head = `{'descr': '|u1', 'fortran_order': False, 'shape': (${sides.join(", ")}), }`;
  head = `${head.padEnd(117)}\n`; // with the ten bytes before it, 128
  const cells = Buffer.alloc(sides[0] * sides[1] * sides[2]);
  let i = 0;
  for (let x = 0; x < sides[0]; ++x) for (let y = 0; y < sides[1]; ++y) for (let z = 0; z < sides[2]; ++z) cells[i++] = at(x, y, z);
  const size = Buffer.alloc(2);
  size.writeUInt16LE(head.length);
  writeFileSync(file, Buffer.concat([Buffer.from("\x93NUMPY\x01\x00", "latin1"), size, Buffer.from(head, "latin1"), cells]));
}

// Returns the single faces between voxels and air, or the outside: [material, direction, x, y, z].
function facesOf({ sides, at }) {
  const faces = [];
  const solid = (x, y, z) => x >= 0 && y >= 0 && z >= 0 && x < sides[0] && y < sides[1] && z < sides[2] && at(x, y, z) !== 0;
  for (let x = 0; x < sides[0]; ++x) for (let y = 0; y < sides[1]; ++y) for (let z = 0; z < sides[2]; ++z) {
    const material = at(x, y, z);
    if (material === 0) continue;
    for (let d = 0; d < 6; ++d) {
      const beside = [x, y, z];
      beside[d >> 1] += d & 1 ? 1 : -1;
      if (!solid(...beside)) faces.push([material, d, x, y, z]);
    }
  }
  return faces;
}

// Hills of five materials with caves and islands, in two regions of a model along x and z.
const HILLS = { sides: [150, 40, 140], at: (x, y, z) => {
  const height = 14 + 9 * Math.sin(x / 11) + 6 * Math.cos(z / 7 + x / 23);
  const isCave = Math.sin(x / 5) + Math.sin(y / 3) + Math.sin(z / 6) > 1.6;
  const isIsland = (x - 40) ** 2 + 4 * (y - 33) ** 2 + (z - 60) ** 2 < 90;
  if (isIsland) return 5;
  if (y > height || isCave) return 0;
  if (y + 1 > height) return y < 9 ? 3 : 1;
  return y + 4 > height ? 2 : 4;
} };

// The code of a page: it opens a model with three.js, counts its triangles, and draws it.
const PAGE = `<!doctype html><script type="importmap">{"imports": {"three": "/modules/three/build/three.module.js", "three/addons/": "/modules/three/examples/jsm/"}}</script>
<script type="module">
import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
const [WIDTH, HEIGHT] = [480, 320];
const renderer = new THREE.WebGLRenderer({ preserveDrawingBuffer: true });
renderer.setSize(WIDTH, HEIGHT, false);
const SHADES = [0.75, 0.8, 0.5, 1, 0.65, 0.9]; // by direction, so that faces differ

function picture(scene, sides, eye) {
  const camera = new THREE.PerspectiveCamera(60, WIDTH / HEIGHT, 0.5, 2000);
  camera.position.set(...eye.map((share, axis) => share * sides[axis]));
  camera.lookAt(...sides.map((side) => side / 2));
  scene.background = new THREE.Color(0xff00ff);
  renderer.render(scene, camera);
  return renderer.domElement.toDataURL("image/png").split(",")[1];
}

// Every material without light, with its colour, darker by the direction of the face.
function plain(colour) {
  return new THREE.ShaderMaterial({
    uniforms: { colour: { value: colour }, shades: { value: SHADES } },
    vertexShader: "varying vec3 n; void main() { n = normal; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",
    fragmentShader: "uniform vec3 colour; uniform float shades[6]; varying vec3 n; void main() {" +
      " vec3 a = abs(n); int axis = a.x > 0.5 ? 0 : a.y > 0.5 ? 1 : 2; float s = axis == 0 ? n.x : axis == 1 ? n.y : n.z;" +
      " float shade = 0.0; for (int i = 0; i < 6; ++i) if (i == 2 * axis + (s > 0.0 ? 1 : 0)) shade = shades[i];" +
      " gl_FragColor = linearToOutputTexel(vec4(colour * shade, 1.0)); }",
  });
}

globalThis.openModel = async (url) => {
  const { scene } = await new GLTFLoader().loadAsync(url);
  scene.updateMatrixWorld(true);
  const materials = {}; // by name: triangles, and the area of each direction
  const box = new THREE.Box3().setFromObject(scene);
  scene.traverse((body) => {
    if (!body.isMesh) return;
    const { index, attributes: { position } } = body.geometry;
    const of = (materials[body.material.name] ??= { triangles: 0, areas: [0, 0, 0, 0, 0, 0], colour: body.material.color.toArray() });
    const corner = (i) => new THREE.Vector3().fromBufferAttribute(position, index.getX(i)).applyMatrix4(body.matrixWorld);
    for (let i = 0; i < index.count; i += 3) {
      const [a, b, c] = [corner(i), corner(i + 1), corner(i + 2)];
      const across = b.sub(a).cross(c.sub(a)).toArray();
      const axis = across.findIndex((along) => Math.abs(along) > 1e-6);
      if (axis < 0) throw new Error("a triangle without an area");
      of.triangles += 1;
      of.areas[2 * axis + (across[axis] > 0 ? 1 : 0)] += Math.abs(across[axis]) / 2;
    }
  });
  globalThis.model = scene;
  return { materials, min: box.min.toArray(), max: box.max.toArray() };
};
globalThis.drawModel = (sides, eye) => {
  const seen = globalThis.model.clone(true);
  seen.traverse((body) => {
    if (body.isMesh) body.material = plain(body.material.color);
  });
  const scene = new THREE.Scene();
  scene.add(seen);
  return picture(scene, sides, eye);
};
// The model as its reader sees it, in the light of a sun and of the sky.
globalThis.drawLit = (sides, eye) => {
  const scene = new THREE.Scene();
  const sun = new THREE.DirectionalLight(0xffffff, 2.5);
  sun.position.set(0.5, 1, 0.3);
  scene.add(globalThis.model.clone(true), sun, new THREE.HemisphereLight(0xbfd8ff, 0x665544, 1.5));
  return picture(scene, sides, eye);
};
// The single faces, as [material, direction, x, y, z], in the colours of the model.
globalThis.drawFaces = (faces, colours, sides, eye) => {
  const scene = new THREE.Scene();
  for (const [material, colour] of Object.entries(colours)) {
    const places = [], normals = [];
    for (const [of, d, ...at] of faces) {
      if (of !== Number(material)) continue;
      const [axis, u, v] = [d >> 1, ((d >> 1) + 1) % 3, ((d >> 1) + 2) % 3];
      const corners = [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]];
      for (const [alongU, alongV] of d & 1 ? corners : corners.reverse()) {
        const place = [...at], normal = [0, 0, 0];
        place[axis] += d & 1;
        place[u] += alongU;
        place[v] += alongV;
        normal[axis] = d & 1 ? 1 : -1;
        places.push(...place);
        normals.push(...normal);
      }
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(places, 3));
    geometry.setAttribute("normal", new THREE.Float32BufferAttribute(normals, 3));
    scene.add(new THREE.Mesh(geometry, plain(new THREE.Color(...colour))));
  }
  return picture(scene, sides, eye);
};
globalThis.isReady = true;
</script>`;
writeFileSync(join(folder, "page.html"), PAGE);

const EYES = [[1.3, 2.6, 1.4], [-0.2, 1.4, 1.1], [0.5, -2, 0.4]];
const files = await serve({ "/": folder, "/modules/": join(here, "node_modules") });
const browser = await puppeteer.launch(CHROMIUM);
let failed = 0;
async function test(name, body) {
  const page = await browser.newPage();
  const errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  try {
    await page.goto(`${files.address}/page.html`);
    await page.waitForFunction(() => globalThis.isReady === true);
    await body(page);
    assert.deepEqual(errors, []);
    console.log(`ok      ${name}`);
  } catch (error) {
    ++failed;
    console.log(`FAILED  ${name}: ${error.stack ?? error} ${errors.join("; ")}`);
  }
  await page.close();
}
const open = (page, name) => page.evaluate((url) => openModel(url), `/${name}`);
const draw = (page, sides, eye) => page.evaluate((...all) => drawModel(...all), sides, eye);

const faces = facesOf(HILLS);
const most = (axis) => faces.reduce((max, face) => Math.max(max, face[2 + axis] + 1), 0);
writeArray(join(folder, "hills.npy"), HILLS);
for (const choices of [[], ["--quantise"], ["--split"], ["--close-t-junctions"]]) {
  const name = `hills${choices.join("")}.glb`;
  await test(`an array as ${name} has the faces of its voxels, and their picture`, async (page) => {
    execFileSync(join(bin, "runstone-convert"), [join(folder, "hills.npy"), join(folder, name), ...choices]);
    const model = await open(page, name);
    assert.deepEqual([model.min, model.max], [[0, 0, 0], [0, 1, 2].map(most)]);
    assert.equal(Object.keys(model.materials).length, 5);
    const colours = {};
    let triangles = 0;
    for (const [material, { areas, colour, triangles: of }] of Object.entries(model.materials)) {
      const number = Number(material.match(/^material (\d+)$/)[1]);
      const wanted = [0, 1, 2, 3, 4, 5].map((d) => faces.filter((face) => face[0] === number && face[1] === d).length);
      assert.deepEqual(areas.map((area) => Math.round(area * 1000) / 1000), wanted, material);
      colours[number] = colour;
      triangles += of;
    }
    assert(triangles < 2 * faces.length, `${triangles} triangles for ${faces.length} faces`);
    for (const [i, eye] of EYES.entries()) {
      const of = await draw(page, HILLS.sides, eye);
      const single = await page.evaluate((...all) => drawFaces(...all), faces, colours, HILLS.sides, eye);
      if (choices.length === 0) writeFileSync(join(out, `gltf-hills-${i}.png`), Buffer.from(await sideBySide(page, single, of), "base64"));
      const { share } = await differenceOf(page, of, single, 8);
      assert(share < 0.002, `${(100 * share).toFixed(2)} % of the pixels differ from eye ${i}`);
    }
  });
}

await test("the test sees a model that lacks a layer of voxels", async (page) => {
  const lower = { sides: HILLS.sides, at: (x, y, z) => (y < 39 ? HILLS.at(x, y + 1, z) : 0) };
  writeArray(join(folder, "lower.npy"), lower);
  execFileSync(join(bin, "runstone-convert"), [join(folder, "lower.npy"), join(folder, "lower.glb")]);
  const { materials } = await open(page, "lower.glb");
  const colours = Object.fromEntries(Object.entries(materials).map(([name, { colour }]) => [name.split(" ")[1], colour]));
  const single = await page.evaluate((...all) => drawFaces(...all), faces, colours, HILLS.sides, EYES[0]);
  const { share } = await differenceOf(page, await draw(page, HILLS.sides, EYES[0]), single, 8);
  assert(share > 0.01, `${(100 * share).toFixed(2)} % of the pixels differ`);
});

await test("a box of a landscape opens, with water and trees, in equal pictures by all choices", async (page) => {
  const world = await World.open(bin, null, ["--generator", "landscape", "--seed", "3"]);
  await world.stopServer();
  const place = join(world.folder, "world");
  // The box lies around the highest voxel of a column in a lake.
  const [X, Z, LOW, HIGH] = [-1780, 80, -128, 639];
  execFileSync(join(bin, "runstone-replay"), ["dump", "--world", place, "--box", `${X},${LOW},${Z},${X},${HIGH},${Z}`, join(folder, "column.npy")]);
  const column = readArray(join(folder, "column.npy"));
  let top = HIGH - LOW;
  while (top > 0 && column.at(0, top, 0) === 0) --top;
  const foot = LOW + top - 60, sides = [160, 128, 160];
  const box = "--box", corners = `${X - 80},${foot},${Z - 80},${X + 79},${foot + 127},${Z + 79}`;
  execFileSync(join(bin, "runstone-replay"), ["export", "--world", place, box, corners, join(folder, "land.glb")]);
  execFileSync(join(bin, "runstone-replay"), ["export", "--world", place, box, corners, join(folder, "land.rsb")]);
  execFileSync(join(bin, "runstone-convert"), [join(folder, "land.rsb"), join(folder, "land-quantised.glb"), "--quantise"]);
  execFileSync(join(bin, "runstone-replay"), ["dump", "--world", place, box, corners, join(folder, "land.npy")]);
  await world.close();

  const voxels = readArray(join(folder, "land.npy"));
  assert.deepEqual(voxels.sides, sides);
  const model = await open(page, "land.glb");
  const names = Object.keys(model.materials);
  assert(names.length >= 5 && names.includes("water"), names.join());
  const eye = [1.2, 1.6, 1.3];
  const lit = await page.evaluate((...all) => drawLit(...all), sides, eye);
  writeFileSync(join(out, "gltf-landscape.png"), Buffer.from(lit, "base64"));
  const usual = await draw(page, sides, eye);
  // Each solid voxel at the bottom of the box shows one face downwards, and none lies below it.
  let bottom = 0;
  for (let x = 0; x < sides[0]; ++x) for (let z = 0; z < sides[2]; ++z) bottom += voxels.at(x, 0, z) === 0 ? 0 : 1;
  const downwards = names.reduce((sum, name) => sum + model.materials[name].areas[2], 0);
  assert(bottom > 0 && downwards >= bottom, `${downwards} faces downwards, ${bottom} at the bottom`);
  await open(page, "land-quantised.glb");
  const { share } = await differenceOf(page, usual, await draw(page, sides, eye), 8);
  assert(share < 0.002, `${(100 * share).toFixed(2)} % of the pixels differ`);
});

await browser.close();
await files.close();
rmSync(folder, { recursive: true, force: true });
console.log(failed === 0 ? "all passed" : `${failed} failed`);
process.exit(failed === 0 ? 0 : 1);
