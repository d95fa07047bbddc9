#include "tests/support/rlog/rlog_bytes.hpp"

#include <xxhash.h>

#include <algorithm>

namespace runstone::test {
namespace {

std::uint64_t little_endian(const Bytes& file, std::size_t at, std::size_t bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) value |= std::uint64_t{file[at + i]} << (8 * i);
  return value;
}

void put_u64(Bytes& file, std::size_t at, std::uint64_t value) {
  for (std::size_t i = 0; i < 8; ++i) file[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

}  // namespace

RlogWorld sample_rlog_world(Sequence first) {
  RlogWorld world;
  for (std::size_t i = 0; i < world.world_id.size(); ++i)
    world.world_id[i] = static_cast<std::uint8_t>(i + 1);
  world.chunk_edge = 16;
  world.generator = {"flat", 2, 0x9000000000000001ULL, "ground = \"stone\"\n"};
  world.materials = "# two rows\n";
  world.spawn = {0.5, 70.25, -3.0};
  world.has_base = first != 1;
  if (first != 1) {
    world.head = {1, first - 1};
    world.head_us = 1'600'000'000'000'000;
  }
  return world;
}

std::vector<RlogPlayer> sample_rlog_players() {
  std::vector<RlogPlayer> players = {{1, {}, "ada"}, {300, {}, "zo\xc3\xab"}};
  players[0].key.fill(7);
  players[1].key.fill(9);
  return players;
}

Bytes rlog_of(const RlogWorld& world, std::span<const RlogPlayer> players,
              std::span<const EditRecord> records, RlogOptions options) {
  Bytes file;
  RlogWriter writer(
      [&](ByteView bytes) {
        file.insert(file.end(), bytes.begin(), bytes.end());
        return true;
      },
      options);
  RUNSTONE_ASSERT(writer.begin(world, players).has_value());
  for (const EditRecord& record : records) RUNSTONE_ASSERT(writer.add(record).has_value());
  RUNSTONE_ASSERT(writer.finish().has_value());
  RUNSTONE_ASSERT(writer.bytes() == file.size());
  return file;
}

RlogSource source_of(const Bytes& file) {
  return
      [&file](std::uint64_t position, std::span<std::uint8_t> out) -> std::optional<std::size_t> {
        if (position >= file.size()) return 0;
        const std::size_t count = std::min<std::size_t>(out.size(), file.size() - position);
        std::copy_n(file.begin() + static_cast<std::ptrdiff_t>(position), count, out.begin());
        return count;
      };
}

RlogContents read_rlog(const Bytes& file, Sequence from) {
  RlogContents contents;
  auto reader = RlogReader::open(source_of(file));
  if (!reader) {
    contents.error = reader.error();
    return contents;
  }
  contents.world = reader->world();
  contents.players = reader->players();
  const auto read = reader->read(from, [&](const EditRecord& record) {
    contents.records.push_back(record);
    return true;
  });
  if (!read) contents.error = read.error();
  return contents;
}

std::vector<std::size_t> blocks_of(const Bytes& file) {
  std::vector<std::size_t> begins;
  std::size_t at = kRlogFileHeadBytes;
  while (at + kRlogHeaderBytes <= file.size()) {
    begins.push_back(at);
    at += kRlogHeaderBytes + static_cast<std::size_t>(little_endian(file, at + 4, 4));
  }
  begins.push_back(file.size());
  return begins;
}

void mend_rlog(Bytes& file) {
  std::uint64_t before = 0;
  std::size_t at = kRlogFileHeadBytes;
  while (at + kRlogHeaderBytes <= file.size()) {
    const auto stored = static_cast<std::size_t>(little_endian(file, at + 4, 4));
    const std::size_t payload = at + kRlogHeaderBytes;
    put_u64(file, at + 40, at);
    if (stored <= file.size() - payload)
      put_u64(file, at + 48, XXH3_64bits(file.data() + payload, stored));
    before = XXH3_64bits_withSeed(file.data() + at, kRlogHeaderBytes - 8, before);
    put_u64(file, at + 56, before);
    if (stored > file.size() - payload) return;
    at = payload + stored;
  }
}

}  // namespace runstone::test
