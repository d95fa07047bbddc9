// WorldTextures: the textures of the world as the world strand knows them: their table, and the
// bytes of the pictures, which players fetch.
// Thread: the world strand. Memory: at most kTexturesBytesMax of pictures, 12 bytes a use, and 12
// bytes a material up to the last one.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "common/edits/descriptor/edit_record.hpp"
#include "common/textures/texture_table.hpp"

namespace runstone {

using GivenTexturePtr = std::shared_ptr<const GivenTexture>;

class WorldTextures {
 public:
  /// `start` has the textures of the log before this run, in order. Requires that a table accepts
  /// all of them.
  explicit WorldTextures(std::span<const GivenTexturePtr> start);

  /// Applies the textures among records that were ordered just now. Returns true if there are any.
  bool apply(std::span<const EditRecord> records);

  const TextureTable& table() const { return table_; }
  /// Returns the bytes of entry `index` of the table.
  const Bytes& png(std::size_t index) const { return pictures_[index]->png; }
  /// Returns one entry for each record that gives a texture, in the order of the log.
  std::span<const TextureEntry> given() const { return given_; }
  /// Returns the record that gave a texture last in this run, or 0.
  Sequence newest() const { return newest_; }

 private:
  void add(const GivenTexturePtr& given);

  TextureTable table_;
  std::vector<GivenTexturePtr> pictures_;  // of each entry of the table
  std::vector<TextureEntry> given_;
  Sequence newest_ = 0;
};

}  // namespace runstone
