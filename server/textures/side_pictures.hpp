// SidePictures: the pictures that a material has on its sides, by name, and PictureSource: where a
// folder says so. The kinds of folders are sources of their own (named_pictures.hpp,
// luanti_pictures.hpp, minecraft_pictures.hpp).
#pragma once
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "common/core/coords.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// The pictures that lie over each other, at most.
inline constexpr std::size_t kPictureLayersMax = 8;

/// A picture by the path of its file. Further pictures lie over it, from the lower to the upper
/// one.
struct SidePicture {
  std::vector<std::string> layers;  // at most kPictureLayersMax; empty: the side has no picture
  bool is_tinted = false;           // it is grey and gets the colour of the material
  friend auto operator<=>(const SidePicture&, const SidePicture&) = default;
};

struct SidePictures {
  std::array<SidePicture, kDirectionCount> of;  // by Direction
  SidePicture& operator[](Direction d) { return of[static_cast<std::size_t>(d)]; }
  const SidePicture& operator[](Direction d) const { return of[static_cast<std::size_t>(d)]; }
  bool empty() const {
    for (const SidePicture& side : of) {
      if (!side.layers.empty()) return false;
    }
    return true;
  }
};

class PictureSource {
 public:
  virtual ~PictureSource() = default;
  /// Returns the words for this kind of folder.
  virtual const char* kind() const = 0;
  /// Returns the pictures of a material. The paths are those of files that were there. A side
  /// without a picture is empty.
  virtual SidePictures pictures_of(const MaterialInfo& material) = 0;
};

}  // namespace runstone
