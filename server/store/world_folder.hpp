// World folder: opening a world for a server, or making a new one. Every error is one line that names the
// file. Blocks on the disk: for the start of a program.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "common/core/result.hpp"
#include "common/generate/generator.hpp"
#include "server/store/store.hpp"

namespace runstone {

/// What a new world is made of; an existing world has its own and ignores this.
struct WorldCreation {
  std::string generator = "terrain";
  std::string generator_parameters;  // TOML, empty for the generator's defaults
  std::uint64_t seed = 1;
  std::uint16_t edge = 32;     // 16, 32, 64 or 128
  std::string materials_file;  // TOML; empty: the built-in table
  friend bool operator==(const WorldCreation&, const WorldCreation&) = default;
};

struct OpenedWorld {
  std::unique_ptr<Store> store;
  std::unique_ptr<Generator> generator;
  bool is_new = false;
  bool is_readable_by_others = false;  // the file, and with it the world's secret key
};

/// Whether the folder holds a world.
bool has_world(const std::string& folder);
/// Reads a material table; an empty name means the built-in one.
Result<MaterialTable, std::string> read_materials(const std::string& file);
/// New identity: random world id and server key.
void draw_identity(WorldMeta& meta);
/// Opens the world for writing, or makes it first if the folder holds none. Fails on a generator this build
/// lacks, a world of a newer version, damaged rows, a second server, an unwritable folder.
Result<OpenedWorld, std::string> open_or_create_world(const std::string& folder,
                                                      const WorldCreation& creation);
/// The generator a world pins.
Result<std::unique_ptr<Generator>, std::string> generator_of(const WorldInfo& world);

}  // namespace runstone
