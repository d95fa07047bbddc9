// The page of the browser client: the form for joining, the display over the canvas, and input. The
// world itself is the program in runstone-web-client.wasm, which calls the functions of `page`
// (client/web/page.hpp).
"use strict";

const $ = (id) => document.getElementById(id);
const NOTICE_MS = 6000;
const LINES_MAX = 12;
const CACHE_BYTES_MAX = 64 * 1024 * 1024;
const MOMENT_MS = 150; // from the last movement of the slider to the request
const WHEEL_STEP = 60; // pixels; the notch of a mouse wheel has about 100

let ticker = null; // a worker that calls the program while the page is hidden
let isPlaying = false;
let cache = null; // the promise of openCache(), once it was called
let wantsMouse = false; // the player has captured the mouse, or a click has asked for it
let momentTimer = 0; // runs while the player moves the slider of the timeline
const early = []; // notices that came before there was a place to show them
const materials = new Map();

function fail(headline, detail) {
  isPlaying = false;
  release();
  document.body.classList.add("failed");
  $("hud").hidden = true;
  $("door").hidden = false;
  $("share").hidden = true;
  $("join").hidden = false;
  $("step").textContent = headline;
  $("detail").textContent = detail;
  $("enter").textContent = "Try again";
  $("enter").disabled = false;
  $("join").noValidate = true; // "Try again" needs no name
}

function colourOf(material) {
  return `#${(materials.get(material)?.colour ?? 0).toString(16).padStart(6, "0")}`;
}

const page = {
  progress(text, share, detail) {
    $("step").textContent = text;
    $("detail").textContent = detail;
    $("share").hidden = false;
    if (share >= 0) $("share").value = share;
    else $("share").removeAttribute("value");
  },
  joined() {
    isPlaying = true;
    $("door").hidden = true;
    $("hud").hidden = false;
    Typing.focus();
    for (const notice of early.splice(0)) page.notice(...notice);
  },
  state(text) {
    $("state").textContent = text;
  },
  failed: fail,
  notice(text, isWarning) {
    if (!isPlaying) return void early.push([text, isWarning]);
    const line = document.createElement("div");
    line.textContent = text;
    if (isWarning) line.className = "warning";
    $("notices").append(line);
    while ($("notices").children.length > 4) $("notices").firstChild.remove();
    setTimeout(() => line.remove(), NOTICE_MS);
  },
  chat(text, id) {
    const line = document.createElement("div");
    line.textContent = text;
    line.dataset.id = id;
    $("lines").append(line);
    while ($("lines").children.length > LINES_MAX) $("lines").firstChild.remove();
  },
  withdrawChat(id) {
    for (const line of [...$("lines").children]) if (line.dataset.id === id) line.remove();
  },
  openChat() {
    release();
    $("say").hidden = false;
    $("say").focus();
  },
  clearMaterials() {
    materials.clear();
    $("palette").replaceChildren();
  },
  material(id, name, colour) {
    materials.set(id, { name, colour });
    const button = document.createElement("button");
    button.textContent = name;
    button.style.background = colourOf(id);
    button.onclick = () => {
      Program.call("web_hold", id);
      $("palette").hidden = true;
      Typing.focus();
    };
    $("palette").append(button);
  },
  togglePalette() {
    $("palette").hidden = !$("palette").hidden;
    if (!$("palette").hidden) release();
  },
  slot(slot, material, isChosen) {
    const button = $("slots").children[slot];
    button.style.background = material === 0 ? "transparent" : colourOf(material);
    button.title = materials.get(material)?.name ?? "";
    button.classList.toggle("chosen", isChosen);
  },
  players(count, names) {
    $("players").textContent = count === 0 ? "" : names;
  },
  toggleTimeline() {
    $("timeline").hidden = !$("timeline").hidden;
    if (!$("timeline").hidden) release();
  },
  time(newest, shown, isPast) {
    $("moment").max = newest;
    // A player who holds the slider decides where it is.
    if (momentTimer === 0) $("moment").value = shown;
    $("shown").textContent = `${shown} of ${newest}`;
    $("live").disabled = !isPast;
  },
  walking(isWalking) {
    $("walk").textContent = isWalking ? "fly" : "walk";
  },
  capture(isCaptured) {
    if (!isCaptured) release();
    else if (!document.body.classList.contains("touch")) capture();
  },
  typing: Typing.set,
  async loadFont() {
    let font = new ArrayBuffer(0);
    try {
      const answer = await fetch("DejaVuSans.ttf");
      if (!answer.ok) throw new Error(`the gateway answers ${answer.status}`);
      font = await answer.arrayBuffer();
    } catch (error) {
      page.notice(`the windows lack some letters: their font cannot be loaded: ${error?.message || error}`, true);
    }
    Program.buffer(new Uint8Array(font));
    Program.call("web_font");
  },
  keepServer: Keys.keepServer,
  keepKit: (world, line) => keep(`kit.${world}`, line),
  readKit: (world) => kept(`kit.${world}`) ?? "",
};

// Joining.

function missing() {
  if (typeof WebAssembly !== "object") return ["This browser has no WebAssembly", "A browser of this decade has it."];
  // A function that uses a vector instruction: (func v128.const drop).
  const simd = new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0,
    253, 15, 253, 98, 11]);
  if (!WebAssembly.validate(simd))
    return ["This browser has no SIMD of WebAssembly", "Chrome 91, Firefox 89, Safari 16.4 and later versions have it."];
  const probe = document.createElement("canvas").getContext("webgl2");
  if (!probe) {
    return ["This browser has no WebGL 2",
      "It may be switched off in its settings, or the graphics driver may be blocked. The desktop client does not need it."];
  }
  probe.getExtension("WEBGL_lose_context")?.loseContext();
  return null;
}

async function loadProgram() {
  $("step").textContent = "loading the program";
  await Program.load({ page, chunks: Chunks, textures: Textures }, (why) => {
    ticker?.terminate();
    fail("The client has failed",
      `${why}\nLoad the page again. Edits that the server has not confirmed are lost.`);
  });
  ticker = new Worker("ticker.js");
  ticker.onmessage = () => Program.call("web_tick");
}

// Settings of the form. A browser may forbid to keep them.
function kept(name) {
  try {
    return localStorage.getItem(name);
  } catch {
    return null;
  }
}
function keep(name, value) {
  try {
    localStorage.setItem(name, value);
  } catch (error) {
    console.warn(`${name} is not kept:`, error);
  }
}

// Returns the lines of the worlds of which this browser keeps chunks, or null if it keeps none.
async function openCache() {
  try {
    return await Chunks.open(CACHE_BYTES_MAX);
  } catch (error) {
    page.notice(`this browser keeps no chunks, so a reload takes longer: ${error?.message || error}`, true);
    return null;
  }
}

function resize() {
  const canvas = $("canvas");
  // More pixels cost time, and few players see them.
  const scale = Math.min(window.devicePixelRatio || 1, 2);
  canvas.width = Math.max(1, Math.round(canvas.clientWidth * scale));
  canvas.height = Math.max(1, Math.round(canvas.clientHeight * scale));
  Program.call("web_resize", canvas.width, canvas.height, canvas.clientWidth, canvas.clientHeight);
}

async function join(event) {
  event.preventDefault();
  const name = $("name").value.trim();
  keep("name", name);
  for (const id of ["quality", "sight", "textures"]) keep(id, $(id).value);
  if (document.body.classList.contains("failed")) return location.reload();
  $("enter").disabled = true;
  $("step").textContent = "reading what this browser keeps";
  $("detail").textContent = "";
  cache ??= openCache();
  const [keys, worlds] = await Promise.all([Keys.load(), cache]);
  if (!keys.isKept) page.notice("this browser keeps no keys: you are somebody else at your next visit", true);
  const url = new URL("../play", location.href);
  url.protocol = location.protocol === "https:" ? "wss:" : "ws:";
  // An invite is the part after '#', which browsers do not send.
  const invite = new URLSearchParams(location.hash.slice(1)).get("invite") ?? "";
  const [sight, quality, textures] = ["sight", "quality", "textures"].map((id) => Number($(id).value));
  const FAR_LEVELS = 3;
  const why = Program.text("web_join", url.href, name, invite, keys.seed, keys.isKept ? 1 : 0,
    keys.servers, sight, FAR_LEVELS, quality, textures, worlds === null ? 0 : 1, worlds ?? "");
  if (why !== "") {
    $("step").textContent = "You cannot join like this";
    $("detail").textContent = why;
    $("enter").disabled = false;
    return;
  }
  $("join").hidden = true;
  resize();
  // A browser that is short of disk space deletes data that is not persistent.
  navigator.storage?.persist?.().catch(() => {});
}

// Input.

const isTyping = (target) => target !== Typing.field && ((target instanceof HTMLInputElement && target.type !== "range") ||
  target instanceof HTMLSelectElement);
const modifiers = (event) => (event.ctrlKey ? 1 : 0) | (event.shiftKey ? 2 : 0) | (event.altKey ? 4 : 0);

function onKey(event) {
  if (!isPlaying || isTyping(event.target) || event.isComposing) return;
  if (event.target === Typing.field && Typing.writesLater(event)) return;
  // With the key of the system held, as on a Mac, the releases of other keys are not reported.
  if (event.metaKey || event.key === "Meta") return Program.call("web_focus_lost");
  // The browser keeps these keys.
  if (event.code === "F5" || event.code === "F11" || event.code === "F12") return;
  event.preventDefault();
  const isPressed = event.type === "keydown" ? 1 : 0;
  const character = [...event.key].length === 1 ? event.key.codePointAt(0) : 0;
  Program.call("web_key", event.code, event.key, isPressed, event.repeat ? 1 : 0, modifiers(event),
    character);
}

// If the browser refuses the capture, the mouse turns the player while it is over the canvas.
function capture() {
  wantsMouse = true;
  $("canvas").requestPointerLock?.()?.catch?.(() => {});
}
function release() {
  wantsMouse = false; // the browser may still be about to capture the mouse
  document.exitPointerLock?.();
}
function onCapture() {
  if (document.pointerLockElement === null) return void (isPlaying && Program.call("web_capture_lost"));
  if (!wantsMouse) document.exitPointerLock();
}

// Events of the mouse, because a pointer event does not report a second button that is pressed while
// one is held.
function onButton(event) {
  if (!isPlaying) return;
  event.preventDefault();
  const isPressed = event.type === "mousedown";
  if (isPressed) {
    Typing.focus();
    const isForWindow = Program.call("web_has_window_at", event.clientX, event.clientY) !== 0;
    if (document.pointerLockElement === null && !isForWindow) capture();
  }
  Program.call("web_button", event.button, isPressed ? 1 : 0);
}

function onMove(event) {
  const { clientX, clientY, movementX, movementY } = event;
  if (isPlaying) Program.call("web_mouse", clientX, clientY, movementX, movementY);
}

let wheelPixels = 0; // since the last step
function onWheel(event) {
  event.preventDefault();
  if (!isPlaying) return;
  const delta = event.deltaY || event.deltaX; // some systems turn the wheel while shift is held
  wheelPixels += event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? delta : Math.sign(delta) * WHEEL_STEP;
  if (Math.abs(wheelPixels) < WHEEL_STEP) return;
  Program.call("web_wheel", -Math.sign(wheelPixels));
  wheelPixels = 0;
}

function onTouch(event) {
  if (!isPlaying) return;
  event.preventDefault();
  document.body.classList.add("touch");
  const phase = { touchstart: 0, touchmove: 1, touchend: 2, touchcancel: 3 }[event.type];
  for (const { identifier, clientX, clientY } of event.changedTouches)
    Program.call("web_touch", identifier, phase, clientX, clientY);
  const { clientX, clientY } = event.changedTouches[0];
  if (event.type === "touchend" && Program.call("web_has_window_at", clientX, clientY) !== 0)
    Typing.touched(clientX, clientY);
}

// A button that is a key as long as it is held.
function heldKey(id, code) {
  const send = (isPressed) => (event) => {
    event.preventDefault();
    Program.call("web_key", code, "", isPressed, 0, 0, 0);
  };
  $(id).addEventListener("pointerdown", send(1));
  for (const type of ["pointerup", "pointercancel", "pointerleave"]) $(id).addEventListener(type, send(0));
}

function listen() {
  const canvas = $("canvas");
  window.addEventListener("keydown", onKey);
  window.addEventListener("keyup", onKey);
  canvas.addEventListener("mousedown", onButton);
  window.addEventListener("mouseup", onButton);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("mousemove", onMove);
  canvas.addEventListener("wheel", onWheel, { passive: false });
  for (const type of ["touchstart", "touchmove", "touchend", "touchcancel"])
    canvas.addEventListener(type, onTouch, { passive: false });
  // The press of the button has captured the mouse in the program already.
  document.addEventListener("pointerlockchange", onCapture);
  window.addEventListener("blur", () => Program.call("web_focus_lost"));
  window.addEventListener("resize", resize);
  window.addEventListener("beforeunload", (event) => {
    if (isPlaying && Program.call("web_unconfirmed") > 0) event.preventDefault();
  });
  window.addEventListener("pagehide", () => Program.call("web_leave"));
  // A page that the browser shows again from its history has sent a goodbye.
  window.addEventListener("pageshow", (event) => event.persisted && location.reload());
  $("say").addEventListener("keydown", (event) => {
    if (event.isComposing || (event.key !== "Enter" && event.key !== "Escape")) return;
    if (event.key === "Enter") Program.call("web_say", $("say").value);
    $("say").value = "";
    $("say").hidden = true;
    Typing.focus();
  });
  for (let slot = 0; slot < 9; ++slot) {
    const button = document.createElement("button");
    const number = document.createElement("span");
    number.textContent = slot + 1;
    button.append(number);
    button.onclick = () => {
      Program.call("web_choose_slot", slot);
      Typing.focus();
    };
    $("slots").append(button);
  }
  $("mode").onclick = () => {
    const removes = $("mode").classList.toggle("removes");
    $("mode").textContent = removes ? "remove" : "place";
    Program.call("web_tap_mode", removes ? 1 : 0);
  };
  heldKey("up", "Space");
  heldKey("down", "ShiftLeft");
  $("walk").onclick = () => Program.call("web_act", "walk_or_fly");
  for (const name of ["tools", "map", "rollback"]) $(name).onclick = () => Program.call("web_act", name);
  $("talk").onclick = page.openChat;
  $("all").onclick = page.togglePalette;
  $("past").onclick = page.toggleTimeline;
  $("moment").addEventListener("input", () => {
    clearTimeout(momentTimer);
    momentTimer = setTimeout(() => {
      momentTimer = 0;
      Program.call("web_show_moment", Number($("moment").value));
    }, MOMENT_MS);
  });
  const step = (steps) => () => {
    const [shown, newest] = [Number($("moment").value), Number($("moment").max)];
    Program.call("web_show_moment", Math.max(0, shown + steps * Math.max(1, Math.floor(newest / 100))));
  };
  $("earlier").onclick = step(-1);
  $("later").onclick = step(1);
  $("live").onclick = () => Program.call("web_show_moment", Number($("moment").max));
  if (window.matchMedia("(pointer: coarse)").matches) document.body.classList.add("touch");
}

async function begin() {
  $("name").value = kept("name") ?? "";
  $("quality").value = kept("quality") ?? "-1";
  $("sight").value = kept("sight") ?? "6";
  $("textures").value = kept("textures") ?? "1";
  $("join").addEventListener("submit", join);
  const lack = missing();
  if (lack) return fail(...lack);
  listen();
  resize();
  try {
    await loadProgram();
  } catch (error) {
    return fail("The client cannot be loaded", String(error));
  }
  $("step").textContent = "";
  $("enter").disabled = false;
  if ($("name").value === "") $("name").focus();
}

begin();
