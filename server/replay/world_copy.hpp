// WorldCopy: writes the world of a moment as a new world.
#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>

#include "common/generate/generator.hpp"
#include "server/history/world_at.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

struct WorldCopy {
  std::uint64_t chunks = 0;  // in the base of the new world
  Digest world_digest;       // over them
};

/// Makes a new world in `folder` (NewFolder), which must be empty or must not exist. Generator, materials, edge
/// and spawn are those of the source. World id and server key are new, and the log is empty. The
/// base holds the source's base chunks and all edited chunks, as they were at `at`. Memory: one
/// slice of chunks. The error is one line.
Result<WorldCopy, std::string> copy_world(WorldReader& source, const Generator& generator,
                                          Sequence at, const std::string& folder, std::ostream& out,
                                          const WorldAt::Progress& progress = {});

}  // namespace runstone
