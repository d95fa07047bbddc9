// Parameters of the generators, as a world's pin stores them: canonical TOML with one `key = value`
// a line, only the keys that differ from the default, in the order below. Heights are voxels,
// within kHeightMin .. kHeightMax.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "common/core/result.hpp"

namespace runstone {

inline constexpr std::int32_t kHeightMin = -100000;
inline constexpr std::int32_t kHeightMax = 100000;

/// "flat": one voxel of `surface` on top, `filling_depth` voxels of `filling` below it, and
/// `ground` down to y_min.
struct FlatParameters {
  std::int32_t height = 0;         // y of the first empty voxel
  std::int32_t y_min = -64;        // y of the lowest voxel; at most height
  std::int32_t filling_depth = 3;  // 0 .. 1000
  std::string surface = "grass";
  std::string filling = "dirt";
  std::string ground = "stone";
  friend bool operator==(const FlatParameters&, const FlatParameters&) = default;
};

/// "terrain": the generation rules of the table, with a sea, beaches, rock and peaks.
struct TerrainParameters {
  // The y of the first voxel above the sea. The distances of the rules stay relative to y = 0.
  std::int32_t sea_level = 38;
  std::int32_t y_min = -64;     // y of the lowest voxel; everything below is empty
  std::string water = "water";  // fills every empty voxel below sea_level; "": a dry world
  // Covers columns that end at most beach_height above the sea; "": none.
  std::string beach = "sand";
  std::int32_t beach_height = 3;  // -1000 .. 1000
  std::string rock = "stone";     // covers columns that end above rock_level; "": none
  std::int32_t rock_level = 60;
  std::string peak = "snow";  // topmost voxel of columns that end above peak_level; "": none
  std::int32_t peak_level = 68;
  friend bool operator==(const TerrainParameters&, const TerrainParameters&) = default;
};

/// "landscape": how high it lies, and how much grows on it.
struct LandscapeParameters {
  std::int32_t sea_level = 0;  // the y of the first voxel above the sea
  std::int32_t y_min = -256;   // y of the lowest voxel; at least 96 below sea_level
  std::int32_t trees = 100;    // percent, 0 .. 200
  std::int32_t plants = 100;   // percent, 0 .. 400
  std::int32_t caves = 0;      // 1: with caves
  friend bool operator==(const LandscapeParameters&, const LandscapeParameters&) = default;
};

/// "scenario": one of the thesis' 37 profiling scenarios except the 5th: 3 x 3 x 3 copies of one
/// model.
struct ScenarioParameters {
  std::int32_t number = 1;  // 1 .. 37, not 5
  std::int32_t edge = 32;   // voxels of a model: 8, 16, 32, 64 or 128
  std::string material = "stone";
  friend bool operator==(const ScenarioParameters&, const ScenarioParameters&) = default;
};

/// Fails with bad_value on bytes that are no TOML, an unknown key, a wrong type or a number outside
/// its range. Empty text gives the defaults.
Result<FlatParameters> parse_flat_parameters(std::string_view toml);
Result<TerrainParameters> parse_terrain_parameters(std::string_view toml);
Result<LandscapeParameters> parse_landscape_parameters(std::string_view toml);
Result<ScenarioParameters> parse_scenario_parameters(std::string_view toml);

/// Returns the canonical text. Equal parameters have equal text, and parsing the text returns them.
std::string to_toml(const FlatParameters& parameters);
std::string to_toml(const TerrainParameters& parameters);
std::string to_toml(const LandscapeParameters& parameters);
std::string to_toml(const ScenarioParameters& parameters);

}  // namespace runstone
