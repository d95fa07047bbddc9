// Placing of builds: as one action, beside the edits of others, within rights, and back.
#include <catch2/catch.hpp>
#include <string>
#include <utility>

#include "common/builds/build_builder.hpp"
#include "common/core/hash.hpp"
#include "common/runs/run_builder.hpp"
#include "server/place/place_service.hpp"
#include "tests/unit/server/rollback/rollback_bench.hpp"

namespace runstone::test {
namespace {

struct PlaceBench : RollbackBench {
  using RollbackBench::RollbackBench;

  /// Ticks and works until nothing is under way.
  void settle() {
    for (int i = 0; i < 400 && (!placing.is_idle() || i < 3); ++i) step();
    run_all();
  }
  void step() {
    write_log();
    tick();
    placing.tick(bench.now());
    work();
    bench.answer_loads();
  }
  PlaceService placing{bench.server, service, *this, [](std::span<std::uint8_t> out) {
                         for (auto& byte : out) byte = 0x5a;
                       }};
};

/// Returns a box of one material whose cells in the plane x = 0 are untouched. With `other`, cells
/// have that material at random, so that the build has many edits; the second one along x has it.
BuildPtr box_of(VoxelPos sides, Material material, Material other = kEmpty) {
  auto builder =
      BuildBuilder::of({grid_cuts(sides.x, 64), grid_cuts(sides.y, 64), grid_cuts(sides.z, 64)});
  REQUIRE(builder.has_value());
  const std::uint16_t number = *builder->number_of(material);
  const std::uint16_t second = other == kEmpty ? number : *builder->number_of(other);
  const auto& cuts = builder->cuts();
  SplitMix64 random(7);
  for (std::uint32_t z = 0; z + 1 < cuts[2].size(); ++z) {
    for (std::uint32_t y = 0; y + 1 < cuts[1].size(); ++y) {
      for (std::uint32_t x = 0; x + 1 < cuts[0].size(); ++x) {
        const Extent extent{static_cast<std::uint8_t>(cuts[0][x + 1] - cuts[0][x]),
                            static_cast<std::uint8_t>(cuts[1][y + 1] - cuts[1][y]),
                            static_cast<std::uint8_t>(cuts[2][z + 1] - cuts[2][z])};
        RunBuilder runs(extent, AxisOrder::xyz);
        for (int line = 0; line < extent.y * extent.z; ++line) {
          runs.append(1, x == 0 ? 0 : number);
          for (unsigned cell = 1; cell < extent.x; ++cell)
            runs.append(1, cell != 1 && random.below(2) == 0 ? number : second);
        }
        REQUIRE(builder->put({x, y, z}, runs.finish()).has_value());
      }
    }
  }
  return *builder->finish();
}

PlaceOrder order_of(AuthorId author, VoxelPos at, BuildPtr build) {
  PlaceOrder order;
  order.author = order.payer = author;
  order.build = std::move(build);
  order.at = at;
  return order;
}

}  // namespace

TEST_CASE("a build is placed as one action, and one undo takes it back", "[place]") {
  PlaceBench bench;
  const AuthorId author = GENERATE(AuthorId{0}, AuthorId{1});
  REQUIRE(bench.join(kGriefer) == 1);
  const auto before = bench.digests();
  bench.placing.place(order_of(author, {-5, 0, 3}, box_of({50, 20, 40}, 3)), "\"Hall\"",
                      bench.bench.now(), bench.reply());
  bench.settle();
  REQUIRE(bench.answer().is_ok);
  CHECK(bench.answer().text.starts_with("\"Hall\" is placed: 39200 voxels in "));
  CHECK(bench.at({-4, 0, 3}) == 3);
  CHECK(bench.at({44, 19, 42}) == 3);
  CHECK(bench.at({-5, 0, 3}) == kEmpty);
  const std::vector<EditRecord>& records = bench.bench.environment.records;
  for (std::size_t i = 1; i < records.size(); ++i)
    CHECK(records[i].subject == records[0].version.seq);

  bench.answers.clear();
  bench.service.undo(author, bench.bench.now(), bench.reply());
  bench.settle();
  REQUIRE(bench.answer().is_ok);
  CHECK(bench.digests() == before);
  bench.service.redo(author, bench.bench.now(), bench.reply());
  bench.settle();
  CHECK(bench.at({44, 19, 42}) == 3);
}

TEST_CASE("a build that is cancelled is taken back, whatever its author did since", "[place]") {
  PlaceBench bench;
  const AuthorId author = bench.join(kGriefer);
  bench.placing.place(order_of(author, {0, 0, 0}, box_of({128, 64, 128}, 3, 4)), "\"Wall\"",
                      bench.bench.now(), bench.reply());
  for (int i = 0; i < 6; ++i) bench.step();
  REQUIRE_FALSE(bench.placing.is_idle());
  REQUIRE(bench.at({1, 0, 0}) == 4);
  bench.set(kGriefer, {5, -3, 5}, 2);
  bench.placing.cancel(author, bench.bench.now(), bench.reply());
  bench.settle();
  CHECK(bench.at({1, 0, 0}) == kEmpty);
  CHECK(bench.at({5, -3, 5}) == 2);
  CHECK(bench.placing.is_idle());
  // Nothing of the build is left: of all chunks only that of the other edit has a digest.
  CHECK(bench.digests().size() == 1);
}

TEST_CASE("a build whose log fails while a worker cuts is answered, and nothing breaks",
          "[place]") {
  PlaceBench bench;
  const AuthorId author = bench.join(kGriefer);
  bench.placing.place(order_of(author, {0, 0, 0}, box_of({128, 64, 128}, 3, 4)), "\"Wall\"",
                      bench.bench.now(), bench.reply());
  bench.placing.tick(bench.bench.now());
  REQUIRE(bench.works.size() == 1);  // a worker cuts
  bench.bench.server.log_failed();
  bench.placing.tick(bench.bench.now());
  CHECK(bench.placing.is_idle());
  CHECK_FALSE(bench.answer().is_ok);
  CHECK(bench.answer().text.find("its log cannot be written") != std::string::npos);
  CHECK(bench.work());  // the answer of the worker comes late
}

TEST_CASE("an undo while a build is placed ends it", "[place]") {
  PlaceBench bench;
  const AuthorId author = bench.join(kGriefer);
  bench.placing.place(order_of(author, {0, 0, 0}, box_of({128, 64, 128}, 3, 4)), "\"Wall\"",
                      bench.bench.now(), bench.reply());
  for (int i = 0; i < 6; ++i) bench.step();
  REQUIRE_FALSE(bench.placing.is_idle());
  bench.service.undo(author, bench.bench.now(), bench.reply());
  bench.settle();
  CHECK(bench.placing.is_idle());
  CHECK(bench.digests().empty());
}

TEST_CASE("a build that cannot be placed is refused with words", "[place]") {
  PlaceBench bench;
  const BuildPtr build = box_of({70, 8, 8}, 3);
  bench.placing.place(order_of(0, {kWorldLimit - 8, 0, 0}, build), "\"Hall\"", bench.bench.now(),
                      bench.reply());
  CHECK_FALSE(bench.answer().is_ok);
  CHECK(bench.answer().text.find("does not lie in the world") != std::string::npos);

  bench.placing.place(order_of(0, {0, 0, 0}, build), "\"A\"", bench.bench.now(), bench.reply());
  bench.placing.place(order_of(0, {0, 0, 0}, build), "\"B\"", bench.bench.now(), bench.reply());
  CHECK_FALSE(bench.answer().is_ok);
  CHECK(bench.answer().text.find("\"A\", which you place, is still under way") !=
        std::string::npos);
  bench.answers.clear();
  bench.settle();
  CHECK(bench.answer().is_ok);
  bench.placing.cancel(0, bench.bench.now(), bench.reply());
  CHECK(bench.answer().text == "no build is being placed");
}

TEST_CASE("parts on protected ground are left out and counted", "[place]") {
  PlaceBench bench;
  const AuthorId author = bench.join(kGriefer);
  ProtectedBox box;
  box.name = "square";
  box.box = {{0, 0, 64}, {32, 32, 96}};
  const auto changed = bench.bench.server.changes().change_rights(
      RightsChange{Protect{box}}, RightsActor{}, 0, bench.bench.now());
  REQUIRE(changed.has_value());
  bench.placing.place(order_of(author, {0, 0, 0}, box_of({128, 128, 128}, 3)), "\"Hall\"",
                      bench.bench.now(), bench.reply());
  bench.settle();
  REQUIRE(bench.answer().is_ok);
  CHECK(bench.answer().text.find("part left out: ") != std::string::npos);
  INFO(bench.answer().text);
  CHECK(bench.at({2, 2, 66}) == kEmpty);
  CHECK(bench.at({66, 15, 15}) == 3);
}

}  // namespace runstone::test
