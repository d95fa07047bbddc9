// World kits: the lines in which the client keeps hotbar and tool of the worlds that a player
// joined, newest first, in a TOML file. The functions wait for the disk.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/core/result.hpp"

namespace runstone {

/// The number of worlds that are kept: those that were played last.
inline constexpr std::size_t kWorldKitsMax = 64;

/// Returns $XDG_STATE_HOME/runstone/worlds.toml, otherwise the one in ~/.local/state, or an empty
/// text if neither variable is an absolute path.
std::string default_kits_file();
/// Returns the line of a world (its id in hex), or nullopt if the file has none or cannot be read.
std::optional<std::string> load_kit(const std::string& file, const std::string& world);
/// Puts the line of a world at the front and replaces the file. A file that is not TOML is kept as
/// FILE.broken. Fails with a line that begins with the file's name.
Result<void, std::string> save_kit(const std::string& file, const std::string& world,
                                   const std::string& line);

/// Lines that are not written yet, one for each world.
class UnsavedKits {
 public:
  /// Adds the line of a world, and replaces an earlier one of that world.
  void add(std::string world, std::string line);
  /// Adds the lines of `newer`, as add() does.
  void add_all(UnsavedKits newer);
  /// Returns the line of a world, or nullopt if none is unsaved.
  std::optional<std::string> find(const std::string& world) const;
  /// Writes all lines with save_kit(). Lines that cannot be written stay for the next call. Fails
  /// as save_kit() does.
  Result<void, std::string> save(const std::string& file);
  bool empty() const { return lines_.empty(); }

 private:
  std::vector<std::pair<std::string, std::string>> lines_;  // by world, in the order of add()
};

}  // namespace runstone
