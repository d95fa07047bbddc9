// ModelLevels: a build and its levels of detail, the finest first, for a file that holds them all.
// Thread: one at a time. Memory: the coarser builds, and a ModelWalk for each level.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>

#include "common/core/result.hpp"
#include "common/model_writers/coarser_build.hpp"
#include "common/model_writers/model_walk.hpp"
#include "common/model_writers/model_writing.hpp"

namespace runstone {

class ModelLevels {
 public:
  /// Makes `writing.levels` levels besides the finest one, or fewer: no level follows a single
  /// cell, or one of shapes of which none is a cube. Keeps a reference to the build. Fails with
  /// limit_exceeded if a level takes more memory than the finer one and kBuildBytesMax together.
  /// Requires at most kModelLevelsMax levels.
  static Result<ModelLevels> of(const WrittenBuild& source, const ModelWriting& writing);

  /// Returns the number of levels, at least 1.
  std::size_t count() const { return walks_.size(); }
  ModelWalk& walk(std::size_t level) { return walks_[level]; }
  /// Returns the cell number that a cell number of a level has in the finest one.
  std::uint16_t finest_number(std::size_t level, std::uint16_t number) const {
    return level == 0 ? number : coarser_[level - 1].finest_numbers[number - 1U];
  }

 private:
  struct Level {
    CoarserBuild made;
    WrittenBuild source;  // of made.build
    std::vector<std::uint16_t> finest_numbers;
  };
  ModelLevels() = default;

  // Deques keep their elements in place, also when they are moved.
  std::deque<Level> coarser_;
  std::deque<ModelWalk> walks_;
};

}  // namespace runstone
