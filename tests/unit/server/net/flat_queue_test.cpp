#include "server/net/flat_queue.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <deque>
#include <memory>

#include "common/core/hash.hpp"

namespace runstone {

TEST_CASE("a flat queue does what a deque does", "[net]") {
  SplitMix64 random(7);
  FlatQueue<int> queue;
  std::deque<int> model;
  for (int step = 0; step < 20'000; ++step) {
    // Phases of growth and of shrinking, so that the queue is long, short and empty.
    const bool grows = step / 500 % 2 == 0;
    switch (random.below(8)) {
      case 0:
        queue.push_front(step);
        model.push_front(step);
        break;
      case 1:
        if (random.below(50) == 0) {
          const auto goes = [&](int item) { return item % 3 == 0; };
          queue.remove_if(goes);
          std::erase_if(model, goes);
        }
        break;
      case 2:
        if (random.below(200) == 0) {
          queue.clear();
          model.clear();
        }
        break;
      default:
        if (grows) {
          queue.push_back(step);
          model.push_back(step);
        } else if (!model.empty()) {
          queue.pop_front();
          model.pop_front();
        }
    }
    REQUIRE(queue.size() == model.size());
    REQUIRE(queue.empty() == model.empty());
    if (!model.empty()) REQUIRE(queue.front() == model.front());
    if (step % 50 == 0) REQUIRE(std::equal(queue.begin(), queue.end(), model.begin(), model.end()));
  }
}

TEST_CASE("a flat queue lets go of what was taken", "[net]") {
  FlatQueue<std::shared_ptr<int>> queue;
  const auto first = std::make_shared<int>(1), second = std::make_shared<int>(2);
  queue.push_back(first);
  queue.push_back(second);
  queue.pop_front();
  CHECK(first.use_count() == 1);
  CHECK(second.use_count() == 2);
  queue.clear();
  CHECK(second.use_count() == 1);
}

}  // namespace runstone
