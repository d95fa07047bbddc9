#include "common/runs/run_chunk.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "common/runs/run_builder.hpp"

using namespace runstone;

namespace {

RunChunk chunk_of_runs(Extent extent, const std::vector<Run>& runs) {
  RunChunk chunk{extent, AxisOrder::xyz, RunList{extent.volume()}};
  for (const Run& run : runs) chunk.runs.push_back(run);
  return chunk;
}

std::vector<Run> runs_of(const RunChunk& chunk) {
  std::vector<Run> out;
  for (std::size_t i = 0; i < chunk.runs.size(); ++i) out.push_back(chunk.runs[i]);
  return out;
}

void check_broken(const RunChunk& chunk, ErrorCode code, const std::string& what,
                  std::uint64_t run) {
  const Result<void> valid = validate(chunk);
  REQUIRE_FALSE(valid.has_value());
  CHECK(valid.error().code == code);
  CHECK(std::string(valid.error().what) == what);
  CHECK(valid.error().offset == run);
}

const Extent kSmall{8, 8, 8};     // 512 voxels, narrow
const Extent kLarge{64, 64, 64};  // 262,144 voxels, wide

}  // namespace

TEST_CASE("a fill splits the run it lands in", "[runs][fill]") {
  for (const Extent extent : {kSmall, kLarge}) {
    RunChunk chunk = uniform_chunk(extent, 1);
    EditArea area;
    CHECK(fill(chunk, 10, 5, 2, &area));
    CHECK(runs_of(chunk) == std::vector<Run>{{10, 1}, {15, 2}, {extent.volume(), 1}});
    CHECK(area == EditArea{0, 1, 3});
  }
}

TEST_CASE("a fill merges with neighbours of its material", "[runs][fill]") {
  RunChunk chunk = chunk_of_runs(kSmall, {{10, 1}, {20, 2}, {30, 1}, {512, 3}});
  EditArea area;
  CHECK(fill(chunk, 10, 10, 1, &area));
  CHECK(runs_of(chunk) == std::vector<Run>{{30, 1}, {512, 3}});
  CHECK(area == EditArea{0, 3, 1});
}

TEST_CASE("a fill moves a border without splitting", "[runs][fill]") {
  RunChunk left = chunk_of_runs(kSmall, {{10, 1}, {512, 2}});
  EditArea area;
  CHECK(fill(left, 10, 3, 1, &area));
  CHECK(runs_of(left) == std::vector<Run>{{13, 1}, {512, 2}});
  CHECK(area == EditArea{0, 2, 2});
  CHECK(fill(left, 8, 5, 2, &area));
  CHECK(runs_of(left) == std::vector<Run>{{8, 1}, {512, 2}});
  CHECK(area == EditArea{0, 2, 2});
}

TEST_CASE("a fill over many runs leaves one", "[runs][fill]") {
  RunChunk chunk = chunk_of_runs(kSmall, {{10, 1}, {20, 2}, {30, 1}, {40, 3}, {512, 1}});
  EditArea area;
  CHECK(fill(chunk, 5, 30, 9, &area));
  CHECK(runs_of(chunk) == std::vector<Run>{{5, 1}, {35, 9}, {40, 3}, {512, 1}});
  CHECK(area == EditArea{0, 4, 3});
  CHECK(fill(chunk, 0, 512, 4));
  CHECK(chunk.is_uniform());
  CHECK(chunk == uniform_chunk(kSmall, 4));
}

TEST_CASE("a fill that changes no voxel returns false and leaves chunk and area unchanged",
          "[runs][fill]") {
  RunChunk chunk = chunk_of_runs(kSmall, {{10, 1}, {20, 2}, {512, 1}});
  const RunChunk before = chunk;
  EditArea area{7, 7, 7};
  CHECK_FALSE(fill(chunk, 12, 4, 2, &area));
  CHECK_FALSE(fill(chunk, 10, 10, 2, &area));
  CHECK_FALSE(fill(chunk, 511, 1, 1, &area));
  CHECK(chunk == before);
  CHECK(area == EditArea{7, 7, 7});
}

TEST_CASE("fills reach the first and the last voxel", "[runs][fill]") {
  RunChunk chunk = uniform_chunk(kLarge, 0);
  CHECK(fill(chunk, 0, 1, 5));
  CHECK(fill(chunk, kLarge.volume() - 1, 1, 6));
  CHECK(runs_of(chunk) == std::vector<Run>{{1, 5}, {kLarge.volume() - 1, 0}, {kLarge.volume(), 6}});
}

TEST_CASE("validate accepts canonical chunks of both forms", "[runs][validate]") {
  CHECK(validate(chunk_of_runs(kSmall, {{10, 1}, {512, 2}})).has_value());
  CHECK(validate(chunk_of_runs(kLarge, {{10, 1}, {70000, 2}, {262144, 1}})).has_value());
}

TEST_CASE("validate names each broken invariant and its run", "[runs][validate]") {
  for (const Extent extent : {kSmall, kLarge}) {
    const std::uint32_t volume = extent.volume();
    CAPTURE(volume);
    check_broken(chunk_of_runs(extent, {}), ErrorCode::broken_invariant, "chunk has no runs", 0);
    check_broken(chunk_of_runs(extent, {{0, 1}, {volume, 2}}), ErrorCode::broken_invariant,
                 "run ends do not ascend", 0);
    check_broken(chunk_of_runs(extent, {{9, 1}, {9, 2}, {volume, 1}}), ErrorCode::broken_invariant,
                 "run ends do not ascend", 1);
    check_broken(chunk_of_runs(extent, {{9, 1}, {12, 2}, {7, 1}}), ErrorCode::broken_invariant,
                 "run ends do not ascend", 2);
    check_broken(chunk_of_runs(extent, {{9, 1}, {volume + 1, 2}}), ErrorCode::broken_invariant,
                 "run ends behind the volume", 1);
    check_broken(chunk_of_runs(extent, {{9, 1}, {12, 1}, {volume, 2}}), ErrorCode::broken_invariant,
                 "neighbouring runs have one material", 1);
    check_broken(chunk_of_runs(extent, {{9, 1}, {volume - 1, 2}}), ErrorCode::broken_invariant,
                 "runs do not reach the volume", 1);
  }
}

TEST_CASE("validate names a bad extent, order or form", "[runs][validate]") {
  RunChunk chunk = uniform_chunk(kSmall, 1);
  chunk.extent.y = 7;
  check_broken(chunk, ErrorCode::bad_value, "chunk side outside 8..128", 0);
  chunk.extent.y = 129;
  check_broken(chunk, ErrorCode::bad_value, "chunk side outside 8..128", 0);
  chunk = uniform_chunk(kSmall, 1);
  chunk.order = static_cast<AxisOrder>(6);
  check_broken(chunk, ErrorCode::bad_value, "unknown axis order", 0);
  chunk = uniform_chunk(kSmall, 1);
  chunk.runs = RunList{kLarge.volume()};
  chunk.runs.push_back({512, 1});
  check_broken(chunk, ErrorCode::broken_invariant, "run list form does not fit the volume", 0);
}
