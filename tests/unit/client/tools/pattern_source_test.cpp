#include "client/tools/pattern_source.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "client/tools/preview_words.hpp"
#include "common/patterns/pattern_parser.hpp"
#include "tests/unit/client/build/fake_port.hpp"
#include "tests/unit/client/tools/tool_bench.hpp"

namespace runstone::test {
namespace {

constexpr std::int32_t kGridLow = -2 * ToolBench::kEdge, kGridEnd = 2 * ToolBench::kEdge;
constexpr std::int32_t kGridSide = kGridEnd - kGridLow;

/// The shown voxels of a bench as a dense grid. Voxels outside of it are not known.
class DenseVoxels {
 public:
  explicit DenseVoxels(const ToolBench& bench) {
    for_each([&](VoxelPos at) { materials_.push_back(bench.at(at)); });
  }
  template <class F>
  static void for_each(F&& f) {
    for (VoxelPos at{0, 0, kGridLow}; at.z < kGridEnd; ++at.z) {
      for (at.y = kGridLow; at.y < kGridEnd; ++at.y) {
        for (at.x = kGridLow; at.x < kGridEnd; ++at.x) f(at);
      }
    }
  }
  static bool holds(VoxelPos at) {
    return std::min({at.x, at.y, at.z}) >= kGridLow && std::max({at.x, at.y, at.z}) < kGridEnd;
  }
  Material& at(VoxelPos at) {
    return materials_[static_cast<std::size_t>(
        at.x - kGridLow + kGridSide * (at.y - kGridLow + kGridSide * (at.z - kGridLow)))];
  }
  bool is(VoxelPos place, Material material) { return holds(place) && at(place) == material; }
  bool is_exposed(VoxelPos p) {
    return is({p.x - 1, p.y, p.z}, kEmpty) || is({p.x + 1, p.y, p.z}, kEmpty) ||
           is({p.x, p.y - 1, p.z}, kEmpty) || is({p.x, p.y + 1, p.z}, kEmpty) ||
           is({p.x, p.y, p.z - 1}, kEmpty) || is({p.x, p.y, p.z + 1}, kEmpty);
  }

 private:
  std::vector<Material> materials_;
};

struct PatternBench : ToolBench {
  PatternBench() { box.set_materials(default_material_table()); }

  /// Returns the work of a text in a box. Requires a pattern that can be read.
  PatternWorkPtr work_of(std::string_view text, const VoxelBox& where) {
    const auto pattern = parse_pattern(text);
    REQUIRE(pattern);
    const PatternFrame frame{5, middle2_of(where)};
    auto bound = BoundMix::of(pattern->mix, default_material_table(), frame);
    REQUIRE(bound);
    std::optional<BoundFilter> filter;
    if (pattern->filter)
      filter = BoundFilter::of(*pattern->filter, default_material_table(), 5).value();
    auto made = pattern_work(replica, {where}, *std::move(bound), std::move(filter));
    REQUIRE(made);
    return *made;
  }
  /// Applies the edits of a source as they come. Returns how it ended, and counts its waits.
  SourceStep apply(EditSource& source) {
    for (waits = edits = 0;;) {
      const SourceStep step = source.next();
      if (step.kind == SourceStep::Kind::edit) {
        ++edits;
        predict({step.edit});
      } else if (step.kind == SourceStep::Kind::wait) {
        ++waits;
      } else {
        return step;
      }
    }
  }
  void check(DenseVoxels wanted) {
    std::size_t wrong = 0;
    DenseVoxels::for_each([&](VoxelPos p) { wrong += wanted.at(p) != at(p) ? 1 : 0; });
    CHECK(wrong == 0);
  }

  std::size_t waits = 0, edits = 0;
};

}  // namespace

TEST_CASE("a pattern in small parts changes what it changes in a dense grid", "[tools][property]") {
  SplitMix64 rng(Catch::rngSeed() + 11);
  constexpr std::string_view kMix = "60% stone, 30% (noise 3: sand, gravel), 10% air";
  for (int round = 0; round < 8; ++round) {
    PatternBench bench;
    bench.rng = SplitMix64(rng.next());
    bench.show_random();
    const auto range = [&](std::int32_t& low, std::int32_t& high) {
      low = rng.between(kGridLow, kGridEnd - 2);
      high = rng.between(low + 1, std::min(low + 24, kGridEnd));
    };
    VoxelBox where;
    range(where.min.x, where.max.x);
    range(where.min.y, where.max.y);
    range(where.min.z, where.max.z);
    const bool has_filter = round % 2 == 0;
    const PatternWorkPtr work = bench.work_of(
        std::string(kMix) + (has_filter ? " where exposed and not on air" : ""), where);
    const PatternSteps steps{{rng.between(4, 17), rng.between(4, 17), rng.between(4, 17)},
                             static_cast<std::uint64_t>(rng.between(1, 900))};
    CAPTURE(round, steps.part_sides.x, steps.part_sides.y, steps.part_sides.z, steps.turn_work);
    DenseVoxels before(bench), wanted(bench);
    BoundMix mix = work->mix;
    std::size_t changed = 0;
    DenseVoxels::for_each([&](VoxelPos p) {
      if (!where.contains(p)) return;
      const VoxelPos below{p.x, p.y - 1, p.z};
      if (has_filter && (!before.is_exposed(p) || before.is(below, kEmpty))) return;
      if (wanted.at(p) != mix.at(p)) ++changed;
      wanted.at(p) = mix.at(p);
    });
    PatternSource source(work, bench.replica.edit_limits(), steps);
    const SourceStep end = bench.apply(source);
    CHECK(end.kind == (changed == 0 ? SourceStep::Kind::failed : SourceStep::Kind::end));
    CHECK(source.next().kind == end.kind);
    bench.check(std::move(wanted));
  }
}

TEST_CASE_METHOD(PatternBench,
                 "the steps of a pattern are bounded, and later ones read the old world",
                 "[tools]") {
  show_flat();
  const PatternWorkPtr work =
      work_of("stone where is grass and exposed", {{-32, -32, -32}, {32, 32, 32}});
  PatternSource source(work, replica.edit_limits(), {{16, 16, 16}, 100});
  // Somebody builds on the grass after the click.
  predict({{FillBox{{{-32, 0, -32}, {32, 4, 32}}}, {}, 4}});
  CHECK(apply(source).kind == SourceStep::Kind::end);
  CHECK(waits > 64U * 64U / 100U);
  CHECK(edits >= 16);
  for (const VoxelPos p : {VoxelPos{-32, -1, -32}, VoxelPos{31, -1, 31}, VoxelPos{0, -1, 0}}) {
    CHECK(at(p) == *default_material_table().find("stone"));
    CHECK(at({p.x, p.y - 1, p.z}) == 1);
  }
}

TEST_CASE_METHOD(PatternBench, "a turn of the sender does the work of one turn, not of one an edit",
                 "[tools]") {
  show_flat();
  // Each part of 16 x 16 columns takes 256 units and more, and makes one edit.
  const PatternWorkPtr work = work_of("stone where is grass", {{-32, -16, -32}, {32, 0, 32}});
  FakePort port;
  ActionSender sender(std::make_unique<PatternSource>(work, replica.edit_limits(),
                                                      PatternSteps{{16, 16, 16}, 600}));
  std::size_t before = 0, turns = 0;
  for (; !sender.has_ended(); ++turns) {
    REQUIRE(turns < 64);
    sender.step(port, 1'000'000);
    CHECK(port.offered.size() - before <= 2);
    before = port.offered.size();
    port.apply_all();
  }
  CHECK(sender.state() == ActionSender::State::done);
  CHECK(before >= 16);
  CHECK(turns >= 8);
}

TEST_CASE_METHOD(PatternBench, "each copy of a pattern is that of its box, mirrored", "[tools]") {
  show_random();
  const VoxelBox where{{3, -9, 2}, {20, 11, 30}};
  auto work = work_of("50% stone, 50% sand where noise 40% 5", where);
  auto copied = with_symmetry(work, {SymmetryKind::both, 0, 1}, default_material_table());
  REQUIRE(copied);
  DenseVoxels wanted(*this);
  BoundMix mix = work->mix;
  const auto whole = replaced(where, mix, &*work->filter, kEdge,
                              [&](ChunkCoord c) { return replica.shown({0, c}); });
  REQUIRE((whole && whole->build));
  DenseVoxels::for_each([&](VoxelPos p) {
    if (!where.contains(p)) return;
    const auto now = whole->build->at({p.x - where.min.x, p.y - where.min.y, p.z - where.min.z});
    if (!now) return;
    for (const VoxelPos copy :
         {p, VoxelPos{-p.x, p.y, p.z}, VoxelPos{p.x, p.y, 1 - p.z}, VoxelPos{-p.x, p.y, 1 - p.z}})
      wanted.at(copy) = *now;
  });
  PatternSource source(*copied, replica.edit_limits(), {{8, 64, 11}, 1'000});
  CHECK(apply(source).kind == SourceStep::Kind::end);
  check(std::move(wanted));
  CHECK(with_symmetry(work, {SymmetryKind::x, 2 * kWorldLimit, 0}, default_material_table())
            .error() == "a mirrored copy reaches outside the world");
}

TEST_CASE_METHOD(PatternBench, "a large box of the tool mix is one action with an exact preview",
                 "[tools]") {
  show_flat();
  for (std::int32_t y = -2; y < 2; ++y) {
    for (std::int32_t z = -2; z < 2; ++z)
      show({2, y, z}, uniform_chunk(Extent::cube(kEdge), y < 0 ? Material{1} : kEmpty));
  }
  REQUIRE(box.choose("mix"));
  REQUIRE(box.set_text("pattern", "stone, gravel where is grass"));
  REQUIRE(box.set_parameter("region", 1));
  box.select(VoxelBox{{-32, -32, -32}, {48, 32, 32}});
  const Aim aim = aim_at({0, -1, 0}, Direction::pos_y);
  unsigned turns = 0;
  while (turns <= ToolBox::kRestCalls || !box.is_preview_complete()) {
    REQUIRE(++turns < 300);
    box.step_preview(replica, aim, 64);
  }
  CHECK(preview_words(box) == "sets 163840 and removes 0 voxels");
  const auto made = box.press(replica, aim, ToolButton::place);
  REQUIRE(made);
  CHECK_FALSE(made->empty());
  CHECK(made->pastes.empty());
  CHECK(made->edits.empty());
  CHECK_FALSE(is_small(*made, replica.edit_limits()));
  const auto source = source_of(*made, replica.edit_limits());
  CHECK(apply(*source).kind == SourceStep::Kind::end);
  const Material stone = *default_material_table().find("stone"),
                 gravel = *default_material_table().find("gravel");
  std::size_t mixed = 0;
  for (VoxelPos p{0, 0, -32}; p.z < 32; ++p.z) {
    for (p.y = -32; p.y < 32; ++p.y) {
      for (p.x = -32; p.x < 48; ++p.x) mixed += at(p) == stone || at(p) == gravel ? 1 : 0;
    }
  }
  CHECK(mixed == 163'840);
  // The voxels have the materials of the pattern now.
  const auto again = box.press(replica, aim, ToolButton::place);
  REQUIRE(again);
  CHECK(apply(*source_of(*again, replica.edit_limits())).why ==
        "the pattern changes no voxel there");
  box.select(VoxelBox{{-32, -32, -32}, {49, 32, 32}});
  CHECK(box.press(replica, aim, ToolButton::place).error() == "a chunk of the box is not loaded");
}

TEST_CASE_METHOD(PatternBench, "a preview mirrors one build a turn, and counts the copies",
                 "[tools]") {
  show_flat();
  const PatternWorkPtr work = work_of("stone, sand", {{1, -20, 1}, {11, -10, 11}});
  const auto copied = with_symmetry(work, {SymmetryKind::both, 0, 0}, default_material_table());
  REQUIRE(copied);
  MirroredBuilds mirrored;
  PatternPreview preview(4'000), small(3'999);
  small.set(*copied);
  REQUIRE(small.step(mirrored, true));
  CHECK(small.is_too_large());
  preview.set(*copied);
  for (int turn = 0; turn < 3; ++turn) REQUIRE_FALSE(preview.step(mirrored, false));
  CHECK(preview.is_under_way());
  const auto made = preview.step(mirrored, false);
  REQUIRE(made);
  CHECK(made->size() == 4);
  CHECK_FALSE(preview.is_under_way());
}

TEST_CASE_METHOD(PatternBench, "a preview of more than four boxes is given up at once", "[tools]") {
  show_flat();
  for (const std::size_t boxes : {4U, 5U}) {
    auto work = std::make_shared<PatternWork>(*work_of("stone", {{0, -2, 0}, {1, -1, 1}}));
    while (work->boxes.size() < boxes) {
      VoxelBox next = work->boxes.back();
      next.min.x += 2;
      next.max.x += 2;
      work->boxes.push_back(next);
    }
    PatternPreview preview;
    preview.set(work);
    CHECK(preview.is_under_way() == (boxes == 4));
    CHECK(preview.is_too_large() == (boxes == 5));
    MirroredBuilds mirrored;
    const auto made = preview.step(mirrored, true);
    REQUIRE(made.has_value() == (boxes == 4));
    if (made) CHECK(made->size() == 4);
  }
}

TEST_CASE_METHOD(PatternBench, "another tool ends the preview of a pattern", "[tools]") {
  show_flat();
  REQUIRE(box.choose("mix"));
  REQUIRE(box.set_text("pattern", "50% stone, 50% sand"));
  REQUIRE(box.set_parameter("region", 1));
  box.select(VoxelBox{{-32, -32, -32}, {32, 32, 32}});
  REQUIRE(box.select({{-32, -32, -32}, {0, 0, 0}}, SelectMode::remove));
  const Aim aim = aim_at({0, -1, 0}, Direction::pos_y);
  for (unsigned turns = 0; box.is_preview_complete() || turns <= ToolBox::kRestCalls; ++turns) {
    REQUIRE(turns < 2 * ToolBox::kRestCalls);
    box.step_preview(replica, aim, 64);
  }
  REQUIRE_FALSE(box.is_preview_complete());
  REQUIRE(box.choose("voxel"));
  CHECK(box.is_preview_complete());
}

TEST_CASE_METHOD(PatternBench,
                 "a preview of too many single voxels is given up, and the click is not",
                 "[tools]") {
  show_flat();
  const PatternWorkPtr work = work_of("stone, sand", {{-20, -20, -20}, {20, 20, 20}});
  MirroredBuilds mirrored;
  PatternPreview preview(64'000), small(63'000);
  preview.set(work);
  small.set(work);
  CHECK(small.is_under_way());
  const auto made = small.step(mirrored, true);
  REQUIRE(made);
  CHECK(made->empty());
  CHECK(small.is_too_large());
  CHECK_FALSE(small.is_under_way());
  const auto whole = preview.step(mirrored, true);
  REQUIRE(whole);
  REQUIRE(whole->size() == 1);
  CHECK_FALSE(preview.is_too_large());
  CHECK(whole->front().build->touched() == 64'000);
  small.set(nullptr);
  CHECK_FALSE(small.is_too_large());
}

}  // namespace runstone::test
