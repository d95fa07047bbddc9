// Commands that place a build: the words that say where and how, and the steps up to PlaceService.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

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

/// Takes `at X Y Z` and the words behind it.
PlaceWords take_place_words(WordReader& reader);

/// Places a build from a file as an action of the caller. If the world lacks materials of it and the
/// words do not say how to treat them, refuses and lists them. Only console and operators may add
/// materials. Answers begin with `name`, and refusals with `command`.
void place_build(const CommandCall& call, const std::string& command, const std::string& name,
                 std::shared_ptr<const FileBuild> build, const PlaceWords& words);

}  // namespace runstone
