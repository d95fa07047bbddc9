#include "common/edits/descriptor/given_texture.hpp"

namespace runstone {

Result<void> validate(const GivenTexture& given) {
  if (const auto edge = texture_edge(given.png); !edge) return failure(edge.error());
  return check_texture_uses(given.uses);
}

void write_given_texture(ByteWriter& w, const GivenTexture& given) {
  w.varint(given.png.size() - 1);
  w.bytes(given.png);
  w.varint(given.uses.size() - 1);
  Material before = kEmpty;
  for (const TextureUse& use : given.uses) {
    w.varint(static_cast<std::uint64_t>(use.material - before - 1));
    w.u8(use.sides);
    before = use.material;
  }
}

GivenTexture read_given_texture(ByteReader& r) {
  GivenTexture given;
  const auto size = static_cast<std::size_t>(
      1 + r.varint_max(kTextureBytesMax - 1, "the picture is longer than 24,576 bytes"));
  const ByteView png = r.bytes(size);
  given.png.assign(png.begin(), png.end());
  const std::uint64_t count = 1 + r.varint_max(kTextureUsesMax - 1, "a picture has too many uses");
  std::uint64_t material = kEmpty;
  while (r.ok() && given.uses.size() < count) {
    material += 1 + r.varint_max(kMaterialCountMax - 1, "material id exceeds 16 bits");
    if (material >= kMaterialCountMax)
      r.reject(ErrorCode::bad_value, "material id exceeds 16 bits");
    given.uses.push_back({static_cast<Material>(material), r.u8()});
  }
  return given;
}

}  // namespace runstone
