#include "common/formats/nbt_writer.hpp"

#include "common/core/assert.hpp"

namespace runstone {

void NbtWriter::int_array(std::string_view name, std::span<const std::int32_t> values) {
  array(name, NbtType::int_array, static_cast<std::int32_t>(values.size()));
  for (const std::int32_t v : values) big_endian(v);
}

void NbtWriter::list(std::string_view name, NbtType type, std::int32_t count) {
  entry(NbtType::list, name);
  out_.push_back(static_cast<std::uint8_t>(type));
  big_endian(count);
}

void NbtWriter::string_value(std::string_view text) {
  const std::string modified = to_modified_utf8(text);
  RUNSTONE_ASSERT(modified.size() <= 65'535);
  big_endian(static_cast<std::uint16_t>(modified.size()));
  out_.insert(out_.end(), modified.begin(), modified.end());
}

}  // namespace runstone
