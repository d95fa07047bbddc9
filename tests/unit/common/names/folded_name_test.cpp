#include "common/names/folded_name.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {

TEST_CASE("names that people take for one another have one folded form", "[names]") {
  CHECK(folded_name("Ana") == "ana");
  CHECK(folded_name("ANA") == "ana");
  CHECK(folded_name("Stra\u00dfe") == folded_name("STRASSE"));
  CHECK(folded_name("Ren\u00e9") == folded_name("Rene\u0301"));
  CHECK(folded_name("the  mole") == "the mole");
  CHECK(folded_name("\uff53\uff45\uff52\uff56\uff45\uff52") == "server");  // fullwidth
  CHECK(folded_name("\u24d0\u24d3\u24dc\u24d8\u24dd") == "admin");         // in circles
  CHECK(folded_name("\U0001d5ba\U0001d5bd\U0001d5c6\U0001d5c2\U0001d5c7") ==
        "admin");                            // sans-serif
  CHECK(folded_name("\ufb01sh") == "fish");  // a ligature
  CHECK(folded_name("a\u034fna") == "ana");  // an invisible joiner
  CHECK(folded_name("ana") != folded_name("anna"));
}

TEST_CASE("a name has a fault if it hides, mixes or is not known", "[names]") {
  for (const char* name :
       {"ana", "the mole", "Ren\u00e9", "\u0410\u043d\u0430", "\u0391\u03bd\u03bd\u03b1",
        "\u5c0f\u660e", "\u0905\u0928\u093e", "bot-17", "x_X", "\U0001f426"}) {
    CAPTURE(name);
    CHECK_FALSE(name_fault(name).has_value());
  }
  CHECK(name_fault(""));
  CHECK(name_fault(" ana"));
  CHECK(name_fault("a\u200bna"));   // zero width space
  CHECK(name_fault("a\u200dna"));   // zero width joiner
  CHECK(name_fault("\u202eana"));   // right-to-left override
  CHECK(name_fault("a\u2066na"));   // isolate
  CHECK(name_fault("\u0301ana"));   // begins with a mark
  CHECK(name_fault("\u00b4"));      // folds to a blank and a mark
  CHECK(name_fault("\U000e1234"));  // a tag
  CHECK(name_fault("a\u0378"));     // not assigned
  CHECK(name_fault("a\ue000"));     // private use
  CHECK(*name_fault("\u0430na") ==
        "it mixes Latin and Cyrillic letters, many of which look the same");
  CHECK(*name_fault("an\u03b1") == "it mixes Latin and Greek letters, many of which look the same");
  CHECK(*name_fault("\u0430\u03b1") ==
        "it mixes Greek and Cyrillic letters, many of which look the same");
  CHECK(name_fault("\uff41\u0430"));  // fullwidth Latin counts as Latin
}

}  // namespace runstone::test
