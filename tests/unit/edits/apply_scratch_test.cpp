#include <catch2/catch.hpp>

#include <atomic>
#include <cstdlib>
#include <new>

#include "common/edits/edit_stack.hpp"
#include "tests/support/edit_oracle.hpp"
#include "tests/support/random_chunk.hpp"

namespace {
std::atomic<std::size_t> allocations{0};
}  // namespace

// Counts every allocation of this test program. Not inlined: g++ would see free() meet operator new and warn.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size == 0 ? 1 : size);
}
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (void* p = operator new(size, std::nothrow)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace runstone::test {

TEST_CASE("applying stacks allocates nothing once scratch, result and chunk have their size", "[edits]") {
  SplitMix64 rng{31};
  ApplyScratch scratch;
  ApplyResult result;
  const RunChunk start = random_chunk(rng, Extent::cube(32), AxisOrder::yxz, 5, Shape::columns);
  std::vector<EditDescriptor> edits(100);
  for (EditDescriptor& edit : edits) edit = random_edit_near(rng, {}, start.extent);
  const auto all = [&](RunChunk& chunk) {
    Digest digest = digest_of(chunk);
    apply_stack(chunk, digest, {}, edits, scratch, result);
    for (const EditDescriptor& edit : edits) {
      apply_stack(chunk, digest, {}, std::span(&edit, 1), scratch, result);
    }
  };
  RunChunk warm = start;
  warm.runs.reserve(start.volume());
  RunChunk measured = warm;
  measured.runs.reserve(start.volume());
  all(warm);
  const std::size_t before = allocations;
  REQUIRE(before > 0);
  all(measured);
  CHECK(allocations == before);
  CHECK(measured == warm);
}

TEST_CASE("a scratch used on other chunks before gives the same result as a fresh one", "[edits]") {
  SplitMix64 rng{32};
  ApplyScratch used;
  for (int round = 0; round < 200; ++round) {
    RunChunk chunk = random_chunk(rng);
    RunChunk same = chunk;
    std::vector<EditDescriptor> edits(1 + rng.below(10));
    for (EditDescriptor& edit : edits) edit = random_edit_near(rng, {}, chunk.extent);
    Digest digest = digest_of(chunk);
    Digest same_digest = digest;
    ApplyScratch fresh;
    apply_stack(chunk, digest, {}, edits, used);
    apply_stack(same, same_digest, {}, edits, fresh);
    REQUIRE(chunk == same);
    REQUIRE(digest == same_digest);
  }
}

}  // namespace runstone::test
