// PreviewPictures: what a rollback would do, as two pictures of the area: as it is now, and as it would be. Drawn by
// a child (draw_child.hpp) into WORLD/previews. Belongs to one preview; blocks on the disk and the child, so it
// runs on a worker.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/core/coords.hpp"
#include "common/generate/generator.hpp"
#include "common/runs/run_chunk.hpp"
#include "server/rollback/restore_plan.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

class PreviewPictures {
 public:
  /// Changed chunks in a picture at most; of more there is none.
  static constexpr std::size_t kChunksMax = 1024;

  explicit PreviewPictures(std::string world_folder)
      : folder_(std::move(world_folder) + "/previews") {}

  /// A chunk that would change.
  void see(const RestorePlan& plan);
  /// Draws NAME-before.png and NAME-after.png with the land around. Returns a line for people: where they lie, or why
  /// there are none.
  std::string draw(WorldReader& reader, const Generator& generator, const std::string& name);

 private:
  struct Seen {
    ChunkKey key;
    RunChunk now, restored;
  };
  Result<void, std::string> draw_both(WorldReader& reader, const Generator& generator,
                                      const std::string& name);

  std::string folder_;
  std::vector<Seen> seen_;
  std::optional<VoxelBox> area_;  // of the voxels that change
  std::int32_t edge_ = 0;
};

}  // namespace runstone
