#include "common/formats/deflate.hpp"

#include <catch2/catch.hpp>

#include "common/core/hash.hpp"

using namespace runstone;

namespace {

constexpr DeflateForm kForms[] = {DeflateForm::zlib, DeflateForm::gzip, DeflateForm::raw};

Bytes deflate_sample(std::size_t size) {
  SplitMix64 random(size);
  Bytes out(size);
  for (auto& byte : out) byte = static_cast<std::uint8_t>(random.below(7));
  return out;
}

}  // namespace

TEST_CASE("deflated bytes inflate to what they were", "[formats]") {
  for (const DeflateForm form : kForms) {
    for (const std::size_t size : {0u, 1u, 16'384u, 16'385u, 300'000u}) {
      const Bytes plain = deflate_sample(size);
      Bytes packed = {9, 9, 9};  // the stream begins behind other bytes
      const Bytes stream = deflate_all(plain, form);
      packed.insert(packed.end(), stream.begin(), stream.end());
      packed.insert(packed.end(), {1, 2, 3, 4});  // and ends before others
      Bytes out = {5};
      const auto end = inflate_all(packed, 3, form, size, &out);
      REQUIRE(end.has_value());
      CHECK(*end == 3 + stream.size());
      CHECK(out[0] == 5);
      CHECK(Bytes(out.begin() + 1, out.end()) == plain);
      CHECK(inflate_all(packed, 3, form, SIZE_MAX, nullptr).has_value());
      if (form != DeflateForm::raw)
        CHECK(inflate_all(packed, 3, DeflateForm::zlib_or_gzip, size, nullptr).has_value());
      CHECK(deflate_all(plain, form) == stream);
    }
  }
}

TEST_CASE("a stream that inflates to more than the bound is rejected", "[formats]") {
  const Bytes bomb = deflate_all(Bytes(50'000'000), DeflateForm::gzip, 9);
  CHECK(bomb.size() < 60'000);
  Bytes out;
  const auto end = inflate_all(bomb, 0, DeflateForm::gzip, 1'000'000, &out);
  REQUIRE_FALSE(end.has_value());
  CHECK(end.error().code == ErrorCode::limit_exceeded);
  CHECK(out.size() <= 1'000'000);
  CHECK(out.capacity() < 4'000'000);
  CHECK(inflate_all(bomb, 0, DeflateForm::gzip, 49'999'999, nullptr).error().code ==
        ErrorCode::limit_exceeded);
  CHECK(inflate_all(bomb, 0, DeflateForm::gzip, 50'000'000, nullptr).has_value());
  CHECK_FALSE(inflate_all(bomb, 0, DeflateForm::gzip, 0, nullptr).has_value());
}

TEST_CASE("every truncation of a deflate stream is rejected", "[formats]") {
  for (const DeflateForm form : kForms) {
    const Bytes packed = deflate_all(deflate_sample(3000), form);
    for (std::size_t size = 0; size < packed.size(); ++size) {
      const auto end = inflate_all(ByteView(packed).first(size), 0, form, 3000, nullptr);
      REQUIRE_FALSE(end.has_value());
      CHECK(end.error().code == ErrorCode::truncated);
      CHECK(end.error().offset <= size);
    }
  }
}

TEST_CASE("flipped bits of a deflate stream are found by its checksum", "[formats]") {
  const Bytes plain = deflate_sample(200);
  const Bytes packed = deflate_all(plain, DeflateForm::zlib);
  for (std::size_t i = 0; i < packed.size() * 8; ++i) {
    Bytes flipped = packed;
    flipped[i / 8] = static_cast<std::uint8_t>(flipped[i / 8] ^ (1u << i % 8));
    Bytes out;
    const auto end = inflate_all(flipped, 0, DeflateForm::zlib, 200, &out);
    if (end) CHECK(out == plain);
  }
}

TEST_CASE("a stream is read piece by piece", "[formats]") {
  const Bytes plain = deflate_sample(10'000);
  Bytes packed;
  Deflater deflater(DeflateForm::gzip, 1, packed);
  for (std::size_t at = 0; at < plain.size(); at += 100)
    deflater.write(ByteView(plain).subspan(at, 100));
  deflater.finish();
  Inflater in(packed, DeflateForm::zlib_or_gzip);
  Bytes out(plain.size());
  for (std::size_t at = 0; at < plain.size(); at += 1000)
    REQUIRE(*in.read(std::span(out).subspan(at, 1000)) == 1000);
  CHECK(out == plain);
  Bytes more(1);
  CHECK(*in.read(more) == 0);
  CHECK(in.at_end());
  CHECK(in.packed_offset() == packed.size());
}
