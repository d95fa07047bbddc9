#include "client/render/light_field.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <map>
#include <vector>

#include "common/core/hash.hpp"

using namespace runstone;

namespace {

constexpr std::int32_t kLightEdge = 16;
#ifdef RUNSTONE_SANITIZED
constexpr int kLightSteps = 3;
#else
constexpr int kLightSteps = 12;
#endif
constexpr Material kLightStone = 1, kLightWater = 2, kLightLeaves = 3, kLightLamp = 4,
                   kLightRed = 5;

MaterialTable lit_materials() {
  MaterialTable table;
  const auto add = [&](const char* name, MaterialColour colour, Visibility visibility,
                       MaterialBody body = MaterialBody::solid) {
    REQUIRE(table.add({name, colour, visibility, {}, body}).has_value());
  };
  add("stone", {90, 90, 90, 255}, Visibility::opaque);
  add("water", {40, 80, 200, 128}, Visibility::transparent, MaterialBody::liquid);
  add("leaves", {30, 120, 30, 255}, Visibility::opaque);
  add("lamp", {255, 230, 150, 255}, Visibility::opaque);
  add("red torch", {255, 40, 20, 200}, Visibility::transparent);
  return table;
}

/// A world of 5 x 5 x 5 chunks around the origin, with a code for each voxel.
class DenseLight {
 public:
  static constexpr std::int32_t kMin = -32, kSide = 80;

  explicit DenseLight(const LightCodes& codes) : codes_(codes) {
    for (std::int32_t x = -2; x < 3; ++x) {
      for (std::int32_t y = -2; y < 3; ++y) {
        for (std::int32_t z = -2; z < 3; ++z) {
          const auto order = kAxisOrders[static_cast<std::size_t>(std::abs(x + 2 * y + 3 * z)) %
                                         kAxisOrders.size()];
          chunks_.emplace(ChunkCoord{x, y, z},
                          uniform_chunk(Extent::cube(kLightEdge), kEmpty, order));
        }
      }
    }
  }

  const std::map<ChunkCoord, RunChunk>& chunks() const { return chunks_; }
  void set_box(const VoxelBox& box, Material material) {
    for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
      for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
        for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
          RunChunk& chunk = chunks_.at(chunk_of({x, y, z}, kLightEdge));
          fill(chunk, index_of(local_of({x, y, z}, kLightEdge), chunk.extent, chunk.order), 1,
               material);
        }
      }
    }
  }

  /// Relaxes every voxel with its 18 neighbours until nothing changes. A voxel whose light is as it
  /// was when it was last relaxed is left out.
  void light() {
    const std::size_t volume = std::size_t{kSide} * kSide * kSide;
    code_.assign(volume, 0);
    levels_.assign(volume, {});
    is_pending_.assign(volume, true);
    for (const auto& [at, chunk] : chunks_) {
      const VoxelPos origin = origin_of(at, kLightEdge);
      for (VoxelIndex i = 0; i < chunk.volume(); ++i) {
        const LocalPos local = pos_of(i, chunk.extent, chunk.order);
        code_[place({origin.x + local.x, origin.y + local.y, origin.z + local.z})] =
            codes_[chunk.runs.material(find_run(chunk, i))];
      }
    }
    for (std::int32_t x = kMin; x < kMin + kSide; ++x) {
      for (std::int32_t z = kMin; z < kMin + kSide; ++z) {
        int sky = kLightMax;
        for (std::int32_t y = kMin + kSide - 1; y >= kMin; --y) {
          const std::size_t i = place({x, y, z});
          sky = is_opaque(i) ? 0 : std::max(sky - loss(i), 0);
          levels_[i] = {static_cast<int>(emission_of(code_[i], 0)) * 8,
                        static_cast<int>(emission_of(code_[i], 1)) * 8,
                        static_cast<int>(emission_of(code_[i], 2)) * 8, sky};
        }
      }
    }
    while (relax()) {
    }
  }
  std::array<int, 4> levels_at(VoxelPos at) const { return levels_[place(at)]; }

 private:
  static std::size_t place(VoxelPos at) {
    return static_cast<std::size_t>(at.x - kMin) +
           std::size_t{kSide} * (static_cast<std::size_t>(at.y - kMin) +
                                 std::size_t{kSide} * static_cast<std::size_t>(at.z - kMin));
  }
  static bool is_inside(VoxelPos at) {
    return VoxelBox{{kMin, kMin, kMin}, {kMin + kSide, kMin + kSide, kMin + kSide}}.contains(at);
  }
  bool is_opaque(std::size_t i) const { return pass_of(code_[i]) == LightPass::opaque; }
  int loss(std::size_t i) const {
    return pass_of(code_[i]) == LightPass::liquid   ? 4
           : pass_of(code_[i]) == LightPass::leaves ? 14
                                                    : 0;
  }
  bool relax() {
    bool has_changed = false;
    for (std::int32_t z = kMin; z < kMin + kSide; ++z) {
      for (std::int32_t y = kMin; y < kMin + kSide; ++y) {
        for (std::int32_t x = kMin; x < kMin + kSide; ++x)
          has_changed = spread({x, y, z}) || has_changed;
      }
    }
    return has_changed;
  }
  bool spread(VoxelPos at) {
    if (!is_pending_[place(at)]) return false;
    is_pending_[place(at)] = false;
    const std::array<int, 4> from = levels_[place(at)];
    if (*std::max_element(from.begin(), from.end()) <= 8) return false;
    bool has_changed = false;
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dz = -1; dz <= 1; ++dz) {
          const int steps = std::abs(dx) + std::abs(dy) + std::abs(dz);
          if (steps == 0 || steps == 3) continue;
          const VoxelPos to{at.x + dx, at.y + dy, at.z + dz};
          if (!is_inside(to) || is_opaque(place(to))) continue;
          if (steps == 2) {
            const VoxelPos one =
                dx != 0 ? VoxelPos{at.x + dx, at.y, at.z} : VoxelPos{at.x, at.y + dy, at.z};
            const VoxelPos other =
                dz != 0 ? VoxelPos{at.x, at.y, at.z + dz} : VoxelPos{at.x, at.y + dy, at.z};
            if (is_opaque(place(one)) && is_opaque(place(other))) continue;
          }
          for (std::size_t c = 0; c < 4; ++c) {
            const int level = from[c] - (steps == 1 ? 8 : 11) - loss(place(to));
            int& before = levels_[place(to)][c];
            if (level <= before) continue;
            before = level;
            is_pending_[place(to)] = true;
            has_changed = true;
          }
        }
      }
    }
    return has_changed;
  }

  LightCodes codes_;
  std::map<ChunkCoord, RunChunk> chunks_;
  std::vector<LightCode> code_;
  std::vector<std::array<int, 4>> levels_;
  std::vector<bool> is_pending_;
};

std::array<int, 4> bytes_of(LightLevels levels) {
  return {static_cast<int>(levels & 255U), static_cast<int>(levels >> 8 & 255U),
          static_cast<int>(levels >> 16 & 255U), static_cast<int>(levels >> 24)};
}

/// Returns the number of voxels that differ. Near the rim of the field light may be missing that
/// comes from outside.
std::size_t differences(const LightField& field, const DenseLight& dense) {
  VoxelBox inner = field.box();
  inner.min = {inner.min.x + kLightReach, inner.min.y + kLightReach, inner.min.z + kLightReach};
  inner.max = {inner.max.x - kLightReach, inner.max.y - kLightReach, inner.max.z - kLightReach};
  std::size_t out = 0, lit = 0;
  for (std::int32_t x = inner.min.x; x < inner.max.x; ++x) {
    for (std::int32_t y = inner.min.y; y < inner.max.y; ++y) {
      for (std::int32_t z = inner.min.z; z < inner.max.z; ++z) {
        const auto levels = bytes_of(field.levels_at({x, y, z}));
        out += levels != dense.levels_at({x, y, z}) ? 1 : 0;
        lit += levels[0] != 0 && levels[3] < 100 ? 1 : 0;
      }
    }
  }
  CHECK(lit > 0);
  return out;
}

void send(LightField& field, const DenseLight& world, const LightCodes& codes) {
  for (const auto& [at, chunk] : world.chunks())
    field.set(at, kLightEdge, light_chunk(chunk, codes));
}

/// A ground with a hall below it, which has a door and a hole in its roof, and lamps inside.
void build_hall(DenseLight& world) {
  world.set_box({{-32, -32, -32}, {48, 6, 48}}, kLightStone);
  world.set_box({{-14, -8, -14}, {24, 4, 24}}, kEmpty);
  world.set_box({{0, 4, 0}, {2, 6, 2}}, kEmpty);
  world.set_box({{24, -8, 3}, {36, -4, 6}}, kEmpty);
  world.set_box({{33, -8, 3}, {36, 6, 6}}, kEmpty);
  world.set_box({{6, -8, -14}, {7, 4, 18}}, kLightStone);
  world.set_box({{-6, -8, -6}, {-5, -7, -5}}, kLightLamp);
  world.set_box({{9, -3, 14}, {10, -2, 15}}, kLightRed);
  world.set_box({{-14, -8, 10}, {0, -5, 24}}, kLightWater);
  world.set_box({{-4, 10, -4}, {9, 12, 9}}, kLightLeaves);
}

}  // namespace

TEST_CASE("light spreads as the dense oracle says, after edits and while the box moves",
          "[render]") {
  const LightCodes codes = light_codes(lit_materials());
  DenseLight world(codes);
  build_hall(world);
  LightField field(64, 64);
  std::vector<VoxelBox> changed;
  field.update({8, 0, 8}, true, changed);
  send(field, world, codes);
  field.update({8, 0, 8}, true, changed);
  world.light();
  REQUIRE(differences(field, world) == 0);
  // The oracle is broken on purpose: without its lamp it differs.
  world.set_box({{-6, -8, -6}, {-5, -7, -5}}, kLightStone);
  world.light();
  REQUIRE(differences(field, world) > 100);
  send(field, world, codes);
  field.update({8, 0, 8}, true, changed);
  REQUIRE(differences(field, world) == 0);

  SplitMix64 rng(11);
  for (int step = 0; step < kLightSteps; ++step) {
    const auto at = [&rng] { return static_cast<std::int32_t>(rng.below(28)) - 6; };
    const VoxelPos min{at(), at() - 6, at()};
    const auto size = [&rng] { return static_cast<std::int32_t>(1 + rng.below(6)); };
    world.set_box({min, {min.x + size(), min.y + size(), min.z + size()}},
                  static_cast<Material>(rng.below(6)));
    send(field, world, codes);
    const auto move = [&rng] { return static_cast<std::int32_t>(rng.below(36)) - 10; };
    field.update({move(), 0, move()}, true, changed);
    world.light();
    CAPTURE(step);
    REQUIRE(differences(field, world) == 0);
  }
}

TEST_CASE("a roof above the box keeps the sky out, and chunks may leave", "[render]") {
  const LightCodes codes = light_codes(lit_materials());
  LightField field(64, 32);
  std::vector<VoxelBox> changed;
  field.update({8, 8, 8}, true, changed);
  const auto sky = [&] { return bytes_of(field.levels_at({8, 8, 8}))[3]; };
  CHECK(sky() == kLightMax);
  RunChunk roof = uniform_chunk(Extent::cube(kLightEdge), kEmpty, AxisOrder::zxy);
  for (std::uint8_t x = 0; x < kLightEdge; ++x) {
    for (std::uint8_t z = 0; z < kLightEdge; ++z)
      fill(roof, index_of({x, 3, z}, roof.extent, roof.order), 1, kLightStone);
  }
  for (std::int32_t x = -3; x <= 3; ++x) {
    for (std::int32_t z = -3; z <= 3; ++z)
      field.set({x, 4, z}, kLightEdge, light_chunk(roof, codes));
  }
  field.update({8, 8, 8}, true, changed);
  CHECK(sky() == 0);
  field.remove({0, 4, 0});
  field.update({8, 8, 8}, true, changed);
  CHECK(sky() == kLightMax);
  field.set({0, 6, 0}, kLightEdge,
            light_chunk(uniform_chunk(Extent::cube(kLightEdge), kEmpty), codes));
  field.update({8, 8, 8}, true, changed);
  CHECK(sky() == kLightMax);
}

TEST_CASE("an edit changes no more than light reaches, and small changes come first", "[render]") {
  const LightCodes codes = light_codes(lit_materials());
  DenseLight world(codes);
  build_hall(world);
  LightField field(64, 64);
  std::vector<VoxelBox> changed;
  send(field, world, codes);
  field.update({8, 0, 8}, true, changed);
  changed.clear();
  world.set_box({{3, -8, 3}, {4, -7, 4}}, kLightLamp);
  send(field, world, codes);
  field.update({8, 0, 8}, false, changed);
  REQUIRE(changed.size() == 1);
  CHECK(changed[0].min.x >= 3 - kLightReach);
  CHECK(changed[0].max.x <= 4 + kLightReach);
  CHECK(field.levels_at({3, -7, 3}) % 256 > 90);
  changed.clear();
  send(field, world, codes);
  field.update({8, 0, 8}, false, changed);
  CHECK(changed.empty());
}

TEST_CASE("chunks of another edge are ignored", "[render]") {
  const LightCodes codes = light_codes(lit_materials());
  LightField field(64, 32);
  std::vector<VoxelBox> changed;
  field.update({8, 8, 8}, true, changed);
  field.set({5, 5, 5}, 16, light_chunk(uniform_chunk(Extent::cube(16), kEmpty), codes));
  field.set({0, 0, 0}, 32, light_chunk(uniform_chunk(Extent::cube(32), kLightStone), codes));
  field.update({8, 8, 8}, true, changed);
  CHECK(bytes_of(field.levels_at({8, 8, 8}))[3] == kLightMax);
}

TEST_CASE("a light chunk has one run for materials that do the same to light", "[render]") {
  const LightCodes codes = light_codes(lit_materials());
  RunChunk chunk = uniform_chunk(Extent::cube(kLightEdge), kLightStone, AxisOrder::yxz);
  fill(chunk, 100, 40, 77);  // not in the table: opaque
  const LightChunk uniform = light_chunk(chunk, codes);
  CHECK(uniform.codes.is_uniform());
  CHECK(uniform.top(3, 4) == kLightEdge);
  fill(chunk, 0, chunk.volume(), kEmpty);
  fill(chunk, index_of({3, 9, 4}, chunk.extent, chunk.order), 1, kLightLamp);
  const LightChunk lamp = light_chunk(chunk, codes);
  CHECK(lamp.codes.runs.size() == 3);
  CHECK(lamp.top(3, 4) == 10);
  CHECK(lamp.top(4, 4) == 0);
  const LightCode code = lamp.codes.runs.material(1);
  CHECK(pass_of(code) == LightPass::opaque);
  CHECK(emission_of(code, 0) == 15);
  CHECK(emission_of(code, 2) < emission_of(code, 1));
}

TEST_CASE("levels of four bytes are dimmed and compared byte by byte", "[render]") {
  SplitMix64 rng(5);
  for (int step = 0; step < 2000; ++step) {
    std::array<std::uint32_t, 4> a{}, b{};
    LightLevels packed_a = 0, packed_b = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      a[c] = rng.below(kLightMax + 1);
      b[c] = rng.below(kLightMax + 1);
      packed_a |= a[c] << (8 * c);
      packed_b |= b[c] << (8 * c);
    }
    const std::uint32_t loss = rng.below(26);
    const auto less = bytes_of(dimmed(packed_a, loss));
    const auto more = bytes_of(brighter(packed_a, packed_b));
    for (std::size_t c = 0; c < 4; ++c) {
      REQUIRE(less[c] == std::max(static_cast<int>(a[c]) - static_cast<int>(loss), 0));
      REQUIRE(more[c] == static_cast<int>(std::max(a[c], b[c])));
    }
  }
}
