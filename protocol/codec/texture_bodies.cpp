#include <utility>

#include "protocol/codec/body_reader.hpp"
#include "protocol/codec/texture_list.hpp"

namespace runstone {

Result<Message> BodyReader::read(const wire::TexturesGiven& t) const {
  auto entries = decode_textures(view_of(t.entries()));
  if (!entries) return failure(entries.error());
  return TexturesGiven{*std::move(entries)};
}

Result<Message> BodyReader::read(const wire::TexturesWanted& t) const {
  auto hashes = decode_hashes(view_of(t.hashes()));
  if (!hashes) return failure(hashes.error());
  return TexturesWanted{*std::move(hashes)};
}

Result<Message> BodyReader::read(const wire::TextureParts& t) const {
  auto parts = decode_texture_parts(view_of(t.parts()));
  if (!parts) return failure(parts.error());
  return TextureParts{*std::move(parts)};
}

}  // namespace runstone
