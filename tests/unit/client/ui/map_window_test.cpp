#include "client/ui/map_window.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "tests/unit/client/tools/tool_bench.hpp"

namespace runstone::test {
namespace {

constexpr std::array<int, 2> kMapFrame = {800, 600};
constexpr double kMiddleX = 400, kMiddleY = 300;  // of the full window, nearly that of its canvas

/// A full-size map window over flat ground, with a mouse.
struct MapWindowBench {
  MapWindowBench() {
    ground.show_flat();
    map.set_materials(default_material_table());
    map.open(ground.replica);
    while (map.is_drawing()) map.step(ground.replica, 0, 0);
    state.map = &map;
    window.set_open(true);
    window.set_full(true);
    frame();
    frame();
  }
  std::shared_ptr<const OverlayFrame> frame(const std::vector<InputEvent>& events = {}) {
    context.feed(events);
    return context.make_frame(kMapFrame, 0.016,
                              [&] { window.build(state, default_material_table(), context); });
  }
  void move(double x, double y) { frame({CursorEvent{x, y, 0, 0}}); }
  void press(bool is_pressed) { frame({ButtonEvent{MouseButton::left, is_pressed}}); }

  ToolBench ground;
  WorldMap map;
  MapState state;
  MapWindow window;
  UiContext context;
};

}  // namespace

TEST_CASE("the map window shows the images of its tiles", "[client_ui]") {
  MapWindowBench bench;
  const auto frame = bench.frame();
  CHECK(frame->images.size() == 16);
  std::set<std::uint32_t> used;
  for (const OverlayCommand& command : frame->commands) {
    REQUIRE(command.image <= frame->images.size());
    used.insert(command.image);
  }
  CHECK(used.size() == 17);  // the glyphs, too
  bench.window.set_open(false);
  CHECK(bench.frame()->images.empty());
}

TEST_CASE("tiles outside of the window are not drawn", "[client_ui]") {
  MapWindowBench bench;
  bench.window.set_zoom(16);  // 256 pixels a tile
  bench.state.me.x = bench.state.me.z = 8;
  CHECK(bench.frame()->images.size() < 16);
  bench.state.me.x = 10'000;
  CHECK(bench.frame()->images.empty());
}

TEST_CASE("the wheel zooms the map, within limits", "[client_ui]") {
  MapWindowBench bench;
  const double before = bench.window.zoom();
  bench.move(kMiddleX, kMiddleY);
  bench.frame({WheelEvent{1}});
  CHECK(bench.window.zoom() > before);
  for (int i = 0; i < 50; ++i) bench.frame({WheelEvent{1}});
  CHECK(bench.window.zoom() == MapWindow::kZoomMax);
  for (int i = 0; i < 100; ++i) bench.frame({WheelEvent{-1}});
  CHECK(bench.window.zoom() == MapWindow::kZoomMin);
  bench.move(2, 2);  // beside the window
  bench.frame({WheelEvent{1}});
  CHECK(bench.window.zoom() == MapWindow::kZoomMin);
}

TEST_CASE("the map follows the player until it is dragged", "[client_ui]") {
  MapWindowBench bench;
  bench.window.set_zoom(2);
  bench.state.me.x = 20;
  bench.state.me.z = -7;
  bench.frame();
  CHECK(bench.window.centre_x() == 20);
  CHECK(bench.window.centre_z() == -7);
  bench.move(kMiddleX, kMiddleY);
  bench.press(true);
  bench.move(kMiddleX + 40, kMiddleY + 20);
  bench.move(kMiddleX + 60, kMiddleY + 20);
  bench.press(false);
  CHECK_FALSE(bench.window.follows());
  CHECK(bench.window.centre_x() < 20);
  CHECK(bench.window.centre_z() < -7);
  const double x = bench.window.centre_x();
  bench.state.me.x = 100;
  bench.frame();
  CHECK(bench.window.centre_x() == x);
}

TEST_CASE("a click makes a place of the map the centre", "[client_ui]") {
  MapWindowBench bench;
  bench.window.set_zoom(2);
  bench.frame();
  bench.move(kMiddleX + 100, kMiddleY);
  bench.press(true);
  bench.press(false);
  CHECK_FALSE(bench.window.follows());
  CHECK(bench.window.centre_x() == Approx(50).margin(2));
}

TEST_CASE("a map without a world shows no window", "[client_ui]") {
  MapWindow window;
  UiContext context;
  window.set_open(true);
  const auto frame = context.make_frame(
      kMapFrame, 0.016, [&] { window.build({}, default_material_table(), context); });
  CHECK(frame->commands.empty());
}

}  // namespace runstone::test
