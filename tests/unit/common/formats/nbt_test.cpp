#include <array>
#include <catch2/catch.hpp>

#include "common/core/hash.hpp"
#include "common/formats/nbt_reader.hpp"
#include "common/formats/nbt_writer.hpp"

using namespace runstone;

namespace {

/// An outermost compound with a value of every type.
Bytes nbt_sample() {
  Bytes bytes;
  NbtWriter out(bytes);
  out.compound("top");
  out.i8("byte", -1);
  out.i16("short", -2);
  out.i32("int", 0x01020304);
  out.i64("long", -4);
  out.string("text", "caf\xc3\xa9 \xf0\x9f\x8c\xb2");
  out.array("bytes", NbtType::byte_array, 3);
  bytes.insert(bytes.end(), {1, 2, 3});
  out.int_array("ints", std::array<std::int32_t, 2>{5, -6});
  out.array("longs", NbtType::long_array, 1);
  out.i64_value(7);
  out.list("empty", NbtType::end, 0);
  out.list("numbers", NbtType::i32, 2);
  out.i32_value(8);
  out.i32_value(9);
  out.list("compounds", NbtType::compound, 2);
  out.i8("inner", 10);
  out.end();
  out.end();
  out.list("lists", NbtType::list, 1);
  bytes.insert(bytes.end(), {8, 0, 0, 0, 1});
  out.string_value("deep");
  out.compound("nested");
  out.compound("more");
  out.end();
  out.end();
  out.end();
  return bytes;
}

/// Skips every value of a compound, and returns the names of its entries.
std::vector<std::string> names_in(NbtReader& in) {
  std::vector<std::string> names;
  in.root();
  NbtEntry entry;
  while (in.next(entry)) {
    names.emplace_back(entry.name);
    in.skip(entry.type);
  }
  return names;
}

Error nbt_error(const Bytes& bytes) {
  NbtReader in(bytes);
  names_in(in);
  REQUIRE_FALSE(in.ok());
  REQUIRE(in.error().what[0] != '\0');
  return in.error();
}

/// Gives a few bytes at a time, from a new place in memory each time.
class SlowSource : public NbtSource {
 public:
  SlowSource(ByteView all, std::size_t step) : left_(all), step_(step) {}
  Result<ByteView> more(ByteView rest) override {
    Bytes next(rest.begin(), rest.end());
    const std::size_t count = std::min(step_, left_.size());
    next.insert(next.end(), left_.begin(), left_.begin() + static_cast<std::ptrdiff_t>(count));
    left_ = left_.subspan(count);
    window_ = std::move(next);
    return ByteView(window_);
  }

 private:
  ByteView left_;
  std::size_t step_;
  Bytes window_;
};

}  // namespace

TEST_CASE("values of every type of NBT are read", "[formats][nbt]") {
  const Bytes bytes = nbt_sample();
  NbtReader in(bytes);
  CHECK(in.root() == "top");
  NbtEntry entry;
  const auto is_next = [&](std::string_view name, NbtType type) {
    return in.next(entry) && entry.is(name, type);
  };
  REQUIRE(is_next("byte", NbtType::i8));
  CHECK(in.i8() == -1);
  REQUIRE(is_next("short", NbtType::i16));
  CHECK(in.integer(entry.type, "") == -2);
  REQUIRE(is_next("int", NbtType::i32));
  CHECK(in.i32() == 0x01020304);
  REQUIRE(is_next("long", NbtType::i64));
  CHECK(in.i64() == -4);
  REQUIRE(is_next("text", NbtType::string));
  CHECK(from_modified_utf8(in.string()) == "caf\xc3\xa9 \xf0\x9f\x8c\xb2");
  REQUIRE(is_next("bytes", NbtType::byte_array));
  const ByteView array = in.byte_array();
  CHECK(Bytes(array.begin(), array.end()) == Bytes{1, 2, 3});
  CHECK(array.data() >= bytes.data());  // a view, not a copy
  CHECK(array.data() < bytes.data() + bytes.size());
  REQUIRE(is_next("ints", NbtType::int_array));
  const NbtInts ints = in.int_array();
  REQUIRE(ints.size() == 2);
  CHECK(ints[0] == 5);
  CHECK(ints[1] == -6);
  REQUIRE(is_next("longs", NbtType::long_array));
  const NbtLongs longs = in.long_array();
  REQUIRE(longs.size() == 1);
  CHECK(longs[0] == 7);
  REQUIRE(is_next("empty", NbtType::list));
  CHECK(in.list().count == 0);
  REQUIRE(is_next("numbers", NbtType::list));
  const NbtList numbers = in.list();
  CHECK(numbers.type == NbtType::i32);
  REQUIRE(numbers.count == 2);
  CHECK(in.i32() == 8);
  CHECK(in.i32() == 9);
  REQUIRE(is_next("compounds", NbtType::list));
  CHECK(in.list().count == 2);
  REQUIRE(is_next("inner", NbtType::i8));
  CHECK(in.i8() == 10);
  CHECK_FALSE(in.next(entry));
  CHECK_FALSE(in.next(entry));
  REQUIRE(is_next("lists", NbtType::list));
  in.skip(entry.type);
  REQUIRE(is_next("nested", NbtType::compound));
  in.skip(entry.type);
  CHECK_FALSE(in.next(entry));
  CHECK(in.ok());
  CHECK(in.offset() == bytes.size());
}

TEST_CASE("the first bytes of NBT are those of the published format", "[formats][nbt][golden]") {
  // The example of the format's first description: a compound "hello world" with one string.
  const std::string hello(
      "\x0a\x00\x0bhello world\x08\x00\x04name\x00\x09"
      "Bananrama\x00",
      14 + 7 + 11 + 1);
  Bytes bytes;
  NbtWriter out(bytes);
  out.compound("hello world");
  out.string("name", "Bananrama");
  out.end();
  CHECK(std::string(bytes.begin(), bytes.end()) == hello);
}

TEST_CASE("every value of NBT can be skipped", "[formats][nbt]") {
  const Bytes bytes = nbt_sample();
  NbtReader in(bytes);
  CHECK(names_in(in).size() == 13);
  CHECK(in.ok());
  CHECK(in.offset() == bytes.size());
}

TEST_CASE("every truncation of NBT is rejected", "[formats][nbt]") {
  const Bytes bytes = nbt_sample();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    CAPTURE(size);
    const Error error =
        nbt_error(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)));
    CHECK(error.code == ErrorCode::truncated);
    CHECK(error.offset <= size);
  }
}

TEST_CASE("NBT of a stream reads as that in memory", "[formats][nbt]") {
  const Bytes bytes = nbt_sample();
  NbtReader whole(bytes);
  const auto expected = names_in(whole);
  for (std::size_t step = 1; step < 40; ++step) {
    SlowSource source(bytes, step);
    NbtReader in(source);
    CHECK(names_in(in) == expected);
    CHECK(in.ok());
    CHECK(in.offset() == bytes.size());
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      SlowSource cut(ByteView(bytes).first(size), step);
      NbtReader cut_in(cut);
      names_in(cut_in);
      CHECK_FALSE(cut_in.ok());
      CHECK(cut_in.error().code == ErrorCode::truncated);
    }
  }
}

TEST_CASE("counts of 2^31 in NBT are rejected before anything is allocated", "[formats][nbt]") {
  const Bytes head = {10, 0, 0};
  for (const std::uint8_t type : Bytes{7, 8, 9, 11, 12}) {
    CAPTURE(int{type});
    for (const std::uint8_t high : Bytes{0x7f, 0xff, 0x80}) {
      Bytes bytes = head;
      bytes.insert(bytes.end(), {type, 0, 0});
      if (type == 9) bytes.push_back(10);
      bytes.insert(bytes.end(), {high, 0xff, 0xff, 0xff, 0, 0});
      const Error error = nbt_error(bytes);
      CHECK((error.code == ErrorCode::truncated || error.code == ErrorCode::bad_value));
    }
  }
  // A list of values without a type, and types that do not exist.
  CHECK(nbt_error({10, 0, 0, 9, 0, 0, 0, 0, 0, 0, 1, 0}).code == ErrorCode::bad_value);
  CHECK(nbt_error({10, 0, 0, 9, 0, 0, 13, 0, 0, 0, 0, 0}).code == ErrorCode::bad_value);
  CHECK(nbt_error({10, 0, 0, 13, 0, 0, 0}).code == ErrorCode::bad_value);
  CHECK(nbt_error({9, 0, 0, 0, 0, 0, 0, 0}).code == ErrorCode::bad_value);
}

TEST_CASE("NBT is nested 512 deep at most", "[formats][nbt]") {
  const auto nested = [](std::size_t depth, bool is_list) {
    Bytes bytes = {10, 0, 0};
    bytes.insert(bytes.end(), {static_cast<std::uint8_t>(is_list ? 9 : 10), 0, 0});
    for (std::size_t i = 1; i < depth; ++i) {
      if (is_list)
        bytes.insert(bytes.end(), {9, 0, 0, 0, 1});
      else
        bytes.insert(bytes.end(), {10, 0, 0});
    }
    if (is_list)
      bytes.insert(bytes.end(), {0, 0, 0, 0, 0});
    else
      bytes.insert(bytes.end(), depth, 0);
    bytes.push_back(0);
    return bytes;
  };
  for (const bool is_list : {false, true}) {
    const Bytes deepest = nested(kNbtDepthMax, is_list);
    NbtReader in(deepest);
    CHECK(names_in(in).size() == 1);
    CHECK(in.ok());
    CHECK(nbt_error(nested(kNbtDepthMax + 1, is_list)).code == ErrorCode::limit_exceeded);
    CHECK(nbt_error(nested(1'000'000, is_list)).code == ErrorCode::limit_exceeded);
  }
}

TEST_CASE("flipped bytes of NBT never read past its end", "[formats][nbt]") {
  const Bytes bytes = nbt_sample();
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      Bytes flipped = bytes;
      flipped[i] = static_cast<std::uint8_t>(flipped[i] ^ (1 << bit));
      NbtReader in(flipped);
      names_in(in);
      CHECK(in.offset() <= bytes.size());
    }
  }
}

TEST_CASE("modified UTF-8 and UTF-8 become each other", "[formats][nbt]") {
  const std::string text("a\0\xc3\xa9\xe2\x82\xac\xf0\x9f\x8c\xb2\xf4\x8f\xbf\xbf", 15);
  const std::string modified = to_modified_utf8(text);
  CHECK(modified.size() == 15 + 1 + 2 + 2);
  CHECK(modified.find('\0') == std::string::npos);
  CHECK(from_modified_utf8(modified) == text);
  // Parts of characters stay as they are.
  for (const std::string part : {"\xed\xa0", "\xed\xa0\x80", "\xed\xa0\x80\xed\xb0", "\xf0\x9f\x8c",
                                 "\xc0", "\xff\xff\xff\xff"}) {
    CHECK(from_modified_utf8(part) == part);
    CHECK(to_modified_utf8(part) == part);
  }
}
