#include "common/generate/columns_world.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <sstream>

#include "common/runs/reorder.hpp"

using namespace runstone;

namespace {

std::string read_text(const std::string& name) {
  std::ifstream in(std::string(RUNSTONE_SOURCE_DIR) + "/tests/data/thesis/" + name,
                   std::ios::binary);
  REQUIRE(in.good());
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

constexpr const char* kHeader = "x,y,runs_bottom_to_top\n";

Error error_of(const std::string& body) {
  const auto world = ColumnsWorld::parse(kHeader + body);
  REQUIRE_FALSE(world.has_value());
  return world.error();
}

std::uint32_t opaque_voxels(const RunChunk& chunk) {
  std::uint32_t out = 0;
  for (std::size_t i = 0; i < chunk.runs.size(); ++i) {
    if (chunk.runs.material(i) != kEmpty) out += chunk.runs.end(i) - chunk.runs.begin(i);
  }
  return out;
}

}  // namespace

TEST_CASE("the thesis' noise scenario has its opaque voxels and its runs, chunk by chunk",
          "[generate][thesis]") {
  const auto world = ColumnsWorld::parse(read_text("scenario5_columns.csv"));
  REQUIRE(world.has_value());
  CHECK((*world)->bounds() == VoxelBox{{-32, -32, -32}, {64, 64, 64}});

  std::istringstream rows(read_text("scenario5_chunks.csv"));
  std::string row;
  std::getline(rows, row);
  REQUIRE(row.starts_with("chunk_x,chunk_y,chunk_z,opaque_voxels,empty_voxels,runs,"));
  int chunks = 0;
  while (std::getline(rows, row)) {
    for (char& c : row) {
      if (c == ',') c = ' ';
    }
    std::istringstream fields(row);
    std::int32_t x = 0, y = 0, z = 0;
    std::uint32_t opaque = 0, empty = 0, runs = 0;
    fields >> x >> y >> z >> opaque >> empty >> runs;
    REQUIRE(fields.good());
    CAPTURE(x, y, z);
    // The thesis' z is up. Its index order y, z, x is z, y, x here.
    const RunChunk chunk = (*world)->generate({x * 32, z * 32, y * 32}, Extent::cube(32));
    REQUIRE(validate(chunk).has_value());
    CHECK(opaque_voxels(chunk) == opaque);
    CHECK(chunk.volume() - opaque_voxels(chunk) == empty);
    CHECK(reorder(chunk, AxisOrder::zyx).runs.size() == runs);
    ++chunks;
  }
  CHECK(chunks == 27);
}

TEST_CASE("a column world is empty outside of its columns", "[generate]") {
  const auto world = ColumnsWorld::parse(std::string(kHeader) + "3,5,0:2|-1:1|3:1\n4,5,1:4\n");
  REQUIRE(world.has_value());
  const RunChunk chunk = (*world)->generate({0, -32, 0}, Extent::cube(8));
  const auto at = [&](int x, int y, int z) {
    return material_at(chunk, {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                               static_cast<std::uint8_t>(z)});
  };
  CHECK(at(3, 0, 5) == 1);
  CHECK(at(3, 1, 5) == 1);
  CHECK(at(3, 2, 5) == kEmpty);
  CHECK(at(3, 3, 5) == 4);
  CHECK(at(3, 4, 5) == kEmpty);
  CHECK(at(4, 3, 5) == 2);
  CHECK(at(5, 3, 5) == kEmpty);
  CHECK(at(3, 0, 4) == kEmpty);
  CHECK((*world)->surface_y(3, 5) == -28);
  CHECK((*world)->surface_y(9, 9) == -32);
  CHECK((*world)->generate({0, 0, 0}, Extent::cube(8)).is_uniform());
}

TEST_CASE("a column world does not depend on the order of its lines", "[generate]") {
  const auto a = ColumnsWorld::parse(std::string(kHeader) + "0,0,0:2\n1,0,1:2\n0,1,2:2\n1,1,3:2\n");
  const auto b = ColumnsWorld::parse(std::string(kHeader) + "1,1,3:2\n0,1,2:2\n1,0,1:2\n0,0,0:2");
  REQUIRE((a.has_value() && b.has_value()));
  CHECK((*a)->generate({-3, -32, -3}, Extent::cube(8)) ==
        (*b)->generate({-3, -32, -3}, Extent::cube(8)));
}

TEST_CASE("a bad column file is rejected with its line", "[generate]") {
  CHECK(ColumnsWorld::parse("").error().code == ErrorCode::truncated);
  CHECK(ColumnsWorld::parse(kHeader).error().code == ErrorCode::truncated);
  CHECK(ColumnsWorld::parse("x,y,runs\n0,0,0:1\n").error().code == ErrorCode::bad_version);
  for (const char* line :
       {"", "0", "0,0", "0,0,", "0,0,1", "0,0,1:", "0,0,1:0", "0,0,1:-2", "0,0,-2:4", "0,0,65535:4",
        "0,0,1:2|", "0,0,1:2;", "0,0,1:2 ", "x,0,1:2", "0,0,1:99999999999", "600000000,0,1:2"}) {
    CAPTURE(line);
    const Error error = error_of(std::string("0,0,0:2\n") + line + "\n");
    CHECK(error.code == ErrorCode::bad_value);
    CHECK(error.offset == 3);
  }
  CHECK(error_of("0,0,1:4097\n").code == ErrorCode::limit_exceeded);
  CHECK(error_of("0,0,1:4096|1:1\n").code == ErrorCode::limit_exceeded);
  CHECK(error_of("0,0,1:2\n1,0,1:3\n").code == ErrorCode::bad_value);  // heights differ
  CHECK(error_of("0,0,1:2\n0,0,1:2\n").code == ErrorCode::bad_value);  // the same place twice
  CHECK(error_of("0,0,1:2\n2,0,1:2\n").code == ErrorCode::bad_value);  // a gap
  CHECK(error_of("0,0,1:2\n1,0,1:2\n1,1,1:2\n").code ==
        ErrorCode::bad_value);  // a corner is missing
  CHECK(error_of("1,0,1:2\n0,1,1:2\n").code == ErrorCode::bad_value);
  CHECK(error_of("0,0,1:2\n1024,0,1:2\n").code == ErrorCode::limit_exceeded);
}
