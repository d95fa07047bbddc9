// The functions of client/web/page.hpp: they pass their arguments on to Module.page (client.js).
// Emscripten 3.1 takes functions apart as text, and knows no arrows.
"use strict";
mergeInto(LibraryManager.library, {
  page_progress: function (text, share, detail) {
    Module.page.progress(UTF8ToString(text), share, UTF8ToString(detail));
  },
  page_joined: function () {
    Module.page.joined();
  },
  page_state: function (text) {
    Module.page.state(UTF8ToString(text));
  },
  page_failed: function (headline, detail) {
    Module.page.failed(UTF8ToString(headline), UTF8ToString(detail));
  },
  page_notice: function (text, isWarning) {
    Module.page.notice(UTF8ToString(text), isWarning !== 0);
  },
  page_chat: function (text, id) {
    Module.page.chat(UTF8ToString(text), UTF8ToString(id));
  },
  page_withdraw_chat: function (id) {
    Module.page.withdrawChat(UTF8ToString(id));
  },
  page_open_chat: function () {
    Module.page.openChat();
  },
  page_clear_materials: function () {
    Module.page.clearMaterials();
  },
  page_material: function (id, name, colour) {
    Module.page.material(id, UTF8ToString(name), colour);
  },
  page_toggle_palette: function () {
    Module.page.togglePalette();
  },
  page_slot: function (slot, material, isChosen) {
    Module.page.slot(slot, material, isChosen !== 0);
  },
  page_players: function (count, names) {
    Module.page.players(count, UTF8ToString(names));
  },
  page_walking: function (isWalking) {
    Module.page.walking(isWalking !== 0);
  },
  page_capture: function (isCaptured) {
    Module.page.capture(isCaptured !== 0);
  },
  page_typing: function (isTyping) {
    Module.page.typing(isTyping !== 0);
  },
  page_load_font: function () {
    Module.page.loadFont();
  },
  page_keep_server: function (world, key) {
    Module.page.keepServer(UTF8ToString(world), UTF8ToString(key));
  },
  page_keep_kit: function (world, line) {
    Module.page.keepKit(UTF8ToString(world), UTF8ToString(line));
  },
  page_read_kit: function (world, out, bytes) {
    var line = Module.page.readKit(UTF8ToString(world));
    stringToUTF8(lengthBytesUTF8(line) < bytes ? line : "", out, bytes);
  },
  page_toggle_timeline: function () {
    Module.page.toggleTimeline();
  },
  page_time: function (newest, shown, isPast) {
    Module.page.time(newest, shown, isPast !== 0);
  },
  page_cache_enter: function (world, text) {
    Module.chunks.enter(UTF8ToString(world), UTF8ToString(text));
  },
  page_cache_drop_rows: function (world, all, edited, lost, tiles, common, epoch) {
    Module.chunks.dropRows(UTF8ToString(world), all !== 0, edited !== 0, lost !== 0, tiles !== 0, common, epoch >>> 0);
  },
  page_cache_drop_row: function (world, level, x, y, z) {
    Module.chunks.dropRow(UTF8ToString(world), level, x, y, z);
  },
  page_cache_find: function (world, keys, count) {
    var list = [];
    for (var i = keys >> 2; i < (keys >> 2) + 4 * count; i += 4)
      list.push([HEAP32[i], HEAP32[i + 1], HEAP32[i + 2], HEAP32[i + 3]]);
    Module.chunks.find(UTF8ToString(world), list);
  },
  page_cache_keep: function (world, rows, bytes) {
    Module.chunks.keep(UTF8ToString(world), HEAPU8.slice(rows, rows + bytes));
  },
  page_textures_find: function (hashes, count) {
    Module.textures.find(HEAPU8.slice(hashes, hashes + 32 * count));
  },
  page_textures_keep: function (rows, bytes) {
    Module.textures.keep(HEAPU8.slice(rows, rows + bytes));
  },
});
