// The program in runstone-web-client.wasm. Every call of the page into it passes through
// Program.call() or Program.text(). They do nothing before the program is loaded, and after it has
// failed: its memory may be damaged then.
"use strict";

let runstone = null; // the module that Emscripten makes

const Program = (() => {
  let hasFailed = false;

  const runs = () => runstone !== null && !hasFailed;
  function callAs(type, name, args) {
    const types = args.map((value) => (typeof value === "string" ? "string" : "number"));
    return runstone.ccall(name, type, types, args);
  }

  // Calls a function with numbers and texts. Returns its number, or 0 if the program does not run.
  const call = (name, ...args) => (runs() ? callAs("number", name, args) : 0);
  // Calls a function that returns a text. Returns an empty text if the program does not run.
  const text = (name, ...args) => (runs() ? callAs("string", name, args) : "");
  // Copies bytes into the buffer from which functions that take bytes read them.
  function buffer(bytes) {
    const address = call("web_buffer", bytes.length); // the memory may grow in this call
    if (runs()) runstone.HEAPU8.set(bytes, address);
  }

  // Loads the program. `parts` has the objects that its functions call (bridge.js). `onFailure` is
  // called once, with the reason, when the program has failed.
  async function load(parts, onFailure) {
    await new Promise((resolve, reject) => {
      const script = document.createElement("script");
      script.src = "runstone-web-client.js";
      script.onload = resolve;
      script.onerror = () => reject(new Error("runstone-web-client.js cannot be loaded"));
      document.head.append(script);
    });
    function end(why) {
      if (hasFailed) return;
      hasFailed = true;
      onFailure(why);
    }
    runstone = await makeRunstone({ ...parts, onAbort: end, printErr: (line) => console.warn(line) });
    // A trap of WebAssembly, such as an access beyond the memory, is no abort().
    window.addEventListener("error", ({ error }) => {
      if (error instanceof WebAssembly.RuntimeError) end(error);
    });
    call("web_prepare");
  }

  return { load, call, text, buffer };
})();
