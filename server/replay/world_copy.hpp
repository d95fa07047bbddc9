// WorldCopy: the world of a moment as a world of its own.
#pragma once
#include <cstdint>
#include <string>

#include "common/generate/generator.hpp"
#include "server/history/world_at.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

struct WorldCopy {
  std::uint64_t chunks = 0;  // in the base of the new world
  Digest world_digest;       // over them
};

/// Makes a new world in `folder`, which must be empty or not there: generator, materials, edge and spawn of the source, an
/// identity of its own (world id and server key), an empty log; its base are the chunks of the source's base and all that were edited, as they stood at
/// `at`. One slice of chunks at a time; until all is written the folder has another name. The error is one line.
Result<WorldCopy, std::string> copy_world(WorldReader& source, const Generator& generator,
                                          Sequence at, const std::string& folder,
                                          const WorldAt::Progress& progress = {});

}  // namespace runstone
