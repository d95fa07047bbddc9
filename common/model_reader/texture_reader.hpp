// TextureReader: the textures of a model, decoded from files of its folder and from bytes within the
// model: PNG, JPEG, BMP and TGA. Their sizes are checked before they are decoded.
// Thread: one. Calls block on the disk.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/model_reader/model_folder.hpp"
#include "common/model_reader/reader_notices.hpp"
#include "common/models/model.hpp"

namespace runstone {

/// The meaning of the alpha values of a texture to a material.
enum class AlphaRule : std::uint8_t {
  opaque,  // nothing: all texels are opaque
  mask,    // texels below the cutoff are transparent, all others opaque
  blend    // as they are
};

class TextureReader {
 public:
  /// All must outlive this object. Textures are added to `textures`.
  TextureReader(const ModelFolder& folder, std::vector<ModelTexture>& textures,
                ReaderNotices& notices)
      : folder_(folder), textures_(textures), notices_(notices) {}

  struct Alpha {
    AlphaRule rule = AlphaRule::blend;
    std::uint8_t cutoff = 128;
    friend auto operator<=>(const Alpha&, const Alpha&) = default;
  };
  /// Returns the number of the texture in the file at a path, which is decoded once. If there is none
  /// at the path, a file of its last name in the folder of the model is taken, because many exporters
  /// write paths of their own machine. Returns nullopt, with a notice, if there is none either, or if
  /// it cannot be decoded. Fails if it is too large; the error is one line.
  Result<std::optional<std::uint32_t>, std::string> from_file(const std::string& path, Alpha alpha);
  /// Does the same with the bytes of an image file. Equal names are equal images.
  Result<std::optional<std::uint32_t>, std::string> from_bytes(const std::string& name,
                                                               ByteView bytes, Alpha alpha);

 private:
  using Number = std::optional<std::uint32_t>;
  using Key = std::tuple<std::string, AlphaRule, std::uint8_t>;

  Result<Number, std::string> decode(const std::string& name, ByteView bytes, Alpha alpha);
  Result<Bytes, ModelFolder::Refusal> load(const std::string& path) const;

  const ModelFolder& folder_;
  std::vector<ModelTexture>& textures_;
  ReaderNotices& notices_;
  std::map<Key, Number> known_;
  std::size_t bytes_ = 0;  // of all textures
};

}  // namespace runstone
