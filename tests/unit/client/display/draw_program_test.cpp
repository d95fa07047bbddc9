#include "client/display/draw_program.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "client/report/exit_code.hpp"
#include "protocol/codec/draw_answer.hpp"
#include "protocol/codec/draw_order.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/unit/client/display/fake_screen.hpp"

namespace runstone {
namespace {

struct Outcome {
  int code = -1;
  std::vector<DrawAnswer> answers;
  std::vector<std::string> screen;
};

class Bench {
 public:
  Bench() { append_draw_world(16, default_material_table(), orders); }
  Outcome run() {
    std::ofstream(folder / "orders", std::ios::binary)
        .write(reinterpret_cast<const char*>(orders.data()),
               static_cast<std::streamsize>(orders.size()));
    const int in = ::open((folder / "orders").c_str(), O_RDONLY | O_CLOEXEC);
    const int out = ::open((folder / "answers").c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0644);
    REQUIRE(in >= 0);
    REQUIRE(out >= 0);
    Outcome outcome;
    outcome.code = draw_program(in, out, 0, make_screen);
    ::close(in);
    ::close(out);
    std::ifstream lines(folder / "answers");
    for (std::string line; std::getline(lines, line);) {
      const auto answer = parse_draw_answer(line);
      CAPTURE(line);
      REQUIRE(answer);
      outcome.answers.push_back(*answer);
    }
    outcome.screen = screen_log.lines();
    return outcome;
  }
  void order_picture(const std::string& name) {
    append_draw_picture({{}, {64, 48}, folder / name}, orders);
  }

  test::TempFolder folder;
  test::FakeScreenLog screen_log;
  std::function<std::unique_ptr<Screen>()> make_screen = test::fake_screen_on(screen_log);
  Bytes orders;
};

std::string failure_in(const DrawAnswer& answer) {
  const auto* failed = std::get_if<DrawFailed>(&answer);
  REQUIRE(failed != nullptr);
  return failed->text;
}

}  // namespace

TEST_CASE("the draw program answers for each picture once its file is on disk", "[client_app]") {
  Bench bench;
  append_draw_chunk({0, {2, 0, 0}}, uniform_chunk(Extent::cube(16), 1), bench.orders);
  bench.order_picture("a.png");
  append_draw_forget({0, {2, 0, 0}}, bench.orders);
  bench.order_picture("b.png");
  append_draw_end(bench.orders);
  const Outcome outcome = bench.run();
  CHECK(outcome.code == kExitOk);
  REQUIRE(outcome.answers.size() == 3);
  CHECK(outcome.answers[0] == DrawAnswer{DrawReady{kDrawVersion, "fake"}});
  CHECK(std::get<PictureDrawn>(outcome.answers[1]).file == bench.folder / "a.png");
  CHECK(std::get<PictureDrawn>(outcome.answers[2]).file == bench.folder / "b.png");
  CHECK(std::filesystem::file_size(bench.folder / "a.png") > 0);
  CHECK(std::filesystem::exists(bench.folder / "b.png"));
  const std::vector<std::string> screen = {
      "materials " + std::to_string(default_material_table().size()),
      "upload 2 quads 6",
      "draw",
      "remove 2",
      "draw",
      "gone"};
  CHECK(outcome.screen == screen);
}

TEST_CASE(
    "for a picture that cannot be written the answer names file and reason, and the next one is "
    "drawn",
    "[client_app]") {
  Bench bench;
  bench.order_picture("no/such/folder/a.png");
  bench.order_picture("world.key");
  bench.order_picture("b.png");
  append_draw_end(bench.orders);
  const Outcome outcome = bench.run();
  CHECK(outcome.code == kExitFailed);
  REQUIRE(outcome.answers.size() == 4);
  CHECK(outcome.answers[1] ==
        DrawAnswer{PictureUnwritten{bench.folder / "no/such/folder/a.png" +
                                    ": cannot be written: No such file or directory"}});
  CHECK(outcome.answers[2] ==
        DrawAnswer{
            PictureUnwritten{bench.folder / "world.key" +
                             ": is not overwritten: files called *.key hold a world or a key"}});
  CHECK_FALSE(std::filesystem::exists(bench.folder / "world.key"));
  CHECK(std::filesystem::exists(bench.folder / "b.png"));
}

TEST_CASE("orders that are wrong or end early end the draw program with the reason",
          "[client_app]") {
  Bench bench;
  const auto begun = std::to_string(bench.orders.size());
  SECTION("wrong") {
    bench.orders.insert(bench.orders.end(), {0, 0, 0, 0, 9});
    const Outcome outcome = bench.run();
    CHECK(outcome.code == kExitNoStart);
    REQUIRE(outcome.answers.size() == 2);
    CHECK(failure_in(outcome.answers[1]) == "draw order: unknown kind, at byte " + begun);
  }
  SECTION("broken off") {
    const Outcome outcome = bench.run();
    CHECK(outcome.code == kExitNoStart);
    REQUIRE(outcome.answers.size() == 2);
    CHECK(failure_in(outcome.answers[1]).find("break off") != std::string::npos);
  }
}

TEST_CASE("a missing OpenGL or a failing driver ends the draw program with the driver's text",
          "[client_app]") {
  Bench bench;
  bench.order_picture("a.png");
  append_draw_end(bench.orders);
  SECTION("none") {
    bench.make_screen = []() -> std::unique_ptr<Screen> {
      throw std::runtime_error("no headless context");
    };
    const Outcome outcome = bench.run();
    CHECK(outcome.code == kExitNoStart);
    REQUIRE(outcome.answers.size() == 1);
    CHECK(failure_in(outcome.answers[0]) == "no headless context");
  }
  SECTION("no more") {
    bench.screen_log.fail_next();
    const Outcome outcome = bench.run();
    CHECK(outcome.code == kExitNoStart);
    REQUIRE(outcome.answers.size() == 2);
    CHECK(failure_in(outcome.answers[1]) == "the cable is out");
  }
}

}  // namespace runstone
