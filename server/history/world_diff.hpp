// WorldDiff: the differences of a world between two moments, and the authors of the voxels that
// differ. Each chunk that edits between the moments touched is made as it was at the first moment.
// Then it gets these edits one by one. Each stretch that an edit really changed is written into a
// second chunk, whose "materials" are authors. At the end the chunk is compared with its first
// state run by run, and the second chunk gives the author of each stretch that differs.
#pragma once
#include <cstdint>
#include <vector>

#include "common/generate/generator.hpp"
#include "server/history/world_at.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

struct WorldDiff {
  Sequence from = 0, to = 0;
  std::uint64_t edits = 0;   // between the moments
  std::uint64_t voxels = 0;  // that differ
  struct ChunkPart {
    ChunkKey key;
    std::uint64_t edits = 0, voxels = 0;
    friend bool operator==(const ChunkPart&, const ChunkPart&) = default;
  };
  std::vector<ChunkPart> chunks;  // that differ; most voxels first, then by key
  struct AuthorPart {
    AuthorId author = 0;
    std::uint64_t edits = 0;   // made between the moments
    std::uint64_t voxels = 0;  // that differ and were last changed by this author
    friend bool operator==(const AuthorPart&, const AuthorPart&) = default;
  };
  /// Authors of edits between the moments: most voxels first, then most edits, then by number.
  std::vector<AuthorPart> authors;
};

/// Compares two moments. Requires from <= to. Errors and `progress` are those of WorldAt::open().
/// Memory: the edits between the moments. Blocks on the disk.
StoreResult<WorldDiff> diff_world(WorldReader& reader, const Generator& generator, Sequence from,
                                  Sequence to, const WorldAt::Progress& progress = {});

}  // namespace runstone
