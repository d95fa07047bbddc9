#include "protocol/codec/texture_list.hpp"

#include <algorithm>
#include <set>

#include "common/core/assert.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

TextureHash read_texture_hash(ByteReader& r) {
  TextureHash hash{};
  const ByteView bytes = r.bytes(hash.size());
  if (r.ok()) std::copy(bytes.begin(), bytes.end(), hash.begin());
  return hash;
}

}  // namespace

Bytes encode_textures(const std::vector<TextureEntry>& entries) {
  RUNSTONE_ASSERT(!entries.empty() && entries.size() <= kTexturesGivenMax);
  Bytes out;
  ByteWriter w(out);
  w.u16(static_cast<std::uint16_t>(entries.size()));
  for (const TextureEntry& entry : entries) {
    RUNSTONE_ASSERT(entry.uses.size() <= kTextureUsesMax);
    w.bytes(entry.hash);
    w.u32(entry.bytes);
    w.u16(static_cast<std::uint16_t>(entry.uses.size()));
    for (const TextureUse& use : entry.uses) {
      w.u16(use.material);
      w.u8(use.sides);
    }
  }
  return out;
}

Result<std::vector<TextureEntry>> decode_textures(ByteView bytes) {
  ByteReader r(bytes);
  const std::size_t count = r.u16();
  if (r.ok() && (count == 0 || count > kTexturesGivenMax))
    r.reject(ErrorCode::limit_exceeded, "textures_given: not 1 .. 1024 pictures");
  std::vector<TextureEntry> entries;
  std::size_t use_count = 0;
  while (r.ok() && entries.size() < count) {
    TextureEntry entry;
    entry.hash = read_texture_hash(r);
    entry.bytes = r.u32();
    if (r.ok() && (entry.bytes == 0 || entry.bytes > kTextureBytesMax))
      r.reject(ErrorCode::bad_value, "textures_given: the size of a picture is not 1 .. 24576");
    const std::size_t uses = r.u16();
    use_count += uses;
    if (uses > kTextureUsesMax || use_count > kTexturesGivenUsesMax)
      r.reject(ErrorCode::limit_exceeded, "textures_given: too many uses");
    while (r.ok() && entry.uses.size() < uses) {
      const Material material = r.u16();
      entry.uses.push_back({material, r.u8()});
    }
    if (!r.ok()) break;
    if (const auto sound = check_texture_uses(entry.uses); !sound) return failure(sound.error());
    entries.push_back(std::move(entry));
  }
  if (const auto done = r.finish(); !done) return failure(done.error());
  return entries;
}

Bytes encode_hashes(const std::vector<TextureHash>& hashes) {
  RUNSTONE_ASSERT(!hashes.empty() && hashes.size() <= kTexturesWantedMax);
  Bytes out;
  ByteWriter w(out);
  for (const TextureHash& hash : hashes) w.bytes(hash);
  return out;
}

Result<std::vector<TextureHash>> decode_hashes(ByteView bytes) {
  if (bytes.empty() || bytes.size() > kTexturesWantedMax * sizeof(TextureHash))
    return fail(ErrorCode::limit_exceeded, "textures_wanted: not 1 .. 96 hashes");
  ByteReader r(bytes);
  std::vector<TextureHash> hashes;
  std::set<TextureHash> known;
  while (r.ok() && !r.at_end()) {
    hashes.push_back(read_texture_hash(r));
    if (!known.insert(hashes.back()).second)
      r.reject(ErrorCode::bad_value, "textures_wanted: a hash is there twice");
  }
  if (const auto done = r.finish(); !done) return failure(done.error());
  return hashes;
}

Bytes encode_texture_parts(const std::vector<TexturePart>& parts) {
  RUNSTONE_ASSERT(!parts.empty() && parts.size() <= kTexturesWantedMax);
  Bytes out;
  ByteWriter w(out);
  for (const TexturePart& part : parts) {
    RUNSTONE_ASSERT(part.png.size() <= kTextureBytesMax);
    w.bytes(part.hash);
    w.u16(static_cast<std::uint16_t>(part.png.size()));
    w.bytes(part.png);
  }
  RUNSTONE_ASSERT(out.size() <= kTexturePartsBytesMax);
  return out;
}

Result<std::vector<TexturePart>> decode_texture_parts(ByteView bytes) {
  if (bytes.empty() || bytes.size() > kTexturePartsBytesMax)
    return fail(ErrorCode::limit_exceeded, "texture_parts: not 1 .. 65536 bytes");
  ByteReader r(bytes);
  std::vector<TexturePart> parts;
  while (r.ok() && !r.at_end()) {
    TexturePart part;
    part.hash = read_texture_hash(r);
    const std::size_t size = r.u16();
    if (size > kTextureBytesMax || parts.size() == kTexturesWantedMax)
      r.reject(ErrorCode::limit_exceeded, "texture_parts: too many pictures, or a long one");
    const ByteView png = r.bytes(size);
    part.png.assign(png.begin(), png.end());
    parts.push_back(std::move(part));
  }
  if (const auto done = r.finish(); !done) return failure(done.error());
  return parts;
}

}  // namespace runstone
