// The tests read .rsb files: intact ones, truncated at every byte, with every bit flipped, with
// reordered blocks, and with wrong content under correct checksums.
#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <string>

#include "common/runs/reorder.hpp"
#include "tests/support/formats/rsb_bytes.hpp"

namespace runstone::test {
namespace {

SampleBuild small_build() {
  SampleBuild build;
  build.info = sample_build_info();
  build.materials = sample_build_materials();
  RunChunk cells = uniform_chunk({64, 3, 2}, 0);
  fill(cells, 5, 100, 1);
  fill(cells, 110, 1, 3);
  build.sections.push_back({{0, 0, 0}, std::move(cells)});
  build.sections.push_back({{1, 0, 0}, uniform_chunk({6, 3, 2}, 2)});
  return build;
}

bool is_start_of_build(const SampleBuild& part, const SampleBuild& whole) {
  return part.sections.size() <= whole.sections.size() &&
         std::equal(part.sections.begin(), part.sections.end(), whole.sections.begin());
}

/// Writes with a sink that takes everything, and returns the first error.
std::optional<RsbError> write_error(const SampleBuild& build) {
  RsbWriter writer([](ByteView) { return true; });
  if (const auto begun = writer.begin(build.info, build.materials); !begun) return begun.error();
  for (const BuildSection& section : build.sections) {
    if (const auto added = writer.add(section); !added) return added.error();
  }
  if (const auto done = writer.finish(); !done) return done.error();
  return std::nullopt;
}

/// Changes a byte of an unpacked file, corrects the checksums, and returns the error that reading
/// finds.
std::optional<RsbError> read_changed(Bytes file, std::size_t at, std::uint8_t byte) {
  file[at] = byte;
  mend_rsb(file);
  return read_rsb(file).error;
}

}  // namespace

TEST_CASE("an .rsb gives back info, materials and cells", "[rsb]") {
  const SampleBuild build = small_build();
  for (const int level : {0, 9}) {
    CAPTURE(level);
    const RsbContents read = read_rsb(rsb_of(build, level));
    if (read.error) FAIL(read.error->message());
    CHECK(read.build.info == build.info);
    CHECK(read.build.materials == build.materials);
    CHECK(read.build.sections == build.sections);
  }
}

TEST_CASE("a build of the greatest sides has its sections at both ends", "[rsb]") {
  SampleBuild build = small_build();
  build.info.sides = {kBuildSideMax, kBuildSideMax, kBuildSideMax};
  build.info.origin = {-kWorldLimit, 0, kWorldLimit - kBuildSideMax};
  constexpr std::uint32_t kLast = kBuildSideMax / kBuildSectionEdge - 1;
  build.sections = {{{0, 0, 0}, uniform_chunk(Extent::cube(64), 1)},
                    {{kLast, 0, 0}, uniform_chunk(Extent::cube(64), 2)},
                    {{0, kLast, kLast}, uniform_chunk(Extent::cube(64), 3)},
                    {{kLast, kLast, kLast}, uniform_chunk(Extent::cube(64), 1)}};
  const Bytes file = rsb_of(build, 0);
  CHECK(file.size() < 500);
  const RsbContents read = read_rsb(file);
  if (read.error) FAIL(read.error->message());
  CHECK(read.build.sections == build.sections);
}

TEST_CASE("the greatest palette takes several blocks, and a section can have all its numbers",
          "[rsb]") {
  SampleBuild build;
  build.materials = sample_build_materials(kBuildMaterialsMax);
  build.info = sample_build_info({64, 64, 64});
  RunChunk cells{Extent::cube(64), AxisOrder::xyz, RunList(kBuildSectionVolumeMax)};
  for (std::uint32_t i = 0; i < kBuildSectionVolumeMax; ++i)
    cells.runs.push_back({i + 1, static_cast<Material>(i % 65536)});
  build.sections.push_back({{0, 0, 0}, cells});
  const Bytes file = rsb_of(build, 1);
  CHECK(rsb_blocks_of(file).size() > 5);  // head, two of materials, one of sections, end, length
  const RsbContents read = read_rsb(file);
  if (read.error) FAIL(read.error->message());
  CHECK(read.build.materials == build.materials);
  CHECK(read.build.sections == build.sections);
}

TEST_CASE("an .rsb that is cut at any byte is an error, and its sections before are sound",
          "[rsb]") {
  for (const int level : {0, 9}) {
    const SampleBuild build = small_build();
    const Bytes file = rsb_of(build, level);
    for (std::size_t size = 0; size < file.size(); ++size) {
      CAPTURE(level, size);
      const RsbContents read = read_rsb(ByteView(file).first(size));
      REQUIRE(read.error.has_value());
      if (size >= kRsbMark.size()) REQUIRE(read.error->error.code == ErrorCode::truncated);
      REQUIRE(is_start_of_build(read.build, build));
    }
  }
}

TEST_CASE("each flipped bit of an .rsb is noticed", "[rsb]") {
  const SampleBuild build = small_build();
  for (const int level : {0, 9}) {
    const Bytes file = rsb_of(build, level);
    for (std::size_t bit = 0; bit < file.size() * 8; ++bit) {
      Bytes damaged = file;
      damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ 1U << bit % 8);
      CAPTURE(level, bit);
      const RsbContents read = read_rsb(damaged);
      REQUIRE(read.error.has_value());
      REQUIRE(is_start_of_build(read.build, build));
    }
  }
}

TEST_CASE("an .rsb with a byte behind its end, or without its end, is an error", "[rsb]") {
  Bytes file = rsb_of(small_build(), 0);
  Bytes longer = file;
  longer.push_back(0);
  REQUIRE(read_rsb(longer).error.has_value());
  CHECK(read_rsb(longer).error->error.code == ErrorCode::trailing_bytes);
  const auto blocks = rsb_blocks_of(file);
  file.resize(blocks[blocks.size() - 2]);
  const auto error = read_rsb(file).error;
  REQUIRE(error.has_value());
  CHECK(error->message() ==
        "block at byte " + std::to_string(file.size()) + ": file ends without its end block");
}

TEST_CASE("blocks of an .rsb that are removed, repeated or moved are noticed", "[rsb]") {
  const Bytes file = rsb_of(small_build(), 0);
  const auto blocks = rsb_blocks_of(file);
  REQUIRE(blocks.size() == 5);  // head, materials, sections, end, length
  const auto part = [&](std::size_t i) {
    return ByteView(file).subspan(blocks[i], blocks[i + 1] - blocks[i]);
  };
  const std::vector<std::vector<std::size_t>> orders = {
      {1, 2, 3},       {0, 2, 3},    {0, 1, 3},   {0, 1, 2, 2, 3},
      {0, 1, 1, 2, 3}, {0, 2, 1, 3}, {1, 0, 2, 3}};
  for (const auto& order : orders) {
    Bytes other(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(kRsbFileHeadBytes));
    for (const std::size_t i : order) other.insert(other.end(), part(i).begin(), part(i).end());
    CAPTURE(order);
    CHECK(read_rsb(other).error.has_value());
    // With correct checksums the rules of the order remain.
    mend_rsb(other);
    CHECK(read_rsb(other).error.has_value());
  }
}

TEST_CASE("an .rsb of another version, and a file that is none, are refused with words", "[rsb]") {
  Bytes file = rsb_of(small_build(), 0);
  file[8] = 3;
  auto error = read_rsb(file).error;
  REQUIRE(error.has_value());
  CHECK(error->error.code == ErrorCode::bad_version);
  CHECK(error->message() ==
        "mark at byte 0: is an .rsb of another version than this program knows");
  file[0] = 0x88;
  error = read_rsb(file).error;
  REQUIRE(error.has_value());
  CHECK(error->message() == "mark at byte 0: is not an .rsb file");
}

TEST_CASE("an .rsb has version 2 if a material has a shape", "[rsb][shapes]") {
  SampleBuild build = small_build();
  CHECK(rsb_of(build, 0)[8] == 1);
  const Shape plant{ShapeForm::crossed, {{{1, 0, 1}, {15, 12, 15}}}};
  BuildMaterial& shaped = *std::find_if(
      build.materials.begin(), build.materials.end(),
      [](const BuildMaterial& each) { return each.row.visibility != Visibility::empty; });
  shaped.row.shape = plant;
  Bytes file = rsb_of(build, 0);
  CHECK(file[8] == 2);
  const RsbContents read = read_rsb(file);
  if (read.error) FAIL(read.error->message());
  CHECK(read.build.materials == build.materials);
  CHECK(read.build.sections == build.sections);
  file[8] = 1;  // bit 5 is unknown in version 1
  CHECK(read_rsb(file).error.has_value());
  Bytes without = rsb_of(small_build(), 0);
  without[8] = 2;
  const auto error = read_rsb(without).error;
  REQUIRE(error.has_value());
  CHECK(error->error.code == ErrorCode::not_canonical);
  shaped.row.shape.boxes[0].max[0] = 1;  // an empty box
  CHECK(write_error(build).has_value());
}

TEST_CASE("wrong fields of an .rsb under correct checksums are named", "[rsb]") {
  const Bytes file = rsb_of(small_build(), 0);
  const auto blocks = rsb_blocks_of(file);
  const auto what = [&](std::size_t block, std::size_t at, std::uint8_t byte) {
    const auto error = read_changed(file, blocks[block] + at, byte);
    return error ? std::string(error->error.what) : std::string();
  };
  CHECK(what(0, 0, 9) == "unknown kind of block");
  CHECK(what(0, 8, 0) == "block is longer packed than unpacked");
  CHECK(what(0, 11, 1) == "block is too long");
  CHECK(what(0, 12, 1) == "block of this kind cannot have this count");
  CHECK(what(1, 12, 0) == "block of this kind cannot have this count");
  CHECK(what(1, 14, 2) == "block has too many entries");
  CHECK(what(1, 16, 1) == "materials are not those that the head announces");
  CHECK(what(2, 16, 2) == "section lies outside the build");
  // A frame is announced and there is none.
  CHECK(what(2, 8, 255) == "zstd frame of another size than announced");
  const std::size_t section = kRsbHeaderBytes;
  CHECK(what(2, section, 1) == "first section of a block is not the announced one");
  CHECK(what(2, section + 1, 6) == "unknown axis order of a section");
  CHECK(what(2, section + 2, 200) != "");
  CHECK(what(2, section + 2, 4) == "section has more numbers than the build has materials");
  CHECK(what(2, section + 4, 5) == "cell of a section has no material");
}

TEST_CASE("fields of a build outside their ranges are refused by the writer", "[rsb]") {
  const auto refused = [](const std::function<void(SampleBuild&)>& change) {
    SampleBuild build = small_build();
    change(build);
    const auto error = write_error(build);
    return error ? std::string(error->error.what) : std::string();
  };
  CHECK(refused([](SampleBuild&) {}).empty());
  CHECK(refused([](SampleBuild& b) { b.info.name = ""; }) ==
        "name of the build must be a plain name of 1 .. 64 bytes");
  CHECK(refused([](SampleBuild& b) { b.info.name = std::string(65, 'a'); }) != "");
  CHECK(refused([](SampleBuild& b) { b.info.name = "a\nb"; }) != "");
  CHECK(refused([](SampleBuild& b) {
          b.info.name =
              "a\xe2\x80\xae"
              "b";
        }) != "");
  CHECK(refused([](SampleBuild& b) { b.info.author = std::string(33, 'a'); }) ==
        "author must be a plain name of at most 32 bytes, or empty");
  CHECK(refused([](SampleBuild& b) { b.info.author = ""; }).empty());
  CHECK(refused([](SampleBuild& b) { b.info.tags = {"wood", "mill"}; }) == "tags do not ascend");
  CHECK(refused([](SampleBuild& b) { b.info.tags = {"wood", "wood"}; }) == "tags do not ascend");
  CHECK(refused([](SampleBuild& b) { b.info.tags = {""}; }) ==
        "tag must be a plain name of 1 .. 32 bytes");
  CHECK(refused([](SampleBuild& b) {
          b.info.tags.clear();
          for (char letter = 'a'; letter <= 'q'; ++letter) b.info.tags.emplace_back(1, letter);
        }) == "build has more than 16 tags");
  CHECK(refused([](SampleBuild& b) { b.info.created_us = -1; }) ==
        "time of the build is outside 0 .. 2^53");
  CHECK(refused([](SampleBuild& b) { b.info.sides.y = 0; }) ==
        "side of the build is outside 1 .. 1048576");
  CHECK(refused([](SampleBuild& b) { b.info.sides.y = kBuildSideMax + 1; }) ==
        "side of the build is outside 1 .. 1048576");
  CHECK(refused([](SampleBuild& b) { b.info.origin.x = kWorldLimit - 69; }) ==
        "build reaches out of the world");
  CHECK(refused([](SampleBuild& b) { b.info.origin.x = kWorldLimit - 70; }).empty());
  CHECK(refused([](SampleBuild& b) { b.materials.clear(); }) == "build has no material");
  CHECK(refused([](SampleBuild& b) { std::swap(b.materials[0], b.materials[1]); }) ==
        "materials of the build do not ascend");
  CHECK(refused([](SampleBuild& b) { b.materials[1] = b.materials[0]; }) ==
        "materials of the build do not ascend");
  CHECK(refused([](SampleBuild& b) { b.materials[0].states = std::string(257, 'a'); }) ==
        "states must be at most 256 bytes of UTF-8 without control characters");
  CHECK(refused([](SampleBuild& b) { b.materials[0].row.colour[3] = 254; }) ==
        "colour of an opaque material must not be see-through");
  CHECK(refused([](SampleBuild& b) { b.sections.clear(); }) == "build has no touched cell");
  CHECK(refused([](SampleBuild& b) { b.sections[1].at = {2, 0, 0}; }) ==
        "section lies outside the build");
  CHECK(refused([](SampleBuild& b) { std::swap(b.sections[0], b.sections[1]); }) ==
        "sections do not ascend");
  CHECK(refused([](SampleBuild& b) { b.sections[1].cells = uniform_chunk({7, 3, 2}, 1); }) ==
        "section has another extent");
  CHECK(refused([](SampleBuild& b) { b.sections[1].cells = uniform_chunk({6, 3, 2}, 4); }) ==
        "cell of a section has no material");
}

TEST_CASE("a sink and a source that fail end the writing and the reading", "[rsb]") {
  const SampleBuild build = small_build();
  const Bytes file = rsb_of(build, 0);
  for (std::size_t calls = 0; calls < 5; ++calls) {
    std::size_t taken = 0;
    RsbWriter writer([&](ByteView) { return taken++ < calls; }, 0);
    RsbResult<void> written = writer.begin(build.info, build.materials);
    for (const BuildSection& section : build.sections) {
      if (written) written = writer.add(section);
    }
    if (written) written = writer.finish();
    REQUIRE_FALSE(written.has_value());
    CHECK(written.error().error.code == ErrorCode::io_failed);
  }
  const auto reader = RsbReader::open(
      [](std::uint64_t, std::span<std::uint8_t>) -> std::optional<std::size_t> { return {}; });
  REQUIRE_FALSE(reader.has_value());
  CHECK(reader.error().message() == "mark at byte 0: cannot be read");
}

TEST_CASE("a section without touched cells is left out, and the end is found again", "[rsb]") {
  SampleBuild build = small_build();
  build.sections[0].cells = uniform_chunk({64, 3, 2}, 0);
  const Bytes file = rsb_of(build, 0);
  auto reader = RsbReader::open(rsb_source(file));
  REQUIRE(reader.has_value());
  auto section = reader->next();
  REQUIRE((section.has_value() && section->has_value()));
  CHECK((*section)->at == SectionCoord{1, 0, 0});
  for (int i = 0; i < 2; ++i) {
    section = reader->next();
    REQUIRE(section.has_value());
    CHECK_FALSE(section->has_value());
  }
  CHECK(reader->section_count() == 1);
  CHECK(reader->touched() == 36);
}

}  // namespace runstone::test
