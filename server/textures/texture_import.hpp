// TextureImport: the textures that a folder of pictures has for the materials of a world
// (docs/materials.md, "Textures"). Thread: any. Blocks on the disk.
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "common/edits/descriptor/given_texture.hpp"
#include "common/materials/material_table.hpp"
#include "common/textures/texture_table.hpp"

namespace runstone {

/// Names and lines that a TextureImport keeps to show them.
inline constexpr std::size_t kTextureLinesShown = 8;

struct TextureImport {
  /// Pictures for which read_texture() succeeds, with their uses. The present table takes all of
  /// them.
  std::vector<std::shared_ptr<const GivenTexture>> textures;
  std::string kind;                        // of the folder, in words
  std::size_t pictures = 0;                // different ones
  std::size_t materials = 0, sides = 0;    // that get a picture
  std::size_t sides_before = 0;            // that have one already
  std::size_t without = 0;                 // materials for which the folder has no picture
  std::vector<std::string> without_names;  // the first ones
  std::size_t faults = 0;                  // pictures that cannot be used
  std::vector<std::string> fault_lines;    // the first ones
};

/// Reads the pictures of a folder, or of one file, for the materials of a table. `present`: the
/// textures that the world has. Ends early if `should_continue` returns false. The error is one
/// line that begins with the place. Memory: the textures, and some pictures.
Result<TextureImport, std::string> import_textures(
    const std::string& place, const MaterialTable& materials, const TextureTable& present,
    const std::function<bool()>& should_continue = {});

/// Returns what an import found, in lines for people.
std::string textures_text(const TextureImport& found);

}  // namespace runstone
