#include "common/patterns/replaced.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <string>

#include "common/patterns/column_patterns.hpp"
#include "common/patterns/passing_voxels.hpp"
#include "common/patterns/pattern_parser.hpp"
#include "common/runs/run_builder.hpp"
#include "tests/support/runs/random_chunk.hpp"
#include "tests/unit/common/patterns/random_pattern.hpp"

namespace runstone::test {
namespace {

constexpr std::int32_t kEdge = 16;

/// Air, stone, oak planks, a lamp with two states, and moss.
MaterialTable patterns_table() {
  MaterialTable table;
  for (const char* name : {"stone", "oak planks", "lamp[lit=off]", "lamp[lit=on]", "moss"}) {
    MaterialInfo info;
    info.name = name;
    REQUIRE(table.add(info));
  }
  return table;
}

struct MixedWorld {
  explicit MixedWorld(std::uint64_t seed) {
    SplitMix64 rng(seed);
    for (std::int32_t x = -2; x < 2; ++x) {
      for (std::int32_t y = -2; y < 2; ++y) {
        for (std::int32_t z = -2; z < 2; ++z)
          chunks[{x, y, z}] = std::make_shared<RunChunk>(
              random_chunk(rng, Extent::cube(kEdge), random_order(rng), 6));
      }
    }
  }
  std::shared_ptr<const RunChunk> operator()(ChunkCoord at) const {
    const auto found = chunks.find(at);
    return found == chunks.end() ? nullptr : found->second;
  }
  std::optional<Material> at(VoxelPos voxel) const {
    const auto chunk = (*this)(chunk_of(voxel, kEdge));
    if (!chunk) return std::nullopt;
    return material_at(*chunk, local_of(voxel, kEdge));
  }
  std::map<ChunkCoord, std::shared_ptr<const RunChunk>> chunks;
};

/// The conditions of a filter, asked of one voxel at a time.
class FilterOracle {
 public:
  FilterOracle(const MixedWorld& world, const MaterialTable& table, std::uint64_t seed)
      : world_(world), table_(table), seed_(seed) {}

  bool holds(const VoxelFilter& filter, VoxelPos at) {
    count_ = 0;
    return evaluate(filter, at);
  }

 private:
  bool is_one_of(const VoxelFilter& filter, VoxelPos at) const {
    const auto material = world_.at(at);
    if (!material || !table_.knows(*material)) return false;
    const std::string& name = table_[*material].name;
    for (const NamedMaterial& named : filter.materials) {
      if (name == named.name || name.starts_with(named.name + "[")) return true;
    }
    return false;
  }
  bool evaluate(const VoxelFilter& filter, VoxelPos at) {
    const std::uint64_t number = count_++;
    const auto near = [&](std::int32_t dx, std::int32_t dy, std::int32_t dz) {
      return VoxelPos{at.x + dx, at.y + dy, at.z + dz};
    };
    const VoxelPos sides[] = {near(-1, 0, 0), near(1, 0, 0), near(0, 0, -1), near(0, 0, 1)};
    bool out = false;
    switch (filter.kind) {
      case FilterKind::is:
        return is_one_of(filter, at);
      case FilterKind::on:
        return is_one_of(filter, near(0, -1, 0));
      case FilterKind::under:
        return is_one_of(filter, near(0, 1, 0));
      case FilterKind::beside:
        for (const VoxelPos side : sides) out = out || is_one_of(filter, side);
        return out;
      case FilterKind::exposed:
        for (const VoxelPos side : sides) out = out || world_.at(side) == Material{kEmpty};
        return out || world_.at(near(0, 1, 0)) == Material{kEmpty} ||
               world_.at(near(0, -1, 0)) == Material{kEmpty};
      case FilterKind::solid:
        return world_.at(at) != Material{kEmpty};
      case FilterKind::above:
        return at.y > filter.number;
      case FilterKind::below:
        return at.y < filter.number;
      case FilterKind::noise: {
        ClumpNoise noise(mix64(seed_ + mix64((std::uint64_t{1} << 32) + number)), filter.size);
        const double share = noise.at(at) / 4294967296.0;
        return share * 100 < filter.number;
      }
      case FilterKind::all:
        out = true;
        for (const VoxelFilter& part : filter.parts) out = evaluate(part, at) && out;
        return out;
      case FilterKind::any:
        for (const VoxelFilter& part : filter.parts) out = evaluate(part, at) || out;
        return out;
      case FilterKind::negation:
        break;
    }
    return !evaluate(filter.parts.front(), at);
  }

  const MixedWorld& world_;
  const MaterialTable& table_;
  const std::uint64_t seed_;
  std::uint64_t count_ = 0;
};

/// Returns what becomes of a voxel: nullopt if the build leaves it alone.
std::optional<Material> change_at(const PlacedBuild& placed, VoxelPos at) {
  if (!placed.build) return std::nullopt;
  return placed.build->at({at.x - placed.at.x, at.y - placed.at.y, at.z - placed.at.z});
}

/// Replaces in a box by a text. Requires a text that can be read.
Result<PlacedBuild> replace_by(const MixedWorld& world, const VoxelBox& box,
                               std::string_view text) {
  const auto pattern = parse_pattern(text);
  REQUIRE(pattern);
  const MaterialTable table = patterns_table();
  auto mix = BoundMix::of(pattern->mix, table, {1, middle2_of(box)});
  REQUIRE(mix);
  if (!pattern->filter) return replaced(box, *mix, nullptr, kEdge, world);
  auto filter = BoundFilter::of(*pattern->filter, table, 1);
  REQUIRE(filter);
  return replaced(box, *mix, &*filter, kEdge, world);
}

}  // namespace

TEST_CASE("a pattern changes the voxels that it changes in a dense grid, and no others",
          "[patterns][property]") {
  SplitMix64 rng(Catch::rngSeed() + 7);
  const MaterialTable table = patterns_table();
  RandomPattern random(rng);
  std::size_t changed = 0, passed = 0;
  for (int round = 0; round < 40; ++round) {
    const MixedWorld world(rng.next());
    const std::string text =
        (rng.below(3) == 0 ? "moss" : random.mix()) + " where " + random.filter();
    CAPTURE(round, text);
    const auto pattern = parse_pattern(text);
    if (!pattern) continue;  // it is too long
    const VoxelPos low{rng.between(-32, 20), rng.between(-32, 20), rng.between(-32, 20)};
    const VoxelBox box{
        low,
        {rng.between(low.x + 1, std::min(32, low.x + 24)), rng.between(low.y + 1, 32),
         rng.between(low.z + 1, std::min(32, low.z + 24))}};
    const PatternFrame frame{rng.next(), middle2_of(box)};
    auto mix = BoundMix::of(pattern->mix, table, frame);
    auto filter = BoundFilter::of(*pattern->filter, table, frame.seed);
    REQUIRE((mix && filter));
    const auto placed = replaced(box, *mix, &*filter, kEdge, world);
    REQUIRE(placed);
    const auto found = passing_voxels({&box, 1}, *filter, UINT64_MAX, kEdge, world);
    REQUIRE(found);
    FilterOracle oracle(world, table, frame.seed);
    std::size_t touched = 0, held = 0;
    for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
      for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
        for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
          const VoxelPos at{x, y, z};
          std::optional<Material> wanted;
          const bool is_held = oracle.holds(*pattern->filter, at);
          if (found->contains(at) != is_held) FAIL_CHECK("found " << x << " " << y << " " << z);
          if (is_held) {
            ++held;
            const Material material = mix->at(at);
            if (material != world.at(at)) wanted = material;
          }
          if (wanted) ++touched;
          if (change_at(*placed, at) != wanted) FAIL_CHECK(x << " " << y << " " << z);
        }
      }
    }
    CHECK((placed->build ? placed->build->touched() : 0) == touched);
    CHECK(found->count() == held);
    changed += touched;
    passed += held;
  }
  CHECK(changed > 10'000);
  CHECK(passed > changed);
}

TEST_CASE("voxels are searched up to a bound, and only where chunks are known", "[patterns]") {
  const MixedWorld world(8);
  const auto filter = BoundFilter::of(*parse_filter("solid"), patterns_table(), 1);
  REQUIRE(filter);
  const auto fault = [&](const VoxelBox& box, std::uint64_t voxels_max) {
    const auto found = passing_voxels({&box, 1}, *filter, voxels_max, kEdge, world);
    return found ? std::nullopt : std::optional(found.error());
  };
  const VoxelBox all{{-32, -32, -32}, {32, 32, 32}};
  const auto found = passing_voxels({&all, 1}, *filter, UINT64_MAX, kEdge, world);
  REQUIRE(found);
  CHECK_FALSE(fault(all, found->count()));
  CHECK(fault(all, found->count() - 1) == FloodFault::too_many_voxels);
  CHECK(fault({{0, 0, 0}, {33, 1, 1}}, UINT64_MAX) == FloodFault::missing_chunk);
  // A box of the whole world ends at its first chunk.
  CHECK(fault({{-kWorldLimit, 0, 0}, {kWorldLimit, 1, kWorldLimit}}, 9) ==
        FloodFault::missing_chunk);
}

TEST_CASE("only voxels of a set are replaced", "[patterns]") {
  const MixedWorld world(9);
  const VoxelBox box{{-20, -20, -20}, {20, 20, 20}};
  SplitMix64 rng(4);
  auto only = std::make_shared<VoxelRows>();
  for (int i = 0; i < 300; ++i) {
    const std::int32_t x = rng.between(-25, 20);
    only->add(rng.between(-25, 25), rng.between(-25, 25), {x, x + rng.between(1, 9)});
  }
  only->join();
  auto replacing = Replacing::of(box, BoundMix::of(5), std::nullopt, kEdge, world, only);
  REQUIRE(replacing);
  std::uint64_t work = UINT64_MAX;
  REQUIRE(replacing->step(work));
  const auto placed = replacing->finish();
  REQUIRE(placed);
  std::size_t touched = 0, wrong = 0;
  for (VoxelPos v = box.min; v.z < box.max.z; ++v.z) {
    for (v.y = box.min.y; v.y < box.max.y; ++v.y) {
      for (v.x = box.min.x; v.x < box.max.x; ++v.x) {
        const bool is_changed = only->contains(v) && world.at(v) != Material{5};
        touched += is_changed ? 1 : 0;
        wrong += change_at(*placed, v) != (is_changed ? std::optional<Material>(5) : std::nullopt);
      }
    }
  }
  CHECK(wrong == 0);
  CHECK(placed->build->touched() == touched);
}

TEST_CASE("a box of several slices is replaced without seams", "[patterns]") {
  const auto flat = [](ChunkCoord at) -> std::shared_ptr<const RunChunk> {
    return std::make_shared<RunChunk>(
        uniform_chunk(Extent::cube(kEdge), at.y < 0 ? Material{1} : kEmpty));
  };
  const MaterialTable table = patterns_table();
  const auto pattern = parse_pattern("moss where is stone and exposed and not beside air");
  REQUIRE(pattern);
  auto mix = BoundMix::of(pattern->mix, table, {});
  auto filter = BoundFilter::of(*pattern->filter, table, 1);
  REQUIRE((mix && filter));
  const VoxelBox box{{-300, -20, -270}, {290, 3, 5}};
  const auto placed = replaced(box, *mix, &*filter, kEdge, flat);
  REQUIRE(placed);
  REQUIRE(placed->build);
  CHECK(placed->build->touched() == 590U * 275U);
  CHECK(change_at(*placed, {-300, -1, -270}) == Material{5});
  CHECK(change_at(*placed, {255, -1, -1}) == Material{5});
  CHECK(change_at(*placed, {256, -1, -256}) == Material{5});
  CHECK(change_at(*placed, {0, -2, 0}) == std::nullopt);
}

TEST_CASE("a pattern that is applied again changes nothing", "[patterns]") {
  MixedWorld world(8);
  const VoxelBox box{{-16, -16, -16}, {16, 16, 16}};
  constexpr std::string_view kText = "noise 4: stone, (moss, air)";
  const auto first = replace_by(world, box, kText);
  REQUIRE(first);
  REQUIRE(first->build);
  for (auto& [coord, chunk] : world.chunks) {
    const VoxelPos o = origin_of(coord, kEdge);
    if (!box.contains(o)) continue;
    RunBuilder changed(Extent::cube(kEdge), AxisOrder::xyz);
    for (std::int32_t z = 0; z < kEdge; ++z) {
      for (std::int32_t y = 0; y < kEdge; ++y) {
        for (std::int32_t x = 0; x < kEdge; ++x) {
          const VoxelPos at{o.x + x, o.y + y, o.z + z};
          changed.append(1, change_at(*first, at).value_or(*world.at(at)));
        }
      }
    }
    chunk = std::make_shared<RunChunk>(changed.finish());
  }
  const auto second = replace_by(world, box, kText);
  REQUIRE(second);
  CHECK(second->build == nullptr);
}

TEST_CASE("a name without states stands for all states", "[patterns]") {
  const MixedWorld world(3);
  const auto placed = replace_by(world, {{-32, -32, -32}, {32, 32, 32}}, "air where is lamp");
  REQUIRE(placed);
  REQUIRE(placed->build);
  std::size_t lamps = 0;
  for (std::int32_t x = -32; x < 32; ++x) {
    for (std::int32_t y = -32; y < 32; ++y) {
      for (std::int32_t z = -32; z < 32; ++z) {
        const Material is = *world.at({x, y, z});
        lamps += is == 3 || is == 4 ? 1 : 0;
      }
    }
  }
  CHECK(placed->build->touched() == lamps);
  CHECK(placed->build->solid() == 0);
}

TEST_CASE("a box with a chunk that is not known is refused, and one beside it is not",
          "[patterns]") {
  MixedWorld world(4);
  world.chunks.erase({0, 0, 0});
  const auto inside = replace_by(world, {{-4, -4, -4}, {1, 1, 1}}, "moss");
  REQUIRE_FALSE(inside);
  CHECK(inside.error().code == ErrorCode::not_found);
  CHECK(replace_by(world, {{-8, -8, -8}, {0, 0, 0}}, "moss where exposed"));
}

TEST_CASE("a box without a voxel that changes makes no build", "[patterns]") {
  const MixedWorld world(5);
  const auto none = replace_by(world, {{-8, -8, -8}, {8, 8, 8}}, "moss where is moss");
  REQUIRE(none);
  CHECK(none->build == nullptr);
}

TEST_CASE("the work of a replacement counts the chunks that it reads and the conditions",
          "[patterns]") {
  MixedWorld world(6);
  for (auto& [at, chunk] : world.chunks)
    chunk = std::make_shared<RunChunk>(uniform_chunk(Extent::cube(kEdge), 2));
  const MaterialTable table = patterns_table();
  const auto work_of = [&](const VoxelBox& box, std::string_view text) {
    const auto pattern = parse_pattern(text);
    REQUIRE(pattern);
    auto mix = BoundMix::of(pattern->mix, table, {});
    REQUIRE(mix);
    std::optional<BoundFilter> filter;
    if (pattern->filter) filter = BoundFilter::of(*pattern->filter, table, 1).value();
    auto steps = Replacing::of(box, *mix, filter, kEdge, world);
    REQUIRE(steps);
    constexpr std::uint64_t kMuch = 1'000'000;
    std::uint64_t work = kMuch;
    CHECK(steps->step(work).value());
    return kMuch - work;
  };
  // One chunk, then four of them above each other, with 9 columns.
  const VoxelBox low{{0, 0, 0}, {3, 1, 3}}, high{{0, -32, 0}, {3, 32, 3}};
  const std::uint64_t once = work_of(low, "stone"), four = work_of(high, "stone");
  CHECK(once >= 256 + 9 * 2);
  CHECK(once < 2 * 256);
  CHECK(four >= 4 * 256);
  CHECK(four < 5 * 256);
  const std::uint64_t solid = work_of(low, "stone where solid"),
                      more = work_of(low, "stone where solid and above -9 and below 90");
  CHECK(solid > once);
  CHECK(more > solid);
}

TEST_CASE("a replacement in steps is that of one call", "[patterns][property]") {
  SplitMix64 rng(Catch::rngSeed() + 9);
  const MaterialTable table = patterns_table();
  for (int round = 0; round < 6; ++round) {
    const MixedWorld world(rng.next());
    const VoxelBox box{{-30, -9, -11}, {rng.between(-10, 30), rng.between(0, 20), 27}};
    const auto pattern = parse_pattern("stone, moss where not on air and noise 60% 3");
    REQUIRE(pattern);
    auto mix = BoundMix::of(pattern->mix, table, {});
    auto filter = BoundFilter::of(*pattern->filter, table, 1);
    REQUIRE((mix && filter));
    const auto whole = replaced(box, *mix, &*filter, kEdge, world);
    REQUIRE((whole && whole->build));
    auto steps = Replacing::of(box, *mix, *filter, kEdge, world);
    REQUIRE(steps);
    const auto work_max = static_cast<std::uint64_t>(rng.between(1, 2'000));
    std::uint64_t decided = 0;
    for (bool is_done = false; !is_done;) {
      std::uint64_t work = work_max;
      const auto done = steps->step(work);
      REQUIRE(done);
      is_done = *done;
      // A step ends with the column in which its work is used up.
      const auto column = static_cast<std::uint64_t>(2 * (box.max.y - box.min.y));
      if (steps->decided() - decided > work_max + column) FAIL_CHECK("a step is too long");
      decided = steps->decided();
    }
    const auto made = steps->finish();
    REQUIRE((made && made->build));
    CHECK(made->at == whole->at);
    CHECK(made->build->touched() == whole->build->touched());
    for (VoxelPos c; c.z < whole->build->sides().z; ++c.z) {
      for (c.y = 0; c.y < whole->build->sides().y; ++c.y) {
        for (c.x = 0; c.x < whole->build->sides().x; ++c.x) {
          if (made->build->at(c) != whole->build->at(c))
            FAIL_CHECK(c.x << " " << c.y << " " << c.z);
        }
      }
    }
  }
}

TEST_CASE("the changes of a brush are filtered, and get a mix", "[patterns]") {
  const MixedWorld world(6);
  const MaterialTable table = patterns_table();
  const VoxelBox box{{-20, -20, -20}, {20, 20, 20}};
  const auto columns = GroundColumns::read(box, kEdge, world);
  REQUIRE(columns);
  ColumnChanges changes;
  for (std::size_t i = 0; i < columns->count(); ++i) {
    changes.push_back({i, -20, 3, kMixedMaterial});
    changes.push_back({i, 5, 9, Material{2}});
  }
  const auto condition = parse_filter("is stone or moss and not on air");
  REQUIRE(condition);
  auto filter = BoundFilter::of(*condition, table, 1);
  auto mix = BoundMix::of(*parse_mix("stone, moss"), table, {});
  REQUIRE((filter && mix));
  const auto placed =
      build_of_changes(*columns, mixed(*columns, filtered(*columns, changes, *filter), *mix));
  REQUIRE(placed);
  FilterOracle oracle(world, table, 1);
  for (std::int32_t x = -20; x < 20; ++x) {
    for (std::int32_t z = -20; z < 20; ++z) {
      for (std::int32_t y = -19; y < 20; ++y) {
        const VoxelPos at{x, y, z};
        std::optional<Material> wanted;
        if (y < 3) wanted = mix->at(at);
        if (y >= 5 && y < 9) wanted = Material{2};
        if (!oracle.holds(*condition, at) || wanted == world.at(at)) wanted.reset();
        const VoxelPos cell{x - placed->at.x, y - placed->at.y, z - placed->at.z};
        const auto is =
            placed->build->box().contains(cell) ? placed->build->at(cell) : std::nullopt;
        if (is != wanted) FAIL_CHECK(x << " " << y << " " << z);
      }
    }
  }
}

}  // namespace runstone::test
