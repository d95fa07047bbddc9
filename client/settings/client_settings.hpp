// ClientSettings: the choices of a player that are kept between runs, and their text form in TOML.
// Pure.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "client/render/frame_look.hpp"

namespace runstone {

enum class QualityChoice : std::uint8_t {
  automatic,  // the client measures its frames and picks the level
  low,
  medium,
  high,
};
inline constexpr std::size_t kQualityChoiceCount = 4;
/// Returns "automatic", "low", "medium" or "high".
const char* name_of(QualityChoice quality);

inline constexpr std::uint64_t kMemoryMibMin = 64, kMemoryMibMax = 65'536;

struct ClientSettings {
  std::string name = "builder";  // shown to others; as the option --name
  std::string key_file;          // of the identity; empty: default_key_file()
  QualityChoice quality = QualityChoice::automatic;
  Antialiasing antialiasing = Antialiasing::automatic;
  double field_of_view = 69;     // degrees, vertical, 30 to 110
  std::uint8_t view_radius = 6;  // chunks, horizontal, 1 to kViewRadiusMax
  std::uint8_t far_levels = 5;   // of tiles beyond the view radius; each sees twice as far
  /// The memory for chunks, edits and meshes, from kMemoryMibMin to kMemoryMibMax. 0: the client
  /// uses automatic_memory_mib().
  std::uint64_t memory_mib = 0;
  bool shows_textures = true;   // the pictures that worlds bring for their materials
  double sensitivity = 1;       // of the mouse, 0.1 to 10
  bool invert_y = false;        // mouse up looks down
  double interface_scale = 1;   // of windows and text, 0.5 to 4
  bool walks = false;           // players begin on their feet; false: they fly
  bool shows_previews = true;   // ghosts of what other players are about to do
  bool shares_previews = true;  // others see what this player is about to do
  /// The keys that differ from the defaults, by the name of their action. A value has the names of
  /// keys with blanks between them, such as "W up", or is empty. key_map_of() checks the names.
  std::map<std::string, std::string> keys;
  friend bool operator==(const ClientSettings&, const ClientSettings&) = default;
};

/// The settings of a text, and a line for each key that was not used, with the reason. A key that
/// is not known, has the wrong type or is out of range does not prevent the use of the others.
struct ReadSettings {
  ClientSettings settings;
  std::vector<std::string> warnings;
  bool is_broken = false;  // the text is not TOML; the settings are the defaults
};
/// Reads the text. `file` is the name in the warnings, which have the form "FILE:LINE: KEY: WHAT".
ReadSettings read_settings(std::string_view toml, const std::string& file);
/// Returns the text of all settings with comments. read_settings() reads it back to equal settings.
std::string to_toml(const ClientSettings& settings);

}  // namespace runstone
