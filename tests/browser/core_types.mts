// A program with the types of @runstone/core. The compiler checks it and the declarations; it never
// runs.
import { buildTile, Chunk, Edits, load, Look, Mesh, Pass, RunstoneError, Session, Space, Visibility, type SessionEvent } from "@runstone/core";

await load(new URL("runstone-core.wasm", "http://localhost/"));
const chunk: Chunk = Chunk.filled([32, 16, 32], 1);
const edits = new Edits().box({ x: 0, y: 0, z: 0 }, { x: 4, y: 4, z: 4 }, { material: 2, only: 1 }).sphere({ x: 1, y: 2, z: 3 }, 4, 0);
const voxels: number = chunk.apply({ x: 0, y: 0, z: 0 }, edits).voxels;
const visibility = new Visibility([Look.EMPTY, Look.OPAQUE]);
const positions: Float32Array = new Mesh().build(chunk, visibility, { neighbours: [null, chunk] }).geometry(Pass.OPAQUE).positions;
const digest: [bigint, bigint] = buildTile([chunk], 32, visibility).digest;
const hit = new Space(32).pick({ x: 0, y: 0, z: 0 }, { x: 1, y: 0, z: 0 }, 8);
const session = new Session({ url: "ws://localhost/play", name: "ada", radius: 2 });
const events: SessionEvent[] = session.step();
for (const { at, mesh } of session.meshes()) console.log(at.x, mesh?.quadCount());
// @ts-expect-error A chunk is made by one of its functions.
new Chunk();
// @ts-expect-error A name is a text.
new Session({ url: "ws://localhost/play", name: 1 });
export { digest, events, hit, positions, RunstoneError, voxels };
