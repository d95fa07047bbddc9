// OthersPreviews: ghosts of what other players are about to do. Each preview is made by EditPreview
// on this client's shown runs, as the preview of this player. Work is divided over turns. One
// thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "client/render/ghost.hpp"
#include "client/render/marker.hpp"
#include "client/replica/replica.hpp"
#include "client/session/shared_previews.hpp"
#include "client/tools/edit_preview.hpp"
#include "common/mesh/mesh_materials.hpp"

namespace runstone {

class OthersPreviews {
 public:
  /// The players whose previews are shown at a time: those with the smallest numbers.
  static constexpr std::size_t kShownMax = 8;
  /// The chunks that are compared or meshed in one call of step().
  static constexpr std::size_t kChunksPerStep = 16;

  /// Takes the materials of the world. Makes all ghosts again.
  void set_materials(MeshMaterialsPtr materials);
  /// Makes the ghosts of these previews, a bounded part of them in this call. Returns true if the
  /// ghosts changed. Requires an open replica. Cost: O(touched chunks of the shown previews), and
  /// for kChunksPerStep chunks that of EditPreview::step().
  bool step(const Replica& replica, const std::map<AuthorId, SharedPreviews::Shared>& shared);
  /// Forgets all ghosts. Returns true if there were any.
  bool clear();
  /// Appends the ghosts, each in the colour of its player.
  void append_ghosts(std::vector<GhostChunk>& out) const;
  /// Appends the outline of each edit of the shown previews, in the colour of its player.
  void append_outlines(std::vector<Marker>& out) const;

 private:
  MeshMaterialsPtr materials_ = std::make_shared<const MeshMaterials>();
  std::map<AuthorId, EditPreview> previews_;
};

}  // namespace runstone
