#include "protocol/chunks/wire_palette.hpp"

#include <catch2/catch.hpp>
#include <new>
#include <vector>

namespace runstone::test {
namespace {

/// Runs of which only the first `readable` materials can be read; the next read throws.
struct RunsThatThrow {
  std::vector<Material> materials;
  std::size_t readable;
  std::size_t size() const { return materials.size(); }
  Material material(std::size_t i) const {
    if (i >= readable) throw std::bad_alloc();
    return materials[i];
  }
};

}  // namespace

TEST_CASE("a palette that an exception interrupted finds the next materials alone", "[codec]") {
  WirePalette palette;
  CHECK_THROWS_AS(palette.find(RunsThatThrow{{900, 7, 900, 3}, 3}), std::bad_alloc);
  palette.find(RunsThatThrow{{5, 1000, 5, 2}, 4});
  CHECK(palette.ids() == std::vector<Material>{2, 5, 1000});
  CHECK(palette.index_of(2) == 0);
  CHECK(palette.index_of(5) == 1);
  CHECK(palette.index_of(1000) == 2);
}

}  // namespace runstone::test
