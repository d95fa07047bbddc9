#include "client/cache/texture_cache.hpp"

#include <catch2/catch.hpp>
#include <fstream>

#include "client/cache/cache_thread.hpp"
#include "tests/support/core/temp_folder.hpp"

namespace runstone::test {
namespace {

constexpr std::size_t kPngBytes = 500;
constexpr std::uint64_t kRowBytes = kPngBytes + CacheDatabase::kRowOverheadBytes;

TexturePart part_of(std::uint8_t number) {
  TexturePart out;
  out.hash = {number};
  out.png.assign(kPngBytes, number);
  return out;
}

std::vector<TexturePart> parts_of(std::uint8_t first, std::uint8_t count) {
  std::vector<TexturePart> out;
  for (std::uint8_t i = 0; i < count; ++i)
    out.push_back(part_of(static_cast<std::uint8_t>(first + i)));
  return out;
}

std::vector<TextureHash> hashes_of(std::uint8_t first, std::uint8_t count) {
  std::vector<TextureHash> out;
  for (const TexturePart& part : parts_of(first, count)) out.push_back(part.hash);
  return out;
}

}  // namespace

TEST_CASE("pictures are found as they were stored, also in another run", "[cache][textures]") {
  const TempFolder folder;
  {
    TextureCache cache(folder.path());
    cache.keep(parts_of(1, 50));
    CHECK(cache.find(hashes_of(40, 20)) == parts_of(40, 11));
    CHECK(cache.bytes() == 50 * kRowBytes);
  }
  TextureCache cache(folder.path());
  CHECK(cache.find(hashes_of(1, 60)) == parts_of(1, 50));
  CHECK(cache.bytes() == 50 * kRowBytes);
  // A picture that is stored again replaces a row that may be damaged.
  TexturePart other = part_of(7);
  other.png[3] ^= 1;
  cache.keep(std::vector{other});
  CHECK(cache.find(hashes_of(7, 1)) == std::vector{other});
  CHECK(cache.take_warning().empty());
}

TEST_CASE("pictures that were unused for longest are evicted", "[cache][textures]") {
  const TempFolder folder;
  TextureCache cache(folder.path(), 20 * kRowBytes);
  cache.keep(parts_of(1, 10));
  cache.keep(parts_of(11, 10));
  CHECK(cache.bytes() == 20 * kRowBytes);
  CHECK(cache.find(hashes_of(1, 5)).size() == 5);  // they are used again
  cache.keep(parts_of(21, 5));
  CHECK(cache.bytes() == 20 * kRowBytes);
  CHECK(cache.find(hashes_of(1, 5)).size() == 5);
  CHECK(cache.find(hashes_of(6, 5)).empty());
  CHECK(cache.find(hashes_of(11, 15)).size() == 15);
}

TEST_CASE("a cache of textures with a lower bound than before is made smaller when it opens",
          "[cache][textures]") {
  const TempFolder folder;
  TextureCache(folder.path()).keep(parts_of(1, 20));
  TextureCache cache(folder.path(), 5 * kRowBytes);
  CHECK(cache.bytes() == 5 * kRowBytes);
  CHECK(cache.find(hashes_of(1, 20)).size() == 5);
}

TEST_CASE("a database of textures with another layout is replaced", "[cache][textures]") {
  const TempFolder folder;
  {
    CacheDatabase other(folder.path() + "/textures.sqlite",
                        "CREATE TABLE texture (hash BLOB NOT NULL);", 99);
    REQUIRE(other.ok());
  }
  TextureCache cache(folder.path());
  CHECK(cache.take_warning().empty());
  cache.keep(parts_of(1, 3));
  CHECK(cache.find(hashes_of(1, 3)) == parts_of(1, 3));
}

TEST_CASE("a database of textures that is none is replaced", "[cache][textures]") {
  const TempFolder folder;
  std::ofstream(folder.path() + "/textures.sqlite") << std::string(10'000, 'x');
  TextureCache cache(folder.path());
  CHECK(cache.take_warning().find("a new one is begun") != std::string::npos);
  cache.keep(parts_of(1, 3));
  CHECK(cache.find(hashes_of(1, 3)) == parts_of(1, 3));
}

TEST_CASE("a folder without a place for textures ends their cache, not the client",
          "[cache][textures]") {
  const TempFolder folder;
  TextureCache cache(folder.path() + "/none");
  CHECK_FALSE(cache.take_warning().empty());
  cache.keep(parts_of(1, 3));
  CHECK(cache.find(hashes_of(1, 3)).empty());
}

TEST_CASE("the cache thread answers each lookup of textures in order", "[cache][textures]") {
  const TempFolder folder;
  auto chunks = ChunkCache::open(folder.path(), 1 << 20);
  REQUIRE(chunks.has_value());
  {
    CacheThread thread(*std::move(chunks), std::make_unique<TextureCache>(folder.path()), [] {});
    thread.keep_textures(parts_of(1, 20));
    thread.stop();
  }
  auto again = ChunkCache::open(folder.path(), 1 << 20);
  REQUIRE(again.has_value());
  CacheThread thread(*std::move(again), std::make_unique<TextureCache>(folder.path()), [] {});
  thread.look_up_textures(hashes_of(1, 10));
  thread.look_up_textures(hashes_of(15, 10));
  thread.stop();
  const auto results = thread.drain_textures();
  REQUIRE(results.size() == 2);
  CHECK(results[0] == parts_of(1, 10));
  CHECK(results[1] == parts_of(15, 6));
  CHECK(thread.drain_textures().empty());
}

}  // namespace runstone::test
