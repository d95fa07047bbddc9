#include "server/store/place_rule.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "server/store/copy_stored_world.hpp"
#include "server/store/sqlite_backend.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

const std::vector<std::string> kMistyped = {"postgre://ana:secret@h/d",
                                            "Postgresql://ana:secret@h/d",
                                            "POSTGRES://ana:secret@h/d",
                                            "postgressql:h/d",
                                            "postgresql:/h/d",
                                            "mysql://ana:secret@h/d",
                                            "jdbc:postgresql://h/d",
                                            "sqlite:///srv/valley",
                                            "file:///srv/valley",
                                            "\"postgresql://ana:secret@h/d\"",
                                            " postgresql://ana:secret@h/d",
                                            "postgresql://ana:secre%t@h/d",
                                            "host=localhost dbname=x password=secret",
                                            "dbname = valley user = ana",
                                            "host=localhost dbname"};
const std::vector<std::string> kFolders = {
    "world",   "./world",         "/srv/valley",         "../my world",      "a=b",
    "c:world", "./postgre://h/d", "/srv/host=localhost", "./host=localhost", "postgres",
    "world:2"};

}  // namespace

TEST_CASE("a mistyped address of a database is no place and no folder", "[store][sqlite]") {
  for (const std::string& mistyped : kMistyped) {
    CAPTURE(mistyped);
    for (const auto check : {check_place, check_folder, check_database_address}) {
      const auto checked = check(mistyped);
      REQUIRE_FALSE(checked.has_value());
      CHECK(checked.error().find("secret") == std::string::npos);
    }
    CHECK_FALSE(place_refusal(mistyped).empty());
    CHECK_FALSE(folder_refusal(mistyped).empty());
  }
  CHECK(place_refusal("postgre://h/d").find("postgresql://USER@HOST:PORT/DATABASE") !=
        std::string::npos);
  CHECK(place_refusal("host=localhost dbname=x").find("postgresql://localhost/x") !=
        std::string::npos);
  CHECK(place_refusal("sqlite:///srv/valley").find("write the folder alone") != std::string::npos);
}

TEST_CASE("folders and addresses of databases are places", "[store][sqlite]") {
  for (const std::string& folder : kFolders) {
    CAPTURE(folder);
    CHECK(check_place(folder).has_value());
    CHECK(check_folder(folder).has_value());
    CHECK_FALSE(check_database_address(folder).has_value());
  }
  for (const std::string& url :
       {std::string("postgresql://h/d"), std::string("postgres://ana:secret@h:1/d?options=-cx")}) {
    CAPTURE(url);
    CHECK(check_place(url).has_value());
    CHECK(check_database_address(url).has_value());
    const auto folder = check_folder(url);
    REQUIRE_FALSE(folder.has_value());
    CHECK(folder.error().find("secret") == std::string::npos);
  }
}

TEST_CASE("a mistyped address makes no folder of its name, whatever makes or opens the world",
          "[store][sqlite]") {
  const TempFolder folder;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  for (const std::string& mistyped : kMistyped) {
    CAPTURE(mistyped);
    for (const auto& made : {create_world(mistyped, sample_meta()).has_value(),
                             open_world(mistyped, StoreAccess::read_write).has_value(),
                             create_sqlite_world(mistyped, sample_meta(), {}).has_value(),
                             open_sqlite_world(mistyped, StoreAccess::read_only, {}).has_value()})
      CHECK_FALSE(made);
  }
  REQUIRE(create_world("valley", sample_meta()).has_value());
  const auto copied = copy_stored_world("valley", "postgre://ana:secret@h/d", {});
  REQUIRE_FALSE(copied.has_value());
  CHECK(copied.error().message().find("secret") == std::string::npos);
  std::vector<std::string> left;
  for (const auto& entry : std::filesystem::directory_iterator("."))
    left.push_back(entry.path().filename().string());
  std::filesystem::current_path(before);
  CHECK(left == std::vector<std::string>{"valley"});
}
