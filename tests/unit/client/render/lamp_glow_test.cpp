#include "client/render/lamp_glow.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

constexpr std::int32_t kGlowEdge = 32;
constexpr LightCode kStoneCode = light_code(LightPass::opaque, 0, 0, 0);
constexpr LightCode kLampCode = light_code(LightPass::opaque, 15, 12, 9);
constexpr LightCode kEmberCode = light_code(LightPass::opaque, 5, 1, 0);

/// Codes of a chunk that is half stone, with boxes in it.
class GlowChunk {
 public:
  GlowChunk() : codes_(uniform_chunk(Extent::cube(kGlowEdge), 0, AxisOrder::xzy)) {
    set({{0, 0, 0}, {kGlowEdge, 16, kGlowEdge}}, kStoneCode);
  }
  void set(const VoxelBox& box, LightCode code) {
    for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
      for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
        for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
          fill(codes_, index_of(local_of({x, y, z}, kGlowEdge), codes_.extent, codes_.order), 1,
               code);
        }
      }
    }
  }
  std::vector<LampGlow> glows() const { return lamp_glows(codes_); }

 private:
  RunChunk codes_;
};

}  // namespace

TEST_CASE("a lamp glows around its middle, and stone does not", "[render]") {
  GlowChunk chunk;
  CHECK(chunk.glows().empty());
  chunk.set({{5, 20, 9}, {6, 21, 10}}, kLampCode);
  const auto glows = chunk.glows();
  REQUIRE(glows.size() == 1);
  CHECK(glows[0].at == glm::vec3{5.5F, 20.5F, 9.5F});
  CHECK(glows[0].colour.r == Approx(1));
  CHECK(glows[0].colour.b < glows[0].colour.g);
}

TEST_CASE("lamps side by side glow as one, wider, and the brightest are kept", "[render]") {
  GlowChunk chunk;
  chunk.set({{4, 20, 8}, {5, 21, 9}}, kLampCode);
  const float single = chunk.glows().at(0).radius;
  chunk.set({{4, 20, 8}, {6, 22, 10}}, kLampCode);
  REQUIRE(chunk.glows().size() == 1);
  CHECK(chunk.glows()[0].radius > single);
  CHECK(chunk.glows()[0].at == glm::vec3{5, 21, 9});
  // A lake of embers has more cells than a chunk has glows.
  chunk.set({{0, 0, 0}, {kGlowEdge, 16, kGlowEdge}}, kEmberCode);
  const auto glows = chunk.glows();
  REQUIRE(glows.size() == kGlowsOfChunkMax);
  CHECK(glows[0].colour.r == Approx(1));
  CHECK(glows[1].colour.r < 0.2F);
  CHECK(glm::mod(glows[1].at, 4.0F) == glm::vec3(2));  // the middle of a full cell
}

TEST_CASE("glows are found from near to far, within the view, and only while their chunk is there",
          "[render]") {
  LampGlows all;
  all.set({0, 0, 0}, kGlowEdge, {{{1, 1, 1}, {1, 0, 0}, 2}, {{9, 1, 1}, {0, 1, 0}, 2}});
  all.set({-1, 0, 0}, kGlowEdge, {{{31, 1, 1}, {0, 0, 1}, 2}});
  std::vector<GlowInView> found;
  all.find({8, 1, 1}, 100, 10, found);
  REQUIRE(found.size() == 3);
  CHECK(found[0].at == glm::vec3{1, 0, 0});
  CHECK(found[1].colour == glm::vec3{1, 0, 0});
  CHECK(found[2].at == glm::vec3{-9, 0, 0});
  all.find({8, 1, 1}, 8, 10, found);
  CHECK(found.size() == 2);
  all.find({8, 1, 1}, 100, 1, found);
  CHECK(found.size() == 1);
  all.set({0, 0, 0}, kGlowEdge, {});
  all.find({8, 1, 1}, 100, 10, found);
  CHECK(found.size() == 1);
  all.remove({-1, 0, 0});
  all.find({8, 1, 1}, 100, 10, found);
  CHECK(found.empty());
}
