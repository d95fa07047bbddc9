// The command `materials add`: from the file to the answer.
#include "server/admin/material_file.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "tests/unit/server/admin/material_command_bench.hpp"

namespace runstone::test {
namespace {

struct AddBench : MaterialCommandBench {
  /// Writes a file and adds it at the console.
  CommandAnswer add(const std::string& toml) {
    std::ofstream(file, std::ios::binary) << toml;
    return give({}, "materials add \"" + file + "\"");
  }

  const std::string file = folder / "my wool.toml";
};

constexpr const char* kTwoRows =
    "[[material]]\nname = \"lime\"\ncolour = \"#80ff20\"\n"
    "[[material]]\nname = \"teal\"\ncolour = \"#208080\"\n";

}  // namespace

TEST_CASE("materials add answers with the record, ids and names", "[admin][materials]") {
  AddBench bench;
  const std::size_t first = bench.bench.server.order().materials().size();
  const CommandAnswer added = bench.add(kTwoRows);
  CHECK(added.is_ok);
  CHECK(added.text == "2 materials added (record 1)\n" + std::to_string(first) + " lime\n" +
                          std::to_string(first + 1) + " teal");
  CHECK(bench.give({}, "materials lime").text == "lime");
  CHECK(bench.store->materials()->size() == first + 2);
  const std::string log = bench.give({}, "log cause materials").text;
  CHECK(log.ends_with("the server materials " + std::to_string(first) + " lime, " +
                      std::to_string(first + 1) + " teal"));
  CHECK(bench.add("[[material]]\nname = \"plum\"\ncolour = \"#208080\"\n")
            .text.starts_with("1 material added (record 2)\n"));
}

TEST_CASE("materials add refuses a bad file with file, line and key, and adds nothing",
          "[admin][materials]") {
  AddBench bench;
  const std::string begin = "materials add: " + bench.file;
  CHECK(bench.add("").text == begin + ": material: is missing");
  CHECK(bench.add(std::string(kTwoRows) + "[[material]]\nname = \"stone\"\ncolour = \"#000000\"\n")
            .text == begin + ":7: material[2]: name is already taken");
  CHECK(bench.add("[[material]]\nname = \"a\"\ncolour = \"red\"\n")
            .text.starts_with(begin + ":3: material[0].colour: "));
  CHECK(bench.add("[[material]]\nname = \"a\"\ncolour = \"#000000\"\n[material.generate]\n")
            .text.starts_with(begin + ":4: material[0].generate"));
  std::string many;
  for (std::size_t i = 0; i <= kAddedMaterialsMax; ++i)
    many += "[[material]]\nname = \"a" + std::to_string(i) + "\"\ncolour = \"#000000\"\n";
  CHECK(bench.add(many).text == begin + ": 513 materials: 1 to 512 can be added at a time");
  CHECK(bench.add(std::string(kMaterialFileBytesMax + 1, '#')).text ==
        begin + ": is larger than 1048576 bytes");
  CHECK(bench.bench.server.order().head() == 0);
  CHECK(bench.bench.server.order().materials() == sample_meta().materials);
}

TEST_CASE("materials add reads regular files only, for the console and control",
          "[admin][materials]") {
  AddBench bench;
  CHECK(bench.give({}, "materials add " + bench.folder.path()).text ==
        "materials add: " + bench.folder.path() + ": is a folder");
  CHECK(bench.give({}, "materials add " + (bench.folder / "none")).text.find("No such file") !=
        std::string::npos);
  const std::string pipe = bench.folder / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK(bench.give({}, "materials add " + pipe).text.ends_with("a pipe or a socket, and no file"));
  const PublicKey key = key_pair_of(seed_of(1)).public_key;
  bench.join(1);
  CHECK(bench.give({1, {key, true}}, "materials add wool.toml").text ==
        "this command is for the console and `runstone-server control`");
}

}  // namespace runstone::test
