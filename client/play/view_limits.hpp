// ViewLimits: keeps the memory of a client within its budget. It makes the view smaller or larger,
// bounds the meshes, and changes the levels of distant ground. Tiles and their meshes may take an
// eighth of the memory, if there are tiles. Thread: the main thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "client/display/mesh_pipeline.hpp"
#include "client/far/far_budget.hpp"
#include "client/play/view_follower.hpp"
#include "client/report/report.hpp"
#include "client/schedule/memory_budget.hpp"

namespace runstone {

/// How far a player wants to see, and how much memory the client may use for that.
struct ViewWishes {
  std::size_t memory_mib = 0;
  ViewRadii radii;
  std::uint8_t far_levels = 0;
};

/// A change of what is seen, for the log.
struct LimitChange {
  std::string text;
  bool has_shrunk = false;
};

class ViewLimits {
 public:
  /// All but `wishes` must outlive the object.
  ViewLimits(const ViewWishes& wishes, const Replica& replica, MeshPipeline& pipeline,
             ViewFollower& view);

  /// Call it when a world opens whose server allows this radius.
  void open_world(std::uint8_t radius_max);
  /// Changes the view by one step at most. Returns the change, or nullopt if there is none. After a
  /// change the caller passes the changes of the replica on before it calls limit_meshes().
  std::optional<LimitChange> limit_view(TimeUs now_us);
  /// Gives the meshes what the rest leaves of the budget.
  void limit_meshes();
  /// Changes the levels of distant ground by one at most. Returns the change, or nullopt if there
  /// is none.
  std::optional<LimitChange> limit_far(TimeUs now_us);

  /// Sets the memory that the textures of the world take, their copy on the GPU included.
  void set_texture_bytes(std::size_t bytes) { texture_bytes_ = bytes; }
  MemoryUse use() const;
  /// Returns what is left of the budget of all but the tiles.
  std::size_t room() const { return budget_.room(use()); }
  const MemoryBudget& budget() const { return budget_; }
  const FarBudget& far() const { return far_; }
  /// Returns a line for the player if memory is short, otherwise an empty text.
  std::string text() const;
  /// Sets the memory, the budgets and the reach of a report. `reach` is FrameScene::reach().
  void add_to(ClientReport& report, const View& view, double reach) const;

 private:
  /// Returns true if all chunks of the view have been here for so long that they are taken as
  /// meshed.
  bool is_meshed(TimeUs now_us) const;

  const ViewWishes wishes_;
  const Replica& replica_;
  MeshPipeline& pipeline_;
  ViewFollower& view_;
  FarBudget far_;
  MemoryBudget budget_;  // of all but the tiles
  std::size_t texture_bytes_ = 0;
};

}  // namespace runstone
