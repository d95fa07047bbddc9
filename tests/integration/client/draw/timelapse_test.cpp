// runstone-replay timelapse, with the real client program for drawing. If there is no OpenGL, the
// cases that draw say so with WARN and pass.
#include <stdlib.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "server/draw/draw_child.hpp"
#include "server/replay/timelapse.hpp"
#include "tests/integration/client/draw/png_file.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/support/replay/run_replay.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone {
namespace {

using namespace test;

constexpr Sequence kEdits = 10;

bool no_opengl() {
  const auto child = DrawChild::start({RUNSTONE_CLIENT_PROGRAM});
  if (!child) WARN("no context: " << child.error());
  return !child.has_value();
}

/// A flat world. Edit i puts red wool on the next 8 of 80 voxels along x, 8 wide and one high.
class RedCarpet {
 public:
  explicit RedCarpet(Sequence edits = kEdits) {
    WorldMeta meta = sample_meta();
    meta.generator = {"flat", 1, 0, ""};
    ground_ = (*make_generator(meta.generator, meta.materials))->surface_y(0, 0);
    auto store = *create_world(world(), meta);
    REQUIRE(store->raise_epoch().has_value());
    SplitMix64 rng(1);
    std::vector<EditRecord> records = sample_records(rng, 1, 1, edits);
    for (EditRecord& record : records) {
      const auto x = static_cast<std::int32_t>(record.version.seq - 1) * 8;
      record.edit = {};
      record.edit.shape = FillBox{{{x, ground_, 0}, {x + 8, ground_ + 1, 8}}};
      record.edit.material = *meta.materials.find("wool_red");
    }
    REQUIRE(store->append_history({}, records).has_value());
    // The camera looks down from above the middle, so that +x is on the right and the 80 voxels
    // fill the picture.
    std::ofstream(camera()) << "0% 40 " << ground_ + 45 << " 4 180 -90\n";
  }
  std::string world() const { return folder_ / "world"; }
  std::string frames() const { return folder_ / "frames"; }
  std::string camera() const { return folder_ / "path.txt"; }
  std::string operator/(const std::string& name) const { return folder_ / name; }

  ReplayOutcome run(std::vector<std::string> more = {}) const {
    return run_into(frames(), std::move(more));
  }
  ReplayOutcome run_into(const std::string& folder, std::vector<std::string> more) const {
    std::vector<std::string> all = {"timelapse", folder,    "--world",  world(),
                                    "--size",    "160x120", "--client", RUNSTONE_CLIENT_PROGRAM};
    all.insert(all.end(), more.begin(), more.end());
    return run_replay(all);
  }
  std::size_t frame_count() const {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(frames())) {
      count += entry.path().extension() == ".png" ? 1 : 0;
    }
    return count;
  }
  PngFile frame(std::uint64_t number) const { return PngFile(frames() + "/" + frame_name(number)); }

 private:
  TempFolder folder_;
  std::int32_t ground_ = 0;
};

/// Returns how many of the edits' places are red.
int red_places(const PngFile& picture) {
  int red = 0;
  for (int i = 0; i < 10; ++i) red += is_red(picture.mean(0.05 + 0.1 * i, 0.5)) ? 1 : 0;
  return red;
}

std::size_t red_pixels(const PngFile& picture) {
  std::size_t red = 0;
  for (std::size_t i = 0; i + 2 < picture.rgb.size(); i += 3) {
    red += is_red({picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]}) ? 1U : 0U;
  }
  return red;
}

/// Sets PATH for one test.
class SearchPath {
 public:
  explicit SearchPath(const std::string& path) : before_(::getenv("PATH")) {
    REQUIRE(::setenv("PATH", path.c_str(), 1) == 0);
  }
  ~SearchPath() { ::setenv("PATH", before_.c_str(), 1); }
  SearchPath(const SearchPath&) = delete;
  SearchPath& operator=(const SearchPath&) = delete;

 private:
  const std::string before_;
};

void write_program(const std::string& file, const std::string& script) {
  std::ofstream(file) << "#!/bin/sh\n" << script << '\n';
  std::filesystem::permissions(file, std::filesystem::perms::owner_all);
}

}  // namespace

TEST_CASE("a timelapse has a frame every N edits, and the first and last moment",
          "[integration][draw]") {
  if (no_opengl()) return;
  const RedCarpet carpet;
  const ReplayOutcome outcome =
      carpet.run({"--every", "4", "--camera", carpet.camera(), "--json", carpet / "report.json"});
  INFO(outcome.err << outcome.out);
  REQUIRE(outcome.code == 0);
  REQUIRE(carpet.frame_count() == 4);
  CHECK(carpet.frame(1).width == 160);
  CHECK(carpet.frame(1).height == 120);
  CHECK(is_green(carpet.frame(1).mean(0.5, 0.5)));
  for (const auto& [number, edits] : {std::pair{1, 0}, {2, 4}, {3, 8}, {4, 10}}) {
    CAPTURE(number);
    CHECK(red_places(carpet.frame(static_cast<std::uint64_t>(number))) == edits);
  }
  std::ifstream in(carpet / "report.json");
  const auto report = nlohmann::json::parse(in);
  CHECK(report["frames"] == 4);
  CHECK(report["first_seq"] == 0);
  CHECK(report["last_seq"] == kEdits);
  CHECK(report["edits"] == kEdits);
  CHECK(report["seconds"].get<double>() >= report["draw_seconds"].get<double>());

  // A timelapse of other moments, in another folder.
  const std::string part = carpet / "part";
  const ReplayOutcome second = carpet.run_into(
      part, {"--from", "4", "--at", "8", "--every", "3", "--camera", carpet.camera()});
  INFO(second.err << second.out);
  REQUIRE(second.code == 0);
  CHECK(red_places(PngFile(part + "/" + frame_name(1))) == 4);
  CHECK(red_places(PngFile(part + "/" + frame_name(2))) == 7);
  CHECK(red_places(PngFile(part + "/" + frame_name(3))) == 8);
  CHECK_FALSE(std::filesystem::exists(part + "/" + frame_name(4)));
}

TEST_CASE("without a path the camera sees all edits, from the first frame on",
          "[integration][draw]") {
  if (no_opengl()) return;
  const RedCarpet carpet;
  const ReplayOutcome outcome = carpet.run();
  INFO(outcome.err << outcome.out);
  REQUIRE(outcome.code == 0);
  REQUIRE(carpet.frame_count() == kEdits + 1);  // a frame for each of few edits
  CHECK(red_pixels(carpet.frame(1)) == 0);
  std::size_t before = 0;
  for (std::uint64_t number = 2; number <= kEdits + 1; ++number) {
    const std::size_t red = red_pixels(carpet.frame(number));
    CHECK(red > before);
    before = red;
  }
  // Ground is all around: the lower half of the picture is not sky.
  CHECK_FALSE(is_sky(carpet.frame(1).mean(0.5, 0.9)));
  CHECK_FALSE(is_sky(carpet.frame(1).mean(0.1, 0.6)));
}

TEST_CASE("a camera follows its path while the world grows", "[integration][draw]") {
  if (no_opengl()) return;
  const RedCarpet carpet;
  std::ifstream in(carpet.camera());
  std::string share, x, y;
  in >> share >> x >> y;
  // The camera moves from beside the start of the carpet, where no edit is made, to above its
  // middle.
  std::ofstream(carpet.camera()) << "0% 400 " << y << " 400 180 -90\n100% 40 " << y
                                 << " 4 180 -90\n";
  const ReplayOutcome outcome = carpet.run({"--every", "5", "--camera", carpet.camera()});
  INFO(outcome.err << outcome.out);
  REQUIRE(outcome.code == 0);
  CHECK(red_pixels(carpet.frame(1)) == 0);
  CHECK(is_green(carpet.frame(1).mean(0.5, 0.5)));  // the ground below the camera
  CHECK(red_pixels(carpet.frame(2)) == 0);
  CHECK(is_green(carpet.frame(2).mean(0.5, 0.5)));
  CHECK(red_places(carpet.frame(3)) == 10);
}

TEST_CASE("an impossible timelapse is refused with the reason before a frame is drawn",
          "[integration][draw]") {
  const RedCarpet carpet;
  const auto refused_into = [&](const std::string& folder, std::vector<std::string> more) {
    const ReplayOutcome outcome = carpet.run_into(folder, std::move(more));
    CHECK(outcome.code == 2);
    CHECK((!std::filesystem::exists(carpet.frames()) || carpet.frame_count() == 0));
    return outcome.err;
  };
  const auto refused = [&](std::vector<std::string> more) {
    return refused_into(carpet.frames(), std::move(more));
  };
  CHECK(contains(refused({"--client", carpet / "nothing"}),
                 carpet / "nothing" + ": cannot be started: No such file"));
  CHECK(contains(refused({"--from", "11"}), "no edit from seq=11 to seq=10"));
  CHECK(contains(refused({"--from", "5", "--at", "4"}), "no edit from seq=5 to seq=4"));
  CHECK(contains(refused({"--camera", carpet / "none.txt"}), "none.txt"));
  std::ofstream(carpet / "bad.txt") << "0% 1 2 3 4 5\n50% 1 2 3 4\n";
  CHECK(contains(refused({"--camera", carpet / "bad.txt"}), "bad.txt:2: PITCH is missing"));
  CHECK(contains(refused_into("/proc/nowhere", {}), "/proc/nowhere: cannot be made"));
  CHECK(contains(refused({"--verify"}), "--verify"));
  CHECK(contains(refused({"--every", "0"}), "--every"));
  CHECK(contains(refused({"--size", "9x9"}), "WIDTHxHEIGHT"));
  CHECK(contains(refused({"--radius", "33"}), "--radius"));
  CHECK(run_replay({"timelapse", "--world", carpet.world(), "--every", "3"}).code == 2);
  std::filesystem::create_directories(carpet / "used");
  std::ofstream(carpet / "used/frame-000007.png") << "old";
  CHECK(contains(refused_into(carpet / "used", {}), "holds frames already (frame-000007.png)"));
}

TEST_CASE("a timelapse of a world without edits needs a camera path", "[integration][draw]") {
  if (no_opengl()) return;
  const RedCarpet bare(0);
  CHECK(contains(bare.run().err, "no edit, so there is nothing to look at"));
  const ReplayOutcome outcome = bare.run({"--camera", bare.camera()});
  INFO(outcome.err << outcome.out);
  REQUIRE(outcome.code == 0);
  CHECK(bare.frame_count() == 1);
  CHECK(is_green(bare.frame(1).mean(0.5, 0.5)));
}

TEST_CASE("ffmpeg joins the frames if it is installed, and otherwise its command is printed",
          "[integration][draw]") {
  if (no_opengl()) return;
  const RedCarpet carpet;
  std::filesystem::create_directories(carpet / "bin");
  const SearchPath path(carpet / "bin");
  const std::vector<std::string> few = {"--every", "10", "--fps", "12"};
  const auto with = [&](const std::string& folder) {
    return carpet.run_into(carpet / folder, few);
  };
  const ReplayOutcome without = with("a");
  INFO(without.err);
  CHECK(without.code == 0);
  CHECK(contains(without.out, "ffmpeg is not installed"));
  CHECK(contains(without.out, "\nffmpeg -y -loglevel error -framerate 12 -i 'frame-%06d.png'"));

  write_program(carpet / "bin/ffmpeg", "for last; do :; done; { pwd; echo \"$@\"; } > \"$last\"");
  const ReplayOutcome made = with("b");
  CHECK(made.code == 0);
  CHECK(contains(made.out, carpet / "b/timelapse.mp4"));
  std::ifstream in(carpet / "b/timelapse.mp4");
  const std::string said{std::istreambuf_iterator<char>(in), {}};
  CHECK(contains(said, carpet / "b\n"));
  CHECK(contains(said, "-framerate 12 -i frame-%06d.png"));

  write_program(carpet / "bin/ffmpeg", "exit 7");
  CHECK(contains(with("c").out, "ffmpeg ended with exit code 7"));
}

}  // namespace runstone
