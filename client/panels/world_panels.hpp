// WorldPanels: what the client shows of the world and its players besides the chunks: where the
// others are, the map from above, who edited when, what a rollback would change, and the library of
// builds. Thread: the main thread.
#pragma once
#include <map>
#include <span>

#include "client/display/smooth_players.hpp"
#include "client/map/world_map.hpp"
#include "client/panels/library_control.hpp"
#include "client/panels/rollback_control.hpp"
#include "client/tools/tool_box.hpp"
#include "client/ui/hud_state.hpp"
#include "client/ui/panel_windows.hpp"

namespace runstone {

/// The windows that are open.
struct ShownPanels {
  bool tools = false, map = false, timeline = false, rollback = false, library = false;
  double map_x = 0, map_z = 0;  // the middle of the map, voxels
};
ShownPanels shown_panels(const PanelWindows& windows);

class WorldPanels {
 public:
  /// Session and tools must outlive the object. `has_threads`: as in LibraryControl.
  WorldPanels(ClientSession& session, ToolBox& tools, bool has_threads)
      : session_(session),
        tools_(tools),
        rollback_(session),
        library_(session, tools, has_threads) {}

  void set_materials(const MaterialTable& materials, MeshMaterialsPtr meshed);
  /// Takes what changed in the replica.
  void take(const ReplicaChanges& changes) { map_.take(changes); }
  /// Takes poses and answers, and does a bounded part of the work of open windows. Returns true if
  /// what they show has changed.
  bool step(const ShownPanels& shown, TimeUs now_us);
  /// Fills the state of the open windows, and the names of the others. `me` is the pose of the
  /// player.
  void fill(HudState& state, const ShownPanels& shown, const Pose& me) const;

  /// Returns where the others are shown in this turn, by author.
  const std::map<AuthorId, Pose>& poses() const { return poses_; }
  /// Returns true if others moved since the last call.
  bool take_moved(TimeUs now_us) { return players_.take_moved(now_us); }
  RollbackControl& rollback() { return rollback_; }
  const RollbackControl& rollback() const { return rollback_; }
  LibraryControl& library() { return library_; }
  const LibraryControl& library() const { return library_; }
  /// Returns true while the contents of an open window are missing.
  bool is_loading(const ShownPanels& shown) const;

 private:
  void fill_map(MapState& state, const Pose& me) const;
  void fill_timeline(TimelineState& state) const;
  void fill_rollback(RollbackState& state) const;

  ClientSession& session_;
  const ToolBox& tools_;
  SmoothPlayers players_;
  std::map<AuthorId, Pose> poses_;
  WorldMap map_;
  RollbackControl rollback_;
  LibraryControl library_;
  std::uint64_t timeline_serial_ = 0;  // of the timeline that was shown last
};

}  // namespace runstone
