// WorldInfo: the information that every reader of a world has: the values that are pinned when a
// world is created, and the name of its database.
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/generate/generator.hpp"
#include "common/materials/material_table.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// The values that `meta` pins when a world is created. None of them changes afterwards, with one
/// exception: a compaction appends to `materials` the rows that it removes from the log.
struct WorldMeta {
  WorldId world_id{};
  std::uint16_t chunk_edge = 32;
  GeneratorPin generator;
  MaterialTable materials;  // before the first edit of the log; LogReader::materials() has all
  std::array<std::uint8_t, 32> server_key_seed{};  // Ed25519 identity of this world's server
  WorldPos spawn;
};

class WorldInfo {
 public:
  virtual ~WorldInfo() = default;

  virtual const WorldMeta& meta() const = 0;
  /// Returns the name of the database, as errors show it.
  virtual const std::string& file() const = 0;
};

}  // namespace runstone
