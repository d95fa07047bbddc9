#include "client/tools/preview_words.hpp"

#include <cstdint>

namespace runstone {

std::string preview_words(const ToolBox& box) {
  if (box.is_preview_too_large()) return "too large for a preview: a click makes all of it";
  const EditPreview& edits = box.preview();
  const BuildPreview& builds = box.build_preview();
  const std::uint64_t set = edits.placed_voxels() + builds.placed_voxels();
  if (const auto choice = box.previewed_choice()) {
    const char* const verb = *choice == SelectMode::remove ? "deselects " : "selects ";
    return verb + std::to_string(set) + " voxels";
  }
  if (box.previews_copy()) return "copies " + std::to_string(set) + " voxels";
  const std::uint64_t removed = edits.removed_voxels() + builds.removed_voxels();
  // Builds are not compared with the world: unless they are differences, their numbers are upper
  // bounds.
  return std::string("sets ") + (builds.is_exact() ? "" : "up to ") + std::to_string(set) +
         " and removes " + std::to_string(removed) + " voxels";
}

}  // namespace runstone
