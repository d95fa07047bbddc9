// WorldDiff: where the world differs between two moments, and who is the author of what is new.
// How: each chunk that edits between the moments touched is made as it stood at the first one and gets those edits one by
// one. What each of them really changed is written, stretch by stretch, into a second chunk whose "materials" are authors. In
// the end the chunk is compared with its first state run by run, and each stretch that differs is looked up among the authors.
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
  std::vector<ChunkPart> chunks;  // that differ: most voxels first, then by key
  struct AuthorPart {
    AuthorId author = 0;
    std::uint64_t edits = 0;   // made between the moments
    std::uint64_t voxels = 0;  // that differ and were last changed by this author
    friend bool operator==(const AuthorPart&, const AuthorPart&) = default;
  };
  std::vector<AuthorPart>
      authors;  // who edited between the moments: most voxels first, then most edits, then by number
};

/// Requires from <= to. Errors and `progress` are those of WorldAt::open(). Memory: the edits between the moments. Blocks.
StoreResult<WorldDiff> diff_world(WorldReader& reader, const Generator& generator, Sequence from,
                                  Sequence to, const WorldAt::Progress& progress = {});

}  // namespace runstone
