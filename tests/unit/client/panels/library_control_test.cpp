#include "client/panels/library_control.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <thread>
#include <utility>

#include "client/panels/build_picture.hpp"
#include "common/builds/build_transforms.hpp"
#include "common/builds/paste_source.hpp"
#include "common/edits/clipboard/clipboard_builder.hpp"
#include "tests/unit/client/session/session_bench.hpp"

namespace runstone::test::session_bench {
namespace {

/// Returns a build of 3 x 2 x 2 cells: the lower layer is of material 1, and of the upper one a cell of
/// material 2.
BuildPtr small_build() {
  ClipboardBuilder cells({3, 2, 2});
  for (int z = 0; z < 2; ++z) {
    cells.append(3, Material{1});
    cells.append(1, z == 0 ? Material{2} : kEmpty);
    cells.append(2, kEmpty);
  }
  return build_of(**cells.finish());
}

std::vector<MaterialRow> rows_of(const Build& build) {
  std::vector<MaterialRow> out;
  for (const Material material : build.palette()) {
    if (material == kEmpty) out.push_back({"air", {0, 0, 0, 0}, Visibility::empty});
    if (material == 1) out.push_back({"default:stone", {90, 90, 90, 255}});
    if (material == 2) out.push_back({"somewhere:marble", {250, 240, 230, 255}});
  }
  return out;
}

Bytes small_file(const std::string& name) {
  const BuildPtr build = small_build();
  auto info = named_build(name, {}, "ana");
  REQUIRE(info.has_value());
  auto file =
      write_library_file(*build, rows_of(*build), *std::move(info), EmptyCells::pasted, 1 << 20);
  REQUIRE(file.has_value());
  return *std::move(file);
}

/// A session in a world with a library, and the control without threads. The test plays the server.
struct LibraryClient : SessionBench {
  explicit LibraryClient(bool has_threads = false) : control(session, tools, has_threads) {
    server.features = kFeatureBuilds | kFeatureCommands;
    open();
    static_cast<void>(tools.set_materials(server.welcome.materials));
  }
  template <class T>
  T sent_one() {
    control.step(now);
    const auto out = take<T>(sent());
    REQUIRE(out.size() == 1);
    return out[0];
  }
  void list(const std::vector<std::pair<Sequence, std::uint64_t>>& builds) {
    control.carry_out(FindBuilds{});
    answer_list(builds);
  }
  void answer_list(const std::vector<std::pair<Sequence, std::uint64_t>>& builds) {
    Builds answer;
    answer.request = sent_one<BuildsRequest>().request;
    answer.total = builds.size();
    for (const auto& [number, file_bytes] : builds) {
      ListedBuild build;
      build.number = number;
      build.info.name = "mill";
      build.file_bytes = file_bytes;
      build.added_by = session.author();
      answer.builds.push_back(build);
    }
    receive(answer);
    control.step(now);
  }
  void answer_piece(const Bytes& file) {
    receive(BuildPiece{sent_one<BuildPieceRequest>().request, file, {}});
    for (int i = 0; i < 3; ++i) control.step(now);
  }
  LibraryState state() const {
    LibraryState out;
    control.fill(out);
    return out;
  }
  ToolBox tools;
  LibraryControl control;
};

/// A client whose control uses threads.
struct ThreadedLibraryClient : LibraryClient {
  ThreadedLibraryClient() : LibraryClient(true) {}
};

}  // namespace

TEST_CASE_METHOD(LibraryClient, "the window gets the listing, and the picture of a build",
                 "[client_app]") {
  CHECK(state().builds == nullptr);
  const Bytes file = small_file("mill");
  list({{9, file.size()}, {4, 2'000'000}});
  REQUIRE(state().builds != nullptr);
  CHECK(state().builds->size() == 2);
  CHECK(state().unavailable.empty());
  control.carry_out(ShowBuild{9});
  CHECK(state().fetching == 9);
  answer_piece(file);
  CHECK(state().fetching == 0);
  CHECK(state().fetch_text.empty());
  CHECK(state().pictured == 9);
  REQUIRE(state().picture != nullptr);
  CHECK(tools.clipboard().build == nullptr);
  control.carry_out(TakeBuild{9});  // it is here
  control.step(now);
  CHECK(take<BuildPieceRequest>(sent()).empty());
  REQUIRE(tools.clipboard().build);
  CHECK(tools.clipboard().build->sides() == VoxelPos{3, 2, 2});
}

TEST_CASE_METHOD(LibraryClient,
                 "a build that is taken is pasted next, with materials of this world",
                 "[client_app]") {
  const Bytes file = small_file("mill");
  list({{9, file.size()}});
  control.carry_out(TakeBuild{9});
  answer_piece(file);
  REQUIRE(tools.clipboard().build);
  CHECK(tools.tool().name() == "paste");
  CHECK(state().taken == 1);
  const auto stone = server.welcome.materials.find("default:stone");
  if (stone) CHECK(tools.clipboard().build->at({0, 0, 0}) == stone);
  const auto notices = control.take_notices();
  REQUIRE(notices.size() == 1);
  CHECK(notices[0].starts_with("\"mill\" is in the clipboard: click to paste it"));
  CHECK(notices[0].find("somewhere:marble") != std::string::npos);
}

TEST_CASE_METHOD(LibraryClient, "a damaged file changes no clipboard, and says where it is damaged",
                 "[client_app]") {
  Bytes file = small_file("mill");
  file[file.size() / 2] ^= 1U;
  list({{9, file.size()}});
  control.take(9);
  answer_piece(file);
  CHECK_FALSE(control.is_busy());
  CHECK_FALSE(control.has_succeeded());
  REQUIRE(control.answer().size() == 1);
  CHECK(control.answer()[0].starts_with("the file of the build is damaged: "));
  CHECK(tools.clipboard().build == nullptr);
}

TEST_CASE_METHOD(LibraryClient, "a fetch ends with the connection, and with the user's word",
                 "[client_app]") {
  list({{9, 500'000}});
  control.take(9);
  control.step(now);
  SECTION("the connection") {
    session.disconnected();
    control.step(now);
    CHECK(control.answer().at(0) == "the connection ended");
    CHECK(state().unavailable == "no world is open");
  }
  SECTION("the user") {
    control.carry_out(StopFetch{});
    CHECK(control.answer().at(0) == "stopped");
  }
  CHECK_FALSE(control.is_busy());
  CHECK_FALSE(control.has_succeeded());
  CHECK(state().fetching == 0);
}

TEST_CASE_METHOD(LibraryClient, "the clipboard is added as a build with name, tags and author",
                 "[client_app]") {
  const BuildPtr build = small_build();
  static_cast<void>(tools.set_clipboard(build, EmptyCells::pasted, rows_of(*build)));
  CHECK(state().clipboard.starts_with("3 x 2 x 2 voxels"));
  control.carry_out(AddClipboard{" my mill ", "wood, farm,,wood"});
  CHECK(state().is_adding);
  control.step(now);  // the file is made
  const auto offer = sent_one<BuildOffer>();
  receive(BuildAnswer{offer.request, 0, 0, {}});
  const auto upload = sent_one<BuildUpload>();
  CHECK(upload.bytes.size() == offer.file_bytes);
  const auto read = read_library_file(upload.bytes);
  REQUIRE(read.has_value());
  CHECK(read->info.name == "my mill");
  CHECK(read->info.tags == std::vector<std::string>{"farm", "wood"});
  CHECK(read->info.author == "ada");
  CHECK(read->build->touched() == 12);
  receive(BuildAnswer{offer.request, offer.file_bytes, 0, {}});
  receive(BuildAnswer{offer.request, offer.file_bytes, 31, {}});
  control.step(now);
  CHECK_FALSE(state().is_adding);
  CHECK(state().add_text == "\"my mill\" is in the library: build 31");
}

TEST_CASE_METHOD(LibraryClient, "what cannot be added is refused with a reason", "[client_app]") {
  const auto refusal = [this](const std::string& name) {
    control.add(name);
    for (int i = 0; i < 2; ++i) control.step(now);
    CHECK_FALSE(control.is_busy());
    CHECK_FALSE(control.has_succeeded());
    return control.answer().at(0);
  };
  CHECK(refusal("mill") == "the clipboard is empty: copy a selection first");
  const BuildPtr build = small_build();
  static_cast<void>(tools.set_clipboard(build, EmptyCells::pasted, rows_of(*build)));
  CHECK(refusal(" ") == "the build is not added: give the build a name");
  CHECK(refusal("a\"b").starts_with("the build is not added: name of the build"));
  control.add("mill");
  control.step(now);
  const auto offer = sent_one<BuildOffer>();
  receive(BuildAnswer{offer.request, 0, 0, "the library is full"});
  control.step(now);
  CHECK_FALSE(control.has_succeeded());
  CHECK(control.answer().at(0) == "the build is not added: the library is full");
  CHECK_FALSE(state().is_adding);
}

TEST_CASE_METHOD(LibraryClient, "a build is removed by a command, and the list is asked for again",
                 "[client_app]") {
  list({{9, 500}, {4, 500}});
  control.carry_out(DropBuild{9});
  const auto command = sent_one<CommandRequest>();
  CHECK(command.text == "builds remove 9");
  CHECK(state().is_removing);
  receive(CommandOutput{command.id, {"build 9 is removed"}, true, true});
  answer_list({{4, 500}});
  CHECK(state().remove_text == "build 9 is removed");
  CHECK(state().builds->size() == 1);
}

TEST_CASE_METHOD(LibraryClient, "a script lists builds as lines", "[client_app]") {
  control.list("mi");
  CHECK(control.is_busy());
  answer_list({{9, 500}});
  CHECK_FALSE(control.is_busy());
  CHECK(control.has_succeeded());
  CHECK(control.answer() ==
        std::vector<std::string>{"9  mill  1 x 1 x 1  500 bytes", "the library has 1 build"});
}

TEST_CASE_METHOD(ThreadedLibraryClient, "files are read and written on threads, too",
                 "[client_app]") {
  const Bytes file = small_file("mill");
  list({{9, file.size()}});
  control.take(9);
  receive(BuildPiece{sent_one<BuildPieceRequest>().request, file, {}});
  while (control.is_busy()) {
    control.step(now);
    std::this_thread::yield();
  }
  REQUIRE(control.has_succeeded());
  control.add("copy");
  std::vector<BuildOffer> offers;
  while (offers.empty()) {
    control.step(now);
    offers = take<BuildOffer>(sent());
    std::this_thread::yield();
  }
  CHECK(offers[0].file_bytes > 100);
  control.carry_out(StopAdding{});
  CHECK(control.answer() == std::vector<std::string>{"stopped: nothing is added"});
}

TEST_CASE_METHOD(LibraryClient, "another world forgets the library of the one before",
                 "[client_app]") {
  const Bytes file = small_file("mill");
  list({{9, file.size()}});
  control.carry_out(ShowBuild{9});
  answer_piece(file);
  control.take(4);
  control.step(now);
  static_cast<void>(sent());
  server.world_id = {7, 7};
  open();
  control.step(now);
  CHECK_FALSE(control.is_busy());
  CHECK(control.answer() == std::vector<std::string>{"the connection ended"});
  CHECK(state().builds == nullptr);
  CHECK(state().picture == nullptr);
}

TEST_CASE("the picture of a build is small, and shows the upper cells", "[client_app]") {
  const BuildPtr build = small_build();
  const auto picture = build_picture(*build, rows_of(*build));
  REQUIRE(picture != nullptr);
  CHECK(picture->width <= kBuildPicturePixels);
  CHECK(picture->height <= kBuildPicturePixels);
  CHECK(picture->pixels.size() ==
        static_cast<std::size_t>(picture->width) * static_cast<std::size_t>(picture->height));
  const auto has = [&](std::uint32_t red) {
    return std::ranges::any_of(picture->pixels, [&](std::uint32_t pixel) {
      return pixel >> 24 == 255 && (pixel & 255U) == red;
    });
  };
  CHECK(picture->pixels.front() == 0);
  CHECK(has(99));   // the upper side of the stone, 90 * 1.1
  CHECK(has(255));  // that of the marble
  const auto large = stacked(*build, {3, 0, 0}, 600);
  REQUIRE(large.has_value());
  const auto wide = build_picture(**large, rows_of(**large));
  CHECK(wide->width <= kBuildPicturePixels);
  CHECK(std::ranges::any_of(wide->pixels, [](std::uint32_t pixel) { return pixel != 0; }));
}

}  // namespace runstone::test::session_bench
