// Joins a world, reads it, meshes it, and places a voxel above the ground: the loop of a program
// without a window. It needs a WebSocket, which node has from version 22 on.
//   node join.mjs ws://127.0.0.1:8080/play
import { Edits, load, Session } from "@runstone/core";

const url = globalThis.process?.argv[2] ?? new URLSearchParams(location.search).get("server");

export async function join(say = console.log) {
  await load();
  const session = new Session({ url, name: "robot", radius: 2, radiusVertical: 1 });
  const placed = new Set();
  try {
    for (let turn = 0; turn < 3000; ++turn) {
      for (const { type, number, text } of session.step()) {
        if (type === "open") session.move(session.info.place);
        if (type === "refused" || type === "rejected") throw new Error(text);
        if (type === "durable" && placed.has(number)) return say("the edit is on disk");
      }
      for (const { at, mesh } of session.meshes()) if (mesh) say(`chunk ${at.x} ${at.y} ${at.z}: ${mesh.quadCount()} quads`);
      const { isLoaded, place } = session.info;
      if (isLoaded && placed.size === 0) {
        const ground = session.pick(place, { x: 0, y: -1, z: 0 }, 60);
        if (ground === null) throw new Error("there is no ground below the spawn point");
        const above = { ...ground.voxel, y: ground.voxel.y + 1 };
        for (const number of session.edit(new Edits().voxel(above, ground.material))) placed.add(number);
        say(`voxel ${above.x} ${above.y} ${above.z}: ${session.materials[ground.material].name}`);
      }
      await new Promise((done) => setTimeout(done, 10));
    }
    throw new Error("the server did not answer in time");
  } finally {
    session.close();
  }
}
if (globalThis.process) await join();
