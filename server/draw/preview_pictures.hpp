// PreviewPictures: draws what a rollback would do: a picture of the area as it is, and one of the
// area after the rollback. A child process (draw_child.hpp) draws them into WORLD/previews. One
// object belongs to one preview. Thread: a worker, because calls block on the disk and on the
// child.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/core/coords.hpp"
#include "common/generate/generator.hpp"
#include "common/runs/run_chunk.hpp"
#include "server/rollback/restore_plan.hpp"
#include "server/rollback/should_continue.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

class PreviewPictures {
 public:
  /// The maximum number of changing chunks. If more would change, no picture is drawn.
  static constexpr std::size_t kChunksMax = 1024;

  explicit PreviewPictures(std::string world_folder)
      : folder_(std::move(world_folder) + "/previews") {}

  /// Returns the chunks that add() needs: all of these, which would change, or none if they are too
  /// many for a picture.
  std::vector<ChunkKey> choose(const std::vector<ChunkKey>& changing);
  /// Adds a chunk that would change. Does nothing if they are too many for a picture.
  void add(const RestorePlan& plan);
  /// Draws NAME-before.png and NAME-after.png, with the chunks around. Returns a line of text with
  /// their paths, or with the reason why there are no pictures. Ends within a second or two when
  /// `wanted` returns false.
  std::string draw(WorldReader& reader, const Generator& generator, const std::string& name,
                   const ShouldContinue& wanted);

 private:
  struct ChangedChunk {
    ChunkKey key;
    RunChunk now, restored;
  };
  Result<void, std::string> draw_both(WorldReader& reader, const Generator& generator,
                                      const std::string& name, const ShouldContinue& wanted);

  std::string folder_;
  bool are_too_many_ = false;
  std::vector<ChangedChunk> changed_;
  std::optional<VoxelBox> area_;  // of the voxels that change
  std::int32_t edge_ = 0;
};

}  // namespace runstone
