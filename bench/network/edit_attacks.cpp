#include "bench/network/edit_attacks.hpp"

#include <array>
#include <cmath>
#include <memory>

#include "bench/network/attack_thread.hpp"
#include "common/core/coords.hpp"
#include "common/edits/clipboard/clipboard.hpp"
#include "tests/support/edits/hostile_edits.hpp"

namespace runstone::bench {
namespace {

constexpr std::uint8_t kWorkRadius = 4;  // chunks that an attacker sees around its edits

/// Floods edits at a place of the thread's own, far from everybody. `edit_at` returns the edit at a
/// voxel near that place.
template <class EditAt>
void flood_edits(AttackThread& thread, const EditAt& edit_at) {
  const VoxelPos home{1 << 20, 0, static_cast<std::int32_t>(thread.index() + 1) << 12};
  ClientSequence next = 0;
  const auto begin = [&](AttackClient& client) {
    next = 0;
    const std::int32_t edge = client.welcome().chunk_edge;
    client.queue(View{1, {home.x / edge, home.y / edge, home.z / edge}, kWorkRadius, kWorkRadius});
  };
  const auto edit = [&](AttackClient& client) {
    const VoxelPos at{home.x + thread.random().between(-64, 64), thread.random().between(-64, 64),
                      home.z + thread.random().between(-64, 64)};
    client.queue(EditRequest{++next, 0, edit_at(at)});
  };
  thread.flood(begin, edit, thread.flood_rate());
}

/// Returns a cube of cells in which each cell differs from the six beside it, so that every axis
/// order has a run for nearly each cell. `first` is the cell number at the corner, 1 or 2.
RunChunk checkerboard(std::uint8_t side, std::uint32_t first) {
  const Extent extent{side, side, side};
  RunChunk out{extent, AxisOrder::xyz, RunList(extent.volume())};
  const auto cell_at = [&](std::uint32_t i) {
    const std::uint32_t steps = i % side + i / side % side + i / side / side;
    return static_cast<Material>(1 + (first - 1 + steps) % 2);
  };
  for (std::uint32_t end = 1; end <= extent.volume(); ++end) {
    const Material cell = cell_at(end - 1);
    if (end == extent.volume() || cell_at(end) != cell) out.runs.push_back({end, cell});
  }
  return out;
}

}  // namespace

void edit_too_often(AttackThread& thread) {
  flood_edits(thread, [&thread](const VoxelPos& at) {
    return EditDescriptor{SetVoxel{at}, {}, static_cast<Material>(thread.random().below(2))};
  });
}

void edit_too_much(AttackThread& thread) {
  // 905,000 voxels, just below what one edit may have by default.
  constexpr std::uint16_t kRadius = 60;
  flood_edits(thread, [&thread](const VoxelPos& at) {
    const auto material = static_cast<Material>(thread.random().below(2));
    return EditDescriptor{FillSphere{at, kRadius}, {}, material};
  });
}

void paste_much(AttackThread& thread) {
  const auto clipboard = test::long_clipboard();
  flood_edits(thread, [&clipboard](const VoxelPos& at) {
    return EditDescriptor{Paste{at, clipboard, {}}, {}, kEmpty};
  });
}

void edit_widely(AttackThread& thread) {
  // Each time in other chunks.
  constexpr std::int32_t kStep = 1'024, kPlaces = 1'000;
  flood_edits(thread, [&thread](VoxelPos at) {
    at.x += kStep * thread.random().between(-kPlaces, kPlaces);
    return test::wide_box(at, 1);
  });
}

void build_tiny_chunks(AttackThread& thread) {
  // A checkerboard takes about 300 bytes on the wire and 32,000 runs in memory. Two that differ in
  // all voxels take turns, so that no paste is without effect.
  constexpr std::uint8_t kSide = 32;
  constexpr double kPastesPerSecond = 20;
  // The builders see the chunks within 2 of the spawn. They build in the middle layer.
  constexpr std::int32_t kReach = 2;
  const std::array boards = {Clipboard::of({1, 2}, checkerboard(kSide, 1)),
                             Clipboard::of({1, 2}, checkerboard(kSide, 2))};
  if (!boards[0] || !boards[1]) return;
  ClientSequence next = 0;
  const auto chunk_of_spawn = [](const Welcome& welcome) {
    const auto chunk = [&](double at) {
      return static_cast<std::int32_t>(std::floor(at / welcome.chunk_edge));
    };
    return ChunkCoord{chunk(welcome.spawn.x), chunk(welcome.spawn.y), chunk(welcome.spawn.z)};
  };
  const auto begin = [&](AttackClient& client) {
    next = 0;
    client.queue(View{1, chunk_of_spawn(client.welcome()), kWorkRadius, kWorkRadius});
  };
  const auto paste = [&](AttackClient& client) {
    SplitMix64& random = thread.random();
    ChunkCoord at = chunk_of_spawn(client.welcome());
    at.x += random.between(-kReach, kReach);
    at.y += random.between(1, kReach) * (random.below(2) == 0 ? 1 : -1);
    at.z += random.between(-kReach, kReach);
    const std::int32_t edge = client.welcome().chunk_edge;
    const VoxelPos corner{at.x * edge, at.y * edge, at.z * edge};
    client.queue(EditRequest{++next, 0, {Paste{corner, *boards[random.below(2)], {}}, {}, kEmpty}});
  };
  thread.flood(begin, paste, kPastesPerSecond);
}

}  // namespace runstone::bench
