// MinecraftPictures: the textures of a resource pack of Minecraft, or of the game's own assets, in
// a folder that has assets/NAMESPACE/{blockstates,models,textures}. For a block, the first variant
// of its blockstates that fits its states names a model; the model and its parents name a texture
// for each side.
#pragma once
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "common/core/result.hpp"
#include "server/textures/picture_files.hpp"
#include "server/textures/side_pictures.hpp"

namespace runstone {

class MinecraftPictures final : public PictureSource {
 public:
  /// `pictures` and `texts`: the .png and .json files below the folder assets.
  MinecraftPictures(FilesBelow pictures, FilesBelow texts)
      : pictures_(std::move(pictures)), texts_(std::move(texts)) {}
  /// Reads the names in a folder that has the folder assets. Fails with one line if it cannot be
  /// read.
  static Result<std::unique_ptr<PictureSource>, std::string> open(const std::string& folder);

  const char* kind() const override { return "a resource pack of Minecraft"; }
  SidePictures pictures_of(const MaterialInfo& material) override;

 private:
  using Json = nlohmann::json;
  /// Returns a file below the assets, or null if there is none, it is too long or no JSON, or too
  /// much was read before.
  const Json& json_of(const std::string& path);
  /// Returns the variant that the states of a block choose: {"model": ..., "x": ..., "y": ...}.
  const Json& variant_of(const std::string& name, std::string_view states);
  SidePictures pictures_of_model(const std::string& model, bool is_cube);
  /// Returns the path of the picture of a text such as "#side" or "minecraft:block/stone", or an
  /// empty text.
  std::string texture_path(std::string text,
                           const std::map<std::string, std::string>& textures) const;

  FilesBelow pictures_, texts_;
  std::map<std::string, Json> read_;
  std::size_t read_bytes_ = 0;
};

}  // namespace runstone
