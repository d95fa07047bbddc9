// A box of a world becomes an .npy with the ids of its materials.
#include <array>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "server/history/voxels_at.hpp"
#include "server/replay/command_world.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/replay/run_replay.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

std::string npy_text(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void make_dump_world(const std::string& folder) {
  WorldMeta meta = sample_meta();
  meta.generator = {"terrain", 1, 78, ""};
  auto store = create_world(folder, meta);
  REQUIRE(store.has_value());
  REQUIRE((*store)->raise_epoch().has_value());
  SplitMix64 rng(8);
  const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
  REQUIRE((*store)->append(players, sample_records(rng, 1, 1, 50)).has_value());
}

}  // namespace

TEST_CASE("a dump has the head of numpy and the ids of the box, in parts of any thickness",
          "[server][replay]") {
  const TempFolder folder;
  const std::string world = folder / "world", file = folder / "box.npy";
  make_dump_world(world);
  // 20 layers of 51 x 20,580 voxels are 2 MiB each: with --memory 3 each part is one layer.
  const VoxelBox box{{-9, -20, -80}, {11, 31, 20'500}};
  const auto [at, memory] = GENERATE(table<Sequence, std::string>({{20, "3"}, {50, "256"}}));
  const ReplayOutcome done =
      run_replay({"dump", "--world", world, "--box", "-9,-20,-80,10,30,20499", "--at",
                  std::to_string(at), "--memory", memory, file});
  INFO(done.out << done.err);
  REQUIRE(done.code == 0);
  CHECK(done.out.find("20 x 51 x 20580 elements of type uint16") != std::string::npos);

  const std::string bytes = npy_text(file);
  REQUIRE(bytes.size() > 128);
  CHECK(bytes.starts_with(std::string("\x93NUMPY\x01\x00", 8)));
  const std::size_t head =
      10 + static_cast<unsigned char>(bytes[8]) + 256U * static_cast<unsigned char>(bytes[9]);
  CHECK(head % 64 == 0);
  const std::string words = bytes.substr(10, head - 10);
  CHECK(words.find("'descr': '<u2'") != std::string::npos);
  CHECK(words.find("'fortran_order': False") != std::string::npos);
  CHECK(words.find("(20, 51, 20580)") != std::string::npos);

  const auto source = open_for_reading(world);
  REQUIRE(source.has_value());
  const auto then = WorldAt::open(*source->store, *source->generator, at);
  REQUIRE(then.has_value());
  std::vector<Material> expected(std::size_t{20} * 51 * 20'580);
  const std::array<WorldReader*, 1> readers = {source->store.get()};
  REQUIRE(read_voxels(*then, readers, box, expected).has_value());
  REQUIRE(bytes.size() == head + expected.size() * 2);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto low = static_cast<unsigned char>(bytes[head + 2 * i]);
    const auto high = static_cast<unsigned char>(bytes[head + 2 * i + 1]);
    if (low + 256U * high != expected[i]) ++wrong;
  }
  CHECK(wrong == 0);
}

TEST_CASE("a dump refuses a file, a box and a moment that cannot be, and writes nothing",
          "[server][replay]") {
  const TempFolder folder;
  const std::string world = folder / "world";
  make_dump_world(world);
  const auto refusal = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"dump", "--world", world});
    const ReplayOutcome outcome = run_replay(words);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    return outcome.err;
  };
  const std::string file = folder / "a.npy";
  CHECK(refusal({"--box", "0,0,0,1,1,1", folder / "a.txt"}).find("must end in .npy") !=
        std::string::npos);
  CHECK(refusal({file}).find("--box") != std::string::npos);
  CHECK(refusal({"--box", "0,0,0,1,1", file}).find("two opposite corners") != std::string::npos);
  CHECK(refusal({"--box", "0,0,0,1,1,600000000", file}).find("two opposite corners") !=
        std::string::npos);
  CHECK(refusal({"--box", "0,0,0,1,9999,9999", "--memory", "1", file}).find("--memory") !=
        std::string::npos);
  CHECK(refusal({"--box", "0,0,0,1,1,1", "--at", "51", file}).find("ends at seq=50") !=
        std::string::npos);
  CHECK_FALSE(std::filesystem::exists(file));
}
