// A writer of NBT and of the schematics of Minecraft's tools for tests, made from the published
// formats. It shares no code with the readers and writers of common/formats.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"

namespace runstone::test {

/// Appends values of NBT. In lists, names are left out.
class NbtBytes {
 public:
  NbtBytes& open(std::string_view name) { return head(10, name); }
  NbtBytes& close() { return raw({0}); }
  NbtBytes& i16(std::string_view name, int v) { return head(2, name).big(v, 2); }
  NbtBytes& i32(std::string_view name, std::int64_t v) { return head(3, name).big(v, 4); }
  NbtBytes& i64(std::string_view name, std::int64_t v) { return head(4, name).big(v, 8); }
  NbtBytes& text(std::string_view name, std::string_view v) { return head(8, name).chars(v); }
  NbtBytes& bytes(std::string_view name, const Bytes& v);
  NbtBytes& ints(std::string_view name, const std::vector<std::int32_t>& v);
  NbtBytes& longs(std::string_view name, const std::vector<std::uint64_t>& v);
  NbtBytes& list(std::string_view name, std::uint8_t type, std::int64_t count);
  NbtBytes& raw(const Bytes& v);
  /// Appends the low bytes of a number, the highest of them first.
  NbtBytes& big(std::int64_t v, int bytes);
  const Bytes& get() const { return out_; }

 private:
  NbtBytes& head(std::uint8_t type, std::string_view name);
  NbtBytes& chars(std::string_view text);
  Bytes out_;
};

Bytes gzip_of(const Bytes& plain);

/// A .schem. Every field can be set wrong.
struct SpongeFields {
  std::int64_t version = 2;  // the fields lie where this version has them
  VoxelPos sides{2, 1, 1};
  std::vector<std::pair<std::string, std::int64_t>> palette;
  std::vector<std::uint32_t> cells;  // (y * length + z) * width + x
  std::vector<std::int32_t> offset = {0, 0, 0};
  std::vector<std::int32_t> origin;  // of WorldEdit; empty: none
  std::string name, author;
  std::int64_t date = 0;
  bool has_data_first = false;  // the data precede the palette
};
Bytes sponge_plain(const SpongeFields& fields);

/// A .schematic of MCEdit. Every field can be set wrong.
struct MceditFields {
  VoxelPos sides{2, 1, 1};
  std::string materials = "Alpha";
  Bytes blocks, data, add;                           // empty `add`: there is none
  std::vector<std::pair<std::string, int>> mapping;  // empty: there is none
};
Bytes mcedit_plain(const MceditFields& fields);

/// A region of a .litematic. Every field can be set wrong.
struct LitematicRegionFields {
  std::string name = "region";
  VoxelPos position, size{2, 1, 1};
  struct State {
    std::string name;
    std::vector<std::pair<std::string, std::string>> properties;
  };
  std::vector<State> palette;
  std::vector<std::uint64_t> longs;
};
Bytes litematic_plain(const std::vector<LitematicRegionFields>& regions, int version = 6);
/// Packs numbers bit by bit.
std::vector<std::uint64_t> packed_longs(const std::vector<std::uint32_t>& numbers, unsigned bits);

}  // namespace runstone::test
