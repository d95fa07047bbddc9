// SceneMaterials: the materials of a scene that Assimp read, as those of a model. Only those that occur
// are made. Thread: one. Calls block on the disk.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "common/model_reader/reader_notices.hpp"
#include "common/model_reader/scene_model.hpp"
#include "common/model_reader/texture_reader.hpp"
#include "common/models/model.hpp"

struct aiMaterial;
struct aiScene;

namespace runstone {

/// Returns a value of the range 0 .. 1 as a byte. Others are clamped; NaN is 0.
std::uint8_t unit_byte(float value);
/// Returns a linear value as one of sRGB (IEC 61966-2-1), as unit_byte() does.
std::uint8_t srgb_byte(float linear);

class SceneMaterials {
 public:
  /// All must outlive this object.
  SceneMaterials(const aiScene& scene, const SceneRules& rules, const ModelFolder& folder,
                 Model& model, ReaderNotices& notices);

  /// Returns the number in the model of a material of the scene. Fails as TextureReader does, or if
  /// there are too many.
  Result<std::uint32_t, std::string> number_of(std::uint32_t scene_number);
  /// Returns the set of texture places of a mesh that the texture of this material uses.
  std::uint32_t place_set_of(std::uint32_t scene_number) const;
  /// Returns true if no material says anything: all are those that Assimp adds to files without
  /// materials.
  bool are_defaults() const { return are_defaults_; }

 private:
  Result<ModelMaterial, std::string> material_of(const aiMaterial& from);
  Result<std::optional<std::uint32_t>, std::string> texture_of(const aiMaterial& from,
                                                               TextureReader::Alpha alpha);

  const aiScene& scene_;
  const SceneRules& rules_;
  Model& model_;
  ReaderNotices& notices_;
  TextureReader textures_;
  std::map<std::uint32_t, std::uint32_t> numbers_;
  bool are_defaults_ = true;
};

}  // namespace runstone
