#include "client/net/key_file.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "tests/support/core/temp_folder.hpp"

using namespace runstone;

namespace {

struct Folder : test::TempFolder {
  std::string file(const char* name) const { return *this / name; }
  void write(const char* name, const std::string& text, mode_t mode = 0600) const {
    std::ofstream(file(name)) << text;
    REQUIRE(::chmod(file(name).c_str(), mode) == 0);
  }
};

}  // namespace

TEST_CASE_METHOD(Folder, "a missing key is created with mode 0600, and read again it is the same",
                 "[client_net]") {
  const KeyPair made = load_or_create_key(file("k"));
  struct stat info{};
  REQUIRE(::stat(file("k").c_str(), &info) == 0);
  CHECK((info.st_mode & 0777) == 0600);
  CHECK(load_or_create_key(file("k")).public_key == made.public_key);
  CHECK(load_or_create_key(file("other")).public_key != made.public_key);
  CHECK(random_key().public_key != random_key().public_key);
}

TEST_CASE_METHOD(Folder, "a key file has golden text", "[client_net]") {
  write("k", std::string(62, '0') + "01\n");
  KeySeed seed{};
  seed[31] = 1;
  CHECK(load_or_create_key(file("k")).public_key == key_pair_of(seed).public_key);
}

TEST_CASE_METHOD(Folder, "a key file and its pinned servers may have come through another editor",
                 "[client_net]") {
  const std::string mark = "\xEF\xBB\xBF", digits = std::string(62, '0') + "01";
  KeySeed seed{};
  seed[31] = 1;
  for (const std::string& text : {digits + "\r\n", mark + digits + "\n", mark + digits}) {
    write("k", text);
    CHECK(load_key_seed(file("k")) == seed);
  }
  write("k.servers", mark + std::string(32, '1') + " " + std::string(64, '2') + "\r\n");
  CHECK(load_pinned_servers(file("k")).size() == 1);
}

TEST_CASE_METHOD(Folder,
                 "a key file that other users may read, or that has no key, is refused and kept",
                 "[client_net]") {
  write("open", std::string(64, 'a') + "\n", 0644);
  CHECK_THROWS_WITH(load_or_create_key(file("open")), Catch::Contains("other users may read"));
  write("short", std::string(63, 'a') + "\n");
  CHECK_THROWS_WITH(load_or_create_key(file("short")), Catch::Contains("not a key file"));
  write("odd", std::string(63, 'a') + "g\n");
  CHECK_THROWS_WITH(load_or_create_key(file("odd")), Catch::Contains("not a key file"));
  write("empty", "");
  CHECK_THROWS_WITH(load_or_create_key(file("empty")), Catch::Contains("not a key file"));
  CHECK(std::filesystem::file_size(file("empty")) == 0);
  CHECK_THROWS_WITH(load_or_create_key(file("missing/k")), Catch::Contains("missing/k"));
  // The mode of a folder is not to be changed for a key.
  CHECK_THROWS_WITH(load_or_create_key(path()), path() + ": is a folder");
}

TEST_CASE_METHOD(Folder, "pinned servers are read as written, and an error names the damaged line",
                 "[client_net]") {
  CHECK(load_pinned_servers(file("k")).empty());
  std::map<WorldId, PublicKey> pinned;
  pinned[{1, 2}] = {3, 4};
  pinned[{0xff}] = {5};
  save_pinned_servers(file("k"), pinned);
  CHECK(load_pinned_servers(file("k")) == pinned);
  std::ifstream in(file("k.servers"));
  std::string first;
  std::getline(in, first);
  CHECK(first == "0102" + std::string(28, '0') + " 0304" + std::string(60, '0'));
  write("k.servers", first + "\nnonsense\n");
  CHECK_THROWS_WITH(load_pinned_servers(file("k")), Catch::Contains("k.servers:2"));
}
