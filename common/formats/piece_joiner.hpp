// PieceJoiner: joins the pieces of a foreign file to one build, from runs to runs. Pieces may have any
// place, overlap, and come in any order. Internal to build_of_file.
// The pieces are kept as runs until the last one is known, because only then the box of the build is.
// The planes between the sections of the build are multiples of 64 of the place of the file, so that a
// piece that a reader cut by this grid becomes a section as it is.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "common/builds/build.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/formats/format.hpp"
#include "common/formats/rsb_build.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

class PieceJoiner {
 public:
  /// `keep_all`, `bytes_max` and `only_cubes` are those of ForeignReading.
  PieceJoiner(const Format& format, bool keep_all, std::size_t bytes_max, bool only_cubes = false)
      : format_(format), keep_all_(keep_all), only_cubes_(only_cubes), bytes_max_(bytes_max) {}

  /// Takes the next piece. Fails with bad_value if it reaches out of the world, and with
  /// limit_exceeded if there are more than kBuildMaterialsMax blocks, or if the pieces take more memory
  /// than allowed. Requires voxels that validate_runs() accepts. Cost: O(runs + blocks log blocks).
  Result<void> add(ForeignPiece&& piece);

  /// Returns the smallest box around the pieces. Requires a piece.
  VoxelBox box() const { return box_; }
  bool has_pieces() const { return !box_.empty(); }

  /// Returns build and materials, without an info, and leaves the joiner empty. Fails as
  /// read_foreign_build() does. Requires a piece. Cost: O(runs + lines of the sections that several
  /// pieces meet, or one in part).
  Result<FileBuild> join();

 private:
  struct Piece {
    VoxelBox box;
    RunChunk voxels;  // materials are numbers of blocks
    std::size_t bytes = 0;
    std::uint32_t sections_left = 0;
  };
  /// A section, by its number in the grid, and a piece that meets it.
  struct Meeting {
    std::uint64_t section = 0;
    std::uint32_t piece = 0;
    friend auto operator<=>(const Meeting&, const Meeting&) = default;
  };

  std::vector<Meeting> meetings(const BuildCuts& cuts);
  RunChunk cells_of(const VoxelBox& section, std::span<const Meeting> meetings);
  void release(std::span<const Meeting> meetings);

  const Format& format_;
  bool keep_all_;
  bool only_cubes_;
  std::size_t bytes_max_;
  std::map<ForeignBlock, std::uint16_t> numbers_;  // from 1
  std::vector<Piece> pieces_;
  VoxelBox box_;
  std::size_t bytes_ = 0;  // of pieces and blocks
};

}  // namespace runstone
