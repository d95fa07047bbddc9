#include "common/mesh/rdm/quad_splice.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <utility>

#include "common/core/hash.hpp"

namespace runstone::rdm {
namespace {

constexpr std::size_t kLayerCount = kDirectionCount * kSideMax;

/// The quads of the layers that have any, by the layer's place in QuadLayers::first.
using LayerMap = std::map<std::size_t, std::vector<Quad>>;

QuadLayers layers_of(const LayerMap& map) {
  QuadLayers out;
  for (std::size_t layer = 0; layer < kLayerCount; ++layer) {
    out.first.at(layer) = static_cast<std::uint32_t>(out.quads.size());
    const auto found = map.find(layer);
    if (found != map.end())
      out.quads.insert(out.quads.end(), found->second.begin(), found->second.end());
  }
  out.first.back() = static_cast<std::uint32_t>(out.quads.size());
  return out;
}

/// A stretch of one layer: quads [begin, end) of the layer become `quads`.
struct Replaced {
  std::size_t layer, begin, end;
  std::vector<Quad> quads;
};

/// Applies the stretches and compares with layers in which vectors are replaced one by one.
void splice_and_compare(LayerMap map, const std::vector<Replaced>& all) {
  QuadLayers layers = layers_of(map);
  QuadSplice splice;
  splice.clear();
  for (const Replaced& r : all) {
    const std::uint32_t first = layers.first.at(r.layer);
    splice.add({r.layer, first + static_cast<std::uint32_t>(r.begin),
                first + static_cast<std::uint32_t>(r.end), r.quads.data(),
                static_cast<std::uint32_t>(r.quads.size())});
  }
  splice.apply(layers);
  for (const Replaced& r : all) {
    std::vector<Quad>& quads = map[r.layer];
    const auto at = quads.erase(quads.begin() + static_cast<std::ptrdiff_t>(r.begin),
                                quads.begin() + static_cast<std::ptrdiff_t>(r.end));
    quads.insert(at, r.quads.begin(), r.quads.end());
  }
  const QuadLayers expected = layers_of(map);
  REQUIRE(layers.quads == expected.quads);
  REQUIRE(layers.first == expected.first);
}

/// Returns quads with the bits first, first + 1, ...
std::vector<Quad> numbered(std::uint64_t first, std::size_t count) {
  std::vector<Quad> quads;
  for (std::size_t i = 0; i < count; ++i) quads.push_back({first + i});
  return quads;
}

/// Returns quads in the first layer, in the last one, and in one between them.
LayerMap three_layers() {
  return {{0, numbered(100, 4)}, {200, numbered(200, 5)}, {kLayerCount - 1, numbered(300, 3)}};
}

TEST_CASE("a splice of nothing changes nothing", "[mesh]") {
  splice_and_compare({}, {});
  splice_and_compare(three_layers(), {});
  splice_and_compare(three_layers(), {{200, 2, 2, {}}});
}

TEST_CASE("a stretch becomes more quads, fewer quads or none, at each place of its layer",
          "[mesh]") {
  const LayerMap map = three_layers();
  for (const auto& [layer, quads] : map) {
    for (std::size_t begin = 0; begin <= quads.size(); ++begin) {
      for (std::size_t end = begin; end <= quads.size(); ++end) {
        for (std::size_t count = 0; count < 8; ++count) {
          CAPTURE(layer, begin, end, count);
          splice_and_compare(map, {{layer, begin, end, numbered(900, count)}});
        }
      }
    }
  }
}

TEST_CASE("empty layers get their first quads", "[mesh]") {
  splice_and_compare({}, {{0, 0, 0, numbered(900, 2)}});
  splice_and_compare({}, {{5, 0, 0, numbered(900, 2)}, {kLayerCount - 1, 0, 0, numbered(950, 1)}});
  // The layers before and behind have quads.
  splice_and_compare(three_layers(),
                     {{199, 0, 0, numbered(900, 3)}, {201, 0, 0, numbered(950, 1)}});
}

TEST_CASE("all layers become empty, and all are replaced", "[mesh]") {
  const LayerMap map = three_layers();
  splice_and_compare(map, {{0, 0, 4, {}}, {200, 0, 5, {}}, {kLayerCount - 1, 0, 3, {}}});
  splice_and_compare(map, {{0, 0, 4, numbered(900, 9)},
                           {200, 0, 5, numbered(920, 9)},
                           {kLayerCount - 1, 0, 3, numbered(940, 9)}});
}

TEST_CASE("quads between stretches move up, down, or stay", "[mesh]") {
  LayerMap map;
  for (std::size_t layer = 0; layer < 4; ++layer) map[layer] = numbered(100 * layer, 6);
  for (const auto& [a, b, c] : {std::array{9, 0, 9}, std::array{0, 9, 0}, std::array{0, 0, 9},
                                std::array{9, 9, 0}, std::array{4, 0, 0}, std::array{2, 2, 2}}) {
    const auto count = [](int n) { return static_cast<std::size_t>(n); };
    CAPTURE(a, b, c);
    // Each stretch was two quads, with quads before and behind it in its layer.
    splice_and_compare(map, {{0, 2, 4, numbered(900, count(a))},
                             {1, 1, 3, numbered(920, count(b))},
                             {3, 2, 4, numbered(940, count(c))}});
  }
}

TEST_CASE("quads in front of the first stretch keep their place in memory", "[mesh]") {
  QuadLayers layers = layers_of(three_layers());
  const Quad* const quads = layers.quads.data();
  const std::vector<Quad> fewer = numbered(900, 1);
  QuadSplice splice;
  splice.add({200, layers.first[200] + 1, layers.first[200] + 3, fewer.data(), 1});
  splice.apply(layers);
  CHECK(layers.quads.data() == quads);
  CHECK(layers.quads.size() == 11);
}

TEST_CASE("random stretches of random layers are replaced", "[mesh]") {
  SplitMix64 rng(20261202);
  for (int round = 0; round < 300; ++round) {
    LayerMap map;
    std::uint64_t number = 0;
    for (std::size_t layer = rng.below(30); layer < kLayerCount; layer += 1 + rng.below(90)) {
      map[layer] = numbered(number, rng.below(12));
      number += 100;
    }
    std::vector<Replaced> all;
    for (std::size_t layer = rng.below(30); layer < kLayerCount; layer += 1 + rng.below(60)) {
      const auto size = static_cast<std::uint32_t>(map[layer].size());
      const std::uint32_t begin = rng.below(size + 1), end = begin + rng.below(size - begin + 1);
      all.push_back({layer, begin, end, numbered(1'000'000 + number, rng.below(12))});
      number += 100;
    }
    CAPTURE(round);
    splice_and_compare(map, all);
  }
}

}  // namespace
}  // namespace runstone::rdm
