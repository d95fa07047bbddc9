#include "server/textures/stored_textures.hpp"

#include "common/textures/texture_hash.hpp"

namespace runstone {

Result<StoredTextures, std::string> read_stored_textures(LogReader& reader) {
  StoredTextures out;
  std::string wrong;
  const auto read = reader.read_textures([&](const EditRecord& record) {
    const auto* texture = std::get_if<TextureEdit>(&record.edit.shape);
    if (texture == nullptr) return true;
    const GivenTexture& given = *texture->given;
    if (const auto added = out.table.add(texture_entry(given.png, given.uses, given.hash));
        !added) {
      wrong = reader.file() + ": edit_log seq=" + std::to_string(record.version.seq) + ": " +
              added.error().what;
      return false;
    }
    out.given.push_back(texture->given);
    return true;
  });
  if (!read) return failure(read.error().message());
  if (!wrong.empty()) return failure(wrong);
  return out;
}

StoreResult<void> append_textures(Store& store,
                                  std::span<const std::shared_ptr<const GivenTexture>> textures,
                                  TimeUs time_us) {
  if (textures.empty()) return {};
  const auto epoch = store.raise_epoch();
  if (!epoch) return failure(epoch.error());
  std::vector<EditRecord> records;
  for (const auto& given : textures) {
    EditRecord record;
    const Sequence seq = records.size() + 1;
    record.version = {*epoch, seq};
    record.op = {0, 1, seq};
    record.time_us = time_us;
    record.cause = Cause::textures;
    record.edit.shape = TextureEdit{given};
    records.push_back(std::move(record));
  }
  return store.append({}, records);
}

}  // namespace runstone
