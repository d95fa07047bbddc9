#include "tests/support/formats/luanti_bytes.hpp"

#include <zlib.h>
#include <zstd.h>

#include <map>

#include "common/core/assert.hpp"

namespace runstone::test {
namespace {

void put_u16(Bytes& out, unsigned v) {
  out.push_back(static_cast<std::uint8_t>(v >> 8));
  out.push_back(static_cast<std::uint8_t>(v & 255));
}

void put_zlib(Bytes& out, const Bytes& plain) {
  uLongf size = compressBound(plain.size());
  const std::size_t at = out.size();
  out.resize(at + size);
  const int status = compress(out.data() + at, &size, plain.data(), plain.size());
  RUNSTONE_ASSERT(status == Z_OK);
  out.resize(at + size);
}

}  // namespace

Bytes luanti_plain(const LuantiBlockFields& fields) {
  Bytes out = {0, 0xff, 0xff, 0, 0, 0, 0};  // flags, lighting, timestamp
  out.push_back(fields.name_table_version);
  put_u16(out, static_cast<unsigned>(fields.names.size()));
  for (const auto& [id, name] : fields.names) {
    put_u16(out, id);
    put_u16(out, static_cast<unsigned>(name.size()));
    out.insert(out.end(), name.begin(), name.end());
  }
  out.push_back(fields.content_width);
  out.push_back(fields.params_width);
  for (const std::uint16_t id : fields.nodes) put_u16(out, id);
  out.insert(out.end(), 4096, 0x0f);  // light
  out.insert(out.end(), fields.param2.begin(), fields.param2.end());
  out.insert(out.end(), fields.rest.begin(), fields.rest.end());
  return out;
}

Bytes luanti_row(const Bytes& plain, std::uint8_t version) {
  ZSTD_CStream* stream = ZSTD_createCStream();
  RUNSTONE_ASSERT(stream != nullptr);
  Bytes out(1 + ZSTD_compressBound(plain.size()));
  out[0] = version;
  ZSTD_outBuffer target{out.data() + 1, out.size() - 1, 0};
  ZSTD_inBuffer source{plain.data(), plain.size(), 0};
  // There are two calls. If the call that ends the frame had all input, zstd would write the
  // content size.
  ZSTD_compressStream2(stream, &target, &source, ZSTD_e_continue);
  const std::size_t left = ZSTD_compressStream2(stream, &target, &source, ZSTD_e_end);
  RUNSTONE_ASSERT(left == 0);
  ZSTD_freeCStream(stream);
  out.resize(1 + target.pos);
  return out;
}

Bytes luanti_old_row(const LuantiBlockFields& fields, std::uint8_t version, const Bytes& metadata,
                     const Bytes& behind) {
  Bytes out = {version, 0};
  if (version >= 27) put_u16(out, 0xffff);  // lighting
  out.push_back(fields.content_width);
  out.push_back(fields.params_width);
  Bytes nodes;
  for (const std::uint16_t id : fields.nodes) put_u16(nodes, id);
  nodes.insert(nodes.end(), 4096, 0x0f);  // light
  nodes.insert(nodes.end(), fields.param2.begin(), fields.param2.end());
  put_zlib(out, nodes);
  put_zlib(out, metadata);
  if (version == 24) {  // one timer: place, timeout, elapsed
    out.insert(out.end(), {1, 0, 1, 0, 7, 0, 0, 0, 1, 0, 0, 0, 2});
  }
  out.insert(out.end(), {0, 0, 1, 7});  // one object: kind, place, three bytes
  out.insert(out.end(), 12, 0x55);
  out.insert(out.end(), {0, 3, 'o', 'b', 'j'});
  out.insert(out.end(), {0, 0, 0, 9});  // timestamp
  out.push_back(fields.name_table_version);
  put_u16(out, static_cast<unsigned>(fields.names.size()));
  for (const auto& [id, name] : fields.names) {
    put_u16(out, id);
    put_u16(out, static_cast<unsigned>(name.size()));
    out.insert(out.end(), name.begin(), name.end());
  }
  out.insert(out.end(), behind.begin(), behind.end());
  return out;
}

namespace {

struct LuantiPlanes {
  std::vector<std::string> names;
  Bytes param2;
};

LuantiPlanes luanti_planes(ByteView row) {
  ZSTD_DStream* stream = ZSTD_createDStream();
  RUNSTONE_ASSERT(stream != nullptr && row[0] == 29);
  Bytes plain(4 << 20);
  ZSTD_outBuffer target{plain.data(), plain.size(), 0};
  ZSTD_inBuffer source{row.data() + 1, row.size() - 1, 0};
  const std::size_t left = ZSTD_decompressStream(stream, &target, &source);
  RUNSTONE_ASSERT(left == 0);
  ZSTD_freeDStream(stream);

  std::size_t at = 8;
  const auto u16 = [&] {
    at += 2;
    return plain[at - 2] * 256u + plain[at - 1];
  };
  std::map<unsigned, std::string> names;
  const unsigned count = u16();
  for (unsigned i = 0; i < count; ++i) {
    const unsigned id = u16();
    const unsigned size = u16();
    names[id] = std::string(plain.begin() + static_cast<std::ptrdiff_t>(at),
                            plain.begin() + static_cast<std::ptrdiff_t>(at + size));
    at += size;
  }
  at += 2;  // widths
  LuantiPlanes out;
  for (int node = 0; node < 4096; ++node) out.names.push_back(names.at(u16()));
  at += 4096;  // light
  out.param2.assign(plain.begin() + static_cast<std::ptrdiff_t>(at),
                    plain.begin() + static_cast<std::ptrdiff_t>(at + 4096));
  return out;
}

}  // namespace

std::vector<std::string> luanti_nodes(ByteView row) { return luanti_planes(row).names; }

Bytes luanti_params(ByteView row) { return luanti_planes(row).param2; }

}  // namespace runstone::test
