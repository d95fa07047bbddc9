#include "tests/support/codec/packed_spelling.hpp"

#include <zstd.h>

#include <stdexcept>

namespace runstone::test {

Bytes zstd_frame(ByteView body, bool announce) {
  Bytes out(ZSTD_compressBound(body.size()));
  ZSTD_CCtx* const context = ZSTD_createCCtx();
  ZSTD_CCtx_setParameter(context, ZSTD_c_contentSizeFlag, announce ? 1 : 0);
  const std::size_t size =
      ZSTD_compress2(context, out.data(), out.size(), body.data(), body.size());
  ZSTD_freeCCtx(context);
  if (ZSTD_isError(size) != 0) throw std::runtime_error("zstd does not compress");
  out.resize(size);
  out.erase(out.begin(), out.begin() + 4);
  return out;
}

PackedSpelling::PackedSpelling() : palette({0, 0, 298}), body({1, 0, 2, 231, 3}) {}

Bytes PackedSpelling::bytes() const {
  Bytes out{encoding, version, order, sides[0], sides[1], sides[2]};
  spell_varint(out, runs);
  spell_varint(out, palette_size.value_or(palette.size()));
  for (const std::uint64_t step : palette) spell_varint(out, step);
  const Bytes& rest = stored ? *stored : body;
  out.insert(out.end(), rest.begin(), rest.end());
  return out;
}

}  // namespace runstone::test
