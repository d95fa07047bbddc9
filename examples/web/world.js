// Joins a world through its gateway and draws it with three.js. A click digs, a click with the
// right button builds, W A S D and the mouse fly.
//   index.html?server=ws://127.0.0.1:8080/play&name=ada
import * as THREE from "three";
import { Direction, Edits, load, Look, Pass, Session } from "@runstone/core";

const options = new URLSearchParams(location.search);
const REACH = 64, SPEED = 12; // voxels, and voxels a second
const SIDE_LIGHT = [0.8, 0.8, 0.6, 1, 0.9, 0.9]; // by direction

await load();
const session = new Session({ url: options.get("server") ?? "ws://127.0.0.1:8080/play",
  name: options.get("name") ?? "visitor", radius: Number(options.get("radius") ?? 4) });

const renderer = new THREE.WebGLRenderer({ preserveDrawingBuffer: true });
const scene = new THREE.Scene();
scene.background = new THREE.Color(0x9fc4e8);
const camera = new THREE.PerspectiveCamera(70, 1, 0.1, 1000);
camera.rotation.order = "YXZ";
const looks = [Pass.OPAQUE, Pass.TRANSPARENT].map((pass) => new THREE.MeshBasicMaterial({ vertexColors: true,
  transparent: pass === Pass.TRANSPARENT, depthWrite: pass === Pass.OPAQUE }));
document.body.append(renderer.domElement);

// The colour of each vertex: that of its material, darker on the sides.
function colours({ materials, normals }) {
  const out = new Float32Array(4 * materials.length);
  const colour = new THREE.Color();
  for (let i = 0; i < materials.length; ++i) {
    const [r, g, b, a] = session.materials[materials[i]].colour;
    const axis = [0, 1, 2].find((along) => normals[3 * i + along] !== 0);
    const light = SIDE_LIGHT[2 * axis + (normals[3 * i + axis] > 0 ? 1 : 0)];
    colour.setRGB(r / 255, g / 255, b / 255, THREE.SRGBColorSpace).multiplyScalar(light);
    out.set([colour.r, colour.g, colour.b, a / 255], 4 * i);
  }
  return out;
}

const bodies = new Map(); // by place of the chunk
function show({ at, mesh }) {
  const key = `${at.x},${at.y},${at.z}`;
  for (const body of bodies.get(key) ?? []) {
    scene.remove(body);
    body.geometry.dispose();
  }
  bodies.delete(key);
  if (mesh === null) return;
  bodies.set(key, [Pass.OPAQUE, Pass.TRANSPARENT].filter((pass) => mesh.quadCount(pass) > 0).map((pass) => {
    const arrays = mesh.geometry(pass);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(arrays.positions, 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(colours(arrays), 4));
    geometry.setIndex(new THREE.BufferAttribute(arrays.indices, 1));
    const body = new THREE.Mesh(geometry, looks[pass]);
    body.position.copy(at).multiplyScalar(session.info.edge);
    scene.add(body);
    return body;
  }));
}

function click(builds) {
  const hit = session.pick(camera.position, camera.getWorldDirection(new THREE.Vector3()), REACH);
  if (hit === null || hit.direction === Direction.NONE) return;
  const place = { ...hit.voxel };
  if (builds) place["xyz"[hit.direction >> 1]] += hit.direction & 1 ? 1 : -1;
  const material = builds ? session.materials.find(({ look }) => look === Look.OPAQUE).id : 0;
  session.edit(new Edits().voxel(place, material));
}

const keys = new Set();
addEventListener("keydown", ({ code }) => keys.add(code));
addEventListener("keyup", ({ code }) => keys.delete(code));
addEventListener("contextmenu", (event) => event.preventDefault());
addEventListener("mousedown", ({ button }) => (document.pointerLockElement ? click(button === 2) : document.body.requestPointerLock()));
addEventListener("mousemove", ({ movementX, movementY }) => {
  if (!document.pointerLockElement) return;
  camera.rotation.y -= movementX / 500;
  camera.rotation.x = Math.max(-1.5, Math.min(1.5, camera.rotation.x - movementY / 500));
});

let before = performance.now();
function frame(now) {
  for (const { type, text } of session.step()) {
    if (type === "open") camera.position.copy(session.info.place);
    if (text !== "") document.getElementById("state").textContent = text;
  }
  for (const changed of session.meshes()) show(changed);
  const step = (SPEED * (now - before)) / 1000;
  before = now;
  camera.translateZ(step * (keys.has("KeyS") - keys.has("KeyW"))).translateX(step * (keys.has("KeyD") - keys.has("KeyA")));
  // three.js looks along -z and turns to the left; Runstone looks along +z and turns to +x.
  session.move(camera.position, camera.rotation.y + Math.PI, camera.rotation.x);
  renderer.setSize(innerWidth, innerHeight, false);
  camera.aspect = innerWidth / innerHeight;
  camera.updateProjectionMatrix();
  renderer.render(scene, camera);
  requestAnimationFrame(frame);
}
requestAnimationFrame(frame);
Object.assign(globalThis, { bodies, camera, session }); // for the console
