#include "tests/conformance/scene/scene_world.hpp"

#include <utility>

#include "common/core/assert.hpp"
#include "common/core/hash.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone::conformance {
namespace {

RunChunk fresh_chunk(ChunkCoord at) {
  const Extent extent = Extent::cube(SceneWorld::kEdge);
  if (at.y < 0) return uniform_chunk(extent, SceneWorld::kStone);
  if (at.y > 0) return uniform_chunk(extent, kEmpty);
  constexpr AxisOrder kOrder = AxisOrder::yxz;
  RunBuilder builder(extent, kOrder);
  const VoxelPos origin = origin_of(at, SceneWorld::kEdge);
  for (VoxelIndex i = 0; i < extent.volume(); ++i) {
    const LocalPos p = pos_of(i, extent, kOrder);
    const auto height = 3 + place_hash(0, origin.x + p.x, origin.z + p.z) % 5;
    const Material ground = p.y + 1U == height ? SceneWorld::kMoss : SceneWorld::kEarth;
    builder.append(1, p.y < height ? ground : kEmpty);
  }
  return builder.finish();
}

}  // namespace

MaterialTable SceneWorld::materials() {
  MaterialTable table;
  for (const char* name : {"stone", "earth", "moss", "brick", "glass", "lamp"}) {
    const auto added = table.add({name, {120, 130, 110, 255}, Visibility::opaque, std::nullopt});
    RUNSTONE_ASSERT(added.has_value());
  }
  return table;
}

const Chunk& SceneWorld::chunk(ChunkCoord at) {
  const auto it = chunks_.find(at);
  if (it != chunks_.end()) return it->second;
  Chunk fresh;
  fresh.voxels = fresh_chunk(at);
  fresh.digest = digest_of(fresh.voxels);
  return chunks_.emplace(at, std::move(fresh)).first->second;
}

OrderedEdit SceneWorld::order(const OperationId& op, const EditDescriptor& edit) {
  OrderedEdit out;
  out.seq = ++head_;
  out.op = op;
  out.edit = edit;
  for (const ChunkCoord at : touched_chunks(edit, kEdge)) {
    static_cast<void>(chunk(at));
    Chunk& target = chunks_.find(at)->second;
    out.previous.push_back(target.version.seq);
    apply_stack(target.voxels, target.digest, origin_of(at, kEdge), {&edit, 1}, scratch_);
    target.version = {epoch_, head_};
  }
  return out;
}

void SceneWorld::restart() {
  chunks_.clear();
  head_ = 0;
  ++epoch_;
}

}  // namespace runstone::conformance
