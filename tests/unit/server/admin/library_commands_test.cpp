// The commands of the library, from the file to the disk and back.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "server/admin/build_file.hpp"
#include "server/admin/build_folder.hpp"
#include "server/admin/command_table.hpp"
#include "server/store/build_table.hpp"
#include "tests/support/formats/rsb_bytes.hpp"
#include "tests/unit/server/admin/command_bench.hpp"

namespace runstone::test {
namespace {

/// A world whose log writer writes files of builds when the test says.
struct LibraryBench : CommandBench {
  explicit LibraryBench(const WorldConfig& world_config = config())
      : CommandBench(world_config),
        services{bench.server,
                 service,
                 *this,
                 placing,
                 folder.path(),
                 actions_of(),
                 [](const PublicKey&) { return false; }} {
    author = join(kBuilder);
  }
  CommandAnswer give(const std::string& line, const CommandCaller& caller = {}) {
    begin(line, caller);
    for (int i = 0; i < 1000 && (answers.empty() || !answers.back().is_done); ++i) step();
    return answer();
  }
  /// Gives a command, and forgets the answers to those before.
  void begin(const std::string& line, const CommandCaller& caller = {}) {
    answers.clear();
    give_command({services, caller, bench.now(), reply()}, line);
  }
  /// Does the work that is due, writes one file and the log, and ticks.
  void step() {
    while (work()) {
    }
    save_file();
    write_log();
    bench.time_us += 100'000;
    services.tick(bench.now());
  }
  /// The player of the session kBuilder.
  CommandCaller builder() const {
    return {author, {key_pair_of(seed_of(static_cast<std::uint8_t>(kBuilder))).public_key, false}};
  }
  std::string make_file(const std::string& name, const BuildInfo& info) {
    SampleBuild build;
    build.info = info;
    build.materials = sample_build_materials();
    build.sections.push_back({{}, uniform_chunk(section_extent(info.sides, {}), 2)});
    const Bytes bytes = rsb_of(build, 0);
    std::ofstream(folder / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    return folder / name;
  }
  BuildInfo info(const std::string& name) {
    BuildInfo out = sample_build_info({5, 6, 7});
    out.name = name;
    return out;
  }

  AuthorId author = 0;
  bool is_writer_busy = false;
  std::string save_error;
  CommandServices services;

 private:
  struct Saving {
    std::uint64_t content = 0;
    std::shared_ptr<const Bytes> file;
    std::function<void(const std::string&)> done;
  };
  OperatorActions actions_of() {
    OperatorActions actions;
    actions.save_build_file = [this](std::uint64_t content, std::shared_ptr<const Bytes> file,
                                     std::function<void(const std::string&)> done) {
      if (is_writer_busy) return false;
      saving = Saving{content, std::move(file), std::move(done)};
      return true;
    };
    return actions;
  }
  void save_file() {
    if (!saving) return;
    const Saving now = *std::exchange(saving, std::nullopt);
    if (!save_error.empty()) return now.done(save_error);
    REQUIRE(now.file->size() <= kBuildPartBytes);
    REQUIRE(store->save_build_part(now.content, 0, *now.file).has_value());
    now.done("");
  }
  std::optional<Saving> saving;
};

std::string bytes_in(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("a build is imported, listed, shown, exported and removed", "[admin][library]") {
  LibraryBench bench;
  const std::string file = bench.make_file("mill.rsb", bench.info("Old Mill"));
  CommandAnswer answer = bench.give("builds import " + file);
  INFO(answer.text);
  REQUIRE(answer.is_ok);
  CHECK(answer.text.starts_with("added: 1 \"Old Mill\" by zo\xc3\xab, 5 x 6 x 7, "));
  CHECK(answer.text.ends_with(", mill wood"));
  REQUIRE(bench.give("builds import " + bench.make_file("t.rsb", bench.info("Tower"))).is_ok);

  answer = bench.give("builds list");
  CHECK(answer.text.starts_with("2 \"Tower\""));
  CHECK(answer.text.ends_with("\nthe library has 2 builds"));
  answer = bench.give("builds list name OLD tag mill author ZO");
  CHECK(answer.text.starts_with("1 \"Old Mill\""));
  answer = bench.give("builds list count 1");
  CHECK(answer.text.find("\nmore: builds list before 2 count 1\n") != std::string::npos);
  answer = bench.give("builds list count 1 tag wood name \"D M\"");
  CHECK(answer.text.find("\nmore:") == std::string::npos);
  answer = bench.give("builds list count 1 tag wood author \"zo\xc3\xab\"");
  CHECK(answer.text.find("\nmore: builds list author zo\xc3\xab tag wood before 2 count 1\n") !=
        std::string::npos);
  CHECK(bench.give("builds list before 2").text.starts_with("1 \"Old Mill\""));
  CHECK(bench.give("builds list tag stone").text == "no build fits\nthe library has 2 builds");

  answer = bench.give("builds show 1");
  CHECK(answer.text.find("name      Old Mill\n") != std::string::npos);
  CHECK(answer.text.find("cells     210\n") != std::string::npos);
  CHECK(answer.text.find("created   2023-11-14T22:13:20Z\n") != std::string::npos);
  CHECK(answer.text.find(" by the console\n") != std::string::npos);

  const std::string copy = bench.folder / "copy.rsb";
  REQUIRE(bench.give("builds export 1 " + copy).is_ok);
  CHECK(bytes_in(copy) == bytes_in(file));

  const std::string picture = bench.folder / "mill.png";
  REQUIRE(bench.give("builds picture 1 " + picture).is_ok);
  CHECK(bytes_in(picture).starts_with("\x89PNG"));

  answer = bench.give("builds remove 1");
  REQUIRE(answer.is_ok);
  CHECK(answer.text == "removed build 1 (record 3)");
  CHECK(bench.give("builds remove 1").text ==
        "builds remove: the library has no build 1 (builds list has the numbers)");
  CHECK_FALSE(bench.give("builds show 1").is_ok);
  CHECK_FALSE(bench.give("builds export 1 " + copy).is_ok);
  CHECK(bench.store->check().has_value());
}

TEST_CASE("a file that is no sound .rsb is refused with the place of the fault",
          "[admin][library]") {
  LibraryBench bench;
  const std::string file = bench.make_file("mill.rsb", bench.info("Mill"));
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 1);
  CommandAnswer answer = bench.give("builds import " + file);
  CHECK_FALSE(answer.is_ok);
  CHECK(answer.text.starts_with("builds import: " + file + ": end at byte "));
  CHECK(answer.text.ends_with(": file ends inside a block"));
  answer = bench.give("builds import " + (bench.folder / "none.rsb"));
  CHECK_FALSE(answer.is_ok);
  answer = bench.give("builds import " + bench.folder.path() + "/world.sqlite");
  CHECK(answer.text.ends_with("mark at byte 0: is not an .rsb file"));
  CHECK(bench.bench.environment.records.empty());
}

TEST_CASE("an import that cannot be written adds nothing", "[admin][library]") {
  LibraryBench bench;
  const std::string file = bench.make_file("mill.rsb", bench.info("Mill"));
  bench.is_writer_busy = true;
  CHECK(bench.give("builds import " + file).text ==
        "builds import: another file is being written, or the world cannot be written: try again");
  bench.is_writer_busy = false;
  bench.save_error = "disk is full";
  CHECK(bench.give("builds import " + file).text == "builds import: disk is full");
  CHECK(bench.give("builds list").text == "no build fits\nthe library has 0 builds");
}

TEST_CASE("a folder is imported in the order of its names", "[admin][library]") {
  LibraryBench bench;
  const std::string files = bench.folder / "files";
  std::filesystem::create_directories(files + "/more.rsb");
  constexpr std::size_t kFiles = kFolderBatchFiles + 20;  // two batches
  for (std::size_t i = 0; i < kFiles; ++i) {
    const std::string number = std::to_string(1000 + i);
    bench.make_file("files/" + number + (i == 3 ? ".RSB" : ".rsb"), bench.info("Build " + number));
  }
  std::ofstream(files + "/readme.txt") << "x";
  std::ofstream(files + "/1001.rsb") << "no build";

  CommandAnswer answer = bench.give("builds import " + files);
  CHECK_FALSE(answer.is_ok);
  CHECK(answer.text.starts_with("added: 275 builds of 277 files in " + files +
                                "; left out: 1 that are no .rsb files\nrefused: 2 files\n  " +
                                files + "/1001.rsb: "));
  CHECK(answer.text.find("\n  " + files + "/more.rsb: ") != std::string::npos);
  CHECK(bench.give("builds list count 1").text.starts_with("275 \"Build 1275\""));
  CHECK(bench.give("builds list before 4 count 1").text.starts_with("3 \"Build 1003\""));
  CHECK(bench.store->check().has_value());

  std::filesystem::remove(files + "/1001.rsb");
  std::filesystem::remove(files + "/more.rsb");
  bench.make_file("files/0.rsb", bench.info("First"));
  answer = bench.give("builds import " + files);
  CHECK(answer.is_ok);
  CHECK(answer.text == "added: 1 build of 276 files in " + files +
                           "; left out: 275 that the library has already; left out: 1 that are no "
                           ".rsb files");
}

TEST_CASE("the answer about a folder shows the first files that were refused", "[admin][library]") {
  LibraryBench bench;
  const std::string files = bench.folder / "files";
  std::filesystem::create_directories(files);
  CHECK(bench.give("builds import " + files).text ==
        "builds import: " + files + ": has no .rsb file");
  for (int i = 0; i < 9; ++i) std::ofstream(files + "/" + std::to_string(i) + ".rsb") << "no build";
  std::ofstream(files + "/\x1b.rsb") << "no build";
  const CommandAnswer answer = bench.give("builds import " + files);
  CHECK_FALSE(answer.is_ok);
  CHECK(
      answer.text.find("refused: 10 files\n  file 1 of the folder: its name is no printable UTF-8 "
                       "text\n  " +
                       files + "/0.rsb: ") != std::string::npos);
  CHECK(answer.text.find("/3.rsb: ") != std::string::npos);
  CHECK(answer.text.find("/4.rsb: ") == std::string::npos);
  CHECK(answer.text.ends_with("\n  and 5 more"));
}

TEST_CASE("the import of a folder waits for the log writer, and ends where the library is full",
          "[admin][library]") {
  WorldConfig world_config = config();
  world_config.library.builds_max = 3;
  LibraryBench bench(world_config);
  const std::string files = bench.folder / "files";
  std::filesystem::create_directories(files);
  for (int i = 0; i < 3; ++i)
    bench.make_file("files/" + std::to_string(i) + ".rsb",
                    bench.info("Build " + std::to_string(i)));
  REQUIRE(bench.give("builds import " + bench.make_file("mill.rsb", bench.info("Mill"))).is_ok);

  bench.is_writer_busy = true;
  bench.begin("builds import " + files);
  for (int i = 0; i < 30; ++i) bench.step();
  CHECK(bench.answers.back().text == "builds import: 0 of 3 files");
  bench.begin("builds import " + files);
  for (int i = 0; i < 3; ++i) bench.step();
  CHECK(bench.answer().text ==
        "builds import: " + files + " is being imported: wait, or end that with `builds cancel`");
  bench.is_writer_busy = false;
  for (int i = 0; i < 10; ++i) bench.step();
  CHECK_FALSE(bench.answer().is_ok);
  CHECK(bench.answer().text ==
        "added: 2 builds of 3 files in " + files +
            "\nended before the end of the folder: the library of this world has 3 builds, and no "
            "more are allowed (builds_max): remove some");

  bench.make_file("files/3.rsb", bench.info("Build 3"));
  CHECK(bench.give("builds import " + files).text ==
        "builds import: " + files +
            ": has more than 3 .rsb files, and the library of this world takes no more builds "
            "(builds_max): divide it");
}

TEST_CASE("the console cancels the import of a folder, and what was added stays",
          "[admin][library]") {
  LibraryBench bench;
  const std::string files = bench.folder / "files";
  std::filesystem::create_directories(files);
  for (int i = 0; i < 5; ++i)
    bench.make_file("files/" + std::to_string(i) + ".rsb",
                    bench.info("Build " + std::to_string(i)));
  bench.begin("builds import " + files);
  for (int i = 0; i < 4; ++i) bench.step();
  CHECK_FALSE(bench.give("builds cancel", bench.builder()).is_ok);
  CHECK(bench.give("builds cancel").text ==
        "ended: the import of " + files + "; what it added stays");
  for (int i = 0; i < 10; ++i) bench.step();
  CHECK(bench.answer().text.ends_with("\nended before the end of the folder: cancelled"));
  const std::size_t added = bench.bench.environment.records.size();
  CHECK(added > 0);
  CHECK(added < 5);
  CHECK(bench.give("builds import " + files).is_ok);
  CHECK(bench.give("builds list").text.ends_with("\nthe library has 5 builds"));
}

TEST_CASE("players list builds, and remove only their own ones", "[admin][library]") {
  LibraryBench bench;
  REQUIRE(bench.give("builds import " + bench.make_file("m.rsb", bench.info("Mill"))).is_ok);
  CHECK(bench.give("builds list", bench.builder()).is_ok);
  CHECK(bench.give("builds show 1", bench.builder()).is_ok);
  CHECK_FALSE(bench.give("builds import " + (bench.folder / "m.rsb"), bench.builder()).is_ok);
  CHECK_FALSE(bench.give("builds export 1 /dev/null", bench.builder()).is_ok);
  CHECK(bench.give("builds remove 1", bench.builder()).text ==
        "builds remove: somebody else has added it, and you may not administer");
}

TEST_CASE("a file is verified up to a number of runs, and as long as it is wanted",
          "[admin][library]") {
  SampleBuild build;
  build.info = sample_build_info({128, 64, 64});
  build.materials = sample_build_materials();
  for (std::uint32_t x = 0; x < 2; ++x)
    build.sections.push_back({{x, 0, 0}, uniform_chunk(Extent::cube(64), 2)});
  const Bytes file = rsb_of(build, 0);
  const auto verified = verify_build(file, 2 * (kRunsOfSection + 1));
  REQUIRE(verified.has_value());
  CHECK(verified->info == build.info);
  CHECK(verified->touched == 128 * 64 * 64);
  CHECK(verified->file_bytes == file.size());
  const auto too_many = verify_build(file, 2 * (kRunsOfSection + 1) - 1);
  REQUIRE_FALSE(too_many.has_value());
  CHECK(too_many.error().find("too finely divided") != std::string::npos);
  int sections = 0;
  const auto stopped = verify_build(file, 1'000, [&] { return ++sections < 2; });
  CHECK_FALSE(stopped.has_value());
  CHECK(sections == 2);
}

TEST_CASE("the log names what happened to the library", "[admin][library]") {
  AddBuild build;
  build.info.name = "Mill";
  build.info.sides = {5, 6, 7};
  build.file_bytes = 2000;
  CHECK(library_change_text(build) == "added the build \"Mill\", 5 x 6 x 7, 2 KiB");
  CHECK(library_change_text(RemoveBuild{7}) == "removed build 7");
}

TEST_CASE("a file is placed with the materials that a map chooses", "[admin][library]") {
  LibraryBench bench;
  const std::string file = bench.make_file("mill.rsb", bench.info("Mill"));
  const std::string map = bench.folder / "map.toml";
  std::ofstream(map) << "[materials]\n\"*\" = \"no such material\"\n\"a:b\" = \"stone\"\n";
  CommandAnswer answer = bench.give("import " + file + " at 0 0 0 map " + map);
  CHECK_FALSE(answer.is_ok);
  CHECK(answer.text.find("lacks 1 material of it: no such material;") != std::string::npos);
  REQUIRE(bench.answers.size() == 2);
  CHECK(bench.answers[0].text == map + ": these rows fit no material: \"a:b\"");

  std::ofstream(bench.folder / "c.png") << "x";
  answer = bench.give("import " + file + " at 0 0 0 colours " + (bench.folder / "c.png"));
  CHECK(answer.text.find("mill.rsb: is no height map (.png)") != std::string::npos);

  std::ofstream(map) << "[materials]\n\"*\" = 4\n";
  answer = bench.give("import " + file + " at 0 0 0 map " + map);
  CHECK_FALSE(answer.is_ok);
  CHECK(answer.text == "import: " + map + ":2: \"*\": must be the name of a material, in quotes");
  CHECK_FALSE(bench.give("builds place 1 at 0 0 0 map " + map).is_ok);
}

TEST_CASE("an import of a model takes the words of the converter", "[admin][library]") {
  LibraryBench bench;
  const std::string file = bench.folder / "statue.obj";
  const auto answer = [&](const std::string& words) {
    const CommandAnswer given = bench.give("import " + file + " at 0 0 0 " + words);
    CHECK_FALSE(given.is_ok);
    return given.text;
  };
  CHECK(answer("voxels 5000") == "voxels \"5000\": a whole number from 1 to 4096 is expected");
  CHECK(answer("up x") == "up \"x\": y or z is expected");
  CHECK(answer("voxels-per-metre 0") ==
        "voxels-per-metre \"0\": a number from 0.000001 to 1000000 is expected");
  CHECK(answer("hollow surface none").find("neither its inside nor its surface is wanted") !=
        std::string::npos);
  CHECK(answer("wide").find("voxels-per-metre, surface, hollow, fill-overlaps or up") !=
        std::string::npos);
}

}  // namespace runstone::test
