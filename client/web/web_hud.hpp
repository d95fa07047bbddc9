// WebHud: the heads-up display of the browser client: the hotbar, notices, chat and players. The
// page shows them beside the canvas; this object sends it what changed. Thread: the page's only
// one.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "client/play/play.hpp"
#include "client/play/time_travel.hpp"

namespace runstone {

class WebHud {
 public:
  /// `play` must outlive the object.
  explicit WebHud(Play& play) : play_(play) {}

  void notify(std::string_view text, NoticeKind kind);
  /// Shows the changes of the materials, the hotbar, notices, chat, players and the past. Call it
  /// every turn. Cost: O(new materials, lines and players).
  void step();
  /// Shows a line about the state while playing.
  void set_state(const std::string& text);

 private:
  void show_materials();
  void show_slots();
  void show_walking();
  void show_players();
  void show_time();

  struct Slots {
    std::array<Material, kSlotCount> materials{};
    std::size_t chosen = 0;
    friend bool operator==(const Slots&, const Slots&) = default;
  };

  Play& play_;
  // That the page shows.
  std::optional<WorldId> world_;  // whose materials they are
  std::size_t materials_ = 1;     // the rows of the table, with kEmpty
  std::optional<Slots> slots_;
  std::string players_ = "?", state_;
  std::optional<ShownSequence> time_;
  bool is_past_ = false, is_walking_ = false;
};

}  // namespace runstone
