#include "tests/reference/t_junctions.hpp"

#include <cstdint>
#include <numeric>
#include <vector>

#include "common/runs/extent.hpp"
#include "tests/reference/each_polygon.hpp"

namespace runstone::reference {
namespace {

/// A bit for each point of the voxel lattice.
class LatticeBits {
 public:
  void set(std::size_t at) { words_[at / 64] |= std::uint64_t{1} << at % 64; }
  bool test(std::size_t at) const { return (words_[at / 64] >> at % 64 & 1) != 0; }

  static constexpr std::size_t kSide = kSideMax + 1;
  static std::size_t at(const Corner& p) {
    return static_cast<std::size_t>(p[0]) +
           kSide * (static_cast<std::size_t>(p[1]) + kSide * static_cast<std::size_t>(p[2]));
  }

 private:
  std::vector<std::uint64_t> words_ = std::vector<std::uint64_t>(kSide * kSide * kSide / 64 + 1);
};

/// Calls visit(place) for the lattice points between the ends of an edge.
template <class F>
void each_inner_point(const Corner& from, const Corner& to, F&& visit) {
  const Corner way = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
  const int count = std::gcd(std::gcd(way[0], way[1]), way[2]);
  for (int i = 1; i < count; ++i) {
    visit(LatticeBits::at({from[0] + way[0] / count * i, from[1] + way[1] / count * i,
                           from[2] + way[2] / count * i}));
  }
}

}  // namespace

TJunctions count_t_junctions(const Surface& surface) {
  LatticeBits vertices, counted;
  each_polygon(surface, [&](std::span<const Corner> corners) {
    for (const Corner& corner : corners) vertices.set(LatticeBits::at(corner));
  });
  TJunctions out;
  each_polygon(surface, [&](std::span<const Corner> corners) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      each_inner_point(corners[i], corners[(i + 1) % corners.size()], [&](std::size_t place) {
        if (!vertices.test(place)) return;
        ++out.edges;
        if (counted.test(place)) return;
        ++out.places;
        counted.set(place);
      });
    }
  });
  return out;
}

}  // namespace runstone::reference
