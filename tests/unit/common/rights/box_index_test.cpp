#include "common/rights/box_index.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

namespace runstone::test {
namespace {

std::vector<BoxIndex::Id> ids_in(const BoxIndex& index, const VoxelBox& box) {
  std::vector<BoxIndex::Id> ids;
  index.visit_overlapping(box, [&](BoxIndex::Id id) {
    ids.push_back(id);
    return true;
  });
  std::sort(ids.begin(), ids.end());
  return ids;
}

}  // namespace

TEST_CASE("an index finds boxes at their borders and not beyond", "[rights]") {
  BoxIndex index;
  CHECK(ids_in(index, {{0, 0, 0}, {1, 1, 1}}).empty());
  index.insert(7, {{0, 0, 0}, {2, 2, 2}});
  index.insert(9, {{1, -kWorldLimit, 1}, {5, kWorldLimit, 5}});
  CHECK(index.size() == 2);
  CHECK(ids_in(index, {{1, 1, 1}, {2, 2, 2}}) == std::vector<BoxIndex::Id>{7, 9});
  CHECK(ids_in(index, {{0, 0, 0}, {1, 1, 1}}) == std::vector<BoxIndex::Id>{7});
  CHECK(ids_in(index, {{2, 2, 2}, {3, 3, 3}}) == std::vector<BoxIndex::Id>{9});
  CHECK(ids_in(index, {{1, kWorldLimit - 1, 1}, {2, kWorldLimit, 2}}) ==
        std::vector<BoxIndex::Id>{9});
  CHECK(ids_in(index, {{5, 0, 1}, {6, 1, 2}}).empty());
  index.remove(7);
  CHECK(index.size() == 1);
  CHECK(ids_in(index, {{0, 0, 0}, {2, 2, 2}}) == std::vector<BoxIndex::Id>{9});
}

TEST_CASE("an index holds many equal boxes, and each of them can be removed", "[rights]") {
  constexpr BoxIndex::Id kCount = 500;
  const VoxelBox world = {{-kWorldLimit, -kWorldLimit, -kWorldLimit},
                          {kWorldLimit, kWorldLimit, kWorldLimit}};
  BoxIndex index;
  for (BoxIndex::Id id = 0; id < kCount; ++id) index.insert(id, world);
  CHECK(ids_in(index, {{3, 3, 3}, {4, 4, 4}}).size() == kCount);
  for (BoxIndex::Id id = 0; id < kCount; ++id) {
    index.remove(id);
    CHECK(index.size() == kCount - 1 - id);
    if (id % 50 == 0) {
      CHECK(ids_in(index, {{3, 3, 3}, {4, 4, 4}}).size() == index.size());
    }
  }
  index.insert(3, world);
  CHECK(ids_in(index, world) == std::vector<BoxIndex::Id>{3});
}

TEST_CASE("a visitor ends the search", "[rights]") {
  BoxIndex index;
  for (BoxIndex::Id id = 0; id < 100; ++id) index.insert(id, {{0, 0, 0}, {1, 1, 1}});
  int visited = 0;
  index.visit_overlapping({{0, 0, 0}, {1, 1, 1}}, [&](BoxIndex::Id) { return ++visited < 3; });
  CHECK(visited == 3);
}

}  // namespace runstone::test
