// NamedPictures: a folder of PNGs that are named for materials and sides. docs/materials.md,
// "Textures", has the names. A material "mod:stone" finds mod_stone.png, or else stone.png.
#pragma once
#include <map>
#include <string>
#include <string_view>

#include "server/textures/side_pictures.hpp"

namespace runstone {

class NamedPictures final : public PictureSource {
 public:
  /// `files`: the path of each picture by its name without ending.
  explicit NamedPictures(std::map<std::string, std::string> files) : files_(std::move(files)) {}

  const char* kind() const override { return "a folder of pictures"; }
  SidePictures pictures_of(const MaterialInfo& material) override;

 private:
  /// Returns the first picture that there is, of the names "stem_part" for each part. A part ""
  /// means the stem alone.
  SidePicture first_of(const std::string& stem, std::initializer_list<const char*> parts) const;
  SidePictures upright(const std::string& stem) const;

  std::map<std::string, std::string> files_;
};

}  // namespace runstone
