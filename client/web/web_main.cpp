// runstone-web-client: the client in a browser. The page (page/client.js) calls the functions
// below. The browser calls turn() once a frame. A hidden page has no frames, so a worker
// (page/ticker.js) calls it there, and the connection lives.
#include <emscripten.h>
#include <emscripten/html5.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <sstream>
#include <string>

#include "client/input/action.hpp"
#include "client/input/dom_key.hpp"
#include "client/platform/canvas_context.hpp"
#include "client/play/time_travel.hpp"
#include "client/session/join_check.hpp"
#include "client/web/page.hpp"
#include "client/web/web_client.hpp"
#include "common/core/hex.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone {
namespace {

constexpr const char* kCanvas = "#canvas";
/// A page that is shown has frames at least this often.
constexpr TimeUs kShownUs = 250'000;

std::unique_ptr<Screen> screen;
std::unique_ptr<WebClient> client;  // null: nobody plays
TimeUs frame_us = 0;                // when the last frame began
ByteView buffered;                  // the bytes in the buffer of web_buffer()

EM_BOOL on_frame(double /*time_ms*/, void* /*unused*/) {
  frame_us = steady_now_us();
  if (client) client->turn(frame_us, true);
  return EM_TRUE;
}

EM_BOOL on_context_lost(int /*type*/, const void* /*reserved*/, void* /*unused*/) {
  if (client) client->leave();
  page_failed("The graphics driver has failed",
              "the context of WebGL 2 is lost; load the page again");
  return EM_TRUE;
}

/// Reads lines "WORLD KEY" in hex. Lines of another form are left out.
std::map<WorldId, PublicKey> read_pins(const char* text) {
  std::map<WorldId, PublicKey> out;
  std::istringstream in(text);
  std::string world, key;
  while (in >> world >> key) {
    WorldId world_id;
    PublicKey server_key;
    if (read_hex(world, world_id) && read_hex(key, server_key)) out[world_id] = server_key;
  }
  return out;
}

std::optional<Quality> quality_of(int level) {
  if (level < 0 || level > static_cast<int>(Quality::high)) return std::nullopt;
  return static_cast<Quality>(level);
}

/// Returns the text of a function that gives one to the page. It lives until the next call.
const char* kept(std::string text) {
  static std::string last;
  last = std::move(text);
  return last.c_str();
}

}  // namespace
}  // namespace runstone

using namespace runstone;

extern "C" {

/// Makes the context of WebGL 2. Ends the program if the browser gives none, so the page asks for
/// one before.
EMSCRIPTEN_KEEPALIVE void web_prepare() {
  screen = make_screen(make_canvas_context(kCanvas));
  emscripten_set_webglcontextlost_callback(kCanvas, nullptr, false, on_context_lost);
  emscripten_request_animation_frame_loop(on_frame, nullptr);
}

/// Joins the server. `seed` is the secret key of the player in hex, and `pins` has the known server
/// keys. `quality` is -1 for automatic. `has_cache`: the page keeps chunks; `cached_worlds` is as
/// for read_cached_worlds(). Returns why the player cannot join like this, or an empty text.
EMSCRIPTEN_KEEPALIVE const char* web_join(const char* url, const char* name, const char* ticket,
                                          const char* seed, int is_key_kept, const char* pins,
                                          int view_radius, int far_levels, int quality,
                                          int shows_textures, int has_cache,
                                          const char* cached_worlds) {
  if (const auto checked = check_player_name(name); !checked) return kept(checked.error());
  if (const auto checked = check_ticket(ticket); !checked) return kept(checked.error());
  JoinOptions options;
  if (!read_hex(seed, options.seed)) return kept("the key that this browser keeps is damaged");
  options.url = url;
  options.name = name;
  options.ticket = ticket;
  options.is_key_kept = is_key_kept != 0;
  options.pinned = read_pins(pins);
  options.view_radius = static_cast<std::uint8_t>(std::clamp(view_radius, 2, 16));
  options.view_radius_v = static_cast<std::uint8_t>((options.view_radius + 1) / 2);
  options.far_levels = static_cast<std::uint8_t>(std::clamp(far_levels, 0, 5));
  options.quality = quality_of(quality);
  options.shows_textures = shows_textures != 0;
  options.has_cache = has_cache != 0;
  options.cached_worlds = read_cached_worlds(cached_worlds);
  client = std::make_unique<WebClient>(options, *screen);
  return kept("");
}

/// The page calls it while it is hidden. Does nothing if the page has frames.
EMSCRIPTEN_KEEPALIVE void web_tick() {
  const TimeUs now_us = steady_now_us();
  if (client && now_us - frame_us > kShownUs) client->turn(now_us, false);
}

/// Returns the number of the player's edits that are not on the server's disk yet.
EMSCRIPTEN_KEEPALIVE int web_unconfirmed() {
  return client ? static_cast<int>(client->play().session().replica().local_edits().all().size())
                : 0;
}

EMSCRIPTEN_KEEPALIVE void web_leave() {
  if (client) client->leave();
}

EMSCRIPTEN_KEEPALIVE void web_resize(int width, int height, double page_width, double page_height) {
  if (client) client->set_size({std::max(width, 1), std::max(height, 1)}, page_width, page_height);
}

/// `modifiers`: 1 control, 2 shift, 4 alt. `character` is the one that the key types, or 0.
EMSCRIPTEN_KEEPALIVE void web_key(const char* code, const char* text, int is_pressed, int is_repeat,
                                  int modifiers, std::uint32_t character) {
  if (!client) return;
  KeyEvent event;
  event.place = key_of_code(code);
  event.key = key_of_text(text, event.place);
  event.is_pressed = is_pressed != 0;
  event.is_repeat = is_repeat != 0;
  event.control = (modifiers & 1) != 0;
  event.shift = (modifiers & 2) != 0;
  event.alt = (modifiers & 4) != 0;
  client->play().input().push({event});
  // Control and alt together are the key AltGr of some systems.
  if (event.is_pressed && character != 0 && event.control == event.alt)
    client->play().input().push({CharacterEvent{static_cast<char32_t>(character)}});
}

/// A character that no key has typed, such as one of an input method.
EMSCRIPTEN_KEEPALIVE void web_character(std::uint32_t character) {
  if (client) client->play().input().push({CharacterEvent{static_cast<char32_t>(character)}});
}

/// `x` and `y` are a place of the page.
EMSCRIPTEN_KEEPALIVE void web_mouse(double x, double y, double dx, double dy) {
  if (client) client->move_mouse(x, y, dx, dy);
}

/// Returns 1 if a window is at this place of the page: the mouse is the window's there.
EMSCRIPTEN_KEEPALIVE int web_has_window_at(double x, double y) {
  return client && client->has_window_at(x, y) ? 1 : 0;
}

/// Takes the font of the windows: the bytes in the buffer of web_buffer().
EMSCRIPTEN_KEEPALIVE void web_font() {
  if (client) client->set_font(buffered);
}

/// Carries out an action by its name, see action_table().
EMSCRIPTEN_KEEPALIVE void web_act(const char* name) {
  for (const ActionInfo& info : action_table()) {
    if (client && info.name == name) client->act(info.action);
  }
}

/// `button` as in MouseEvent.button.
EMSCRIPTEN_KEEPALIVE void web_button(int button, int is_pressed) {
  if (!client || button < 0 || button > 2) return;
  constexpr MouseButton kButtons[] = {MouseButton::left, MouseButton::middle, MouseButton::right};
  client->play().input().push({ButtonEvent{kButtons[button], is_pressed != 0}});
}

EMSCRIPTEN_KEEPALIVE void web_wheel(double steps) {
  if (client) client->play().input().push({WheelEvent{steps}});
}

/// The browser has freed the mouse.
EMSCRIPTEN_KEEPALIVE void web_capture_lost() {
  if (client) client->capture(false);
}

EMSCRIPTEN_KEEPALIVE void web_focus_lost() {
  if (client) client->play().input().push({FocusEvent{false}});
}

/// `phase`: 0 begins, 1 moves, 2 ends, 3 all touches are cancelled.
EMSCRIPTEN_KEEPALIVE void web_touch(int id, int phase, double x, double y) {
  if (client) client->touch(id, phase, x, y);
}

EMSCRIPTEN_KEEPALIVE void web_tap_mode(int removes) {
  if (client) client->set_tap_mode(removes != 0 ? TapMode::remove : TapMode::place);
}

EMSCRIPTEN_KEEPALIVE void web_choose_slot(int slot) {
  if (client && slot >= 0) client->play().hotbar().choose(static_cast<std::size_t>(slot));
}

EMSCRIPTEN_KEEPALIVE void web_hold(int material) {
  if (client && material > 0 && static_cast<std::size_t>(material) < kMaterialCountMax)
    client->play().hotbar().hold(static_cast<Material>(material), steady_now_us());
}

EMSCRIPTEN_KEEPALIVE void web_say(const char* line) {
  if (client) client->play().chat().send(line);
}

/// Shows the world after an edit, or the live world for the newest edit and beyond.
EMSCRIPTEN_KEEPALIVE void web_show_moment(double seq) {
  if (client && seq >= 0 && seq <= static_cast<double>(kSequenceShownMax))
    show_after(client->play().session(), static_cast<Sequence>(seq));
}

/// Returns the address of so many bytes, for the functions that take bytes. They live until the next
/// call.
EMSCRIPTEN_KEEPALIVE std::uint8_t* web_buffer(int bytes) {
  static Bytes buffer;
  buffer.resize(static_cast<std::size_t>(std::max(bytes, 1)));
  buffered = ByteView(buffer).first(static_cast<std::size_t>(std::max(bytes, 0)));
  return buffer.data();
}

// The chunk cache, see WebCache.

/// Gives the record in the buffer to the oldest lookup. Returns 0 if the lookup takes no more.
EMSCRIPTEN_KEEPALIVE int web_cache_found(int index) {
  WebCache* const cache = client ? client->cache() : nullptr;
  return cache != nullptr && cache->found(static_cast<std::size_t>(index), buffered) ? 1 : 0;
}

EMSCRIPTEN_KEEPALIVE void web_cache_looked_up() {
  if (client && client->cache() != nullptr) client->cache()->looked_up();
}

EMSCRIPTEN_KEEPALIVE void web_cache_kept(int rows, int evicted) {
  if (client && client->cache() != nullptr)
    client->cache()->kept(static_cast<std::size_t>(rows), static_cast<std::size_t>(evicted));
}

EMSCRIPTEN_KEEPALIVE void web_cache_dropped(int rows) {
  if (client && client->cache() != nullptr)
    client->cache()->dropped(static_cast<std::size_t>(rows));
}

EMSCRIPTEN_KEEPALIVE void web_cache_failed() {
  if (client && client->cache() != nullptr) client->cache()->fail();
}

// The texture cache, see WebTextures.

/// Gives the picture in the buffer to the oldest lookup.
EMSCRIPTEN_KEEPALIVE void web_texture_found(int index) {
  if (client) client->network().textures().found(static_cast<std::size_t>(index), buffered);
}

EMSCRIPTEN_KEEPALIVE void web_textures_looked_up() {
  if (client) client->network().textures().looked_up();
}

// For tests and measurements.

EMSCRIPTEN_KEEPALIVE void web_camera(double x, double y, double z, double yaw, double pitch,
                                     int is_exact) {
  if (client) client->set_camera({x, y, z}, yaw, pitch, is_exact != 0);
}

/// Returns the material at a voxel, or -1 if it is not known.
EMSCRIPTEN_KEEPALIVE int web_voxel(int x, int y, int z) {
  const auto shown = client ? client->play().session().replica().shown_at({x, y, z}) : std::nullopt;
  return shown ? static_cast<int>(*shown) : -1;
}

EMSCRIPTEN_KEEPALIVE const char* web_state() {
  if (!client) return kept("{}");
  const Play& play = client->play();
  const WorldPos& eye = play.player().eye();
  const auto sight = play.tool().pick();
  char text[512];
  std::snprintf(
      text, sizeof text,
      "{\"connected\": %s, \"complete\": %s, \"x\": %.3f, \"y\": %.3f, \"z\": %.3f, "
      "\"walking\": %s, \"held\": %d, \"meshed\": %llu, \"frames\": %llu, \"sight\": %s",
      client->network().is_connected() ? "true" : "false", client->is_complete() ? "true" : "false",
      eye.x, eye.y, eye.z, play.player().is_walking() ? "true" : "false", play.player().held(),
      static_cast<unsigned long long>(play.pipeline().meshed_count()),
      static_cast<unsigned long long>(play.pipeline().frames_presented()), sight ? "[" : "null}");
  std::string out = text;
  if (sight) {
    out += std::to_string(sight->voxel.x) + ", " + std::to_string(sight->voxel.y) + ", " +
           std::to_string(sight->voxel.z) + ", " + std::to_string(sight->material) + "]}";
  }
  return kept(std::move(out));
}

/// Returns what the windows show, and the number of ghosts.
EMSCRIPTEN_KEEPALIVE const char* web_windows() {
  if (!client) return kept("{}");
  const ShownPanels shown = client->shown_panels();
  const Play& play = client->play();
  std::vector<GhostChunk> others;
  play.others_previews().append_ghosts(others);
  HudState state;
  play.fill(state, shown);
  const auto word = [](bool is_true) {
    return is_true ? std::string("true") : std::string("false");
  };
  return kept("{\"captured\": " + word(state.is_captured) + ", \"map\": " + word(shown.map) +
              ", \"rollback\": " + word(shown.rollback) + ", \"library\": " + word(shown.library) +
              ", \"tools\": " + word(shown.tools) + ", \"tool\": \"" +
              std::string(state.tools->tool().name()) + "\", \"tiles\": " +
              std::to_string(state.map.map == nullptr ? 0 : state.map.map->tiles().size()) +
              ", \"phase\": " + std::to_string(static_cast<int>(state.rollback.phase)) +
              ", \"voxels\": " + std::to_string(state.rollback.voxels) +
              ", \"ghosts\": " + std::to_string(play.panels().rollback().ghosts().size()) +
              ", \"others\": " + std::to_string(others.size()) + "}");
}

/// Returns the text of the field of a window that has the keyboard, or an empty one.
EMSCRIPTEN_KEEPALIVE const char* web_field() {
  return kept(client ? client->field_text() : std::string());
}

EMSCRIPTEN_KEEPALIVE const char* web_report() {
  return kept(client ? client->report_json() : std::string("{}"));
}

}  // extern "C"
