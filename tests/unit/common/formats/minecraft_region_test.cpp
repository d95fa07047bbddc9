#include "common/formats/minecraft_region.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <map>

#include "common/core/hash.hpp"
#include "common/formats/deflate.hpp"
#include "common/formats/minecraft_blocks.hpp"
#include "common/formats/nbt_writer.hpp"
#include "tests/support/formats/minecraft_bytes.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

const ForeignBlock kAirBlock{"minecraft:air", ""};

std::vector<ForeignBlock> mc_palette(std::size_t size) {
  std::vector<ForeignBlock> out;
  for (std::size_t i = 0; i < size; ++i)
    out.push_back({"minecraft:block_" + std::to_string(i % 7),
                   i < 7 ? "" : "axis=y,kind=" + std::to_string(i)});
  return out;
}

/// Stretches of random indices, and some single ones.
std::vector<std::uint16_t> random_indices(std::uint64_t seed, std::uint32_t bound) {
  SplitMix64 random(seed);
  std::vector<std::uint16_t> out;
  while (out.size() < 4096) {
    const std::size_t count = std::min<std::size_t>(1 + random.below(70), 4096 - out.size());
    out.insert(out.end(), count, static_cast<std::uint16_t>(random.below(bound)));
  }
  return out;
}

McSection mc_section(std::int8_t y, std::size_t palette, std::uint64_t seed = 1) {
  McSection out;
  out.y = y;
  out.palette = mc_palette(palette);
  out.indices = random_indices(seed, static_cast<std::uint32_t>(palette));
  return out;
}

std::vector<ForeignPiece> pieces_of(const Bytes& file, unsigned slot = 0) {
  const auto region = open_minecraft_region(file);
  REQUIRE(region.has_value());
  MinecraftChunkReader reader;
  std::vector<ForeignPiece> out;
  const auto read = reader.read(*region, slot, nullptr, [&](ForeignPiece&& piece) -> Result<void> {
    REQUIRE(validate_runs(piece.voxels).has_value());
    out.push_back(std::move(piece));
    return {};
  });
  CAPTURE(read.has_value() ? "" : read.error().what);
  REQUIRE(read.has_value());
  CHECK(*read == !out.empty());
  return out;
}

/// Returns the block at a place, or nullopt if no piece holds the place.
std::optional<ForeignBlock> block_at(const std::vector<ForeignPiece>& pieces, VoxelPos at) {
  for (const ForeignPiece& piece : pieces) {
    const Extent extent = piece.voxels.extent;
    const VoxelPos local{at.x - piece.origin.x, at.y - piece.origin.y, at.z - piece.origin.z};
    if (local.x < 0 || local.y < 0 || local.z < 0 || local.x >= extent.x || local.y >= extent.y ||
        local.z >= extent.z)
      continue;
    const Material material = material_at(
        piece.voxels, {static_cast<std::uint8_t>(local.x), static_cast<std::uint8_t>(local.y),
                       static_cast<std::uint8_t>(local.z)});
    return piece.blocks.at(material - 1U);
  }
  return std::nullopt;
}

Result<bool> read_one(const Bytes& file, unsigned slot = 0,
                      const ExternalChunk& external = nullptr) {
  const auto region = open_minecraft_region(file);
  REQUIRE(region.has_value());
  MinecraftChunkReader reader;
  return reader.read(*region, slot, external, [](ForeignPiece&&) -> Result<void> { return {}; });
}

/// Returns the error of a chunk in slot 0.
Error error_of(const McChunk& chunk) {
  const auto read = read_one(mc_region({mc_slot(0, mc_chunk(chunk))}));
  REQUIRE_FALSE(read.has_value());
  REQUIRE(std::strlen(read.error().what) > 0);
  return read.error();
}

/// Checks that a chunk in slot 0 is refused if its bytes end early, at each byte.
void check_truncations(const Bytes& packed, std::uint8_t compression) {
  Bytes file = mc_region({{0, compression, packed}});
  const auto region = open_minecraft_region(file);  // sees the changes of the file
  REQUIRE(region.has_value());
  MinecraftChunkReader reader;
  const PieceSink none = [](ForeignPiece&&) -> Result<void> { return {}; };
  REQUIRE(reader.read(*region, 0, nullptr, none).has_value());
  std::size_t refused = 0;
  for (std::size_t size = 0; size < packed.size(); ++size) {
    for (std::size_t i = 0; i < 4; ++i)
      file[8192 + i] = static_cast<std::uint8_t>((size + 1) >> (24 - 8 * i));
    const auto read = reader.read(*region, 0, nullptr, none);
    refused += !read && std::strlen(read.error().what) > 0;
  }
  CHECK(refused == packed.size());
}

void check_section(const std::vector<ForeignPiece>& pieces, const McSection& section,
                   const std::vector<ForeignBlock>& blocks, VoxelPos chunk) {
  std::size_t wrong = 0;
  for (std::uint32_t i = 0; i < 4096; ++i) {
    const VoxelPos at{chunk.x + static_cast<std::int32_t>(i % 16),
                      *section.y * 16 + static_cast<std::int32_t>(i / 256),
                      chunk.z + static_cast<std::int32_t>(i / 16 % 16)};
    wrong += block_at(pieces, at) != blocks.at(section.indices[i]);
  }
  CHECK(wrong == 0);
}

}  // namespace

TEST_CASE("blocks of a palette are read in each layout and width", "[formats]") {
  for (const auto layout : {ChunkLayout::crossed, ChunkLayout::uncrossed, ChunkLayout::tall}) {
    for (const std::size_t size : {2U, 16U, 17U, 33U, 100U, 300U, 700U, 1500U, 3000U, 4096U}) {
      CAPTURE(static_cast<int>(layout), size);
      McChunk chunk{layout, -31, 2};
      chunk.sections = {mc_section(5, size, size), mc_section(4, 3)};
      const auto pieces = pieces_of(mc_region({mc_slot(1 + 2 * 32, mc_chunk(chunk))}), 65);
      for (const McSection& section : chunk.sections)
        check_section(pieces, section, section.palette, {-31 * 16, 0, 32});
    }
  }
}

TEST_CASE("wider values than a palette needs are read", "[formats]") {
  for (const auto layout : {ChunkLayout::crossed, ChunkLayout::uncrossed}) {
    for (unsigned bits = 5; bits <= 10; ++bits) {
      CAPTURE(static_cast<int>(layout), bits);
      McChunk chunk{layout};
      chunk.version_last = true;
      chunk.sections = {mc_section(0, 3)};
      chunk.sections[0].bits = bits;
      const auto pieces = pieces_of(mc_region({mc_slot(0, mc_chunk(chunk))}));
      check_section(pieces, chunk.sections[0], chunk.sections[0].palette, {});
    }
  }
}

TEST_CASE("numbers of 1.12 become names and states", "[formats]") {
  McChunk chunk{ChunkLayout::numbers};
  McSection section;
  section.y = 3;
  section.indices = random_indices(9, 256 * 16);
  section.indices[7] = 300 << 4 | 5;  // an id of a modification
  chunk.sections = {section};
  const auto pieces = pieces_of(mc_region({mc_slot(0, mc_chunk(chunk))}));
  std::size_t wrong = 0;
  for (std::uint32_t i = 0; i < 4096; ++i) {
    const unsigned number = section.indices[i];
    const auto known = minecraft_block_of(static_cast<std::uint16_t>(number >> 4),
                                          static_cast<std::uint8_t>(number & 15));
    const auto expected = known.value_or(ForeignBlock{"numeric:" + std::to_string(number >> 4),
                                                      "data=" + std::to_string(number & 15)});
    wrong += block_at(pieces,
                      {static_cast<std::int32_t>(i % 16), 48 + static_cast<std::int32_t>(i / 256),
                       static_cast<std::int32_t>(i / 16 % 16)}) != expected;
  }
  CHECK(wrong == 0);
  CHECK(block_at(pieces, {7, 48, 0}) == ForeignBlock{"numeric:300", "data=5"});
  CHECK(block_at(pieces, {0, 47, 0}) == kAirBlock);
}

TEST_CASE("pieces are cut at multiples of 64, and missing sections are air", "[formats]") {
  McChunk chunk{ChunkLayout::tall};
  chunk.sections = {mc_section(-5, 3, 1), mc_section(-4, 1, 2), mc_section(1, 3, 3)};
  chunk.sections[1].indices.clear();  // uniform
  const auto pieces = pieces_of(mc_region({mc_slot(0, mc_chunk(chunk))}));
  REQUIRE(pieces.size() == 3);
  CHECK(pieces[0].origin == VoxelPos{0, -80, 0});
  CHECK(pieces[0].voxels.extent == Extent{16, 16, 16});
  CHECK(pieces[1].origin == VoxelPos{0, -64, 0});
  CHECK(pieces[1].voxels.extent == Extent{16, 64, 16});
  CHECK(pieces[1].voxels.runs.size() == 2);
  CHECK(pieces[2].origin == VoxelPos{0, 0, 0});
  CHECK(pieces[2].voxels.extent == Extent{16, 32, 16});
  CHECK(block_at(pieces, {3, -60, 3}) == ForeignBlock{"minecraft:block_0", ""});
  CHECK(block_at(pieces, {3, -48, 3}) == kAirBlock);
  CHECK(block_at(pieces, {3, 15, 3}) == kAirBlock);
  check_section(pieces, chunk.sections[2], chunk.sections[2].palette, {});

  SECTION("before 1.18 a chunk has 256 layers") {
    McChunk old{ChunkLayout::uncrossed};
    old.sections = {mc_section(2, 3)};
    const auto layers = pieces_of(mc_region({mc_slot(0, mc_chunk(old))}));
    REQUIRE(layers.size() == 4);
    CHECK(layers[3].origin == VoxelPos{0, 192, 0});
    CHECK(layers[3].voxels.is_uniform());
    CHECK(block_at(layers, {15, 255, 15}) == kAirBlock);
  }
  SECTION("a chunk that is not fully generated is read, one without blocks is none") {
    McChunk part = chunk;
    part.status = "features";
    CHECK(pieces_of(mc_region({mc_slot(0, mc_chunk(part))})).size() == 3);
    McChunk light{ChunkLayout::crossed};
    light.sections.resize(2);
    light.sections[0].y = -1;
    CHECK(pieces_of(mc_region({mc_slot(0, mc_chunk(light))})).empty());
    CHECK(pieces_of(mc_region({}), 77).empty());
    CHECK(pieces_of({}, 77).empty());
  }
}

TEST_CASE("each compression gives the same pieces", "[formats]") {
  McChunk chunk{ChunkLayout::tall};
  chunk.sections = {mc_section(0, 30), mc_section(1, 300)};
  const Bytes plain = mc_chunk(chunk);
  for (std::uint8_t compression = 1; compression <= 4; ++compression) {
    CAPTURE(int{compression});
    const auto pieces = pieces_of(mc_region({mc_slot(0, plain, compression)}));
    check_section(pieces, chunk.sections[1], chunk.sections[1].palette, {});
  }
  SECTION("and so do external files") {
    for (std::uint8_t compression = 1; compression <= 4; ++compression) {
      const Bytes outside = mc_slot(0, plain, compression).packed;
      const Bytes file = mc_region({{0, static_cast<std::uint8_t>(128 + compression), {}}});
      unsigned asked = 99;
      const auto read = read_one(file, 0, [&](unsigned slot) {
        asked = slot;
        return std::optional<ByteView>(outside);
      });
      CHECK((read.has_value() && *read));
      CHECK(asked == 0);
      const auto missing = read_one(file);
      REQUIRE_FALSE(missing.has_value());
      CHECK(missing.error().code == ErrorCode::not_found);
    }
  }
  SECTION("unknown ones are refused") {
    for (const int compression : {0, 5, 127}) {
      const auto read = read_one(mc_region({{0, static_cast<std::uint8_t>(compression), plain}}));
      REQUIRE_FALSE(read.has_value());
      CHECK(read.error().code == ErrorCode::unknown_kind);
    }
  }
}

TEST_CASE("damaged LZ4 streams are refused", "[formats]") {
  McChunk chunk{ChunkLayout::tall};
  chunk.sections = {mc_section(0, 30)};
  const Bytes plain = mc_chunk(chunk);
  const Bytes good = lz4_java_stream(plain, 1024);
  CHECK(read_one(mc_region({{0, 4, good}})).has_value());
  check_truncations(good, 4);
  for (const std::size_t at : {0U, 8U, 9U, 13U, 17U, 25U}) {
    Bytes bad = good;
    bad[at] ^= 0xff;
    CAPTURE(at);
    CHECK_FALSE(read_one(mc_region({{0, 4, bad}})).has_value());
  }
  Bytes huge = good;
  huge[13] = huge[14] = huge[15] = huge[16] = 0xff;  // the plain size of the first block
  CHECK_FALSE(read_one(mc_region({{0, 4, huge}})).has_value());
}

TEST_CASE("chunks with bad sectors are refused, and the others are read", "[formats]") {
  std::vector<McSlot> slots;
  for (unsigned slot = 0; slot < 6; ++slot) {
    McChunk chunk{ChunkLayout::tall, static_cast<std::int32_t>(slot), 0};
    chunk.sections = {mc_section(0, 4)};
    slots.push_back(mc_slot(slot, mc_chunk(chunk)));
  }
  Bytes file = mc_region(slots);
  const auto place = [&](unsigned slot) {
    return static_cast<std::uint32_t>(file[slot * 4 + 1] << 8 | file[slot * 4 + 2]);
  };
  set_place(file, 1, place(0), 1);                                        // where slot 0 is
  set_place(file, 2, static_cast<std::uint32_t>(file.size() / 4096), 1);  // behind the end
  set_place(file, 3, 1, 200);                                             // in the header
  set_place(file, 4, place(4), 0);                                        // of no sector
  set_place(file, 31, 0xffffff, 255);
  std::vector<RegionFault> faults;
  std::vector<std::int32_t> read;
  const PieceSink sink = [&](ForeignPiece&& piece) -> Result<void> {
    read.push_back(piece.origin.x / 16);
    return {};
  };
  REQUIRE(read_minecraft_region(file, sink, faults).has_value());
  CHECK(read == std::vector<std::int32_t>{5});
  std::map<unsigned, std::string> what;
  for (const RegionFault& fault : faults) what[fault.slot] = fault.error.what;
  CHECK(what.size() == 6);
  CHECK(what[0] == what[1]);
  CHECK(what[0].find("also those of another") != std::string::npos);
  CHECK(what[2].find("outside the file") != std::string::npos);
  CHECK(what[31] == what[2]);
  CHECK(what[3].find("header") != std::string::npos);
  CHECK(what[4].find("no sectors") != std::string::npos);

  SECTION("the reader of the table gives all, and then the first error") {
    read.clear();
    const auto all = read_minecraft_region(file, sink);
    REQUIRE_FALSE(all.has_value());
    CHECK(read == std::vector<std::int32_t>{5});
    CHECK(std::string(all.error().what) == what[0]);
    CHECK(read_minecraft_region(mc_region(slots), sink).has_value());
  }
  SECTION("an error of the sink ends the reading") {
    const auto stopped = read_minecraft_region(
        file, [](ForeignPiece&&) -> Result<void> { return fail(ErrorCode::io_failed, "full"); },
        faults);
    REQUIRE_FALSE(stopped.has_value());
    CHECK(stopped.error().code == ErrorCode::io_failed);
  }
}

TEST_CASE("a chunk must say the place of its slot", "[formats]") {
  McChunk chunk{ChunkLayout::tall, 33, -1};
  chunk.sections = {mc_section(0, 2)};
  const Bytes file = mc_region({mc_slot(1 + 31 * 32, mc_chunk(chunk))});
  CHECK(read_one(file, 1 + 31 * 32).has_value());
  CHECK_FALSE(read_one(mc_region({mc_slot(1 + 30 * 32, mc_chunk(chunk))}), 1 + 30 * 32));
  MinecraftChunkReader reader;
  const PieceSink none = [](ForeignPiece&&) -> Result<void> { return {}; };
  CHECK(reader.read(*open_minecraft_region(file, RegionPos{1, -1}), 993, nullptr, none));
  CHECK_FALSE(reader.read(*open_minecraft_region(file, RegionPos{0, -1}), 993, nullptr, none));
  chunk.z = std::nullopt;
  CHECK(error_of(chunk).code == ErrorCode::bad_value);
  chunk.z = 1 << 25;
  chunk.x = 0;
  CHECK(error_of(chunk).code == ErrorCode::bad_value);
}

TEST_CASE("names of region files and external chunks", "[formats]") {
  CHECK(region_of_file_name("world/region/r.0.-2.mca") == RegionPos{0, -2});
  CHECK(region_of_file_name("r.-10.7.mca") == RegionPos{-10, 7});
  for (const char* path : {"", "r.mca", "r.1.mca", "r.1.2.mcr", "r.1.2.mca.bak", "r.x.2.mca",
                           "r.1.2.3.mca", "r.99999999999.0.mca", "r.2000000.0.mca", "r.1.2"})
    CHECK_FALSE(region_of_file_name(path).has_value());
  CHECK(external_chunk_file({0, -2}, 3 + 4 * 32) == "c.3.-60.mcc");
}

TEST_CASE("bad chunks are refused with a reason", "[formats]") {
  McChunk chunk{ChunkLayout::tall};
  chunk.sections = {mc_section(0, 5)};
  McSection& section = chunk.sections[0];
  const auto what = [&] { return std::string(error_of(chunk).what); };
  SECTION("an index outside the palette") {
    section.indices[4095] = 5;
    CHECK(what().find("outside its palette") != std::string::npos);
    section.indices[4095] = 0;
    section.indices[0] = 15;
    CHECK(what().find("outside its palette") != std::string::npos);
  }
  SECTION("a number of longs that fits no width") {
    for (const std::size_t longs : {1U, 255U, 257U, 2000U}) {
      section.longs = longs;
      CHECK(what().find("number of longs") != std::string::npos);
    }
  }
  SECTION("blocks without longs, and an empty palette") {
    section.indices.clear();
    CHECK(what().find("no blocks") != std::string::npos);
    section.palette.clear();
    CHECK(what().find("no list of blocks") != std::string::npos);
  }
  SECTION("a palette that is too large") {
    section.palette = mc_palette(4097);
    CHECK(error_of(chunk).code == ErrorCode::limit_exceeded);
  }
  SECTION("names that are too long together") {
    section.palette.clear();
    for (int i = 0; i < 20; ++i)
      section.palette.push_back({std::string(60000, 'a' + static_cast<char>(i)), ""});
    section.indices.assign(4096, 0);
    CHECK(error_of(chunk).code == ErrorCode::limit_exceeded);
  }
  SECTION("a block without a name") {
    section.palette[3].name.clear();
    CHECK(what().find("no Name") != std::string::npos);
  }
  SECTION("sections twice, too many, or without Y") {
    chunk.sections.push_back(section);
    CHECK(what().find("one Y") != std::string::npos);
    chunk.sections.back().y = std::nullopt;
    CHECK(what().find("no Y") != std::string::npos);
    chunk.sections.resize(257);
    CHECK(error_of(chunk).code == ErrorCode::limit_exceeded);
  }
  SECTION("a bomb") {
    const Bytes bomb = deflate_all(Bytes(kMinecraftChunkBytesMax + 1), DeflateForm::zlib);
    REQUIRE(bomb.size() < 20000);
    const auto read = read_one(mc_region({{0, 2, bomb}}));
    REQUIRE_FALSE(read.has_value());
    CHECK(read.error().code == ErrorCode::limit_exceeded);
  }
  SECTION("numbers of another size") {
    McChunk old{ChunkLayout::numbers};
    McSection numbers;
    numbers.y = 0;
    numbers.indices.assign(4094, 16);
    old.sections = {numbers};
    CHECK(error_of(old).code == ErrorCode::bad_value);
  }
}

TEST_CASE("every truncation of a chunk and of a region fails or gives less", "[formats]") {
  for (const auto layout : {ChunkLayout::numbers, ChunkLayout::crossed, ChunkLayout::tall}) {
    McChunk chunk{layout};
    chunk.sections = {mc_section(0, 3)};
    const Bytes plain = mc_chunk(chunk);
    check_truncations(plain, 3);
  }
  McChunk chunk{ChunkLayout::tall};
  chunk.sections = {mc_section(0, 3)};
  const McSlot slot = mc_slot(0, mc_chunk(chunk));
  const Bytes file = mc_region({slot});
  MinecraftChunkReader reader;
  const PieceSink none = [](ForeignPiece&&) -> Result<void> { return {}; };
  std::size_t wrong = 0;
  for (std::size_t size = 0; size < file.size(); ++size) {
    const auto region = open_minecraft_region(ByteView(file).first(size));
    if (size != 0 && size < 8192) {
      wrong += region || region.error().code != ErrorCode::truncated;
      continue;
    }
    REQUIRE(region.has_value());
    const auto read = reader.read(*region, 0, nullptr, none);
    // Bytes behind the chunk only fill its last sector.
    if (size < 8192 + 4 + 1 + slot.packed.size() && size != 0)
      wrong += read.has_value();
    else
      wrong += !read || *read != (size != 0);
  }
  CHECK(wrong == 0);
}
