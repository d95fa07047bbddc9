#include "common/rights/box_index.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>

#include "tests/support/rights/random_rights.hpp"

namespace runstone::test {
namespace {

constexpr VoxelBox kEverything = {{-kWorldLimit, -kWorldLimit, -kWorldLimit},
                                  {kWorldLimit, kWorldLimit, kWorldLimit}};

/// Small boxes, nested ones, whole columns, and boxes at the borders of the world.
VoxelBox random_indexed_box(SplitMix64& rng) {
  const VoxelBox town = {{-300, -20, -300}, {300, 60, 300}};
  VoxelBox box = random_box_in(rng, town, rng.below(8) == 0 ? 400 : 20);
  switch (rng.below(6)) {
    case 0:
      box.min.y = -kWorldLimit;
      box.max.y = kWorldLimit;
      break;
    case 1:
      return random_box_in(rng, kEverything, std::int32_t{1} << rng.between(0, 30));
    default:
      break;
  }
  return box;
}

std::vector<BoxIndex::Id> linear_search(const std::map<BoxIndex::Id, VoxelBox>& boxes,
                                        const VoxelBox& box) {
  std::vector<BoxIndex::Id> ids;
  for (const auto& [id, other] : boxes) {
    if (!intersect(box, other).empty()) ids.push_back(id);
  }
  return ids;
}

std::vector<BoxIndex::Id> indexed_search(const BoxIndex& index, const VoxelBox& box) {
  std::vector<BoxIndex::Id> ids;
  index.visit_overlapping(box, [&](BoxIndex::Id id) {
    ids.push_back(id);
    return true;
  });
  std::sort(ids.begin(), ids.end());
  return ids;
}

}  // namespace

TEST_CASE("an index of boxes finds what a linear search finds", "[rights][property]") {
  SplitMix64 rng{61 + Catch::rngSeed()};
  std::size_t found = 0;
  for (int round = 0; round < 12; ++round) {
    BoxIndex index;
    std::map<BoxIndex::Id, VoxelBox> boxes;
    // Some rounds grow, the others shrink again and again.
    const std::uint32_t inserts_of_ten = round % 3 == 0 ? 10 : 4 + rng.below(4);
    for (int step = 0; step < 1500; ++step) {
      CAPTURE(Catch::rngSeed(), round, step);
      const bool shrinks = round % 3 != 0 && step / 300 % 2 == 1;
      if (!boxes.empty() && (rng.below(10) >= inserts_of_ten || (shrinks && rng.below(2) == 0))) {
        auto at = boxes.lower_bound(rng.below(2000));
        if (at == boxes.end()) at = boxes.begin();
        index.remove(at->first);
        boxes.erase(at);
      } else if (const BoxIndex::Id id = rng.below(2000); !boxes.contains(id)) {
        boxes[id] = random_indexed_box(rng);
        index.insert(id, boxes[id]);
      }
      REQUIRE(index.size() == boxes.size());
      const VoxelBox wanted = rng.below(4) == 0
                                  ? random_indexed_box(rng)
                                  : random_box_in(rng, {{-300, -20, -300}, {300, 60, 300}}, 1);
      const auto ids = linear_search(boxes, wanted);
      REQUIRE(indexed_search(index, wanted) == ids);
      found += ids.size();
    }
  }
  CHECK(found > 10'000);
}

}  // namespace runstone::test
