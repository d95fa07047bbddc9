// Commands that place a build: the words that say where and how, and the steps up to PlaceService.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "common/build_files/model_reading.hpp"
#include "common/builds/paste_source.hpp"
#include "common/core/coords.hpp"
#include "common/edits/clipboard/orientation.hpp"
#include "common/formats/rsb_build.hpp"
#include "server/admin/command_call.hpp"

namespace runstone {

/// How a command treats the materials of a build that the world lacks.
enum class MissingMaterials : std::uint8_t {
  refused,  // the command lists them and asks
  added,    // they become new rows of the world's table, for ever
  nearest,  // they become the materials with the nearest colours
};

struct PlaceWords {
  VoxelPos at;  // of the corner of the build in the world
  Orientation orientation;
  Mask mask;
  EmptyCells empty = EmptyCells::pasted;
  MissingMaterials missing = MissingMaterials::refused;
};

/// The materials that one command adds at most. Rows of a world's table are for ever.
inline constexpr std::size_t kPlacedMaterialsMax = 1024;

/// The command that reads a file and places its build, and the words before the names of further
/// files.
inline constexpr std::string_view kImportFileWords = "import FILE";
inline constexpr std::string_view kMapWord = "map", kColoursWord = "colours";
/// The words of a command that reads a file, besides those that place its build.
struct PlacedFileWords {
  std::string map;      // the TOML file that chooses materials (material_map_file.hpp); empty: none
  std::string colours;  // the PNG with the colours of a height map; empty: none
  ModelReading model;   // how a model becomes a build
};

/// Takes `at X Y Z` and the words behind it. If `file` is not null, also takes the words for it.
PlaceWords take_place_words(WordReader& reader, PlacedFileWords* file = nullptr);

/// Places a build from a file as an action of the caller. If the world lacks materials of it and the
/// words do not say how to treat them, refuses and lists them. Only console and operators may add
/// materials. Answers begin with `name`, and refusals with `command`.
void place_build(const CommandCall& call, const std::string& command, const std::string& name,
                 std::shared_ptr<const FileBuild> build, const PlaceWords& words);

}  // namespace runstone
