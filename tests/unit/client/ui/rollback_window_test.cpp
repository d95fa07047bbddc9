#include "client/ui/rollback_window.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "client/ui/ui_context.hpp"

using namespace runstone;

namespace {

constexpr std::array<int, 2> kRollbackFrame = {1280, 720};

struct RollbackWindowBench {
  RollbackWindowBench() {
    state.is_allowed = true;
    state.authors = {{7, "ann"}, {9, "bob"}};
    window.toggle();
    frame();
    frame();
  }
  std::optional<RollbackOrder> frame(const std::vector<InputEvent>& events = {}) {
    std::optional<RollbackOrder> out;
    context.feed(events);
    made = context.make_frame(kRollbackFrame, 0.016, [&] {
      if (auto order = window.build(state, 1)) out = std::move(order);
    });
    return out;
  }
  /// Clicks on a grid of places of the window. Returns the orders.
  std::vector<RollbackOrder> click_all() {
    std::vector<RollbackOrder> out;
    for (double y = 180; y < 400; y += 5) {
      for (double x = 20; x < 430; x += 10) {
        frame({CursorEvent{x, y, 0, 0}});
        for (const bool is_pressed : {true, false}) {
          if (const auto order = frame({ButtonEvent{MouseButton::left, is_pressed}}))
            out.push_back(*order);
        }
      }
    }
    return out;
  }
  template <class T>
  static bool has(const std::vector<RollbackOrder>& orders) {
    return std::ranges::any_of(
        orders, [](const RollbackOrder& order) { return std::holds_alternative<T>(order); });
  }
  RollbackWindow window;
  UiContext context;
  RollbackState state;
  std::shared_ptr<const OverlayFrame> made;
};

}  // namespace

TEST_CASE("a rollback is previewed first, then applied or forgotten, then undone", "[client_ui]") {
  RollbackWindowBench bench;
  auto orders = bench.click_all();
  CHECK(bench.has<PreviewRollback>(orders));
  CHECK_FALSE(bench.has<ApplyRollback>(orders));
  CHECK_FALSE(bench.has<UndoRollback>(orders));
  bench.state.phase = RollbackPhase::previewed;
  orders = bench.click_all();
  CHECK(bench.has<ApplyRollback>(orders));
  CHECK(bench.has<ForgetRollback>(orders));
  CHECK_FALSE(bench.has<UndoRollback>(orders));
  bench.state.phase = RollbackPhase::applied;
  CHECK(bench.has<UndoRollback>(bench.click_all()));
}

TEST_CASE("while the server works, and without the right, nothing can be ordered", "[client_ui]") {
  RollbackWindowBench bench;
  bench.state.phase = RollbackPhase::applying;
  CHECK(bench.click_all().empty());
  bench.state.phase = RollbackPhase::previewed;
  bench.state.is_allowed = false;
  CHECK(bench.click_all().empty());
}
