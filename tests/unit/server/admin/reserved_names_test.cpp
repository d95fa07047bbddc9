#include "server/admin/reserved_names.hpp"

#include <catch2/catch.hpp>

#include "common/names/folded_name.hpp"

using namespace runstone;

TEST_CASE("reserved names are parsed and compared by their folded forms", "[admin][names]") {
  CHECK(parse_reserved_names("")->empty());
  CHECK(*parse_reserved_names(" Host Anna, ,mayor ") ==
        std::vector<std::string>{"Host Anna", "mayor"});
  CHECK_FALSE(parse_reserved_names("a\"b").has_value());
  const auto reserved = folded_reserved_names({"Host Anna"});
  for (const char* name : {"server", "Console", "ADMIN", "everyone", "host  anna",
                           "\uff53\uff45\uff52\uff56\uff45\uff52"}) {
    CAPTURE(name);
    CHECK(reserved.contains(folded_name(name)));
  }
  for (const char* name : {"builder", "bot-1", "example", "ana", "the mole", "recorded server"}) {
    CAPTURE(name);
    CHECK_FALSE(reserved.contains(folded_name(name)));
  }
}
