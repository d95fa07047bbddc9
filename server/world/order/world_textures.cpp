#include "server/world/order/world_textures.hpp"

#include "common/core/assert.hpp"
#include "common/textures/texture_hash.hpp"

namespace runstone {

WorldTextures::WorldTextures(std::span<const GivenTexturePtr> start) {
  for (const GivenTexturePtr& given : start) add(given);
}

void WorldTextures::add(const GivenTexturePtr& given) {
  TextureEntry entry = texture_entry(given->png, given->uses, given->hash);
  const auto added = table_.add(entry);
  RUNSTONE_ASSERT(added.has_value());
  if (table_.entries().size() > pictures_.size()) pictures_.push_back(given);
  given_.push_back(std::move(entry));
}

bool WorldTextures::apply(std::span<const EditRecord> records) {
  bool has_changed = false;
  for (const EditRecord& record : records) {
    const auto* texture = std::get_if<TextureEdit>(&record.edit.shape);
    if (texture == nullptr) continue;
    add(texture->given);
    newest_ = record.version.seq;
    has_changed = true;
  }
  return has_changed;
}

}  // namespace runstone
