// The textures of a stored world. Thread: any. Blocks on the disk.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "common/edits/descriptor/given_texture.hpp"
#include "common/textures/texture_table.hpp"
#include "server/store/log_reader.hpp"
#include "server/store/store.hpp"

namespace runstone {

struct StoredTextures {
  std::vector<std::shared_ptr<const GivenTexture>> given;  // in the order of the log
  TextureTable table;
};

/// Reads all textures of a world. The error is one line that names the file, and the record if no
/// table takes it.
Result<StoredTextures, std::string> read_stored_textures(LogReader& reader);

/// Gives a new world textures, as records of the log in an epoch of their own, at this time (UTC).
/// Requires that the world has its base chunks, and no log.
StoreResult<void> append_textures(Store& store,
                                  std::span<const std::shared_ptr<const GivenTexture>> textures,
                                  TimeUs time_us);

}  // namespace runstone
