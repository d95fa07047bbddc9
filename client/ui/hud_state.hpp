// HudState: what the heads-up display shows of this moment. It is plain data that the client fills
// for each frame; texts are ready to be drawn.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "client/render/inspection.hpp"
#include "client/ui/statistics_window.hpp"
#include "common/core/ids.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

inline constexpr std::size_t kSlotCount = 9;

/// A player in the list. The first one is this client's.
struct ListedPlayer {
  std::string name, fingerprint;
  std::string distance;  // such as "120 voxels", or empty
};

/// A name over the head of another player.
struct NamePlate {
  std::string name;
  double x = 0, y = 0;  // pixels; the plate stands above this point
  double distance = 0;  // voxels
};

/// The state of the timeline.
struct TimelineState {
  Sequence newest = 0;  // of the live world
  Sequence shown = 0;   // equal to `newest` in the live world
  bool is_past = false;
  bool is_loading = false;
  std::string moment;  // the shown moment in words, for example its time in UTC
};

struct HudState {
  const MaterialTable* materials = nullptr;  // not null; it must outlive the call
  std::array<Material, kSlotCount> slots{};
  std::size_t slot = 0;      // the chosen one
  bool is_captured = false;  // the mouse moves the player
  bool is_connected = false;
  std::string place;                 // position, and how the player moves
  std::optional<Material> aimed_at;  // the voxel in sight
  std::string state;                 // for example that the past is shown; empty: nothing special
  std::string tool;                  // the chosen tool and its numbers; empty: the plain hand
  bool shows_players = false;
  std::string role;  // of this player; empty if the server named none
  std::vector<ListedPlayer> players;
  std::vector<NamePlate> plates;
  TimelineState timeline;
  InspectionModes inspection;
  StatisticsState statistics;  // filled only while Hud::shows_statistics()
};

}  // namespace runstone
