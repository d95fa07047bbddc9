#include "common/rlog/rlog_world.hpp"

#include <algorithm>
#include <bit>
#include <string_view>

#include "common/core/coords.hpp"
#include "common/rlog/rlog_block.hpp"

namespace runstone {
namespace {

void write_text(ByteWriter& w, std::string_view text) {
  w.varint(text.size());
  w.bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::string read_text(ByteReader& r, std::uint64_t bytes_max) {
  const ByteView text =
      r.bytes(static_cast<std::size_t>(r.varint_max(bytes_max, "text is too long")));
  return {text.begin(), text.end()};
}

template <std::size_t N>
std::array<std::uint8_t, N> read_array(ByteReader& r) {
  std::array<std::uint8_t, N> out{};
  const ByteView in = r.bytes(N);
  std::copy(in.begin(), in.end(), out.begin());
  return out;
}

}  // namespace

Bytes encode_rlog_world(const RlogWorld& world) {
  Bytes out(world.world_id.begin(), world.world_id.end());
  ByteWriter w(out);
  w.varint(world.chunk_edge);
  write_text(w, world.generator.name);
  w.varint(world.generator.version);
  w.u64(world.generator.seed);
  write_text(w, world.generator.parameters);
  for (const double coordinate : world.spawn) w.f64(coordinate);
  w.u8(world.has_base ? 1 : 0);
  w.varint(world.head.epoch);
  write_text(w, world.materials);
  return out;
}

Result<RlogWorld> decode_rlog_world(ByteView in) {
  ByteReader r(in);
  RlogWorld world;
  world.world_id = read_array<16>(r);
  const std::uint64_t edge = r.varint_max(128, "chunk edge is not 16, 32, 64 or 128");
  if (r.ok() && (edge < 16 || !std::has_single_bit(edge))) {
    r.reject(ErrorCode::bad_value, "chunk edge is not 16, 32, 64 or 128");
  }
  world.chunk_edge = static_cast<std::uint16_t>(edge);
  world.generator.name = read_text(r, kRlogRawBytesMax);
  world.generator.version =
      static_cast<std::uint32_t>(r.varint_max(kRlogU32Max, "version exceeds 32 bits"));
  world.generator.seed = r.u64();
  world.generator.parameters = read_text(r, kRlogRawBytesMax);
  for (double& coordinate : world.spawn) {
    coordinate = r.f64();
    // The condition is also false for a NaN.
    if (r.ok() && !(coordinate >= -kWorldLimit && coordinate < kWorldLimit)) {
      r.reject(ErrorCode::bad_value, "spawn lies outside the world");
    }
  }
  const std::uint8_t has_base = r.u8();
  if (has_base > 1) r.reject(ErrorCode::bad_value, "neither has base chunks nor has none");
  world.has_base = has_base == 1;
  world.head.epoch = static_cast<Epoch>(r.varint_max(kRlogU32Max, "epoch exceeds 32 bits"));
  world.materials = read_text(r, kRlogRawBytesMax);
  if (const auto done = r.finish(); !done) return failure(done.error());
  return world;
}

void encode_rlog_player(const RlogPlayer& player, Bytes& out) {
  RUNSTONE_ASSERT(player.author != 0 && player.name.size() <= kRlogNameBytesMax);
  ByteWriter w(out);
  w.varint(player.author);
  w.bytes(player.key);
  write_text(w, player.name);
}

Result<void> decode_rlog_players(ByteView in, std::uint32_t count, AuthorId author_before,
                                 std::vector<RlogPlayer>& out) {
  ByteReader r(in);
  for (std::uint32_t i = 0; i < count; ++i) {
    RlogPlayer player;
    player.author = static_cast<AuthorId>(r.varint_max(kRlogU32Max, "author exceeds 32 bits"));
    if (r.ok() && player.author <= author_before)
      r.reject(ErrorCode::bad_value, "authors do not ascend");
    player.key = read_array<32>(r);
    player.name = read_text(r, kRlogNameBytesMax);
    if (!r.ok()) break;
    author_before = player.author;
    out.push_back(std::move(player));
  }
  return r.finish();
}

}  // namespace runstone
