// OpenedWorld: a world that is opened for a server, or created. Every error is one line that names
// the file. All functions block on the disk: they are for the start of a program.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "common/generate/generator.hpp"
#include "server/store/store.hpp"

namespace runstone {

/// The properties of a new world. An existing world ignores them.
struct WorldCreation {
  std::string generator = "landscape";
  std::string generator_parameters;   // TOML, empty for the generator's defaults
  std::optional<std::uint64_t> seed;  // nullopt: a random one
  std::uint16_t edge = 32;            // 16, 32, 64 or 128
  std::string materials_file;         // TOML; empty: the built-in table of the generator
  friend bool operator==(const WorldCreation&, const WorldCreation&) = default;
};

struct OpenedWorld {
  std::unique_ptr<Store> store;
  std::unique_ptr<Generator> generator;
  bool is_new = false;
  bool is_readable_by_others = false;  // the file, which holds the world's secret key
  std::vector<std::string> losses;     // that were accepted, one line each
};

/// Returns false if the place holds no world. Returns true also if a database does not answer:
/// opening the world then says so.
bool has_world(const std::string& place);
/// Reads the material table of a new world of a generator. An empty name means the built-in one.
/// Looks are those of look_on_shape().
Result<MaterialTable, std::string> read_materials(const std::string& file,
                                                  const std::string& generator);
/// Sets a new identity: a random world id and a random server key.
void draw_identity(WorldMeta& meta);
/// Opens the world for writing. Creates it first if the place holds none. Fails if
///   - this build lacks the generator;
///   - the world has a newer format, or its rows are damaged;
///   - the world lacks edits that were durable, unless `accept_losses` is set;
///   - another server has the world open;
///   - the place cannot be written.
Result<OpenedWorld, std::string> open_or_create_world(const std::string& place,
                                                      const WorldCreation& creation,
                                                      bool accept_losses = false,
                                                      const LeaseTerms& lease = {});
/// Returns the generator that a world pins.
Result<std::unique_ptr<Generator>, std::string> generator_of(const WorldInfo& world);

}  // namespace runstone
