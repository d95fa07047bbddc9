#include "server/names/lookalike_names.hpp"

#include <catch2/catch.hpp>

#include "server/names/name_skeleton.hpp"

namespace runstone::lookalike_names_test {
namespace {

LookalikeNames guarded() {
  LookalikeNames names;
  for (const char* name : {"admin", "mod", "server", "runstone server"}) names.add(name);
  for (const char* name : {"me", "here"}) names.add(name, LookalikeNames::Compare::whole);
  return names;
}

}  // namespace

TEST_CASE("names that look like a guarded one are found", "[names]") {
  const LookalikeNames names = guarded();
  CHECK(names.like("adm\u0131n") == "admin");                      // without a dot
  CHECK(names.like("\u1d00\u1d05\u1d0d\u026a\u0274") == "admin");  // small capitals
  CHECK(names.like("\u13daerver") == "server");                    // a Cherokee letter
  CHECK(names.like("m\u0585d") == "mod");                          // an Armenian letter
  CHECK(names.like("[ADMIN] ana") == "admin");
  CHECK(names.like("a d m i n") == "admin");
  CHECK(names.like("ana (a.d.m.i.n)") == "admin");
  CHECK(names.like("adm1n") == "admin");
  CHECK(names.like("AdmIn") == "admin");
  CHECK(names.like("admln") == "admin");
  CHECK(names.like("\u00e4dmin") == "admin");
  CHECK(names.like("the server") == "server");
  CHECK(names.like("Runstone-Server").has_value());
  CHECK(names.like("M\u0308od") == "mod");
}

TEST_CASE("other names are free, also with a word that only means listeners", "[names]") {
  const LookalikeNames names = guarded();
  for (const char* name : {"ana", "administrate", "modesty", "observer", "call me ana", "adam",
                           "\u0438\u0432\u0430\u043d", "\u4e2d\u6587", "\U0001f600", "..."}) {
    CAPTURE(name);
    CHECK(names.like(name) == std::nullopt);
  }
  CHECK(names.like("ME") == "me");
  CHECK(names.like("m e") == "me");
}

TEST_CASE("only words that mean listeners are compared as a whole", "[names]") {
  for (const char* name : {"all", "anybody", "everybody", "everyone", "here", "me", "nobody"}) {
    CAPTURE(name);
    CHECK(is_compared_whole(name));
  }
  for (const char* name : {"admin", "mod", "op", "staff"}) {
    CAPTURE(name);
    CHECK_FALSE(is_compared_whole(name));
  }
  LookalikeNames names;
  names.add("op");
  for (const char* name : {"[OP] ana", "ana (op)", "0p", "o.p. ana", "\u043e\u0440 ana"}) {
    CAPTURE(name);
    CHECK(names.like(name) == "op");
  }
  for (const char* name : {"opal", "Opa", "Opa Heinz", "drop", "Poppy", "go play"}) {
    CAPTURE(name);
    CHECK(names.like(name) == std::nullopt);
  }
}

TEST_CASE("words are parted by all but letters, digits and marks", "[names]") {
  CHECK(name_words("[ADMIN] ana") == std::vector<std::string>{"ADMIN", "ana"});
  CHECK(name_words("a_b-c.7").size() == 4);
  CHECK(name_words("a\u0308b") == std::vector<std::string>{"a\u0308b"});
  CHECK(name_words("...").empty());
}

}  // namespace runstone::lookalike_names_test
