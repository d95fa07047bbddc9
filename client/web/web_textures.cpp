#include "client/web/web_textures.hpp"

#include "client/web/page.hpp"

namespace runstone {

void WebTextures::look_up_textures(std::vector<TextureHash> hashes) {
  Bytes bytes;
  for (const TextureHash& hash : hashes) bytes.insert(bytes.end(), hash.begin(), hash.end());
  const auto count = static_cast<int>(hashes.size());
  lookups_.push_back({std::move(hashes), {}});
  page_textures_find(bytes.data(), count);
}

void WebTextures::keep_textures(const std::vector<TexturePart>& parts) {
  Bytes rows;
  ByteWriter out(rows);
  for (const TexturePart& part : parts) {
    out.bytes(part.hash);
    out.u32(static_cast<std::uint32_t>(part.png.size()));
    out.bytes(part.png);
  }
  page_textures_keep(rows.data(), static_cast<int>(rows.size()));
}

void WebTextures::found(std::size_t index, ByteView png) {
  if (lookups_.empty() || index >= lookups_.front().hashes.size()) return;
  if (png.size() > kTextureBytesMax) return;
  OpenLookup& open = lookups_.front();
  open.found.push_back({open.hashes[index], {png.begin(), png.end()}});
}

void WebTextures::looked_up() {
  if (lookups_.empty()) return;
  results_.push_back(std::move(lookups_.front().found));
  lookups_.pop_front();
}

}  // namespace runstone
