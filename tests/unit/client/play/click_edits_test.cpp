#include "client/play/click_edits.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {
constexpr TimeUs kDelay = HeldButton::kDelayUs, kRepeat = HeldButton::kRepeatUs;
}

TEST_CASE("a held button acts at the press and then at a steady pace", "[client_app]") {
  HeldButton button;
  int acts = button.acts(1, true, 0);
  for (TimeUs now = 1'000; now < kDelay + 2 * kRepeat + 1'000; now += 1'000) {
    acts += button.acts(0, true, now);
    if (now < kDelay) CHECK(acts == 1);
  }
  CHECK(acts == 4);
  CHECK(button.acts(0, false, kDelay + 9 * kRepeat) == 0);
}

TEST_CASE("presses between two calls all count, and a late call repeats once", "[client_app]") {
  HeldButton button;
  CHECK(button.acts(3, true, 0) == 3);
  CHECK(button.acts(0, true, 10 * kDelay) == 1);
  CHECK(button.acts(0, true, 10 * kDelay + kRepeat - 1) == 0);
  CHECK(button.acts(2, true, 10 * kDelay + kRepeat) == 2);
  CHECK(button.acts(0, true, 10 * kDelay + 2 * kRepeat) == 0);  // a press begins the delay again
}

TEST_CASE("a button that is held without a press that counts does not act", "[client_app]") {
  HeldButton button;
  CHECK(button.acts(0, true, 0) == 0);
  CHECK(button.acts(0, true, 10 * kDelay) == 0);
  CHECK(button.acts(1, true, 11 * kDelay) == 1);
  CHECK(button.acts(0, false, 12 * kDelay) == 0);
  CHECK(button.acts(0, true, 13 * kDelay) == 0);
}
