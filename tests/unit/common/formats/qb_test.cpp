#include "common/formats/qb.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "common/formats/look_material.hpp"
#include "tests/support/formats/file_builds.hpp"

namespace runstone::test {
namespace {

const Format kQb{"qb", ".qb", read_qb, material_of_look};

struct QbFlags {
  std::uint32_t is_bgra = 0, is_right_handed = 0, is_compressed = 0, matrices = 1;
};

void qb_words(Bytes& out, const std::vector<std::uint32_t>& words) {
  ByteWriter w(out);
  for (const std::uint32_t word : words) w.u32(word);
}

Bytes qb_file(QbFlags flags, const std::vector<std::uint32_t>& words_of_matrix) {
  Bytes out;
  qb_words(out,
           {0x0101, flags.is_bgra, flags.is_right_handed, flags.is_compressed, 1, flags.matrices});
  for (std::uint32_t i = 0; i < flags.matrices && i < 2; ++i) {
    out.insert(out.end(), {2, 'a', 'b'});
    qb_words(out, words_of_matrix);
  }
  return out;
}

std::vector<std::string> qb_names(const Bytes& file, VoxelPos* origin = nullptr) {
  const auto build = read_foreign_build(kQb, file, {});
  INFO((build ? "" : build.error().what));
  REQUIRE(build.has_value());
  if (origin != nullptr) *origin = build->info.origin;
  std::vector<std::string> out;
  for (const std::string& text : cell_texts(*build)) out.push_back(text.substr(0, text.find('|')));
  return out;
}

ErrorCode qb_code(const Bytes& file) {
  const auto read = read_qb(file, [](ForeignPiece&&) { return Result<void>{}; });
  REQUIRE_FALSE(read.has_value());
  return read.error().code;
}

}  // namespace

TEST_CASE("a matrix of Qubicle is read, x first, then y, then z", "[formats]") {
  const std::vector<std::uint32_t> matrix = {2,          1,          2,          10,
                                             20,         30,  // sides and place
                                             0x55030201, 0x00ffffff, 0x01040302, 0xff000000};
  VoxelPos origin;
  CHECK(qb_names(qb_file({0, 1, 0}, matrix), &origin) ==
        std::vector<std::string>{"colour #010203", "-", "colour #020304", "colour #000000"});
  CHECK(origin == VoxelPos{10, 20, 30});
  // The z of a left-handed file runs against ours.
  CHECK(qb_names(qb_file({1, 0, 0}, matrix), &origin) ==
        std::vector<std::string>{"colour #040302", "colour #000000", "colour #030201", "-"});
  CHECK(origin == VoxelPos{10, 20, -32});
}

TEST_CASE("a compressed matrix of Qubicle has codes, and ends its slices", "[formats]") {
  const std::vector<std::uint32_t> matrix = {3, 2, 2,          0,          0, 0,  //
                                             2, 4, 0xff0000ff, 0xff00ff00, 6, 2,
                                             0, 0, 0xffff0000, 6};
  CHECK(qb_names(qb_file({0, 1, 1}, matrix)) ==
        std::vector<std::string>{"colour #ff0000", "colour #ff0000", "colour #ff0000",
                                 "colour #ff0000", "colour #00ff00", "-", "colour #0000ff", "-",
                                 "-", "-", "-", "-"});
  CHECK(qb_code(qb_file({0, 1, 1}, {1, 1, 1, 0, 0, 0, 2, 2, 0xff000000, 6})) ==
        ErrorCode::bad_value);
  CHECK(qb_code(qb_file({0, 1, 1}, {1, 1, 1, 0, 0, 0, 2, 0xffffffff, 0xff000000, 6})) ==
        ErrorCode::bad_value);
}

TEST_CASE("bad files of Qubicle are refused", "[formats]") {
  CHECK(qb_code(qb_file({2, 0, 0}, {1, 1, 1, 0, 0, 0, 0})) == ErrorCode::bad_value);
  CHECK(qb_code(qb_file({0, 0, 0, 0xffffffff}, {1, 1, 1, 0, 0, 0, 0})) ==
        ErrorCode::limit_exceeded);
  CHECK(qb_code(qb_file({}, {0, 1, 1, 0, 0, 0, 0})) == ErrorCode::limit_exceeded);
  CHECK(qb_code(qb_file({}, {0xffffffff, 1, 1, 0, 0, 0, 0})) == ErrorCode::limit_exceeded);
  CHECK(qb_code(qb_file({}, {1 << 20, 1 << 20, 1, 0, 0, 0, 0})) == ErrorCode::limit_exceeded);
  CHECK(qb_code(qb_file({}, {1024, 1024, 1024, 0, 0, 0, 0})) == ErrorCode::truncated);
  CHECK(qb_code(qb_file({}, {1, 1, 1, 0x7fffffff, 0, 0, 0})) == ErrorCode::bad_value);
  CHECK(qb_code({1, 2, 0, 0, 0, 0, 0, 0}) == ErrorCode::bad_version);
  const std::vector<std::uint32_t> packed = {2, 2, 2, 0, 0, 0, 2, 4, 0xff000000, 6, 6};
  CHECK(lengths_without_error(kQb, qb_file({0, 0, 1, 2}, packed)).empty());
  CHECK(lengths_without_error(kQb, qb_file({0, 0, 0, 2}, {1, 2, 1, 0, 0, 0, 1, 2})).empty());
}

}  // namespace runstone::test
