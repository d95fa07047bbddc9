#include "client/ui/timeline_window.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "client/render/author_rgb.hpp"
#include "client/ui/log_words.hpp"
#include "client/ui/timeline_band.hpp"
#include "client/ui/ui_context.hpp"

using namespace runstone;

namespace {

constexpr std::array<int, 2> kTimelineFrame = {1280, 720};

LogMark mark(Sequence seq, AuthorId author, EditKind kind = EditKind::set_voxel) {
  return {seq, static_cast<TimeUs>(seq) * 1'000'000, author, Cause::player, kind};
}

TimelineState some_timeline() {
  TimelineState out;
  out.newest = out.shown = 100;
  out.band = {mark(1, 7), mark(20, 7), mark(40, 9), mark(60, 9), mark(80, 7), mark(100, 7)};
  out.recent = {mark(98, 9), mark(99, 9, EditKind::paste), mark(100, 7)};
  out.authors = {{7, "ann"}, {9, "bob"}};
  return out;
}

/// A timeline window with a mouse.
struct TimelineBench {
  TimelineBench() {
    window.toggle();
    frame();
    frame();
  }
  std::optional<ShowMoment> frame(const std::vector<InputEvent>& events = {}) {
    std::optional<ShowMoment> out;
    context.feed(events);
    context.make_frame(kTimelineFrame, 0.016, [&] {
      if (const auto moment = window.build(state, 1)) out = moment;
    });
    return out;
  }
  /// Clicks every few pixels of a column of the frame. Returns the moments that were chosen.
  std::vector<ShowMoment> click_down(double x, double from, double to) {
    std::vector<ShowMoment> out;
    for (double y = from; y < to; y += 4) {
      frame({CursorEvent{x, y, 0, 0}});
      for (const bool is_pressed : {true, false}) {
        if (const auto moment = frame({ButtonEvent{MouseButton::left, is_pressed}}))
          out.push_back(*moment);
      }
    }
    return out;
  }
  TimelineWindow window;
  UiContext context;
  TimelineState state = some_timeline();
};

}  // namespace

TEST_CASE("marks of one author in a row are one segment", "[client_ui]") {
  CHECK(band_segments(some_timeline().band) ==
        std::vector<BandSegment>{{1, 20, 7}, {40, 60, 9}, {80, 100, 7}});
  CHECK(band_segments({}).empty());
}

TEST_CASE("the legend begins with the authors of most marks", "[client_ui]") {
  CHECK(band_authors(some_timeline().band, 8) == std::vector<AuthorId>{7, 9});
  CHECK(band_authors(some_timeline().band, 1) == std::vector<AuthorId>{7});
}

TEST_CASE("authors have different colours, and records have words", "[client_ui]") {
  for (AuthorId author = 0; author < 20; ++author)
    CHECK(author_colour(author) != author_colour(author + 1));
  CHECK(author_colour(0) == 0xFFA09B96);  // grey
  // One channel of a player is bright, and one is not, so that the colour has a hue.
  for (AuthorId author = 1; author < 20; ++author) {
    const auto rgb = author_rgb(author);
    CHECK(*std::max_element(rgb.begin(), rgb.end()) >= 200);
    CHECK(*std::min_element(rgb.begin(), rgb.end()) <= 95);
  }
  CHECK(record_words(EditKind::fill_sphere, Cause::player) == "sphere");
  CHECK(record_words(EditKind::paste, Cause::undo) == "undo");
  CHECK(record_words(EditKind::materials, Cause::materials) == "new materials");
  CHECK(record_words(static_cast<EditKind>(200), Cause::player) == "edit");
}

TEST_CASE("a click on the band and on a recent edit goes there", "[client_ui]") {
  TimelineBench bench;
  // The middle of the window is the middle of the band; the table is below.
  const std::vector<ShowMoment> chosen = bench.click_down(640, 40, 420);
  const auto has = [&](Sequence seq) {
    return std::ranges::any_of(chosen, [&](const ShowMoment& m) { return m.seq == seq; });
  };
  CHECK(has(50));  // the band
  CHECK(has(98));
  CHECK(has(99));
  CHECK(has(100));
  for (const ShowMoment& moment : chosen) CHECK(moment.is_live == (moment.seq == 100));
}

TEST_CASE("a timeline without marks says why", "[client_ui]") {
  TimelineBench bench;
  bench.state = {};
  bench.state.newest = 10;
  bench.state.refusal = "your role does not allow to see the past";
  CHECK_FALSE(bench.frame().has_value());
  bench.state.newest = bench.state.shown = 0;  // nobody has built yet
  CHECK_FALSE(bench.frame().has_value());
}

TEST_CASE_METHOD(TimelineBench, "a key plays the log until its end, or until the slider is moved",
                 "[client_ui]") {
  state.newest = state.shown = 10'000;
  const auto play = [this](int frames) {
    std::vector<ShowMoment> out;
    for (int i = 0; i < frames; ++i) {
      if (const auto moment = frame()) {
        out.push_back(*moment);
        state.is_past = !moment->is_live;
        state.shown = moment->seq;
      }
    }
    return out;
  };
  CHECK(play(10).empty());
  window.toggle_play();
  CHECK(window.is_playing());
  const auto first = play(50);
  REQUIRE(first.size() == 50);
  CHECK(first.front().seq < 10);  // of the whole log
  CHECK(std::is_sorted(first.begin(), first.end(),
                       [](const auto& a, const auto& b) { return a.seq < b.seq; }));
  window.toggle_play();
  play(1);
  CHECK_FALSE(window.is_playing());
  CHECK(play(10).empty());
  window.toggle_play();  // from the shown moment on
  const auto all = play(4'000);
  REQUIRE_FALSE(all.empty());
  CHECK(all.front().seq >= first.back().seq);
  CHECK(all.back().is_live);
  CHECK_FALSE(window.is_playing());
  window.toggle_play();
  play(5);
  for (const bool is_pressed : {true, false})
    frame({CursorEvent{640, 78, 0, 0}, ButtonEvent{MouseButton::left, is_pressed}});
  CHECK_FALSE(window.is_playing());
}
