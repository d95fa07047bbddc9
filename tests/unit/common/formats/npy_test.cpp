#include "common/formats/npy.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "common/formats/look_material.hpp"
#include "common/formats/npy_header.hpp"
#include "tests/support/formats/file_builds.hpp"

namespace runstone::test {
namespace {

const Format kNpy{"npy", ".npy", read_npy, material_of_look, write_npy};
const Format kNpz{"npz", ".npz", read_npz, material_of_look, write_npz};

Bytes npy_of(std::uint8_t version, const std::string& head, const Bytes& items) {
  Bytes out = {0x93, 'N', 'U', 'M', 'P', 'Y', version, 0};
  const std::size_t size = head.size();
  for (unsigned i = 0; i < (version == 1 ? 2U : 4U); ++i)
    out.push_back(static_cast<std::uint8_t>(size >> (8 * i)));
  out.insert(out.end(), head.begin(), head.end());
  out.insert(out.end(), items.begin(), items.end());
  return out;
}

std::string npy_head(const std::string& type, const std::string& shape,
                     const std::string& is_fortran = "False") {
  return "{'descr': '" + type + "', 'fortran_order': " + is_fortran + ", 'shape': " + shape +
         ", }\n";
}

/// Returns the names of all cells, x fastest, then y, then z; "-": untouched.
std::vector<std::string> names_in(const Format& format, const Bytes& file) {
  const auto build = read_foreign_build(format, file, {});
  INFO((build ? "" : build.error().what));
  REQUIRE(build.has_value());
  std::vector<std::string> out;
  for (const std::string& text : cell_texts(*build)) out.push_back(text.substr(0, text.find('|')));
  return out;
}

Error npy_error(const Format& format, const Bytes& file) {
  const auto read = format.read(file, [](ForeignPiece&&) { return Result<void>{}; });
  REQUIRE_FALSE(read.has_value());
  return read.error();
}

/// A zip file of stored members without checksums of the directory's own.
Bytes zip_of(const std::vector<std::pair<std::string, Bytes>>& members, std::uint16_t flags = 0,
             std::uint16_t method = 0) {
  Bytes out, directory;
  for (const auto& [name, bytes] : members) {
    std::uint32_t crc = 0xffff'ffff;
    for (const std::uint8_t byte : bytes) {
      crc ^= byte;
      for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xedb88320U : 0U);
    }
    crc = ~crc;
    const auto offset = static_cast<std::uint32_t>(out.size());
    const auto common = [&](Bytes& to) {
      ByteWriter w(to);
      w.u16(20);
      w.u16(flags);
      w.u16(method);
      w.u32(0);
      w.u32(crc);
      w.u32(static_cast<std::uint32_t>(bytes.size()));
      w.u32(static_cast<std::uint32_t>(bytes.size()));
      w.u16(static_cast<std::uint16_t>(name.size()));
      w.u16(0);
    };
    ByteWriter local(out), central(directory);
    local.u32(0x04034b50);
    common(out);
    out.insert(out.end(), name.begin(), name.end());
    out.insert(out.end(), bytes.begin(), bytes.end());
    central.u32(0x02014b50);
    central.u16(20);
    common(directory);
    for (int i = 0; i < 3; ++i) central.u16(0);
    central.u32(0);
    central.u32(offset);
    directory.insert(directory.end(), name.begin(), name.end());
  }
  const auto begin = static_cast<std::uint32_t>(out.size());
  out.insert(out.end(), directory.begin(), directory.end());
  ByteWriter w(out);
  w.u32(0x06054b50);
  w.u32(0);
  w.u16(static_cast<std::uint16_t>(members.size()));
  w.u16(static_cast<std::uint16_t>(members.size()));
  w.u32(static_cast<std::uint32_t>(directory.size()));
  w.u32(begin);
  w.u16(0);
  return out;
}

}  // namespace

TEST_CASE("an array of numpy has the axes x, y, z in C and in Fortran order", "[formats]") {
  // a[x][y][z] of the shape (2, 1, 3).
  const std::vector<std::string> expected = {"material 1", "material 4", "air",
                                             "material 5", "material 3", "material 6"};
  CHECK(names_in(kNpy, npy_of(1, npy_head("|u1", "(2, 1, 3)"), {1, 0, 3, 4, 5, 6})) == expected);
  CHECK(names_in(kNpy, npy_of(2, npy_head("|i1", "(2, 1, 3)", "True"), {1, 4, 0, 5, 3, 6})) ==
        expected);
  CHECK(names_in(kNpy, npy_of(3, npy_head("<u2", "(2,1,3)"),
                              {1, 0, 0, 0, 3, 0, 4, 0, 5, 0, 6, 0})) == expected);
  CHECK(
      names_in(kNpy, npy_of(1, "{\"shape\": (2L, 1L, 3L,), 'fortran_order':False,'descr':\">i2\"}",
                            {0, 1, 0, 0, 0, 3, 0, 4, 0, 5, 0, 6})) == expected);
  CHECK(names_in(kNpy, npy_of(1, npy_head(">u8", "(1, 1, 1)"), {0, 0, 0, 0, 0, 0, 255, 255})) ==
        std::vector<std::string>{"material 65535"});
  CHECK(names_in(kNpy, npy_of(1, npy_head("|b1", "(1, 1, 2)"), {0, 1})) ==
        std::vector<std::string>{"air", "material 1"});
}

TEST_CASE("arrays that are no voxels are refused", "[formats]") {
  const auto code = [](const std::string& head, const Bytes& items) {
    return npy_error(kNpy, npy_of(1, head, items)).code;
  };
  CHECK(code(npy_head("<u4", "(1, 1, 1)"), {0, 0, 1, 0}) == ErrorCode::bad_value);
  CHECK(code(npy_head("<i4", "(1, 1, 1)"), {255, 255, 255, 255}) == ErrorCode::bad_value);
  CHECK(code(npy_head("<i8", "(1, 1, 1)"), {0, 0, 0, 0, 0, 0, 0, 128}) == ErrorCode::bad_value);
  CHECK(code(npy_head("<f4", "(1, 1, 1)"), {0, 0, 0, 0}) == ErrorCode::bad_value);
  CHECK(code(npy_head("<U1", "(1, 1, 1)"), {65, 0, 0, 0}) == ErrorCode::bad_value);
  CHECK(code(npy_head("|u1", "(1, 1)"), {1}) == ErrorCode::bad_value);
  CHECK(code(npy_head("|u1", "(1, 1, 0)"), {}) == ErrorCode::limit_exceeded);
  CHECK(code(npy_head("|u1", "(1048577, 1, 1)"), {1}) == ErrorCode::limit_exceeded);
  CHECK(code(npy_head("|u1", "(1048576, 1048576, 1048576)"), {1}) == ErrorCode::truncated);
  CHECK(code(npy_head("|u1", "(18446744073709551615, 1, 1)"), {1}) == ErrorCode::limit_exceeded);
  CHECK(code(npy_head("|u1", "(99999999999999999999, 1, 1)"), {1}) == ErrorCode::bad_value);
  CHECK(code(npy_head("|u1", "(1, 1, 1)"), {1, 2}) == ErrorCode::trailing_bytes);
  CHECK(code(npy_head("|u1", "(1, 1, 1)") + "{", {1}) == ErrorCode::bad_value);
  CHECK(code("{'descr': '|u1', 'shape': (1, 1, 1)}", {1}) == ErrorCode::bad_value);
  CHECK(code("{'descr': [('a', '|u1')], 'fortran_order': False, 'shape': (1,)}", {1}) ==
        ErrorCode::bad_value);
  CHECK(npy_error(kNpy, {0x93, 'N', 'U', 'M', 'P', 'Y', 1, 0, 255, 255, '{'}).code ==
        ErrorCode::truncated);
  CHECK(npy_error(kNpy, npy_of(4, "{}", {})).code == ErrorCode::bad_version);
  CHECK(npy_error(kNpy, {0x93, 'N', 'U', 'M', 'P', 'Z', 1, 0}).code == ErrorCode::bad_value);
  CHECK(npy_error(kNpy, {0x93, 'N', 'U', 'M', 'P', 'Y', 2, 0, 255, 255, 255, 255}).code ==
        ErrorCode::limit_exceeded);
}

TEST_CASE("an .npz has names, states, colours and an origin", "[formats]") {
  const Bytes voxels = npy_of(1, npy_head("|u1", "(3, 1, 1)"), {2, 0, 1});
  const Bytes names = npy_of(1, npy_head("|S5", "(3,)"),
                             {0, 0, 0, 0, 0, 's', 't', 'o', 'n', 'e', 'a', 'b', 0, 0, 0});
  const Bytes wide_names =
      npy_of(1, npy_head(">U1", "(3,)"), {0, 0, 0, 0, 0, 1, 0xf6, 0x00, 0, 0, 0, 0xe9});
  const Bytes states = npy_of(1, npy_head("|S3", "(3,)"), {0, 0, 0, 0, 0, 0, 'a', '=', '1'});
  const Bytes colours =
      npy_of(1, npy_head("|u1", "(3, 4)", "True"), {0, 3, 7, 0, 4, 8, 0, 5, 9, 0, 255, 99});
  const Bytes origin = npy_of(1, npy_head("<i2", "(3,)"), {255, 255, 7, 0, 9, 0});
  CHECK(names_in(kNpz, zip_of({{"voxels.npy", voxels}})) ==
        std::vector<std::string>{"material 2", "air", "material 1"});
  CHECK(names_in(kNpz, zip_of({{"names.npy", wide_names}, {"voxels.npy", voxels}})) ==
        std::vector<std::string>{"é", "-", "\xf0\x9f\x98\x80"});
  const auto build = read_foreign_build(kNpz,
                                        zip_of({{"other", {1}},
                                                {"voxels.npy", voxels},
                                                {"origin.npy", origin},
                                                {"names.npy", names},
                                                {"states.npy", states},
                                                {"colours.npy", colours}}),
                                        {});
  REQUIRE(build.has_value());
  CHECK(cell_texts(*build) == std::vector<std::string>{"ab|a=1|7,8,9,99", "-", "stone||3,4,5,255"});
  CHECK(build->info.origin == VoxelPos{-1, 7, 9});

  const auto code = [](const Bytes& file) { return npy_error(kNpz, file).code; };
  CHECK(code(zip_of({{"names.npy", names}})) == ErrorCode::bad_value);
  CHECK(code(zip_of({})) == ErrorCode::bad_value);
  CHECK(code(zip_of({{"voxels.npy", voxels}}, 1)) == ErrorCode::bad_value);
  CHECK(code(zip_of({{"voxels.npy", voxels}}, 0, 12)) == ErrorCode::bad_value);
  // Arrays that say more items than the file holds.
  CHECK(code(zip_of({{"voxels.npy", voxels},
                     {"names.npy", npy_of(1, npy_head("|S4096", "(65536,)"), {'a'})}})) ==
        ErrorCode::truncated);
  CHECK(code(zip_of({{"voxels.npy", voxels},
                     {"colours.npy", npy_of(1, npy_head("|u1", "(65536, 4)"), {1})}})) ==
        ErrorCode::truncated);
  CHECK(code(zip_of({{"voxels.npy", npy_of(1, npy_head("|u1", "(16384, 16384, 1)"), {1})}})) ==
        ErrorCode::truncated);
  const Bytes two = npy_of(1, npy_head("|S1", "(2,)"), {'a', 'b'});
  CHECK(code(zip_of({{"voxels.npy", voxels}, {"names.npy", two}})) == ErrorCode::bad_value);
  CHECK(code(zip_of({{"voxels.npy", voxels}, {"names.npy", names}, {"states.npy", two}})) ==
        ErrorCode::bad_value);
  CHECK(code(zip_of({{"voxels.npy", voxels}, {"names.npy", voxels}})) == ErrorCode::bad_value);
  Bytes wrong_sum = zip_of({{"voxels.npy", voxels}});
  wrong_sum[30 + 10 + voxels.size() - 1] = 7;
  CHECK(code(wrong_sum) == ErrorCode::bad_checksum);
}

TEST_CASE("every .npy and .npz that is cut is refused", "[formats]") {
  SplitMix64 rng{3};
  FileBuild build = random_file_build(rng, {4, 3, 5}, 3, true);
  CHECK(lengths_without_error(kNpy, *written(write_npy, build)).empty());
  CHECK(lengths_without_error(kNpz, *written(write_npz, build)).empty());
}

TEST_CASE("a build written as .npz is read with equal voxels, names, states and colours",
          "[formats]") {
  SplitMix64 rng{9};
  for (int round = 0; round < 16; ++round) {
    CAPTURE(round);
    const bool is_long = round % 4 == 0;
    const VoxelPos sides{rng.between(1, is_long ? 150 : 40), rng.between(1, is_long ? 140 : 40),
                         rng.between(1, 30)};
    FileBuild build = random_file_build(rng, sides, round == 1 ? 300 : 7, round % 2 == 0);
    build.info.origin = {-5, 600, 7};
    const auto bytes = written(write_npz, build);
    REQUIRE(bytes.has_value());
    CHECK(*bytes == *written(write_npz, build));
    const auto read = read_foreign_build(kNpz, *bytes, {});
    REQUIRE(read.has_value());
    CHECK(read->info.origin == build.info.origin);
    CHECK(cell_texts(*read) == cell_texts(build));

    // An .npy has the cells, and names only if they are numbers.
    for (std::size_t i = 0; i < build.materials.size(); ++i) {
      BuildMaterial& material = build.materials[i];
      if (material.row.visibility == Visibility::empty) continue;
      material.row.name = "material " + std::to_string(1000 + 7 * i);
      material.states.clear();
    }
    const auto plain = written(write_npy, build);
    REQUIRE(plain.has_value());
    auto expected = cell_texts(build);
    for (std::string& text : expected) {
      text = text == "-" ? "air" : text.substr(0, text.find('|'));
    }
    CHECK(names_in(kNpy, *plain) == expected);
  }
}

TEST_CASE("a write that fails ends the writing of arrays", "[formats]") {
  SplitMix64 rng{3};
  const FileBuild build = random_file_build(rng, {4, 3, 5}, 3, true);
  for (int allowed = 0; allowed < 30; ++allowed) {
    int calls = 0;
    const auto sink = [&](ByteView) { return calls++ < allowed; };
    const auto done = write_npz(build, sink);
    if (done) break;
    CHECK(done.error().code == ErrorCode::io_failed);
    REQUIRE(allowed < 29);
  }
  CHECK(write_npy(build, [](ByteView) { return false; }).error().code == ErrorCode::io_failed);
}

}  // namespace runstone::test
