// WebClient: the browser client while it plays on a server. It is the counterpart of Client
// (client/app): both make the turns of a Play. It has one thread: turn() runs once a frame and does
// in slices what the desktop client does on several threads. Thread: the page's only one.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/display/draw_queue.hpp"
#include "client/input/touch_pad.hpp"
#include "client/play/play.hpp"
#include "client/tools/tool_box.hpp"
#include "client/web/join_options.hpp"
#include "client/web/web_hud.hpp"
#include "client/web/web_session.hpp"
#include "client/web/web_windows.hpp"

namespace runstone {

class WebClient {
 public:
  /// `screen` must outlive the client.
  WebClient(const JoinOptions& options, Screen& screen);

  /// Handles what was received, and draws a frame if one is due. `draws` is true if the page is
  /// visible.
  void turn(TimeUs now_us, bool draws);
  /// Sends a goodbye to the server and ends the play.
  void leave();

  /// Begins, moves, ends or cancels a touch (`phase` is 0 to 3), at a place of the page. A touch
  /// that begins on a window is a mouse for this window.
  void touch(int id, int phase, double x, double y);
  void set_tap_mode(TapMode mode) { touch_.set_mode(mode); }
  /// Queues a movement of the mouse to a place of the page.
  void move_mouse(double x, double y, double dx, double dy);
  /// Returns true if a window is at this place of the page.
  bool has_window_at(double x, double y) const;
  /// Captures the mouse, or frees it.
  void capture(bool is_captured);
  /// Sets the size of the canvas in pixels, and in those of the page.
  void set_size(std::array<int, 2> pixels, double page_width, double page_height);
  /// Takes the font of the windows.
  void set_font(ByteView font);
  void act(Action action);
  Play& play() { return play_; }
  /// Returns null without a cache.
  WebCache* cache() { return network_.cache(); }

  /// Moves the eye. `is_exact`: frames then depend on the world and the camera only, for
  /// comparisons; nothing in them follows the clock.
  void set_camera(const WorldPos& eye, double yaw, double pitch, bool is_exact);

  /// Returns true if the view is complete, meshed and on the screen.
  bool is_complete() const;
  ShownPanels shown_panels() const { return windows_.shown(); }
  /// See UiContext.
  std::string field_text() const { return windows_.field_text(); }
  const WebSession& network() const { return network_; }
  WebSession& network() { return network_; }
  /// Returns the measurements so far as the JSON of ClientReport.
  std::string report_json() const;

 private:
  /// Returns what the windows show of the world and the player.
  HudState hud_state() const;
  /// Makes the windows of a frame, and carries out what the user did in them.
  std::shared_ptr<const OverlayFrame> make_windows(TimeUs now_us);
  void flush(TimeUs now_us);
  void handle_input(TimeUs now_us);
  /// Frees the mouse for windows that were opened, and captures it again when they are closed.
  void share_mouse();
  /// Tells the page whether a field of a window has the keyboard.
  void share_keyboard();
  /// Meshes until this time, one chunk at least.
  void mesh_until(TimeUs until_us);
  void draw(TimeUs now_us);
  /// Shows the progress of joining, or the state while playing.
  void show_state(TimeUs now_us);
  /// Returns a line about the state while playing.
  std::string playing_text() const;
  void keep_server_key();

  Screen& screen_;
  WebSession network_;
  ClientSession& session_;  // of network_
  DrawQueue queue_{nullptr};
  ToolBox tools_;
  PlayLog log_;  // nothing is logged
  Play play_;
  MeshPipeline& pipeline_;  // of play_
  TouchPad touch_;
  WebWindows windows_;
  WebHud hud_;

  std::array<int, 2> size_{640, 360};  // of the canvas, pixels
  double page_width_ = 640;            // of the canvas, pixels of the page
  std::optional<int> window_touch_;    // the touch that began on a window
  bool types_ = false;                 // the page knows that a field of a window has the keyboard
  TimeUs windows_us_ = 0;              // when the windows were made last
  PlaySettings settings_;
  std::size_t pins_kept_ = 0;       // server keys that the page keeps
  std::optional<TimeUs> drawn_us_;  // when the last turn began, if it drew a frame
  bool is_joined_ = false, is_over_ = false, is_exact_ = false;
};

}  // namespace runstone
