#include "client/display/draw_queue.hpp"

#include <catch2/catch.hpp>
#include <memory>

#include "tests/unit/client/display/draw_samples.hpp"
#include "tests/unit/client/display/fake_screen.hpp"

using namespace runstone;
using test::chunk;
using test::fake_screen_on;
using test::FakeScreenLog;
using test::Lines;
using test::mesh_of;

namespace {

/// A queue whose one thread queues and draws, as in a browser.
struct OneThread {
  OneThread() { queue.set_drawing(screen->name()); }

  FakeScreenLog log;
  const std::unique_ptr<Screen> screen = fake_screen_on(log)();
  DrawQueue queue{nullptr};
};

}  // namespace

TEST_CASE("one thread can queue and draw: a frame shows what was queued before it",
          "[client_app]") {
  OneThread bench;
  CHECK(bench.queue.screen_name() == "fake");
  bench.queue.upload(chunk(1), mesh_of(10, 3));
  bench.queue.remove(chunk(2));
  FrameOrder order;
  order.shows_all = true;
  bench.queue.draw(std::move(order));
  bench.queue.serve(*bench.screen);
  CHECK(bench.log.lines() == Lines{"remove 2", "upload 1 quads 3", "draw"});
  const auto done = bench.queue.take_done();
  REQUIRE(done.size() == 2);
  CHECK(std::get<UploadDone>(done[0]).serial == 10);
  CHECK(std::get<FrameDone>(done[1]).uploads == 1);
  CHECK(bench.queue.take_done().empty());
}

TEST_CASE("without a frame, serving uploads what waits, and nothing that does not",
          "[client_app]") {
  OneThread bench;
  bench.queue.upload(chunk(1), mesh_of(10, 3));
  CHECK(bench.queue.waiting() == 1);
  bench.queue.serve(*bench.screen);
  CHECK(bench.queue.waiting() == 0);
  bench.queue.serve(*bench.screen);
  CHECK(bench.log.lines() == Lines{"upload 1 quads 3"});
}

TEST_CASE("a queue can be cleared for another world while its thread draws nothing",
          "[client_app]") {
  OneThread bench;
  bench.queue.upload(chunk(1), mesh_of(10, 3));
  bench.queue.serve(*bench.screen);
  bench.queue.upload(chunk(2), mesh_of(11, 4));
  bench.queue.clear();
  bench.queue.serve(*bench.screen);
  CHECK(bench.queue.take_done().empty());
  CHECK(bench.log.lines() == Lines{"upload 1 quads 3", "remove 1", "remove 2"});
}

TEST_CASE("a failure of the side that draws reaches the side that queues", "[client_app]") {
  OneThread bench;
  bench.queue.fail("the driver hangs");
  CHECK_THROWS_WITH(bench.queue.take_done(), "the driver hangs");
  CHECK_THROWS_WITH(bench.queue.clear(), "the driver hangs");
}
