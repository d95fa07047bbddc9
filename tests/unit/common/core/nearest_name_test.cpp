#include "common/core/nearest_name.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

const std::vector<std::string> kNames = {"listen", "sessions_max", "sessions_per_key", "world",
                                         "Tls_Key"};

}  // namespace

TEST_CASE("a typing mistake leads to the name that was meant", "[core]") {
  for (const auto& [typed, meant] : std::vector<std::pair<std::string, std::string>>{
           {"sesions_max", "sessions_max"},    // a letter is missing
           {"sessionss_max", "sessions_max"},  // one too many
           {"wotld", "world"},                 // another letter
           {"wrold", "world"},                 // two in the wrong order
           {"LISTEN", "listen"},
           {"tls_key", "Tls_Key"},
           {"session_per_keys", "sessions_per_key"}}) {
    CAPTURE(typed);
    CHECK(nearest_name(typed, kNames) == meant);
    CHECK(did_you_mean(typed, kNames) == "; did you mean " + meant + "?");
  }
}

TEST_CASE("a name that is far from all others leads nowhere", "[core]") {
  for (const std::string& typed : {std::string(), std::string("x"), std::string("port"),
                                   std::string("memory_mib"), std::string(100, 'a')}) {
    CAPTURE(typed);
    CHECK(nearest_name(typed, kNames).empty());
    CHECK(did_you_mean(typed, kNames).empty());
  }
  CHECK(nearest_name("world", {}).empty());
}
