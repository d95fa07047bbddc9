// The cases need OpenGL, off screen. If there is no context, they say so with WARN and pass.
#include "client/render/texel_store.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <vector>

#include "client/platform/egl_context.hpp"
#include "common/core/hash.hpp"

using namespace runstone;

namespace {

using MakeContext = std::unique_ptr<GlContext> (*)(std::string&);

/// Returns null if there is no such context.
std::unique_ptr<GlContext> context(MakeContext make) {
  std::string tried;
  auto out = make(tried);
  if (!out) {
    WARN("no context: " << tried);
    return nullptr;
  }
  load_gl(out->loader());
  return out;
}

/// Returns what a shader would read, a word a texel. Every driver of OpenGL ES reads integers as
/// four words.
std::vector<std::uint32_t> read(const TexelStore& store) {
  const GlFramebuffer framebuffer = GlFramebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.get());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, store.texture(), 0);
  std::vector<std::uint32_t> words(std::size_t{4} * store.capacity()), out;
  glReadPixels(0, 0, kTexelRow, static_cast<GLsizei>(store.capacity() / kTexelRow), GL_RGBA_INTEGER,
               GL_UNSIGNED_INT, words.data());
  REQUIRE(glGetError() == GL_NO_ERROR);
  out.reserve(store.capacity());
  for (std::size_t i = 0; i < words.size(); i += 4) out.push_back(words[i]);
  return out;
}

struct Range {
  std::uint32_t first = 0;
  std::vector<std::uint32_t> texels;
};

}  // namespace

TEST_CASE("a store keeps its texels while they move to a larger buffer", "[render]") {
  const auto gl =
      context(GENERATE(&make_egl_surfaceless_context, &make_egl_surfaceless_es_context));
  if (!gl) return;
  TexelStore store(TexelFormat::r32, 256);
  std::vector<Range> ranges;
  SplitMix64 rng(5);
  int moving = 0;
  for (int step = 0; step < 600; ++step) {
    const bool removes = !ranges.empty() && rng.below(3) == 0;
    if (removes) {
      const auto at = ranges.begin() + rng.below(static_cast<std::uint32_t>(ranges.size()));
      store.remove(at->first, static_cast<std::uint32_t>(at->texels.size()));
      ranges.erase(at);
    } else {
      Range range;
      range.texels.resize(1 + rng.below(rng.below(8) == 0 ? 3 * kTexelRow : 200));
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
  CHECK(store.capacity() >= 32 * kTexelRow);
  CHECK(moving > 20);  // moves are spread over many calls
}

TEST_CASE("a store grows at once for a range that does not fit", "[render]") {
  const auto gl =
      context(GENERATE(&make_egl_surfaceless_context, &make_egl_surfaceless_es_context));
  if (!gl) return;
  TexelStore store(TexelFormat::r32, 16);
  const std::vector<std::uint32_t> few(10, 1), many(10'000, 2);
  store.add(few.data(), 10);
  const std::uint32_t first = store.add(many.data(), 10'000);
  const std::vector<std::uint32_t> texels = read(store);
  CHECK(texels[0] == 1);
  CHECK(texels[first] == 2);
  CHECK(texels[first + 9'999] == 2);
}

TEST_CASE("a store that is filled once and written later does not grow", "[render]") {
  const auto gl =
      context(GENERATE(&make_egl_surfaceless_context, &make_egl_surfaceless_es_context));
  if (!gl) return;
  TexelStore store(TexelFormat::rg32, kTexelRow);
  std::vector<std::uint32_t> texels(std::size_t{2} * kTexelRow, 3);
  store.add(texels.data(), kTexelRow);
  const std::vector<std::uint32_t> other = {7, 8};
  store.write(5, other.data(), 1);
  CHECK(store.capacity() == kTexelRow);
  CHECK_FALSE(store.is_moving());
  const std::vector<std::uint32_t> read_back = read(store);
  CHECK(read_back[4] == 3);
  CHECK(read_back[5] == 7);
  CHECK(read_back[6] == 3);
}
