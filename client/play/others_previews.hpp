// OthersPreviews: ghosts of what other players are about to do. Each preview is made by EditPreview
// on this client's shown runs, as the preview of this player. The stroke of a brush is worked out
// first, on the same runs (client/tools/ground_stroke.hpp). Work is divided over turns. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "client/render/ghost.hpp"
#include "client/render/marker.hpp"
#include "client/replica/replica.hpp"
#include "client/session/shared_previews.hpp"
#include "client/tools/build_preview.hpp"
#include "client/tools/edit_preview.hpp"
#include "client/tools/upright_chunks.hpp"
#include "common/materials/material_table.hpp"
#include "common/mesh/mesh_materials.hpp"

namespace runstone {

class OthersPreviews {
 public:
  /// The players whose previews are shown at a time: those with the smallest numbers.
  static constexpr std::size_t kShownMax = 8;
  /// The chunks that are compared or meshed in one call of step().
  static constexpr std::size_t kChunksPerStep = 16;

  /// The work of the filter and the mix of a stroke (edits_of_stroke()). A stroke with more has the
  /// ghost of its edits.
  static constexpr std::uint64_t kPatternWorkMax = 64'000'000;

  /// Takes the materials of the world, and what previews read of them. Makes all ghosts again.
  void set_materials(const MaterialTable& materials, MeshMaterialsPtr meshed);
  /// Makes the ghosts of these previews, a bounded part of them in this call. Returns true if the
  /// ghosts changed. At most one stroke is worked out in one call, by turns. A stroke that changes
  /// nothing here, or whose ground is not shown, has the ghost of its edits. Requires an open
  /// replica. Cost: O(touched chunks of the shown previews), for kChunksPerStep chunks that of
  /// EditPreview::step(), and that of edits_of_stroke() for a stroke that passes check_stroke().
  bool step(const Replica& replica, const std::map<AuthorId, SharedPreviews::Shared>& shared);
  /// Forgets all ghosts. Returns true if there were any.
  bool clear();
  /// Appends the ghosts, each in the colour of its player.
  void append_ghosts(std::vector<GhostChunk>& out) const;
  /// Appends the outline of each edit of the shown previews, in the colour of its player.
  void append_outlines(std::vector<Marker>& out) const;

 private:
  /// The runs that are kept for the strokes of one player.
  static constexpr std::size_t kKeptRunsMax = std::size_t{1} << 18;

  struct Shown {
    EditPreview edits;
    BuildPreview builds;  // of a stroke that is too large for one edit
    std::optional<BrushStroke> stroke;
    bool is_plan_due = false;  // the stroke, or the ground below it, changed
    UprightChunks upright{kKeptRunsMax};
    bool is_complete() const { return edits.is_complete() && builds.is_complete(); }
  };
  /// Shows what a player shares; a stroke when it is planned.
  void take(Shown& shown, const SharedPreviews::Shared& shared);
  /// Works out the stroke that waits after the player of the last one.
  void plan_next(const Replica& replica, const std::map<AuthorId, SharedPreviews::Shared>& shared);

  MaterialTable materials_;
  MeshMaterialsPtr meshed_ = std::make_shared<const MeshMaterials>();
  std::map<AuthorId, Shown> previews_;
  AuthorId planned_ = 0;  // the player whose stroke was worked out last
};

}  // namespace runstone
