#include "server/map/lru_cache.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace runstone;

namespace {
std::shared_ptr<const std::string> text(const char* words) {
  return std::make_shared<const std::string>(words);
}
}  // namespace

TEST_CASE("the cache drops what was not used for longest and keeps its bound", "[map]") {
  LruCache<int, std::string> cache(10'000);
  for (int i = 0; i < 100; ++i) {
    cache.put(i, text("x"), 1'000);
    REQUIRE(cache.bytes() <= 10'000);
    REQUIRE(cache.find(0) != nullptr);  // it is used all the time
  }
  CHECK(cache.find(99) != nullptr);
  CHECK(cache.find(1) == nullptr);
  const auto held = cache.find(0);
  cache.clear();
  CHECK(cache.bytes() == 0);
  CHECK(cache.find(0) == nullptr);
  CHECK(*held == "x");  // its users share ownership
}

TEST_CASE("a value that is larger than the cache is not kept, and replaces its old form", "[map]") {
  LruCache<int, std::string> cache(10'000);
  cache.put(1, text("small"), 100);
  cache.put(1, text("new"), 200);
  CHECK(*cache.find(1) == "new");
  cache.put(1, text("huge"), 20'000);
  CHECK(cache.find(1) == nullptr);
  CHECK(cache.bytes() == 0);
}
