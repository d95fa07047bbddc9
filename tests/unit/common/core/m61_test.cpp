#include "common/core/m61.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "common/core/hash.hpp"

using namespace runstone;

namespace {

__extension__ using Wide = unsigned __int128;
constexpr Wide kP = (Wide{1} << 61) - 1;

std::vector<std::uint64_t> residues() {
  std::vector<std::uint64_t> out = {0,
                                    1,
                                    2,
                                    3,
                                    1ULL << 31,
                                    1ULL << 32,
                                    1ULL << 60,
                                    m61::kPrime / 2,
                                    m61::kPrime - 2,
                                    m61::kPrime - 1};
  SplitMix64 rng(61);
  for (int i = 0; i < 150; ++i) out.push_back(rng.next() % m61::kPrime);
  return out;
}

}  // namespace

TEST_CASE("sums, differences and products agree with 128-bit remainders", "[core][m61]") {
  for (const std::uint64_t a : residues()) {
    for (const std::uint64_t b : residues()) {
      CAPTURE(a, b);
      REQUIRE(m61::add(a, b) == static_cast<std::uint64_t>((Wide{a} + b) % kP));
      REQUIRE(m61::sub(a, b) == static_cast<std::uint64_t>((Wide{a} + kP - b) % kP));
      REQUIRE(m61::mul(a, b) == static_cast<std::uint64_t>(Wide{a} * b % kP));
    }
  }
}

TEST_CASE("any word reduces to its remainder", "[core][m61]") {
  for (const std::uint64_t v : {std::uint64_t{0}, m61::kPrime - 1, m61::kPrime, m61::kPrime + 1,
                                2 * m61::kPrime, 7 * m61::kPrime, ~std::uint64_t{0}}) {
    CHECK(m61::reduce(v) == v % m61::kPrime);
  }
  SplitMix64 rng(62);
  for (int i = 0; i < 10000; ++i) {
    const std::uint64_t v = rng.next();
    REQUIRE(m61::reduce(v) == v % m61::kPrime);
  }
}
