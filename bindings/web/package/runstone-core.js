// @runstone/core: Runstone's chunks, edits, meshes and sessions in JavaScript (docs/web-core.md).
export { load, RunstoneError, version } from "./wasm.js";
export * from "./chunks.js";
export { Session } from "./session.js";
