#include "common/core/result.hpp"

#include <catch2/catch.hpp>
#include <memory>
#include <string>

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
