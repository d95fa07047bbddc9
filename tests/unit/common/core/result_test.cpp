#include "common/core/result.hpp"

#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <type_traits>

using namespace runstone;

namespace {

Result<int> half(int v) {
  if (v % 2 != 0) return fail(ErrorCode::bad_value, "odd", 7);
  return v / 2;
}

Result<void> even(int v) {
  if (v % 2 != 0) return fail(ErrorCode::not_canonical, "odd");
  return {};
}

}  // namespace

TEST_CASE("a result holds its value", "[core][result]") {
  const Result<int> r = half(8);
  REQUIRE(r.has_value());
  CHECK(static_cast<bool>(r));
  CHECK(r.value() == 4);
  CHECK(*r == 4);
}

TEST_CASE("a result holds its error with code, text and offset", "[core][result]") {
  const Result<int> r = half(3);
  REQUIRE_FALSE(r.has_value());
  CHECK_FALSE(static_cast<bool>(r));
  CHECK(r.error().code == ErrorCode::bad_value);
  CHECK(std::string(r.error().what) == "odd");
  CHECK(r.error().offset == 7);
}

TEST_CASE("the type of a failure follows from what has failed", "[core][result]") {
  struct Place {
    std::string file;
    int line = 0;
  };
  const Place place{"world.toml", 3};
  const Result<int, Place> copied = failure(place);
  CHECK(copied.error().line == 3);
  const Result<void, Place> moved = failure(Place{"world.toml", 4});
  CHECK(moved.error().file == "world.toml");
  const Result<int> passed_on = failure(half(3).error());
  CHECK(passed_on.error().offset == 7);
  // Text is kept as a line, because nobody keeps the characters that a pointer leads to.
  static_assert(std::is_same_v<decltype(failure("a line")), Unexpected<std::string>>);
  const Result<void, std::string> line = failure("a line");
  CHECK(line.error() == "a line");
}

TEST_CASE("an error that cannot be copied is moved into a result", "[core][result]") {
  auto number = std::make_unique<int>(6);
  const Result<int, std::unique_ptr<int>> held = failure(std::move(number));
  CHECK(*held.error() == 6);
}

TEST_CASE("a result without a value holds success or an error", "[core][result]") {
  CHECK(even(2).has_value());
  REQUIRE_FALSE(even(1).has_value());
  CHECK(even(1).error().code == ErrorCode::not_canonical);
}

TEST_CASE("a result moves its value out", "[core][result]") {
  Result<std::unique_ptr<int>> r = std::make_unique<int>(5);
  const std::unique_ptr<int> out = std::move(r).value();
  REQUIRE(out != nullptr);
  CHECK(*out == 5);
}

TEST_CASE("members of a result's value are reached by arrow and changed in place",
          "[core][result]") {
  Result<std::string> r = std::string("run");
  r->push_back('s');
  CHECK(r->size() == 4);
  CHECK(*r == "runs");
}

TEST_CASE("errors compare by code and offset, not by text", "[core][result]") {
  CHECK(Error{ErrorCode::truncated, "a", 3} == Error{ErrorCode::truncated, "b", 3});
  CHECK_FALSE(Error{ErrorCode::truncated, "a", 3} == Error{ErrorCode::truncated, "a", 4});
  CHECK_FALSE(Error{ErrorCode::truncated, "a", 3} == Error{ErrorCode::bad_value, "a", 3});
}
