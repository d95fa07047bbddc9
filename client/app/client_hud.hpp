// ClientHud: the heads-up display of runstone-client. It fills the state that the display shows
// from the session and the player, and carries out what the user does in the display. One thread.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/play/play.hpp"
#include "client/report/report.hpp"
#include "client/ui/hud.hpp"

namespace runstone {

/// The client's own state, as the display shows it.
struct HudScene {
  bool has_window = false, is_connected = false, shows_players = false;
  std::string state;  // as HudState::state
  FileState file;     // as HudState::file
  NetCounts net;      // filled only while ClientHud::shows_statistics()
  Camera camera;
  std::array<int, 2> size{};  // of the frame, in pixels
};

class ClientHud {
 public:
  /// `play` must outlive this object. `name` is that of the player.
  ClientHud(Play& play, std::string name, double scale);

  /// Adds a line to the chat.
  void hear(ShownLine line) { hud_.hear(std::move(line)); }
  /// Removes lines from the chat.
  void withdraw(const std::vector<ChatLineId>& lines) { hud_.withdraw(lines); }
  /// Carries out an action of a key. Returns false if it is no action of the display.
  bool act(Action action);
  void notify(std::string text, NoticeKind kind = NoticeKind::information) {
    hud_.notify(std::move(text), kind);
  }

  void feed(const std::vector<InputEvent>& events) { hud_.feed(events); }
  UiFocus focus() const { return hud_.focus(); }
  /// Makes the overlay of a frame, and carries out what the user did in it. Returns null while the
  /// display is hidden.
  std::shared_ptr<const OverlayFrame> make_frame(const HudScene& scene, TimeUs now_us);
  /// Returns the files that the user wants to read or to write, since the last call.
  std::vector<ClipboardOfFile> take_files() { return std::exchange(files_, {}); }
  /// Returns true once after the user stopped the file that is being read.
  bool take_file_stop() { return std::exchange(stops_file_, false); }
  /// Takes a file that was dropped on the window. Returns the order to read it.
  ClipboardOfFile drop(std::string file) {
    return hud_.panels().tools().file().drop(std::move(file));
  }
  bool is_moving() const { return is_shown_ && hud_.is_moving(); }
  void set_shown(bool is_shown) { is_shown_ = is_shown; }
  bool is_shown() const { return is_shown_; }
  bool shows_statistics() const { return hud_.shows_statistics(); }
  /// Returns which windows of WorldPanels are open.
  ShownPanels shown_panels() const;
  MapWindow& map() { return hud_.panels().map(); }
  void show_timeline(bool is_shown) { hud_.panels().timeline().set_open(is_shown); }
  void show_library(bool is_shown) { hud_.panels().library().set_open(is_shown); }

 private:
  HudState state(const HudScene& scene) const;
  void add_players(HudState& state) const;
  void add_plates(const HudScene& scene, HudState& state) const;
  /// Returns the opacity of a name plate, 0 to 1. It fades with the distance, and is low behind
  /// walls.
  double plate_alpha(const WorldPos& head, double distance) const;
  void add_timeline(TimelineState& state) const;
  StatisticsState statistics(const HudScene& scene, TimeUs now_us);
  void add_traffic(const NetCounts& net, TimeUs now_us, StatisticsState& out);

  Play& play_;
  const std::string name_;
  Hud hud_;
  std::vector<ClipboardOfFile> files_;
  bool stops_file_ = false;
  bool is_shown_ = true;
  NetCounts net_before_;           // at net_us_
  std::array<double, 4> rates_{};  // bytes a second by class, in the interval before net_us_
  TimeUs net_us_ = 0;
  TimeUs made_us_ = 0;  // when the last frame was made
};

}  // namespace runstone
