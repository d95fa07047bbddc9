'use strict';
// The map: tiles on a canvas. World coordinates are voxels, x to the right and z down. A tile is kept
// with its ETag, so a request for another moment costs nothing where nothing changed.
const GLOW_MS = 5000, TILES_MAX = 400, LOADS_MAX = 6, STEP_MS = 150, STEPS = 200;
const BORDER_POLLS = 30;  // polls of state.json between two requests of the border
const el = (id) => document.getElementById(id);
const canvas = el('map'), draw = canvas.getContext('2d');
const view = {x: 0, z: 0, scale: 1};  // the middle, and CSS pixels of a voxel
let state = null;                     // the newest answer of state.json
let at = null;                        // the sequence that is shown; null: the present
let playing = false;
const tiles = new Map();              // by "zoom/x/z"
const glows = new Map();              // by "x/z" of a column of chunks
let players = [], loads = 0, clock = 0, isDue = false;
let border = {}, polls = 0;           // of the world, and how often state.json was asked for

function say(words) { el('words').textContent = words; }

function redraw() {
  if (isDue) return;
  isDue = true;
  requestAnimationFrame(() => { isDue = false; paint(); });
}

// Tiles ------------------------------------------------------------------------------------------

function zoomOfView() {
  const voxelsPerPixel = 1 / (view.scale * devicePixelRatio);
  return Math.min(state.zoom_max, Math.max(0, Math.floor(Math.log2(voxelsPerPixel) + 0.3)));
}

function tileAt(zoom, x, z) {
  const key = zoom + '/' + x + '/' + z;
  let tile = tiles.get(key);
  if (!tile) {
    tile = {key, picture: null, etag: '', shown: undefined, isLoading: false, used: 0, again: 0};
    tiles.set(key, tile);
  }
  tile.used = ++clock;
  return tile;
}

// A tile of the present is up to date until state.json names a change in it.
function isCurrent(tile) { return tile.shown === (at === null ? 'now' : at); }

async function load(tile) {
  const wanted = at === null ? 'now' : at;
  tile.isLoading = true;
  tile.isDirty = false;
  ++loads;
  try {
    const headers = tile.etag ? {'If-None-Match': tile.etag} : {};
    const answer = await fetch('map/tile/' + tile.key + '.png' + (at === null ? '' : '?at=' + at),
                               {headers, cache: 'no-store'});
    if (answer.status === 200) {
      const picture = await createImageBitmap(await answer.blob());
      if (tile.picture) tile.picture.close();
      tile.picture = picture;
      tile.etag = answer.headers.get('ETag') || '';
    }
    if (answer.status === 200 || answer.status === 304) {
      tile.shown = tile.isDirty ? undefined : wanted;
    } else if (answer.status === 429 || answer.status === 503) {
      tile.again = performance.now() + 1500;
      setTimeout(redraw, 1600);
    } else {
      tile.shown = wanted;
      say(await answer.text());
    }
  } catch (error) {
    tile.again = performance.now() + 3000;
    setTimeout(redraw, 3100);
  }
  tile.isLoading = false;
  --loads;
  redraw();
}

function forgetOldTiles() {
  if (tiles.size <= TILES_MAX) return;
  const oldest = [...tiles.values()].filter((t) => !t.isLoading).sort((a, b) => a.used - b.used);
  for (const tile of oldest.slice(0, tiles.size - TILES_MAX)) {
    if (tile.picture) tile.picture.close();
    tiles.delete(tile.key);
  }
}

// Draws what is there of a tile: itself, or the part of a tile that is less detailed.
function paintTile(zoom, x, z, left, top, side) {
  let part = 1, px = 0, pz = 0;
  for (let n = zoom; n <= state.zoom_max; ++n) {
    const tile = tiles.get(n + '/' + x + '/' + z);
    if (tile && tile.picture) {
      const size = state.tile * part;
      draw.drawImage(tile.picture, px * state.tile, pz * state.tile, size, size, left, top, side, side);
      return;
    }
    part /= 2;
    px = (px + (x & 1)) / 2;
    pz = (pz + (z & 1)) / 2;
    x >>= 1;
    z >>= 1;
  }
}

function paintTiles(width, height) {
  const zoom = zoomOfView(), voxels = state.tile << zoom;
  const first = [Math.floor((view.x - width / 2 / view.scale) / voxels),
                 Math.floor((view.z - height / 2 / view.scale) / voxels)];
  const last = [Math.floor((view.x + width / 2 / view.scale) / voxels),
                Math.floor((view.z + height / 2 / view.scale) / voxels)];
  const wanted = [], side = voxels * view.scale;
  draw.imageSmoothingEnabled = side < state.tile;
  for (let z = first[1]; z <= last[1]; ++z) {
    for (let x = first[0]; x <= last[0]; ++x) {
      const left = Math.round((x * voxels - view.x) * view.scale + width / 2);
      const top = Math.round((z * voxels - view.z) * view.scale + height / 2);
      paintTile(zoom, x, z, left, top, Math.ceil(side));
      const tile = tileAt(zoom, x, z);
      if (!isCurrent(tile) && !tile.isLoading && tile.again < performance.now()) wanted.push(tile);
      tile.far = Math.hypot(x * voxels + voxels / 2 - view.x, z * voxels + voxels / 2 - view.z);
    }
  }
  wanted.sort((a, b) => a.far - b.far);
  for (const tile of wanted) if (loads < LOADS_MAX) load(tile);
  forgetOldTiles();
  return wanted.length === 0 && loads === 0;
}

// Everything over the tiles ----------------------------------------------------------------------

function toScreen(x, z) {
  return [(x - view.x) * view.scale + canvas.clientWidth / 2,
          (z - view.z) * view.scale + canvas.clientHeight / 2];
}

function paintGlows() {
  const now = performance.now();
  for (const [key, glow] of glows) {
    const age = (now - glow.since) / GLOW_MS;
    if (age >= 1) { glows.delete(key); continue; }
    const [left, top] = toScreen(glow.x * state.edge, glow.z * state.edge);
    const side = Math.max(6, state.edge * view.scale);
    draw.globalAlpha = (1 - age) * 0.8;
    draw.strokeStyle = '#ffd76a';
    draw.lineWidth = 2;
    draw.strokeRect(left, top, side, side);
    draw.fillStyle = '#ffd76a';
    draw.globalAlpha = (1 - age) * 0.25;
    draw.fillRect(left, top, side, side);
    draw.globalAlpha = 1;
  }
  if (glows.size) setTimeout(redraw, 50);
}

function label(text, x, y) {
  draw.font = '13px sans-serif';
  draw.lineWidth = 3;
  draw.strokeStyle = '#000c';
  draw.strokeText(text, x, y);
  draw.fillStyle = '#fff';
  draw.fillText(text, x, y);
}

function paintBorder() {
  draw.strokeStyle = '#f26b4c';
  draw.lineWidth = 2;
  if (border.circle) {
    const [x, z, radius] = border.circle, [left, top] = toScreen(x + 0.5, z + 0.5);
    draw.beginPath();
    draw.arc(left, top, (radius + 0.5) * view.scale, 0, 2 * Math.PI);
    draw.stroke();
  } else if (border.box) {
    const [left, top] = toScreen(border.box[0], border.box[1]);
    const [right, bottom] = toScreen(border.box[2], border.box[3]);
    draw.strokeRect(left, top, right - left, bottom - top);
  }
}

function paintPlayers() {
  for (const [name, x, , z] of players) {
    const [left, top] = toScreen(x, z);
    draw.beginPath();
    draw.arc(left, top, 5, 0, 2 * Math.PI);
    draw.fillStyle = '#4cc2f2';
    draw.fill();
    draw.lineWidth = 2;
    draw.strokeStyle = '#fff';
    draw.stroke();
    label(name, left + 9, top + 4);
  }
}

let isComplete = false;  // every tile of the view shows the wanted moment

function paint() {
  const width = canvas.clientWidth, height = canvas.clientHeight, ratio = devicePixelRatio;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  draw.setTransform(ratio, 0, 0, ratio, 0, 0);
  draw.fillStyle = '#15171a';
  draw.fillRect(0, 0, width, height);
  if (!state) return;
  isComplete = paintTiles(width, height);
  if (at === null) {
    paintBorder();
    paintGlows();
    paintPlayers();
  }
}

// The server's news ------------------------------------------------------------------------------

function tileChanged(x, z) {
  // A tile also depends on the columns west and north of it.
  for (let zoom = 0; zoom <= state.zoom_max; ++zoom) {
    const columns = state.tile / state.edge, cx = x >> zoom, cz = z >> zoom;
    for (const tx of new Set([Math.floor(cx / columns), Math.floor((cx + 1) / columns)])) {
      for (const tz of new Set([Math.floor(cz / columns), Math.floor((cz + 1) / columns)])) {
        const tile = tiles.get(zoom + '/' + tx + '/' + tz);
        if (!tile) continue;
        if (tile.shown === 'now') tile.shown = undefined;
        tile.isDirty = true;
      }
    }
  }
}

async function poll() {
  try {
    const answer = await fetch('map/state.json' + (state ? '?since=' + state.seq : ''),
                               {cache: 'no-store'});
    if (!answer.ok) {
      if (answer.status !== 429) say(await answer.text());
    } else {
      const news = await answer.json(), isFirst = !state;
      const isOther = state && news.seq < state.seq;
      state = news;
      say(news.lacks_edits ? 'Edits of this world are missing. The map shows what is left.' : '');
      if (isFirst) begin();
      if (isOther || !news.is_complete) {
        for (const tile of tiles.values()) {
          tile.shown = undefined;
          tile.isDirty = true;
          if (isOther) tile.etag = '';
        }
      }
      for (const [x, z] of news.changed) {
        tileChanged(x, z);
        glows.set(x + '/' + z, {x, z, since: performance.now()});
      }
      showTime();
      const list = await fetch('map/players.json', {cache: 'no-store'});
      players = list.ok ? await list.json() : [];
      if (isFirst || ++polls % BORDER_POLLS === 0) {
        const bounds = await fetch('map/border.json', {cache: 'no-store'});
        border = bounds.ok ? await bounds.json() : {};
      }
      redraw();
    }
  } catch (error) {
    say('The gateway does not answer. The map goes on when it is back.');
  }
  setTimeout(poll, 1000);
}

const LIMIT = 2 ** 29;  // voxels from the origin

/// Returns the nearest scale that the map can show, in pixels a voxel.
function scaleOf(wanted) {
  return Math.min(16, Math.max(0.5 / (1 << state.zoom_max), wanted));
}

function begin() {
  const hash = location.hash.slice(1).split(',').map(Number);
  const box = state.bounds;
  if (hash.length >= 3 && hash.slice(0, 3).every(Number.isFinite) && hash[2] > 0) {
    [view.x, view.z] = hash.slice(0, 2).map((one) => Math.max(-LIMIT, Math.min(LIMIT, one)));
    view.scale = scaleOf(hash[2]);
    if (Number.isSafeInteger(hash[3]) && state.look_back) show(hash[3]);
  } else if (box) {
    // A small world fills the window.
    const fit = Math.min(canvas.clientWidth / (box[2] - box[0]), canvas.clientHeight / (box[3] - box[1]));
    view.scale = Math.min(2, Math.max(0.25, 0.8 * fit));
    const inBox = state.spawn[0] >= box[0] && state.spawn[0] < box[2] && state.spawn[1] >= box[1] &&
                  state.spawn[1] < box[3];
    view.x = inBox ? state.spawn[0] : (box[0] + box[2]) / 2;
    view.z = inBox ? state.spawn[1] : (box[1] + box[3]) / 2;
  } else {
    [view.x, view.z] = state.spawn;
  }
  el('time').hidden = !state.look_back;
  redraw();
}

// Time -------------------------------------------------------------------------------------------

let whenOf = null;  // the sequence whose time is shown or asked for

function timeText(ms) { return new Date(ms).toISOString().replace('T', ' ').slice(0, 19); }

async function showTime() {
  if (!state.look_back) return;
  const slider = el('moment'), shown = at === null ? state.last.seq : at;
  slider.min = state.first.seq;
  slider.max = state.last.seq;
  slider.value = shown;
  el('time').classList.toggle('past', at !== null);
  el('play').textContent = playing ? 'Pause' : 'Play';
  if (whenOf === shown) return;
  whenOf = shown;
  if (at === null) {
    el('when').textContent = state.last.time_ms ? timeText(state.last.time_ms) : '';
    return;
  }
  try {
    const answer = await fetch('map/moment.json?seq=' + shown, {cache: 'no-store'});
    if (!answer.ok) throw new Error(answer.status);
    const moment = await answer.json();
    if (whenOf === shown)
      el('when').textContent = moment.seq ? timeText(moment.time_ms) : 'before the first edit';
  } catch (error) {
    if (whenOf === shown) whenOf = null;  // it is asked for again
  }
}

function show(seq) {
  at = seq >= state.last.seq ? null : Math.max(seq, state.first.seq);
  if (at === null) playing = false;
  hideBuilders();  // they are those of the moment before
  showTime();
  remember();
  redraw();
}

function play() {
  if (!playing) return;
  const step = Math.max(1, Math.ceil((state.last.seq - state.first.seq) / STEPS));
  if (isComplete) show((at === null ? state.first.seq : at) + step);
  if (playing) setTimeout(play, STEP_MS);
}

el('moment').addEventListener('input', (event) => { playing = false; show(Number(event.target.value)); });
el('now').addEventListener('click', () => { playing = false; show(state.last.seq); });
el('play').addEventListener('click', () => {
  playing = !playing;
  if (playing && at === null) show(state.first.seq);
  showTime();
  play();
});

// Who built it -----------------------------------------------------------------------------------

function line(tag, text, parent) {
  const made = document.createElement(tag);
  made.textContent = text;
  parent.append(made);
  return made;
}

let looks = 0;  // at builders; the answer of an older one is ignored

function hideBuilders() {
  ++looks;
  el('builders').hidden = true;
}

async function showBuilders(x, z) {
  if (!state.look_back) return;
  const look = ++looks;
  const answer = await fetch('map/builders.json?x=' + x + '&z=' + z + (at === null ? '' : '&at=' + at),
                             {cache: 'no-store'});
  if (look !== looks) return;
  const panel = el('builders'), list = panel.querySelector('ol'), title = panel.querySelector('h2');
  list.replaceChildren();
  panel.hidden = false;
  if (!answer.ok) { title.textContent = await answer.text(); return; }
  const told = await answer.json();
  title.textContent = told.material ? told.material + ' at ' + [x, told.y, z].join(' ')
                                    : 'nothing at ' + x + ' ' + z;
  if (!told.edits.length) line('li', 'Nobody has built here.', list);
  for (const edit of told.edits) {
    const item = line('li', '', list);
    line('b', edit.author, item);
    line('span', ' ' + edit.what + ' ', item);
    line('time', edit.time.replace('T', ' ').replace('Z', ''), item);
    line('code', edit.undo, item).title = 'An operator takes it back with this command.';
  }
}

el('close').addEventListener('click', hideBuilders);

// Pointer and keys -------------------------------------------------------------------------------

const pointers = new Map();
let moved = 0;

function remember() {
  const place = [Math.round(view.x), Math.round(view.z), Number(view.scale.toPrecision(4))];
  history.replaceState(null, '', '#' + place.concat(at === null ? [] : [at]).join(','));
}

function zoomBy(factor, x, y) {
  if (!state) return;
  const scale = scaleOf(view.scale * factor);
  const dx = x - canvas.clientWidth / 2, dy = y - canvas.clientHeight / 2;
  view.x += dx / view.scale - dx / scale;
  view.z += dy / view.scale - dy / scale;
  view.scale = scale;
  remember();
  redraw();
}

function zoomMiddle(factor) { zoomBy(factor, canvas.clientWidth / 2, canvas.clientHeight / 2); }

function moveBy(dx, dy) {
  view.x -= dx / view.scale;
  view.z -= dy / view.scale;
  remember();
  redraw();
}

canvas.addEventListener('pointerdown', (event) => {
  canvas.setPointerCapture(event.pointerId);
  canvas.classList.add('drag');
  if (!pointers.size) moved = 0;
  pointers.set(event.pointerId, event);
});
canvas.addEventListener('pointermove', (event) => {
  if (state) {
    const x = Math.floor(view.x + (event.offsetX - canvas.clientWidth / 2) / view.scale);
    const z = Math.floor(view.z + (event.offsetY - canvas.clientHeight / 2) / view.scale);
    el('place').textContent = 'x ' + x + '  z ' + z;
  }
  const before = pointers.get(event.pointerId);
  if (!before) return;
  const dx = event.clientX - before.clientX, dy = event.clientY - before.clientY;
  moved += Math.abs(dx) + Math.abs(dy);
  if (pointers.size === 1) {
    moveBy(dx, dy);
  } else if (pointers.size === 2) {
    const other = [...pointers.values()].find((p) => p.pointerId !== event.pointerId);
    const far = (p) => Math.hypot(p.clientX - other.clientX, p.clientY - other.clientY);
    moveBy(dx / 2, dy / 2);
    if (far(before) > 0) {
      zoomBy(far(event) / far(before), (event.clientX + other.clientX) / 2,
             (event.clientY + other.clientY) / 2);
    }
  }
  pointers.set(event.pointerId, event);
});
function release(event) {
  const wasClick = pointers.size === 1 && pointers.has(event.pointerId) && moved < 6;
  pointers.delete(event.pointerId);
  if (!pointers.size) canvas.classList.remove('drag');
  if (event.type === 'pointerup' && wasClick && state) {
    showBuilders(Math.floor(view.x + (event.offsetX - canvas.clientWidth / 2) / view.scale),
                 Math.floor(view.z + (event.offsetY - canvas.clientHeight / 2) / view.scale));
  }
}
canvas.addEventListener('pointerup', release);
canvas.addEventListener('pointercancel', release);
canvas.addEventListener('wheel', (event) => {
  event.preventDefault();
  zoomBy(Math.pow(2, -event.deltaY / 300), event.offsetX, event.offsetY);
}, {passive: false});
canvas.addEventListener('keydown', (event) => {
  const keys = {ArrowLeft: [60, 0], ArrowRight: [-60, 0], ArrowUp: [0, 60], ArrowDown: [0, -60]};
  if (keys[event.key]) moveBy(...keys[event.key]);
  if (event.key === '+') zoomMiddle(1.5);
  if (event.key === '-') zoomMiddle(1 / 1.5);
});
el('in').addEventListener('click', () => zoomMiddle(1.5));
el('out').addEventListener('click', () => zoomMiddle(1 / 1.5));
addEventListener('resize', redraw);
poll();
