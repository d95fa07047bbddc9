#include <catch2/catch.hpp>
#include <new>

#include "common/core/thread_scratch.hpp"

namespace runstone::c_interface {
namespace {

struct CountingScratch {
  int uses = 0;
};

}  // namespace

TEST_CASE("a scratch is kept between calls and dropped after an exception", "[c_interface]") {
  const auto use = [](CountingScratch& scratch) { return ++scratch.uses; };
  const auto fail_half_way = [](CountingScratch& scratch) {
    scratch.uses = 100;
    throw std::bad_alloc();
  };
  CHECK(with_scratch<CountingScratch>(use) == 1);
  CHECK(with_scratch<CountingScratch>(use) == 2);
  CHECK_THROWS_AS(with_scratch<CountingScratch>(fail_half_way), std::bad_alloc);
  CHECK(with_scratch<CountingScratch>(use) == 1);
}

}  // namespace runstone::c_interface
