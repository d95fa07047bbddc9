#include "common/runs/run_list.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "common/core/hash.hpp"

using namespace runstone;

namespace {

const std::uint32_t kVolumes[] = {kNarrowVolumeMax, kNarrowVolumeMax + 1};

std::vector<Run> all(const RunList& list) {
  std::vector<Run> out;
  for (std::size_t i = 0; i < list.size(); ++i) out.push_back(list[i]);
  return out;
}

RunList list_of(std::uint32_t volume, const std::vector<Run>& runs) {
  RunList list(volume);
  for (const Run& run : runs) list.push_back(run);
  return list;
}

}  // namespace

TEST_CASE("the volume decides the form: 4 bytes a run up to 65,535, 6 beyond", "[runs][run_list]") {
  CHECK(RunList(0).is_narrow());
  RunList narrow(kNarrowVolumeMax);
  RunList wide(kNarrowVolumeMax + 1);
  CHECK(narrow.is_narrow());
  CHECK_FALSE(wide.is_narrow());
  narrow.push_back({kNarrowVolumeMax, 7});
  wide.push_back({kNarrowVolumeMax + 1, 7});
  CHECK(narrow[0] == Run{65535, 7});
  CHECK(wide[0] == Run{65536, 7});
  CHECK(narrow.byte_size() == 4);
  CHECK(wide.byte_size() == 6);
}

TEST_CASE("runs are read back singly and through the view of their form", "[runs][run_list]") {
  for (const std::uint32_t volume : kVolumes) {
    const std::vector<Run> runs = {{3, 1}, {10, 65535}, {volume, 0}};
    const RunList list = list_of(volume, runs);
    CHECK(all(list) == runs);
    CHECK(list.begin(0) == 0);
    CHECK(list.begin(2) == 10);
    list.visit([&](const auto& view) {
      REQUIRE(view.size() == runs.size());
      for (std::size_t i = 0; i < runs.size(); ++i) {
        CHECK(view.end(i) == runs[i].end);
        CHECK(view.material(i) == runs[i].material);
      }
    });
  }
}

TEST_CASE("splices equal those of a plain vector", "[runs][run_list]") {
  SplitMix64 rng(1);
  for (const std::uint32_t volume : kVolumes) {
    std::vector<Run> model;
    for (int step = 0; step < 3000; ++step) {
      RunList list = list_of(volume, model);
      const std::size_t first = rng.below(static_cast<std::uint32_t>(model.size()) + 1);
      const std::size_t most = model.size() - first;
      const std::size_t count =
          rng.below(static_cast<std::uint32_t>(std::min<std::size_t>(most, 6)) + 1);
      std::vector<Run> with(rng.below(model.size() > 40 ? 3 : 6));
      for (Run& run : with) run = {rng.below(volume + 1), static_cast<Material>(rng.below(65536))};
      list.splice(first, count, with);
      const auto at = model.erase(model.begin() + static_cast<std::ptrdiff_t>(first),
                                  model.begin() + static_cast<std::ptrdiff_t>(first + count));
      model.insert(at, with.begin(), with.end());
      CAPTURE(step, first, count, with.size());
      REQUIRE(all(list) == model);
    }
  }
}

TEST_CASE("lists compare by form and runs, not by capacity", "[runs][run_list]") {
  for (const std::uint32_t volume : kVolumes) {
    RunList a = list_of(volume, {{3, 1}, {volume, 0}});
    RunList b = list_of(volume, {{3, 1}, {volume, 0}});
    b.reserve(100);
    CHECK(a == b);
    CHECK(b.byte_capacity() >= 100 * (b.is_narrow() ? 4 : 6));
    b.shrink_to_fit();
    CHECK(b.byte_capacity() == b.byte_size());
    b.splice(0, 1, {});
    CHECK_FALSE(a == b);
    b.clear();
    CHECK(b.size() == 0);
    CHECK(b.is_narrow() == a.is_narrow());
  }
  CHECK_FALSE(RunList(1) == RunList(70000));
}
