// BuilderSession: single-voxel edits as people make them, from a seed. They resemble the logs of
// real evenings more than uniform noise does:
// - Each author stands at a site; some share one.
// - An author sets or removes voxel after voxel along a line or a wall, and changes the material
//   with the stroke.
// - Sometimes an author takes back the voxel just set, walks on, or starts the client again after
//   some thousand edits.
// - The edits of all authors interleave by time; gaps are drawn to the microsecond.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/hash.hpp"
#include "common/edits/descriptor/edit_record.hpp"

namespace runstone::test {

class BuilderSession {
 public:
  explicit BuilderSession(std::uint64_t seed, AuthorId authors = 8);
  /// Returns the next edit in the order of time: sequences from 1, authors from 1, epoch 1.
  EditRecord next();

 private:
  struct Builder {
    VoxelPos home, at;
    int axis = 0, step = 1, left = 0;  // of the present line
    int rows = 0, row_axis = 1, row_length = 1;
    Material material = 1;
    bool took_back = false;
    ClientInstance instance = 0;
    ClientSequence seq = 0;
    std::int64_t due_us = 0;
  };
  void begin_stroke(Builder& builder);
  void advance(Builder& builder);

  SplitMix64 rng_;
  std::vector<Builder> builders_;
  Sequence seq_ = 0;
};

}  // namespace runstone::test
