#include "client/display/draw_thread.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <thread>

#include "client/net/wake_up.hpp"
#include "client/render/drawn_textures.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/unit/client/display/draw_samples.hpp"
#include "tests/unit/client/display/fake_screen.hpp"

using namespace runstone;
using test::chunk;
using test::fake_screen_on;
using test::FakeScreenLog;
using test::Lines;
using test::mesh_of;
using test::small_frame;

namespace {

/// Uploads that take no time fit it, however busy the machine is.
constexpr UploadBudget kAmple{3'600'000'000, std::size_t{1} << 40};
/// One upload a frame.
constexpr UploadBudget kLeast{0, 0};

/// A draw thread with a fake screen, and the list of what it did.
struct ThreadBench {
  explicit ThreadBench(UploadBudget limits = kAmple) : budget(limits) {}
  ~ThreadBench() { screen_log.release(); }  // also after a failed check, so that the thread can end
  ThreadBench(const ThreadBench&) = delete;
  ThreadBench& operator=(const ThreadBench&) = delete;

  const UploadBudget budget;
  FakeScreenLog screen_log;
  WakeUp wake;
  std::vector<DrawDone> done;
  DrawThread thread{fake_screen_on(screen_log), DrawPriority::normal, [this] { wake.notify(); },
                    budget};

  /// Waits until this many frames are done.
  void take_frames(std::size_t count) {
    while (frames() < count) {
      wake.wait(std::chrono::seconds(1));
      for (DrawDone& one : thread.take_done()) done.push_back(std::move(one));
    }
  }
  /// Waits until nothing is queued and no upload is in progress, and takes what was done.
  void take_uploads(std::size_t count) {
    while (done.size() - frames() < count) {
      wake.wait(std::chrono::seconds(1));
      for (DrawDone& one : thread.take_done()) done.push_back(std::move(one));
    }
  }
  std::size_t frames() const {
    std::size_t count = 0;
    for (const DrawDone& one : done) count += std::holds_alternative<FrameDone>(one) ? 1 : 0;
    return count;
  }
};

}  // namespace

TEST_CASE(
    "changes during a frame wait for its end, and only the newest change of each chunk is done",
    "[client_app]") {
  ThreadBench bench;
  CHECK(bench.thread.screen_name() == "fake");
  bench.screen_log.hold();
  bench.thread.draw(small_frame());
  bench.screen_log.wait_until_drawing();
  bench.thread.upload(chunk(1), mesh_of(10, 1));
  bench.thread.upload(chunk(2), mesh_of(11, 2));
  bench.thread.upload(chunk(1), mesh_of(12, 3));
  bench.thread.remove(chunk(2));
  bench.thread.remove(chunk(3));
  bench.thread.upload(chunk(3), mesh_of(13, 4));
  CHECK(bench.thread.waiting() == 3);
  CHECK(bench.screen_log.lines() == Lines{"draw"});
  bench.screen_log.release();
  bench.take_frames(1);
  bench.thread.draw(small_frame());
  bench.take_frames(2);
  CHECK(bench.thread.waiting() == 0);
  CHECK(bench.screen_log.lines() ==
        Lines{"draw", "remove 2", "upload 1 quads 3", "upload 3 quads 4", "draw"});
}

TEST_CASE("results come in the order of the draw thread: uploads, then the frame that shows them",
          "[client_app]") {
  ThreadBench bench;
  bench.screen_log.hold();
  bench.thread.upload(chunk(1), mesh_of(10, 1));
  bench.thread.draw(small_frame());
  bench.screen_log.wait_until_drawing();
  bench.thread.upload(chunk(1), mesh_of(11, 1));
  bench.screen_log.release();
  bench.take_frames(1);
  bench.thread.draw(small_frame());
  bench.take_frames(2);
  REQUIRE(bench.done.size() == 4);
  const auto& first = std::get<UploadDone>(bench.done[0]);
  const auto& frame = std::get<FrameDone>(bench.done[1]);
  const auto& second = std::get<UploadDone>(bench.done[2]);
  const auto& last = std::get<FrameDone>(bench.done[3]);
  CHECK(first.serial == 10);
  CHECK(second.serial == 11);
  CHECK(first.at_us <= frame.started_us);
  CHECK(frame.started_us <= frame.presented_us);
  CHECK(frame.presented_us <= second.at_us);
  CHECK(second.at_us <= last.started_us);
}

TEST_CASE("a frame makes the uploads that its budget allows and carries the others over",
          "[client_app]") {
  ThreadBench bench(kLeast);
  bench.screen_log.hold_uploads();
  bench.thread.upload(chunk(9), mesh_of(1, 1));
  bench.screen_log.wait_until_uploading();
  // The frame is ordered while the upload above is in progress, which therefore ends before it.
  for (const std::int32_t x : {3, 1, 2}) bench.thread.upload(chunk(x), mesh_of(2, 1));
  bench.thread.remove(chunk(4));
  bench.thread.draw(small_frame());
  bench.screen_log.release();
  bench.take_frames(1);
  bench.take_uploads(4);
  CHECK(bench.screen_log.lines() == Lines{"upload 9 quads 1", "remove 4", "upload 1 quads 1",
                                          "draw", "upload 2 quads 1", "upload 3 quads 1"});
  // The frame is reported after the uploads that it shows, and before the others.
  REQUIRE(bench.done.size() == 5);
  CHECK(std::get<UploadDone>(bench.done[1]).key == chunk(1));
  const auto& frame = std::get<FrameDone>(bench.done[2]);
  CHECK(frame.uploads == 2);
  CHECK(frame.carried == 2);
  CHECK(std::get<UploadDone>(bench.done[3]).at_us >= frame.presented_us);
}

TEST_CASE("uploads that are carried over are replaced and removed like others", "[client_app]") {
  ThreadBench bench(kLeast);
  bench.screen_log.hold_uploads();
  bench.thread.upload(chunk(9), mesh_of(1, 1));
  bench.screen_log.wait_until_uploading();
  for (const std::int32_t x : {1, 2, 3}) bench.thread.upload(chunk(x), mesh_of(2, 1));
  bench.screen_log.hold();
  bench.thread.draw(small_frame());
  bench.screen_log.release_uploads();
  bench.screen_log.wait_until_drawing();  // chunks 2 and 3 are carried over
  bench.thread.upload(chunk(2), mesh_of(3, 5));
  bench.thread.remove(chunk(3));
  bench.screen_log.release();
  bench.take_uploads(3);
  CHECK(bench.screen_log.lines() ==
        Lines{"upload 9 quads 1", "upload 1 quads 1", "draw", "remove 3", "upload 2 quads 5"});
  CHECK(std::get<UploadDone>(bench.done.back()).serial == 3);
}

TEST_CASE("a frame that shows all has every upload that was queued before its order",
          "[client_app]") {
  ThreadBench bench(kLeast);
  bench.screen_log.hold_uploads();
  bench.thread.upload(chunk(9), mesh_of(1, 1));
  bench.screen_log.wait_until_uploading();
  for (const std::int32_t x : {3, 1, 2}) bench.thread.upload(chunk(x), mesh_of(2, 1));
  FrameOrder order = small_frame();
  order.shows_all = true;
  bench.thread.draw(std::move(order));
  bench.screen_log.release();
  bench.take_frames(1);
  CHECK(bench.screen_log.lines() == Lines{"upload 9 quads 1", "upload 1 quads 1",
                                          "upload 2 quads 1", "upload 3 quads 1", "draw"});
  CHECK(std::get<FrameDone>(bench.done.back()).carried == 0);
}

TEST_CASE("materials reach the screen before the frame that needs them", "[client_app]") {
  ThreadBench bench;
  bench.thread.set_materials(MaterialTable{});
  bench.thread.draw(small_frame());
  bench.take_frames(1);
  CHECK(bench.screen_log.lines() ==
        Lines{"materials " + std::to_string(MaterialTable{}.size()), "draw"});
  // The screen gets the shapes of the caller, and makes none.
  const auto shapes = std::make_shared<const ShapeTable>(
      std::vector<Shape>{{}, {ShapeForm::boxes, {ShapeBox{{0, 0, 0}, {16, 8, 16}}}}});
  bench.thread.set_materials(MaterialTable{}, shapes);
  bench.thread.draw(small_frame());
  bench.take_frames(2);
  const std::string all = "materials " + std::to_string(MaterialTable{}.size());
  CHECK(bench.screen_log.lines() ==
        Lines{all, "draw", all + " shapes " + std::to_string(shapes->serial()), "draw"});
}

TEST_CASE("textures reach the screen before the frame that needs them, and clear() removes them",
          "[client_app][textures]") {
  ThreadBench bench;
  auto textures = std::make_shared<DrawnTextures>();
  textures->table = std::make_shared<const TextureTable>();
  textures->pictures.resize(3);
  bench.thread.set_textures(textures);
  bench.thread.draw(small_frame());
  bench.take_frames(1);
  CHECK(bench.screen_log.lines() == Lines{"textures 3", "draw"});
  bench.thread.clear();
  bench.thread.draw(small_frame());
  bench.take_frames(2);
  CHECK(bench.screen_log.lines() == Lines{"textures 3", "draw", "textures 0", "draw"});
}

TEST_CASE(
    "a screenshot shows its frame, and a file that cannot be written is named with the reason",
    "[client_app]") {
  const test::TempFolder folder;
  std::ofstream(folder / "world.sqlite") << "a world";
  ThreadBench bench;
  FrameOrder order = small_frame();
  order.screenshots = {folder / "picture.png", folder / "no-such-folder/picture.png",
                       folder / "world.sqlite", "/dev/full"};
  bench.thread.draw(order);
  bench.take_frames(1);
  CHECK(std::get<FrameDone>(bench.done.back()).unwritten ==
        Lines{folder / "no-such-folder/picture.png" +
                  ": cannot be written: No such file or directory",
              folder / "world.sqlite" +
                  ": is not overwritten: files called *.sqlite hold a world or a key",
              "/dev/full: cannot be written: No space left on device"});
  CHECK(std::filesystem::file_size(folder / "picture.png") > 0);
  CHECK(std::filesystem::file_size(folder / "world.sqlite") == 7);
  CHECK(std::filesystem::is_character_file("/dev/full"));
}

TEST_CASE("a screen that cannot be made fails the start with the same text", "[client_app]") {
  const auto none = []() -> std::unique_ptr<Screen> { throw std::runtime_error("no OpenGL here"); };
  const auto odd = []() -> std::unique_ptr<Screen> { throw 7; };
  CHECK_THROWS_WITH(DrawThread(none, DrawPriority::normal, nullptr), "no OpenGL here");
  CHECK_THROWS_AS(DrawThread(odd, DrawPriority::normal, nullptr), std::runtime_error);
}

TEST_CASE("after a frame failed, every take_done() on the main thread throws", "[client_app]") {
  ThreadBench bench;
  bench.screen_log.fail_next();
  bench.thread.draw(small_frame());
  const auto take_until_failed = [&bench] { bench.take_frames(1); };
  CHECK_THROWS_WITH(take_until_failed(), "the cable is out");
  bench.thread.upload(chunk(1), mesh_of(1, 1));  // accepted, but never done
  CHECK_THROWS_WITH(bench.thread.take_done(), "the cable is out");
}

TEST_CASE(
    "the destructor finishes the current frame, drops queued work and destroys the screen on its "
    "thread",
    "[client_app]") {
  FakeScreenLog screen_log;
  {
    DrawThread thread(fake_screen_on(screen_log), DrawPriority::background, nullptr);
    screen_log.hold();
    thread.draw(small_frame());
    screen_log.wait_until_drawing();
    thread.upload(chunk(1), mesh_of(1, 1));
    const std::jthread later([&screen_log] { screen_log.release(); });
  }
  // The frame may be released before the end is requested. In that case the upload may have been
  // done.
  Lines lines = screen_log.lines();
  std::erase(lines, "upload 1 quads 1");
  CHECK(lines == Lines{"draw", "gone"});
}

TEST_CASE("a cleared screen shows no chunk of before, and no result of before comes later",
          "[client_app]") {
  ThreadBench bench;
  bench.thread.upload(chunk(1), mesh_of(1, 3));
  bench.thread.upload(chunk(2), mesh_of(2, 3));
  bench.thread.remove(chunk(2));
  bench.thread.draw(small_frame());
  bench.take_frames(1);
  bench.done.clear();
  bench.screen_log.hold();
  bench.thread.upload(chunk(3), mesh_of(3, 3));
  bench.thread.draw(small_frame());
  bench.screen_log.wait_until_drawing();
  bench.thread.upload(chunk(4), mesh_of(4, 3));  // queued behind the frame: never uploaded
  std::thread releasing([&] {
    while (bench.thread.waiting() != 0) std::this_thread::yield();  // until clear() dropped it
    bench.screen_log.release();
  });
  bench.thread.clear();
  releasing.join();
  CHECK(bench.thread.take_done().empty());
  bench.thread.draw(small_frame());
  bench.take_frames(1);
  CHECK(bench.done.size() == 1);
  const Lines lines = bench.screen_log.lines();
  const auto has = [&](const std::string& line) {
    return std::find(lines.begin(), lines.end(), line) != lines.end();
  };
  CAPTURE(lines);
  CHECK(has("remove 1"));
  CHECK(has("remove 3"));
  CHECK_FALSE(has("upload 4 quads 3"));
}
