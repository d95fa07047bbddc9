// The cases need OpenGL, off screen. If there is no context, they say so with WARN and pass.
#include "client/render/texel_store.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>
#include <stdexcept>
#include <vector>

#include "client/platform/gl_context.hpp"
#include "common/core/hash.hpp"

using namespace runstone;

namespace {

/// Returns null if there is no OpenGL.
std::unique_ptr<GlContext> context() {
  try {
    auto out = make_headless_context();
    if (gladLoadGL(out->loader()) != 0) return out;
  } catch (const std::runtime_error& error) {
    WARN(error.what());
  }
  return nullptr;
}

/// Returns what a shader would read.
std::vector<std::uint32_t> read(const TexelStore& store) {
  std::vector<std::uint32_t> out(store.capacity());
  glBindTexture(GL_TEXTURE_BUFFER, store.texture());
  GLint buffer = 0;
  glGetTexLevelParameteriv(GL_TEXTURE_BUFFER, 0, GL_TEXTURE_BUFFER_DATA_STORE_BINDING, &buffer);
  glBindBuffer(GL_TEXTURE_BUFFER, static_cast<GLuint>(buffer));
  glGetBufferSubData(GL_TEXTURE_BUFFER, 0, static_cast<GLsizeiptr>(out.size() * 4), out.data());
  return out;
}

struct Range {
  std::uint32_t first = 0;
  std::vector<std::uint32_t> texels;
};

}  // namespace

TEST_CASE("a store keeps its texels while they move to a larger buffer", "[render]") {
  const auto gl = context();
  if (!gl) return;
  TexelStore store(GL_R32UI, 4, 256);
  std::vector<Range> ranges;
  SplitMix64 rng(5);
  int moving = 0;
  for (int step = 0; step < 1500; ++step) {
    const bool removes = !ranges.empty() && rng.below(3) == 0;
    if (removes) {
      const auto at = ranges.begin() + rng.below(static_cast<std::uint32_t>(ranges.size()));
      store.remove(at->first, static_cast<std::uint32_t>(at->texels.size()));
      ranges.erase(at);
    } else {
      Range range;
      range.texels.resize(1 + rng.below(20));
      for (std::uint32_t& texel : range.texels) texel = rng.below(1'000'000);
      range.first = store.add(range.texels.data(), static_cast<std::uint32_t>(range.texels.size()));
      ranges.push_back(std::move(range));
    }
    if (!ranges.empty() && rng.below(4) == 0) {  // overwrite one, also during a move
      Range& range = ranges[rng.below(static_cast<std::uint32_t>(ranges.size()))];
      range.texels.back() = rng.below(1'000'000);
      store.write(range.first, range.texels.data(),
                  static_cast<std::uint32_t>(range.texels.size()));
    }
    moving += store.is_moving() ? 1 : 0;
    if (step % 10 != 0) continue;
    const std::vector<std::uint32_t> texels = read(store);
    for (const Range& range : ranges) {
      CAPTURE(step, range.first);
      REQUIRE(std::equal(range.texels.begin(), range.texels.end(), texels.begin() + range.first));
    }
  }
  CHECK(store.capacity() >= 2048);
  CHECK(moving > 20);  // moves are spread over many calls
}

TEST_CASE("a store grows at once for a range that does not fit", "[render]") {
  const auto gl = context();
  if (!gl) return;
  TexelStore store(GL_R32UI, 4, 16);
  const std::vector<std::uint32_t> few(10, 1), many(1000, 2);
  store.add(few.data(), 10);
  const std::uint32_t first = store.add(many.data(), 1000);
  const std::vector<std::uint32_t> texels = read(store);
  CHECK(texels[0] == 1);
  CHECK(texels[first] == 2);
  CHECK(texels[first + 999] == 2);
}

TEST_CASE("a store that is filled once and written later does not grow", "[render]") {
  const auto gl = context();
  if (!gl) return;
  TexelStore store(GL_RG32UI, 8, 64);
  const std::vector<std::uint32_t> texels(128, 3);
  store.add(texels.data(), 64);
  store.write(5, texels.data(), 1);
  CHECK(store.capacity() == 64);
  CHECK_FALSE(store.is_moving());
}
