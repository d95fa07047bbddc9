#include "client/ui/library_window.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>

#include "client/ui/ui_context.hpp"

using namespace runstone;

namespace {

constexpr std::array<int, 2> kLibraryFrame = {1280, 720};

struct LibraryWindowBench {
  LibraryWindowBench() {
    for (Sequence number = 20; number > 16; --number) {
      ListedBuild build;
      build.number = number;
      build.info.name = "%s%n##mill " + std::to_string(number);
      build.info.author = "ana";
      build.info.tags = {"farm", "wood"};
      build.info.sides = {12, 8, 9};
      build.touched = 700;
      build.file_bytes = number == 17 ? 5'000'000 : 4'000;
      build.added_by = 3;
      build.added_by_name = "ana";
      builds.push_back(build);
    }
    state.builds = &builds;
    state.total = 4;
    state.clipboard = "3 x 2 x 2 voxels, 1.0 KB";
    window.toggle();
    frame();
    frame();
  }
  std::optional<LibraryOrder> frame(const std::vector<InputEvent>& events = {}) {
    std::optional<LibraryOrder> out;
    context.feed(events);
    made = context.make_frame(kLibraryFrame, 0.016, [&] {
      if (auto order = window.build(state, context)) out = std::move(order);
    });
    return out;
  }
  std::optional<LibraryOrder> click(double x, double y) {
    std::optional<LibraryOrder> out;
    frame({CursorEvent{x, y, 0, 0}});
    for (const bool is_pressed : {true, false}) {
      if (auto order = frame({ButtonEvent{MouseButton::left, is_pressed}})) out = std::move(order);
    }
    return out;
  }
  /// Clicks on a grid of places below the list, or of the list. Returns the orders.
  std::vector<LibraryOrder> click_all(double top, double bottom) {
    std::vector<LibraryOrder> out;
    for (double y = top; y < bottom; y += 6) {
      for (double x = 20; x < 610; x += 12) {
        if (auto order = click(x, y)) out.push_back(*std::move(order));
      }
    }
    return out;
  }
  template <class T>
  static bool has(const std::vector<LibraryOrder>& orders) {
    return std::ranges::any_of(
        orders, [](const LibraryOrder& order) { return std::holds_alternative<T>(order); });
  }
  /// Clicks downward in the list until this build is selected. Returns the last order.
  std::optional<LibraryOrder> select(Sequence number) {
    for (double y = 140; y < 330; y += 4) {
      const auto order = click(40, y);
      if (window.selected() == number) return order;
    }
    return std::nullopt;
  }
  LibraryWindow window;
  UiContext context;
  std::vector<ListedBuild> builds;
  LibraryState state;
  std::shared_ptr<const OverlayFrame> made;
};

constexpr double kBelowList = 345, kWindowEnd = 640;

}  // namespace

TEST_CASE("a small build is shown when it is selected, a large one by a button", "[client_ui]") {
  LibraryWindowBench bench;
  auto order = bench.select(20);
  REQUIRE(bench.window.selected() == 20);
  REQUIRE(order.has_value());
  REQUIRE(std::holds_alternative<ShowBuild>(*order));
  CHECK(std::get<ShowBuild>(*order).number == 20);
  order = bench.select(17);
  CHECK(bench.window.selected() == 17);
  CHECK_FALSE(order.has_value());
  CHECK(bench.has<ShowBuild>(bench.click_all(kBelowList, kWindowEnd)));
}

TEST_CASE("a selected build is taken, and only its player may remove it", "[client_ui]") {
  LibraryWindowBench bench;
  bench.select(18);
  auto orders = bench.click_all(kBelowList, kWindowEnd);
  CHECK(bench.has<TakeBuild>(orders));
  CHECK_FALSE(bench.has<DropBuild>(orders));
  CHECK(bench.has<AddClipboard>(orders));
  bench.state.me = 3;
  CHECK(bench.has<DropBuild>(bench.click_all(kBelowList, kWindowEnd)));
  bench.state.me = 4;
  CHECK_FALSE(bench.has<DropBuild>(bench.click_all(kBelowList, kWindowEnd)));
  bench.state.removes_all = true;
  CHECK(bench.has<DropBuild>(bench.click_all(kBelowList, kWindowEnd)));
}

TEST_CASE("while a build is taken, or one is added, it can only be stopped", "[client_ui]") {
  LibraryWindowBench bench;
  bench.select(18);
  bench.state.fetching = 18;
  bench.state.is_taking = bench.state.is_adding = true;
  const auto orders = bench.click_all(kBelowList, kWindowEnd);
  CHECK(bench.has<StopFetch>(orders));
  CHECK(bench.has<StopAdding>(orders));
  CHECK_FALSE(bench.has<TakeBuild>(orders));
  CHECK_FALSE(bench.has<AddClipboard>(orders));
}

TEST_CASE("a window that is opened again asks for a new list", "[client_ui]") {
  LibraryWindowBench bench;
  CHECK_FALSE(bench.frame().has_value());
  bench.window.toggle();
  CHECK_FALSE(bench.frame().has_value());
  bench.window.toggle();
  const auto order = bench.frame();
  REQUIRE(order.has_value());
  CHECK(std::holds_alternative<FindBuilds>(*order));
}

TEST_CASE("the window closes when a build is in the clipboard", "[client_ui]") {
  LibraryWindowBench bench;
  bench.state.taken = 1;
  bench.frame();
  CHECK_FALSE(bench.window.is_open());
  bench.state.taken = 2;  // by a script, while the window is closed
  bench.window.toggle();
  bench.frame();
  CHECK(bench.window.is_open());
}

TEST_CASE("without a library the window says why, and nothing can be ordered", "[client_ui]") {
  LibraryWindowBench bench;
  bench.state.unavailable = "This server gives clients no library of builds.";
  bench.state.builds = nullptr;
  CHECK(bench.click_all(100, kWindowEnd).empty());
}

TEST_CASE("the picture of the selected build is an image of the frame", "[client_ui]") {
  LibraryWindowBench bench;
  bench.select(18);
  auto image = std::make_shared<OverlayImage>();
  image->width = image->height = 4;
  image->pixels.assign(16, 0xff8040c0U);
  bench.state.picture = image;
  bench.state.pictured = 19;
  bench.frame();
  CHECK(bench.made->images.empty());
  bench.state.pictured = 18;
  bench.frame();
  REQUIRE(bench.made->images.size() == 1);
  CHECK(bench.made->images[0] == image);
}
